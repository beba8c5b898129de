# Laboratory tests, and channels.
#>   laboratory         rate and residual of an erosion law fitted to one seepage test, another predicted with
#>                      them: points measured, curves computed           -> workflows/out/laboratory/
#>   channels           a channel that erosion opens on meshes of 20 to 2.5 mm, with and without a length over which the
#>                      flux is averaged: when it has crossed, widths, losses, observed orders; takes ten minutes
#>                                                                            -> workflows/out/channels/

# One fit for each reading of the quoted percentages: NAME.csv. Its exponent doubles k at the loss
# after 20 h.
laboratory_out   := $(OUT)/laboratory
laboratory_fits  := of-fines of-soil
exponent_of-fines := 18
exponent_of-soil  := 3
laboratory_pictures := $(foreach fit,$(laboratory_fits),$(addprefix $(laboratory_out)/$(fit).,$(formats)))

$(foreach fit,$(laboratory_fits),$(laboratory_out)/$(fit)/fit.csv): $(laboratory_out)/%/fit.csv: laboratory/%.csv \
  $(addprefix laboratory/,fit.py gradients.csv) examples/permeameter/specimen.toml $(mesher) $(solver)
	@mkdir -p $(@D)
	$(PYTHON) laboratory/fit.py examples/permeameter/specimen.toml --measured $< --gradients laboratory/gradients.csv --fit constant \
	  --set soil.specimen.exponent=$(exponent_$*) --programs $(BIN) --out $(@D) | tee $(@D)/fit.txt

$(foreach format,$(formats),$(eval \
  $(foreach fit,$(laboratory_fits),$(laboratory_out)/$(fit).$(format)): $(laboratory_out)/%.$(format): \
  $(laboratory_out)/%/fit.csv $(post) ; \
  $(post) figure fines-lost $(laboratory_out)/$$*/constant.results $(laboratory_out)/$$*/stepwise.results \
    --measured laboratory/$$*.csv -o $$@))

.PHONY: laboratory
laboratory: $(laboratory_pictures)
	@head -20 $(foreach fit,$(laboratory_fits),$(laboratory_out)/$(fit)/fit.txt)
	@echo "Figures, tables and results are in $$(realpath $(laboratory_out))"

# --- Channels ---
# SERIES-SIZE and SERIES-SIZE-STRUCTURE, sizes in mm. The drive "gradient" does not grow where soil opens. In l5 and l20
# erosion has a length of 5 and 20 mm; each has a threshold below the flux at which erosion begins with its length.
channel_series   := flux gradient l5 l20
channel_flux     :=
channel_gradient := soil.specimen.erosion={law="first-order",drive="gradient",rate=2e-4}
channel_l5       := soil.specimen.erosion.length=5e-3 soil.specimen.erosion.threshold=1.35e-3 time.end=2000 \
  output.every=10 output.snapshot_every=20
channel_l20      := soil.specimen.erosion.length=20e-3 soil.specimen.erosion.threshold=1.12e-3 time.end=350 \
  output.every=5 output.snapshot_every=5
channel_runs_of_flux     := flux-20 flux-10 flux-5
channel_runs_of_gradient := gradient-20 gradient-10 gradient-5
channel_runs_of_l5       := l5-20 l5-10 l5-5 l5-2.5 l5-5-crossed
channel_runs_of_l20      := l20-20 l20-10 l20-5 l20-2.5 l20-5-crossed
channel_names := $(foreach series,$(channel_series),$(channel_runs_of_$(series)))
channel_stem   = $(OUT)/channels/$1
channel_word   = $(word $1,$(subst -, ,$2))
$(foreach name,$(channel_names),$(eval $(call run_rules,$(call channel_stem,$(name)),laboratory/channel.toml,\
  name=$(name) mesh.size=$(call channel_word,2,$(name))e-3 mesh.structure="$(or $(call channel_word,3,$(name)),free)" \
  $(channel_$(call channel_word,1,$(name))))))

channel_runs := $(foreach name,$(channel_names),$(call channel_stem,$(name)))
$(OUT)/channels/channels.csv: laboratory/channels.py $(addsuffix .status,$(channel_runs)) $(post)
	$(PYTHON) $< $(post) $(addsuffix .results,$(channel_runs)) > $@

# From 5 to 2.5 mm, or of series without the last from 10 to 5 mm: changes and observed orders.
$(OUT)/channels/changes.csv: laboratory/channels.py $(OUT)/channels/channels.csv
	$(PYTHON) $< --changes $(OUT)/channels/channels.csv > $@

$(foreach series,$(channel_series),$(call draw,channel_figures,$(call both,$(OUT)/channels/$(series)),\
  $(foreach name,$(channel_runs_of_$(series)),$(call channel_stem,$(name))),figure fines-lost RESULTS))

# Porosity when a channel has crossed the specimen, or at the end where none has; in the same colours, from that of the
# specimen to that without fines.
$(foreach name,$(channel_names),$(OUT)/channels/$(name).png): $(OUT)/channels/%.png: $(OUT)/channels/channels.csv $(post)
	time=$$(awk -F, '$$1 == "$*" { print $$(NF - 2) }' $<); \
	  $(post) render $(OUT)/channels/$*.results --field porosity --on cell --range 0.3:0.45 $${time:+--time $$time} -o $@

.PHONY: channels
channels: $(OUT)/channels/channels.csv $(OUT)/channels/changes.csv $(addsuffix .png,$(channel_runs)) \
    $(channel_figures) $(call tables,$(channel_runs))
	@cat $< $(OUT)/channels/changes.csv
	@echo "Figures, tables and results are in $$(realpath $(OUT)/channels)"
