# Tests and checks.
#>   test-slurm         through Slurm on this machine: a case on two tasks, stopped by the end of its time and by a
#>                      signal, beside the serial run; a sweep of a hundred runs, some killed, beside one by make -j2;
#>                      takes ten minutes, needs root, installs slurm-wlm and munge
#>   test               all tests and checks; what .ci/run calls
#>   nightly            what takes hours: every test in both builds, with all checks of the sanitizers, tidy of all
#>                      sources, the short accuracy study, cases, stress, kill, fuzz
#>   fuzz               an hour of inputs that nobody would write, for every reader: SECONDS=3600 in all,
#>                      FUZZ_TARGETS=NAMES some of them            -> workflows/out/fuzz/: what was found
#>   test-fuzz          what fuzzing found before, and a few seconds of new inputs
#>   test-report        the levee's report in headless Chromium, where that is installed: console, requests, sliders,
#>                      tables                 -> workflows/out/report/: the page, pictures of it, PDF
#>   docs               a site of all documents, with search and formulas: installs mkdocs, fails where a link leads
#>                      nowhere                                            -> workflows/out/site/
#>   test-docs          links, lengths and index of the documents; numbers of the README against runs of seconds
#>   check-format       clang-format on the sources, changing nothing
#>   check-rooms        includes between the folders of the sources, which go down only, lengths of files, names
#>                      that two files share
#>   tidy               clang-tidy on the sources; TIDY_SINCE=COMMIT on those that differ from that commit,
#>                      TIDY_SINCE=new on those of this branch, which is what test does

source_folders := ../mesher ../solver ../post ../tests

# Each step uses all cores, so the steps run one after the other, whatever -j; a build step makes
# what the next step tests. A table of their seconds follows, then the last lines of ctest.
test_steps := check-format check-rooms build test-docs build-tests test-release test-workflow build-sanitize test-sanitize tidy
.PHONY: test
test: provision
	@MAKE='$(MAKE) TIDY_SINCE=$(or $(TIDY_SINCE),new)' ./timed_steps.sh $(test_steps)
	@for preset in sanitize release; do echo; echo "ctest, $$preset: $$(cat out/test/$$preset.count)"; \
	   sed -n '/tests passed/,$$p' out/test/$$preset.log; done

# Tests that need optimised programs: numbers, pictures and times. All other tests run only with
# sanitizers; RELEASE_TESTS=all runs them here too.
release_labels := verification sanitized post timing install ranks
# These take half of the time of all; other tests cover their parts. RELEASE_TESTS=all runs them.
long_tests := $(addprefix verification_test.,Bank.EndsInItsLastEquilibriumWhereTheSceneSaysSo \
    Consolidation.(LargeStrain|OfCamClaySettlesAsItsElementDoes) \
    DryColumn.CollapsesFromTheStartAndRunsOutAboutAsFarAsSand \
    ErodingOedometer.TheSameWithLiquidPoints ErosionAndDeposition.BalanceInDoublePoint ExactInSpace.FloodedDiscInSealedGround \
    FilterPaths.(UnderAWeirAreTheStreamlines|OfPointsAreThoseTheyWalked) \
    FlowStartup.LateScaledModeLagsAsLumpedMassesDo \
    Footing.OnSoilOf30DegreesCarriesReissnersLoads \
    ImplicitTransport.TakesAWeirThroughACentury \
    InfiniteSlope.FailsWhenItsFrictionHasFallenWithItsFines LargeStrain.ReachesItsEndThoughPoresCloseAtTheSurface \
    Levee.KeepsItsMassesWhateverHappens \
    PaperColumnPoints.TheAnswerDoesNotDependOnTheNumberOfPoints \
    PoissonsRatios/Mandel.PressureInTheMiddleFirstRises/[01] \
    RectangularDam.WithASeepageFaceLetsThroughCharnysDischarge RectangularDam.WithSuctionLetsThroughTheExactDischarge \
    Slope.(HasTheFactorOfGriffithsAndLane|HasTheSameFactorToTheLastBitOnTwoThreads) \
    Slope.(WithALooseLumpOnItsCrestHasTheSameFactor|WithItsSurfaceInsideElementsHasThisFactorToo) \
    Slope.WithoutDilationHasAFactorSlightlyLower \
    SpaceBank.(GoesOnFromWithinItsSlide|LosesItsFinesFailsAndRunsOutUnderWater) SpaceFooting.SquareCarriesItsPublishedLoad \
    Strip.OnSoilWithoutDilationHasAFactorThatTheMeshHardlyChanges \
    Trial.IsDecidedInPseudoTimeAsByNewtonsMethod) \
  $(addprefix verification_of_parts_test.Formulations/ExtrudedScene.TendsToTheSameAsThePlaneOne/,SinglePoint DoublePoint DoublePointWithLength) \
  $(addprefix solver_process_long_test.Modes/Determinism.,StepsEndOnOutputs/moving_soil_implicit TwiceTheSameFiles/moving_soil_implicit) \
  $(addprefix solver_process_long_test.,StrengthTable.(AirAboveTheSoilChangesNothing|SlopeOfDrySandOnFreeTriangles) \
    ChangingBoundaries.DepositionEndsAtItsLargestFlux) \
  estimate_test.Estimate.LooksAheadInScenesOfManyKinds \
  $(foreach ranks,4 5,ranks_test_on_$(ranks) same_files_basin_on_$(ranks)) same_files_points_on_5 \
  $(addprefix near_files_,rest_on_4 suction_on_2 deposition_without_soil_on_4 length_without_soil_on_4 points_on_3)
