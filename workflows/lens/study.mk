# A lens of sand under a levee.
#>   lens               the ground under a levee with a lens of sand, in three dimensions and as a plane section:
#>                      pictures, fines lost and discharge of both           -> workflows/out/lens/
#>   lens-slide         a levee over such a lens, followed until its landside slides, and its plane section: pictures,
#>                      when each has moved by 1, 5 and 10 cm; takes five minutes -> workflows/out/lens-slide/

lens_out := $(OUT)/lens
$(eval $(call run_rules,$(lens_out)/lens,examples/lens/lens.toml))
$(eval $(call run_rules,$(lens_out)/section,examples/lens/lens.toml,name=section geometry.file="section.geo" gravity=[0.0$(comma)-9.81]))

# $(call lens_picture,FILES,RUN,COMMAND)
lens_picture = $(call draw,lens_pictures,$(addprefix $(lens_out)/,$1),$(lens_out)/$2,$3)
$(call lens_picture,model.png,lens,figure model RESULTS)
$(call lens_picture,streamlines.png,lens,render RESULTS --field head --streamlines)
$(call lens_picture,porous.png,lens,render RESULTS --field porosity --iso 0.36$(comma)0.39)
$(call lens_picture,$(call both,cut),lens,render RESULTS --field porosity --cut y=0 --vectors --range 0.3:0.41)
$(call lens_picture,$(call both,section),section,render RESULTS --field porosity --vectors --range 0.3:0.41)

$(lens_out)/compare.csv: lens/compare.py $(lens_out)/lens.history.csv $(lens_out)/section.history.csv
	$(PYTHON) $^ > $@

.PHONY: lens
lens: $(lens_pictures) $(lens_out)/compare.csv $(call tables,$(lens_out)/lens $(lens_out)/section)
	@cat $(lens_out)/compare.csv
	@echo "Pictures, tables and results are in $$(realpath $(lens_out))"

slide_lens_out := $(OUT)/lens-slide
$(eval $(call run_rules,$(slide_lens_out)/levee,examples/lens-slide/lens-slide.toml))
$(eval $(call run_rules,$(slide_lens_out)/section,examples/lens-slide/lens-slide.toml,name=section geometry.file="section.geo" gravity=[0.0$(comma)-9.81]))

# $(call lens_slide_picture,FILES,RUN,COMMAND)
lens_slide_picture = $(call draw,lens_slide_pictures,$(addprefix $(slide_lens_out)/,$1),$(slide_lens_out)/$2,$3)
$(call lens_slide_picture,model.png,levee,figure model RESULTS)
$(call lens_slide_picture,$(call both,cut),levee,render RESULTS --field porosity --cut y=0 --vectors --range 0.3:0.45)
$(call lens_slide_picture,$(call both,section),section,render RESULTS --field displacement --on solid)

$(call draw,lens_slide_pictures,$(call both,$(slide_lens_out)/displacement),$(slide_lens_out)/levee $(slide_lens_out)/section,figure curves displacement_max RESULTS --time-unit h)

$(slide_lens_out)/compare.csv: lens/compare_slide.py $(slide_lens_out)/levee.history.csv $(slide_lens_out)/section.history.csv
	$(PYTHON) $^ > $@

.PHONY: lens-slide
lens-slide: $(lens_slide_pictures) $(slide_lens_out)/compare.csv $(call tables,$(slide_lens_out)/levee $(slide_lens_out)/section)
	@cat $(slide_lens_out)/compare.csv
	@echo "Pictures, tables and results are in $$(realpath $(slide_lens_out))"
