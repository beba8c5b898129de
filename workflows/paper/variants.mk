# Runs of the paper's scenes with some keys changed: name, scene, KEY=VALUE as for the mesher's --set.

# Figs. 5 and 6, as in the paper: the same number of points in every element at the start, each
# element's eroded mass in equal shares to its own liquid points, no erosion in elements without
# liquid points.
as_in_paper := points.seeding=gauss points.equal_volume=false flow.integration=material-point \
  soil.specimen.erosion.mass_transfer=element soil.specimen.erosion.empty_elements=dry

point_counts := 12 6 3 1
$(foreach count,$(point_counts),$(eval $(call variant,dp-paper-$(count),dp-constant-figure,\
  $(as_in_paper) points.liquid_per_element=$(count))))

# The same small numbers of points with all defaults: the result does not depend on them.
$(foreach count,3 1,$(eval $(call variant,dp-default-$(count),dp-constant-figure,\
  points.liquid_per_element=$(count))))

point_variants := $(addprefix dp-paper-,$(point_counts)) $(addprefix dp-default-,3 1)

# Full inertia of water, without mass scaling. This table replaces the scene's, including its step.
unscaled := {end=120.0,scheme="explicit"}
$(eval $(call variant,dp-no-mass-scaling,dp-constant-figure,time=$(unscaled)))
