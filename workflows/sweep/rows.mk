# The runs of a sweep, in its folder: one for each NNNN/NNNN.inputs that sweep.py wrote. Paths here have no spaces, even if the path of
# the folder has.
#
# RUN, PROGRAMS, TOLERANCE, LAUNCH and STATES come from the environment. STATES are the last arguments of run.py, and empty where nobody
# asks how safe a run is. LAUNCH stands before the command of the whole run, so that a scheduler has one job per run.
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules --no-print-directory
ends := $(patsubst %.inputs,%.$(if $(STATES),assessed,status),$(sort $(wildcard [0-9]*/[0-9]*.inputs)))

.PHONY: all
all: $(ends)

$(ends): %.$(if $(STATES),assessed,status): %.inputs $(if $(STATES),assess.inputs)
	@$(LAUNCH) "$$RUN" "$$PROGRAMS" $* "$$TOLERANCE" $(STATES)
