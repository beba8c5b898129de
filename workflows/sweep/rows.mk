# The runs of a sweep, in its folder: one for each NNNN/NNNN.inputs that sweep.py wrote. Paths here
# have no spaces, even if the path of the folder has.
#
# RUN, PROGRAMS, TOLERANCE, LAUNCH, STATES come from the environment, and ENDED, which file RUN writes at
# the end of a run. STATES is the last argument of assess.sh and empty for run.sh. LAUNCH stands before the command of the whole run, so that a
# scheduler has one job per run.
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules --no-print-directory
ends := $(patsubst %.inputs,%.$(ENDED),$(sort $(wildcard [0-9]*/[0-9]*.inputs)))

.PHONY: all
all: $(ends)

$(ends): %.$(ENDED): %.inputs $(if $(STATES),assess.inputs)
	@$(LAUNCH) "$$RUN" "$$PROGRAMS" $* "$$TOLERANCE" $(STATES)