.PHONY: build-tests test-release
build-tests: provision
	@$(call build_preset,release,$(if $(RELEASE_TESTS),,--target programs suffuse-stress suffuse-studies \
	  $(addprefix tests_,$(release_labels))))
test-release: build-tests
	@$(call run_ctest,release,$(if $(RELEASE_TESTS),,-L '$(subst $(space),|,$(release_labels))' \
	  -E '^($(subst $(space),|,$(strip $(long_tests))))$$'))

# Tests of parts of the mesher and the solver, and the verifications that tests/verification
# selects. SANITIZED_TESTS=all also runs the other verifications, the tests of the post stage and
# the suites with the longest runs of the solver, with all checks of the sanitizers
# (SUFFUSE_SANITIZE_ALL of ../CMakeLists.txt); not those of the label study, which repeat
# verifications on finer meshes.
sanitized_labels := quick sanitized
optimised_suites := resume_test.Modes/ResumedVariant resume_test.InSpace/ResumedVariant resume_test.ResumedRun \
  $(addprefix resume_test.,Stage Modes/Stages FromMovedSoil FromEarlierOnce MeshAgain Construction) verification_of_parts_test.Formulations/ExtrudedScene
sanitized_preset := sanitize$(if $(SANITIZED_TESTS),-all)
.PHONY: build-sanitize test-sanitize
build-sanitize: provision
	@$(call build_preset,$(sanitized_preset),$(if $(SANITIZED_TESTS),,--target suffuse-mesher suffuse-solver \
	  $(addprefix tests_,$(sanitized_labels))))
test-sanitize: build-sanitize
	@$(call run_ctest,$(sanitized_preset),$(if $(SANITIZED_TESTS),-LE study,-L '$(subst $(space),|,$(sanitized_labels))' \
	  -E '^($(subst $(space),|,$(optimised_suites)))[.]'))

# $(call run_ctest,PRESET,OPTIONS): ctest counts suites; the number of tests in them is in
# PRESET.count.
define run_ctest
mkdir -p out/test && log=$$PWD/out/test/$1 && cd .. && \
  ctest --preset $1 -j $(jobs) $2 --output-log "$$log.log" && \
  workflows/tests/count_tests.py build/$1/Testing/Temporary/LastTest.log | tee "$$log.count"
endef

# Checks that take too long for each change.
.PHONY: nightly
nightly: provision
	SUFFUSE_TEST_CROSSINGS=1e6 $(MAKE) test-release RELEASE_TESTS=all
	$(MAKE) test-sanitize SANITIZED_TESTS=all
	$(MAKE) tidy TIDY_SINCE=
	SECTIONS=200 $(BIN)/solver_test --gtest_filter='DischargeBounds.HoldIn*'
	$(MAKE) test-accuracy
	tests/convergence.sh
	$(MAKE) cases
	$(MAKE) stress
	$(MAKE) kill
	$(MAKE) test-fuzz
	$(MAKE) fuzz

.PHONY: test-report
test-report: $(call levee_stem,flood).history.csv $(post)
	@tests/report.sh $(post) $(call levee_stem,flood).results $(OUT)/report

# Hostile input. A target's inputs are in tests/fuzz/corpus/, its former findings in
# tests/fuzz/findings/; new inputs are written to OUT/fuzz, new findings to OUT/fuzz/TARGET.found/*.
# Memory and time of one input are limited: a reader may not allocate more than its file accounts
# for. Leaks of HDF5 over damaged files are ignored.
FUZZ_TARGETS  ?= scene geometry case results model
SECONDS       ?= 3600
fuzz_options  := -rss_limit_mb=1500 -malloc_limit_mb=256 -timeout=20 -max_len=2000 -detect_leaks=0 -print_funcs=0
fuzz_program  := ../build/fuzz/bin/fuzz
fuzz_inputs   := $$(find ../tests/fuzz/corpus ../tests/fuzz/findings -name $$target -type d)
# The folder is in memory because files are written anew for every input.
fuzz_run       = env TMPDIR=$(if $(wildcard /dev/shm),/dev/shm,/tmp) ASAN_OPTIONS=detect_leaks=0 $(fuzz_program)

