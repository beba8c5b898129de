# What size costs, and what ranks gain.
#>   scaling            cost of every stage from 1e2 to 1e6 elements, on one thread and two
#>                                                                    -> workflows/out/scaling/, docs/evidence/accuracy.md
#>   ranks              what two ranks gain: linear systems of up to a million faces, bandwidth, explicit steps; takes
#>                      minutes on a machine with nothing else to do     -> workflows/out/ranks/, docs/use/ranks.md
#>   bench              micro-benchmarks of the solver's loops        -> workflows/out/bench/

# The runs are timed, so they are made one after the other, whatever -j. SCALING_ELEMENTS=SIZES: only these sizes; then the
# document is left as it is.
scaling_all      := 1e2 1e3 1e4 1e5 1e6
SCALING_ELEMENTS ?= $(scaling_all)
scaling_modes    := sp-explicit sp-implicit dp-material-point dp-mixed dp-implicit
scaling_lines    := $(foreach size,$(SCALING_ELEMENTS),$(foreach mode,$(scaling_modes),$(foreach threads,1 2,\
                      $(OUT)/scaling/$(mode)-$(size)-$(threads).csv)))

$(scaling_lines): $(OUT)/scaling/%.csv: scaling/study.py scaling/column.toml $(mesher) $(solver) $(post)
	@mkdir -p $(@D)
	@echo "scaling/study.py measure $*"
	@flock $(@D) $(PYTHON) $< measure $(BIN) $* $(OUT)/scaling/$*

.PHONY: scaling
scaling: $(scaling_lines)
	@$(PYTHON) scaling/study.py report $^ | tee $(OUT)/scaling/scaling.md
	@$(if $(filter-out $(SCALING_ELEMENTS),$(scaling_all)),,$(call document,scaling,../docs/evidence/accuracy.md))

.PHONY: ranks
ranks: build
	@$(call build_preset,release,--target ranks_bench)
	@mkdir -p $(OUT)/ranks
	@$(PYTHON) scaling/study.py ranks $(BIN) ../tests/ranks/scenes/basin.toml $(OUT)/ranks | tee $(OUT)/ranks/ranks.md
	@$(if $(ROWS),,$(call document,ranks,../docs/use/ranks.md))

bench_programs := stream flow point transport
.PHONY: bench
bench: provision
	@$(call build_preset,release,--target $(addsuffix _bench,$(bench_programs)))
	@mkdir -p $(OUT)/bench
	@for name in $(bench_programs); do \
	   ../build/release/bin/$${name}_bench --benchmark_out=$(OUT)/bench/$$name.json --benchmark_out_format=json \
	     --benchmark_repetitions=3 --benchmark_report_aggregates_only=true --benchmark_min_time=0.2; done

# Takes minutes. The runs are timed: nothing else should run beside them.
.PHONY: motion
motion: $(mesher) $(solver)
	@mkdir -p $(OUT)/motion
	@$(PYTHON) scaling/study.py motion $(BIN) $(OUT)/motion | tee $(OUT)/motion/motion.md
	@$(call document,motion,../docs/evidence/accuracy.md)
