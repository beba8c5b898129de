# A scene of one's own, and sweeps.
#>   study SCENE=FILE   mesh, solve, ledger, figures and a report of any scene   -> workflows/out/study/
#>   sweep SCENE=FILE SWEEP=FILE.csv   a run for each row of a table of keys, or of values drawn from distributions: one
#>                      table of all, figures over the keys; without files a weir   -> workflows/out/sweep/

# Paths may have spaces here, so scripts do the work, with these variables in the environment. -C changes the folder but not PWD:
# a relative path is relative to the folder where make was called.
$(runs_goals): export PROGRAMS    := $(BIN)
$(runs_goals): export CALLED_FROM := $(PWD)
$(foreach name,PYTHON TOLERANCE SCENE SWEEP NAME LAUNCH FACTOR REGION DEEPER QUADRATIC OUTPUTS SIZES TOLERANCES MEASURED KEYS \
  AGAINST OVER BOUNDARY FROM TO LEVELS SCAN TOLERANCE_LEVEL STEADY SET,$(eval $(runs_goals): export $(name) := $$($(name))))
critical-level fragility: export TOLERANCE := $(tolerance_of_levels)
$(runs_goals): $(if $(build_step),$(mesher) $(solver) $(post))

.PHONY: study
study:
	@$(PYTHON) sweep/study.py

# Studies of several runs: script_TARGET calls make for them.
script_sweep := sweep/sweep.py
of_several   := $(filter-out study adapt,$(runs_goals))
.PHONY: $(of_several)
$(of_several):
	@MAKE='$(MAKE)' $(PYTHON) $(script_$@)