test_fuzz      = $(subst bin/fuzz,bin/fuzz_readers,$(fuzz_run))

.PHONY: build-fuzz
build-fuzz: provision
	@$(call build_preset,fuzz,--target fuzz)

# Each target gets an equal share of the time, and goes on after a finding.
.PHONY: fuzz
fuzz: build-fuzz
	@for target in $(FUZZ_TARGETS); do \
	   mkdir -p $(OUT)/fuzz/$$target $(OUT)/fuzz/$$target.found; \
	   $(fuzz_run) --target=$$target -fork=1 -ignore_crashes=1 -ignore_timeouts=1 -ignore_ooms=1 $(fuzz_options) \
	     -max_total_time=$$(($(SECONDS) / $(words $(FUZZ_TARGETS)))) -artifact_prefix=$(OUT)/fuzz/$$target.found/ \
	     $(OUT)/fuzz/$$target $(fuzz_inputs) \
	     > $(OUT)/fuzz/$$target.log 2>&1 || true; \
	   echo "$$target: $$(grep -a '^#.*cov:' $(OUT)/fuzz/$$target.log | tail -1)"; \
	 done; found=$$(find $(OUT)/fuzz -path '*.found/*' -type f); \
	 [ -z "$$found" ] || { echo "found:"; echo "$$found"; exit 1; }

# Only readers: each input once, then new inputs for a few seconds; a reader ends at its first
# finding. fuzz_test covers models.
.PHONY: build-fuzz-readers test-fuzz
build-fuzz-readers: provision
	@$(call build_preset,fuzz,--target fuzz_readers)
test-fuzz: build-fuzz-readers
	@export scratch=$$(mktemp -d); trap 'rm -rf "$$scratch"' EXIT; mkdir -p $(OUT)/fuzz; \
	 try() { \
	   local target=$$1 log=$$scratch/$$1.log; \
	   mkdir "$$scratch/$$target"; \
	   $(test_fuzz) --target=$$target $(fuzz_options) -max_total_time=$(or $(TEST_SECONDS),8) \
	     -artifact_prefix=$(OUT)/fuzz/$$target- "$$scratch/$$target" \
	     $(fuzz_inputs) > "$$log" 2>&1 || \
	     { tail -60 "$$log"; echo "$$target: failed, the input is $(OUT)/fuzz/$$target-*"; return 1; }; \
	   echo "$$target: $$(grep -a 'DONE' "$$log" | tail -1)"; \
	 }; \
	 export -f try; \
	 printf '%s\n' $(filter-out model,$(FUZZ_TARGETS)) | xargs -P $(jobs) -I{} bash -euc 'try {}'

# Two scripts run at a time: none uses more than one core.
.PHONY: test-workflow
test-workflow: build-studies
	@{ tests/incremental.sh && tests/level.sh && tests/laboratory.sh; } & other=$$!; status=0; \
	  { $(MAKE) stress SHORT=1 && $(MAKE) kill KILLS=6 && tests/sweep.sh && tests/fit.sh && tests/adapt.sh; } || status=1; \
	  wait $$other || status=1; exit $$status

# This study is timed, so it belongs to nightly; tests assert the orders of convergence.
.PHONY: test-accuracy
test-accuracy: build-studies
	@tests/accuracy.sh

# Not in CI: it needs root, and packages in addition to those of packages.txt.
.PHONY: test-slurm
test-slurm: $(if $(build_step),$(mesher) $(solver) $(post))
	@{ [ -x /usr/sbin/slurmd ] && [ -x /usr/sbin/munged ]; } || [ "$$(id -u)" -ne 0 ] || { apt-get --quiet --quiet update && \
	  DEBIAN_FRONTEND=noninteractive apt-get --yes --quiet --no-install-recommends install slurm-wlm munge; }
	@tests/slurm_ranks.sh $(BIN)
	@tests/slurm.sh $(if $(build_step),,BIN='$(BIN)')

# --- Documents ---
.PHONY: docs test-docs
docs:
	@./provision.sh docs
	@$(PYTHON) site/build.py $(OUT)
test-docs: $(if $(build_step),$(mesher) $(solver) $(post))
	@./check_documents.py
	@tests/documents.py $(BIN)

# --- Checks of the sources ---
.PHONY: check-format
check-format: provision
	@find $(source_folders) -name '*.[ch]pp' -print0 | xargs -0 clang-format --dry-run -Werror

# The first line tests the checks themselves.
.PHONY: check-rooms
check-rooms:
	@for check in rooms.sh tidy.py convergence.py; do log=$$(tests/$$check) || { echo "$$log"; exit 1; }; done
	@./check_sources.py

.PHONY: tidy
tidy: build
	@./tidy.py ../build/release $(jobs) $(TIDY_SINCE)
