# A lens of sand under a levee.
#>   lens               the ground under a levee with a lens of sand, in three dimensions and as a plane section:
#>                      pictures, fines lost and discharge of both           -> workflows/out/lens/

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
