# Every figure of the paper.
#>   paper              every figure of the paper, with tables and results  -> workflows/out/paper/

paper_names := sp-constant-table sp-constant-figure sp-logarithmic sp-consistent \
               dp-constant-table dp-constant-figure dp-logarithmic dp-consistent sp-implicit dp-implicit
# $(call paper_stems,NAMES)
paper_stems = $(addprefix $(OUT)/paper/,$1)
$(foreach name,$(paper_names),$(eval $(call run_rules,$(OUT)/paper/$(name),$(PAPER)/$(name).toml)))

# $(call variant,NAME,SCENE,CHANGES): one more run of a scene of the paper with some keys changed.
define variant
variant_names += $1
$(call run_rules,$(OUT)/paper/$1,$(PAPER)/$2.toml,name=$1 $3)
endef
include $(PAPER)/variants.mk
paper_runs := $(call paper_stems,$(paper_names) $(variant_names))

# $(call paper_figure,FILE,NAME,RUNS)
paper_figure = $(call draw,paper_figures,$(call both,$(OUT)/paper/$1),$(call paper_stems,$3),figure $2 RESULTS)
$(foreach name,$(paper_names),$(foreach figure,porosity masses,$(call paper_figure,$(name).$(figure),$(figure),$(name))))
both_laws := constant-table constant-figure logarithmic
$(call paper_figure,fig4-porosity,porosity,$(addprefix sp-,$(both_laws)) $(addprefix dp-,$(both_laws)))
$(call paper_figure,fig5-solid-mass,solid-mass,$(point_variants))
$(call paper_figure,fig6-empty-elements,empty-elements,$(point_variants))
$(call paper_figure,fig7-masses,masses,$(foreach law,constant-figure logarithmic,sp-$(law) dp-$(law)))
$(call paper_figure,sp-dp-comparison,comparison,sp-consistent dp-consistent)
$(call paper_figure,implicit-comparison,comparison,sp-implicit dp-implicit)
$(call paper_figure,mass-scaling-flux,flux,dp-constant-figure dp-no-mass-scaling)
$(call draw,paper_figures,$(OUT)/paper/fig2-model-sp.png,$(OUT)/paper/sp-constant-figure,figure model RESULTS)
$(call draw,paper_figures,$(OUT)/paper/fig3-model-dp.png,$(OUT)/paper/dp-constant-figure,figure model RESULTS)

$(OUT)/paper/runs.csv: $(addsuffix .status,$(paper_runs)) $(post)
	$(post) table $(addsuffix .results,$(paper_runs)) --csv $@

$(OUT)/paper/paper.csv: paper/join.py $(PAPER)/paper-says.csv $(OUT)/paper/runs.csv
	$(PYTHON) $^ > $@

.PHONY: paper
paper: $(paper_figures) $(OUT)/paper/runs.csv $(OUT)/paper/paper.csv $(call tables,$(paper_runs))
	@echo "The paper's figures, tables and results are in $$(realpath $(OUT)/paper)"
