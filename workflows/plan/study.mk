# What skipping is worth, and how good estimates are.
#>   plan               how good estimates are, for scenes of every kind, and what skipping is worth, for those of
#>                      the paper; takes half an hour                    -> workflows/out/plan/, docs/evidence/plan.md

# Scenes of every kind that the workflows, the tutorials and the cases have. Each runs for less than ten minutes. Name, scene,
# KEY=VALUE as for the mesher's --set, without spaces.

# $(call plan_scene,NAME,SCENE,CHANGES): its estimate.
define plan_scene
plan_names += $1
$(call case_rules,$(OUT)/plan/$1,$2,name=$1 $3)
endef
# $(call plan_skips,NAME,SCENE,CHANGES): its estimate, and the gain by skipping.
define plan_skips
plan_skip_names += $1
$(call plan_scene,$1,$(PAPER)/$2.toml,$3)
endef
# The paper's scenes, and finer ones with little output that take long enough to be timed.
plan_fine := output.snapshot_every=30.0
$(foreach name,sp-constant-table dp-logarithmic sp-consistent sp-implicit dp-implicit,$(eval $(call plan_skips,$(name),$(name))))
$(eval $(call plan_skips,dp-consistent-fine,dp-consistent,mesh.size=0.0625 $(plan_fine)))
$(eval $(call plan_skips,sp-implicit-fine,sp-implicit,mesh.size=0.0125 $(plan_fine)))
$(eval $(call plan_skips,dp-implicit-fine,dp-implicit,mesh.size=0.025 $(plan_fine)))

# A flood and a falling reservoir, with retention; years and centuries; a plane section of the lens.
$(eval $(call plan_scene,levee-flood,examples/levee/flood.toml))
$(eval $(call plan_scene,levee-dam,examples/dam/dam.toml))
$(eval $(call plan_scene,decades-weir,examples/decades/weir.toml))
$(eval $(call plan_scene,decades-levee,examples/decades/levee.toml))
$(eval $(call plan_scene,lens-section,examples/lens/lens.toml,geometry.file="section.geo" gravity=[0.0$(comma)-9.81]))
# A channel that erosion opens, a laboratory's specimen, a sheet pile, a weir.
$(eval $(call plan_scene,channel,laboratory/channel.toml,mesh.size=10e-3))
$(eval $(call plan_scene,specimen,examples/permeameter/specimen.toml))
$(eval $(call plan_scene,pile,pictures/pile.toml))
$(eval $(call plan_scene,sweep-weir,examples/weir/weir.toml,output.snapshot_every=200.0))
$(eval $(call plan_scene,day,stiffness/day.toml))
# Soil that moves: a bank, soil with layers.
$(eval $(call plan_scene,kill-bank,stress/kill-bank.toml))
$(eval $(call plan_scene,bedding,../tests/cases/bedding.toml))
# Cases: deposits, pores that erode until no water is left, drives that grow, jumps after decades.
$(foreach case,residual-decades no-water-left negative-deposits gradient-drive jump-in-decades,\
  $(eval $(call plan_scene,$(case),../tests/cases/$(case).toml)))
# Three dimensions.
$(eval $(call plan_scene,lens,examples/lens/lens.toml))

# PLAN_SCENES=NAMES: only these scenes; then the document is left as it is.
PLAN_SCENES  ?= $(plan_names)
plan_columns := scene,seconds,seconds_no_skip,passes,passes_no_skip,steps,steps_no_skip,difference,column,bound,memory,disk,estimate_steps,estimate_seconds,estimate_memory,estimate_disk,trial

# The runs are timed, so they are made one after the other, whatever -j.
plan_lines := $(foreach name,$(PLAN_SCENES),$(OUT)/plan/$(name).csv)
$(plan_lines): $(OUT)/plan/%.csv: $(OUT)/plan/%.case.h5 plan/study.py $(solver)
	@echo "plan/study.py measure $*"
	@flock $(@D) $(PYTHON) plan/study.py measure $(solver) $< $(OUT)/plan/$* $(if $(filter $*,$(plan_skip_names)),skips)

$(OUT)/plan/plan.csv: $(plan_lines)
	@{ echo $(plan_columns); cat $^; } > $@

.PHONY: plan
plan: $(OUT)/plan/plan.csv
	@$(PYTHON) plan/study.py report $< $(if $(filter-out $(PLAN_SCENES),$(plan_names)),,../docs/evidence/plan.md)
