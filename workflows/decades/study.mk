# A weir and a levee over decades.
#>   decades            a weir for a hundred years, a levee through ten floods in ten years: fines lost
#>                                                                            -> workflows/out/decades/

decades_stems := $(addprefix $(OUT)/decades/,weir levee)
$(foreach stem,$(decades_stems),$(eval $(call run_rules,$(stem),examples/decades/$(notdir $(stem)).toml)))
$(foreach stem,$(decades_stems),$(foreach figure,porosity masses,\
  $(call draw,decades_figures,$(call both,$(stem).$(figure)),$(stem),figure $(figure) RESULTS)))

.PHONY: decades
decades: $(call tables,$(decades_stems)) $(decades_figures)
	@echo "Figures, tables and results are in $$(realpath $(OUT)/decades)"
