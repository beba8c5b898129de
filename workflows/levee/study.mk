# A levee and a dam.
#>   levee              a levee under a flood of ten days, and under its highest water for ever; a dam whose
#>                      reservoir falls: head, phreatic line, fines lost      -> workflows/out/levee/

levee_stem = $(OUT)/levee/$1
$(foreach name,levee/flood dam/dam,$(eval $(call run_rules,$(call levee_stem,$(notdir $(name))),examples/$(name).toml)))
$(eval $(call run_rules,$(call levee_stem,high-water),examples/levee/flood.toml,name=high-water \
  boundary[0].head=4.2 initial.flow="steady" time.end=3600.0 output={every=3600.0}))

# $(call levee_map,FILE,FIGURE,RUN,TIME): a map of one figure at a time, s.
levee_map = $(call draw,levee_figures,$(call both,$(OUT)/levee/$1),$(call levee_stem,$3),figure $2 RESULTS $(if $4,--time $4))
$(call levee_map,flood-rising,head,flood,129600)
$(call levee_map,flood-highest,head,flood,518400)
$(call levee_map,flood-falling,head,flood,691200)
$(call levee_map,flood-saturation,saturation,flood,518400)
$(call levee_map,high-water-head,head,high-water,0)
$(call levee_map,dam-full,head,dam,864000)
$(call levee_map,dam-after,head,dam,1209600)
$(call levee_map,dam-late,head,dam,5184000)
$(call levee_map,flood-boundaries,boundaries,flood)
$(call levee_map,dam-boundaries,boundaries,dam)

.PHONY: levee
levee: $(levee_figures) $(call tables,$(foreach name,flood dam high-water,$(call levee_stem,$(name))))
	@echo "Figures, tables and results are in $$(realpath $(OUT)/levee)"
