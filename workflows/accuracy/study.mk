# What an error costs.
#>   accuracy           what an error costs: six problems, every scheme, sizes, points and tolerances; takes
#>                      half an hour                      -> workflows/out/accuracy/, docs/evidence/accuracy.md
#>   accuracy SHORT=1   a few runs of each, in two minutes; checks and leaves the document as it is

# SHORT=1: only coarse meshes, each run once. ACCURACY_PROBLEMS=NAMES: only these problems. With either, the document is left as it is.
accuracy_names    := fines-constant fines-log porosity-gradient startup feedback dam
ACCURACY_PROBLEMS ?= $(accuracy_names)
accuracy_out      := $(OUT)/accuracy$(if $(SHORT),-short)
accuracy_stems    := $(addprefix $(accuracy_out)/,$(ACCURACY_PROBLEMS))
accuracy_settings := problem,scheme,size,points_per_element,tolerance
accuracy_columns  := $(accuracy_settings),quantity,error_l1,error_l2,error_max,seconds,steps,elements,points,memory_bytes,threads
accuracy          := $(PYTHON) accuracy/study.py

$(addsuffix .reference.csv,$(accuracy_stems)): $(accuracy_out)/%.reference.csv: accuracy/study.py accuracy/dam.csv
	@mkdir -p $(@D)
	$(accuracy) reference $* > $@

# The runs are timed, so they are made one after the other, whatever -j. A second file lists the runs left out.
$(addsuffix .csv,$(accuracy_stems)): $(accuracy_out)/%.csv: accuracy/%.toml accuracy/weir.geo $(accuracy_out)/%.reference.csv \
  $(mesher) $(solver) $(post)
	@echo "accuracy/study.py measure $*"
	@flock $(@D) $(accuracy) measure $(BIN) $* $(@D) $(if $(SHORT),short)

$(accuracy_out)/accuracy.csv: $(addsuffix .csv,$(accuracy_stems))
	@{ echo $(accuracy_columns); cat $^; } > $@
	@{ echo $(accuracy_settings),steps,seconds; cat $(addsuffix .left-out.csv,$(accuracy_stems)); } > $(@D)/left-out.csv

accuracy_pictures := $(foreach format,$(formats),$(addsuffix .$(format),$(accuracy_stems)))
$(accuracy_pictures): $(accuracy_out)/accuracy.csv $(studies)
	$(studies) accuracy $< --problem $(basename $(@F)) -o $@

.PHONY: accuracy
accuracy: $(accuracy_pictures)
	@$(if $(SHORT)$(filter-out $(ACCURACY_PROBLEMS),$(accuracy_names)),,$(accuracy) document $(accuracy_out) ../docs)
	@$(accuracy) check $(accuracy_out)
	@echo "Tables and charts are in $$(realpath $(accuracy_out))"

# Reference for the runs of the dam; takes a few minutes, and is made again only when the physics changes.
.PHONY: accuracy-dam
accuracy-dam: $(mesher) $(solver) $(post)
	@mkdir -p $(OUT)
	$(accuracy) dam $(BIN) $(accuracy_out) > $(accuracy_out).dam
	mv $(accuracy_out).dam accuracy/dam.csv
