# Meshes that follow an error.
#>   adapt SCENE=FILE   meshes it again until the discharge of its steady flow is known to mesh.error (1 % without
#>                      that key): the case, and a table of the meshes        -> workflows/out/adapt/
#>   adapt SCENE=FILE OVER=run   likewise for a flow that changes: makes the run on each mesh, and looks at all of it; the
#>                      scene needs mesh.error
#>   adapt-study        ten sections with mesh.error = 1 % and 0.1 %, against uniform meshes and meshes graded by hand;
#>                      takes ten minutes                -> workflows/out/adapt-study/, docs/evidence/accuracy.md

.PHONY: adapt
adapt:
	@$(PYTHON) sweep/study.py adapt

# Runs are timed, so they are made one after the other, whatever -j. The document gets the table although a check may have failed
# (exit code 3).
.PHONY: adapt-study
adapt-study: $(if $(build_step),$(mesher) $(solver) $(post))
	@status=0; $(PYTHON) adapt/study.py $(BIN) $(OUT)/adapt-study || status=$$?; [ $$status = 0 ] || [ $$status = 3 ] || exit $$status; \
	 $(PYTHON) adapt/study.py --document $(BIN) $(OUT)/adapt-study ../docs; exit $$status
