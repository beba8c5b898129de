# What must hold of every result, and of runs that are killed.
#>   stress             some four thousand scenes out of the usual range, judged by what must hold of every
#>                      result                         -> workflows/out/stress/, docs/evidence/stability.md
#>   stress SHORT=1     one in a hundred of them, in half a minute; checks and leaves the document as it is
#>   cases              scenes that once broke the programs, each with the end that it must have; takes minutes
#>   kill               runs killed at random moments, which must go on to the same files: KILLS=240 of them in
#>                      a few minutes              -> workflows/out/kill/kill.csv, docs/evidence/stability.md

# SHORT=1: one run in a hundred. STRESS_SWEEPS=NAMES: only these sweeps. With either, the document is
# left as it is. Runs that fail stay in OUT with their results.
stress_names  := energy conductivity contrast modulus mass-scaling step porosity porosity-jump thin-layer slivers \
                 jitter points density reversal stagnation drying throughput inflow laws anything dry-crest decades \
                 ground-level bedding flat-cells steady-space strength to-the-grains rigid-beside gate-gone
STRESS_SWEEPS ?= $(stress_names)
stress_out    := $(OUT)/stress$(if $(SHORT),-short)
stress_tables := $(foreach name,$(STRESS_SWEEPS),$(stress_out)/$(name).csv)

# A run that fails is recorded in the table; failures are reported when all tables are there.
$(stress_tables): $(stress_out)/%.csv: $(stress_program) $(solver)
	@mkdir -p $(stress_out)
	@echo "suffuse-stress --sweep $*"
	@$(stress_program) --solver $(solver) --sweep $* --folder $(stress_out)/$*.runs --table $@ \
	  $(if $(SHORT),--every 100) || [ $$? = 1 ]

$(stress_out)/stress.csv: $(stress_tables)
	@awk 'FNR > 1 || NR == 1' $^ > $@

$(stress_out)/stress.svg $(stress_out)/stress.png: $(stress_out)/stress.csv $(studies)
	$(studies) stress $< -o $@

.PHONY: stress
stress: $(stress_out)/stress.csv $(if $(SHORT),,$(stress_out)/stress.png)
	@$(PYTHON) stress/study.py check $<
	@$(if $(SHORT)$(filter-out $(STRESS_SWEEPS),$(stress_names)),,$(PYTHON) stress/study.py document $< $(stress_program) ../docs)
	@echo "Tables are in $$(realpath $(stress_out))"

# Scenes that once broke the programs.
.PHONY: cases
cases: $(if $(build_step),$(mesher) $(solver) $(post))
	@$(PYTHON) ../tests/cases/run_cases.py --bin $(BIN)

# The document shows the table of the full number of kills; a smaller number is only a check.
kills_documented := 240
KILLS            ?= $(kills_documented)

.PHONY: kill
kill: $(mesher) $(solver) $(post)
	@mkdir -p $(OUT)/kill
	@status=0; $(PYTHON) stress/kill.py $(BIN) $(OUT)/kill $(KILLS) > $(OUT)/kill/kill.md || status=$$?; cat $(OUT)/kill/kill.md; exit $$status
	@$(if $(filter $(kills_documented),$(KILLS)),$(call document,kill,../docs/evidence/stability.md))
