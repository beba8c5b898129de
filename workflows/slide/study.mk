# A levee that slides.
#>   slide              a levee that loses its fines under a flood, then its strength, and slides: pictures, a film,
#>                      the factor of safety until then                       -> workflows/out/slide/
#>   slide-images       the same, and its pictures into the documentation           -> docs/images/
#>   slide-study        the moment at which it fails, by mesh and tolerance; takes an hour

slide_out  := $(OUT)/slide
slide_stem := $(slide_out)/slide
slide_view := 4$(comma)-1.5:18$(comma)3.5
$(eval $(call run_rules,$(slide_stem),examples/slide/slide.toml))

# $(call slide_picture,NAME,OPTIONS)
slide_picture = $(call draw,slide_pictures,$(call both,$(slide_out)/$1),$(slide_stem),render RESULTS $2 --view $(slide_view))
$(call draw,slide_pictures,$(slide_out)/model.png,$(slide_stem),figure model RESULTS)
$(call draw,slide_pictures,$(slide_out)/head.png,$(slide_stem),figure head RESULTS --time 10000)
$(call slide_picture,fines-before,--field fines_left --on solid --time 17500)
$(call slide_picture,strain-before,--field plastic_strain --on solid --time 17500)
$(call slide_picture,saturation-before,--field saturation --on cell --time 17500)
$(call slide_picture,fines-after,--field fines_left --on solid)
$(call slide_picture,displacement-after,--field displacement --on solid)
$(call draw,slide_pictures,$(slide_out)/film.png,$(slide_stem),animate RESULTS --field fines_left --on solid --view $(slide_view))
# The flood until the levee fails, and the seconds after that.
$(call draw,slide_pictures,$(call both,$(slide_out)/flood),$(slide_stem),figure curves eroded displacement_max RESULTS --time-unit h)
$(call draw,slide_pictures,$(call both,$(slide_out)/fall),$(slide_stem),figure curves displacement_max RESULTS \
  --x-range $$$$($(PYTHON) slide/study.py fall $(slide_stem).results))

$(slide_out)/factors.csv: slide/study.py $(slide_stem).status
	$(PYTHON) $< factors $(solver) $(slide_stem) > $@

.PHONY: slide slide-images
slide: $(slide_pictures) $(slide_out)/factors.csv $(call tables,$(slide_stem))
	@cat $(slide_out)/factors.csv
	@echo "Pictures, film, tables and results are in $$(realpath $(slide_out))"

# The eight pictures of docs/use/from-seepage-to-failure.md.
slide-images: slide
	@for name in model head flood fines-before strain-before fall displacement-after fines-after; do \
	   image=$${name%-before}; [ $$name = fines-after ] || image=$${image%-after}; \
	   cp $(slide_out)/$$name.png ../docs/images/slide-$$image.png; done

# The study takes long, so it is not repeated while its table exists.
$(slide_out)/study.csv: slide/study.py $(addprefix examples/slide/,slide.toml levee.geo) | $(mesher) $(solver)
	@mkdir -p $(@D)/study
	$(PYTHON) $< moments $(BIN) $(@D)/study > $@

.PHONY: slide-study
slide-study: $(slide_out)/study.csv
	@cat $<
