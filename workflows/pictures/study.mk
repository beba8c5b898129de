# Pictures of the documentation.
#>   pictures           a picture of every figure, and of render with every option
#>                                               -> workflows/out/pictures/, docs/images/ (docs/use/figures.md)

pictures_pile = $(OUT)/pictures/pile
$(eval $(call run_rules,$(pictures_pile),pictures/pile.toml))

# $(call picture,NAME,COMMAND,STEMS,OPTIONS): docs/images/NAME.png by suffuse-post.
picture = $(call draw,pictures,$(OUT)/pictures/$1.png,$3,$2 RESULTS $4)
figure_picture = $(call picture,figure-$1,figure $1,$2,$3)
render_picture = $(call picture,render-$1,render,$2,$3)

$(call figure_picture,flownet,$(pictures_pile),--time 0)
$(call figure_picture,head,$(pictures_pile),--time 0)
$(call figure_picture,model,$(call paper_stems,sp-constant-figure))
$(call figure_picture,gradation,$(pictures_pile))
$(call figure_picture,boundaries,$(pictures_pile))
$(call figure_picture,outflow,$(pictures_pile))
$(call figure_picture,saturation,$(call levee_stem,high-water),--time 0)
$(call figure_picture,masses,$(call paper_stems,sp-consistent dp-consistent))
$(call figure_picture,comparison,$(call paper_stems,sp-consistent dp-consistent))
$(call figure_picture,empty-elements,$(call paper_stems,$(point_variants)))
$(call figure_picture,flux,$(call paper_stems,dp-constant-figure dp-no-mass-scaling))
$(call picture,figure-curves,figure curves sections.discharge,$(pictures_pile),--time-unit d)
$(call figure_picture,profile,$(pictures_pile),--line -12$(comma)-3.5:12$(comma)-3.5 --fields porosity \
  --times 0$(comma)86400$(comma)432000$(comma)864000)
$(call render_picture,plain,$(pictures_pile),--field porosity --on node)
$(call render_picture,contours,$(pictures_pile),--field pressure --on node --contours)
$(call render_picture,vectors,$(pictures_pile),--field porosity --on cell --vectors)
$(call render_picture,streamlines,$(call levee_stem,high-water),--field region --time 0 --streamlines)
$(call render_picture,percentile,$(pictures_pile),--field darcy_flux --time 0)
$(call render_picture,log,$(pictures_pile),--field darcy_flux --time 0 --log --range 1e-7:1e-4)
$(call render_picture,view,$(pictures_pile),--field darcy_flux --time 0 --contours --view -1$(comma)-3.5:1$(comma)-2.5)
$(call render_picture,points,$(call paper_stems,dp-logarithmic),--field concentration --on liquid --time 20)

.PHONY: pictures
pictures: $(pictures)
	@cp $^ ../docs/images/
	@echo "Pictures are in $$(realpath $(OUT)/pictures) and docs/images"
