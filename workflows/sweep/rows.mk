# The runs of a sweep, in its folder: one for each NNNN/NNNN.inputs that sweep.py wrote. Paths here
# have no spaces, even if the path of the folder has.
#
# RUN, PROGRAMS, TOLERANCE, LAUNCH come from the environment. LAUNCH stands before the command of
# the whole run, so that a scheduler has one job per run.
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules --no-print-directory
statuses := $(patsubst %.inputs,%.status,$(sort $(wildcard [0-9]*/[0-9]*.inputs)))

.PHONY: all
all: $(statuses)

$(statuses): %.status: %.inputs
	@$(LAUNCH) "$$RUN" "$$PROGRAMS" $* "$$TOLERANCE"
