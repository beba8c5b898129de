# Soils and waters of any stiffness.
#>   stiffness          a day in soils and waters of any stiffness, implicit, beside the steps of the
#>                      explicit scheme                                  -> workflows/out/stiffness/

# A day with the implicit scheme for each conductivity and bulk modulus, and the steps that --explain gives for the explicit
# scheme, which needs a finite modulus.
stiffness_k := 1e-9 1e-7 1e-5 1e-3 1e-1
stiffness_K := 2e5 2e7 2e9
stiffness_finite := $(foreach k,$(stiffness_k),$(foreach K,$(stiffness_K),$(OUT)/stiffness/k$k-K$K))
stiffness_stems  := $(foreach k,$(stiffness_k),$(foreach K,$(stiffness_K) inf,$(OUT)/stiffness/k$k-K$K))
explicit_day     := {end=86400.0,scheme="explicit"}
# $(call stiffness_keys,STEM)
stiffness_keys = $(patsubst k%,soil.specimen.conductivity=%,$(firstword $(subst -K, ,$(notdir $1)))) \
  liquid.bulk_modulus=$(lastword $(subst -K, ,$(notdir $1)))

$(foreach stem,$(stiffness_stems),$(eval $(call run_rules,$(stem),stiffness/day.toml,\
  name=$(notdir $(stem)) $(call stiffness_keys,$(stem)))))
$(foreach stem,$(stiffness_finite),$(eval $(call case_rules,$(stem)-explicit,stiffness/day.toml,\
  name=$(notdir $(stem))-explicit $(call stiffness_keys,$(stem)) time=$(explicit_day))))

$(OUT)/stiffness/%.explain: $(OUT)/stiffness/%.case.h5 $(solver)
	$(solver) $< --explain > $@

$(OUT)/stiffness/stiffness.csv: stiffness/table.py $(addsuffix .status,$(stiffness_stems)) $(addsuffix -explicit.explain,$(stiffness_finite))
	$(PYTHON) $< $(stiffness_stems) > $@

.PHONY: stiffness
stiffness: $(OUT)/stiffness/stiffness.csv $(call tables,$(stiffness_stems))
	@cat $<
	@echo "The table is $$(realpath $<)"
