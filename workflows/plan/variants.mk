# Runs that take long enough to be timed: finer, and with little to write. Name, scene, KEY=VALUE as for
# the mesher's --set.

# $(call plan_variant,NAME,SCENE,CHANGES)
define plan_variant
plan_variants += $1
$(call run_rules,$(OUT)/plan/$1,$(PAPER)/$2.toml,name=$1 output.snapshot_every=30.0 $3,plan/variants.mk)
endef
$(eval $(call plan_variant,sp-consistent-fine,sp-consistent,mesh.size=0.0625))
$(eval $(call plan_variant,dp-consistent-fine,dp-consistent,mesh.size=0.0625))
$(eval $(call plan_variant,sp-implicit-fine,sp-implicit,mesh.size=0.0125))
$(eval $(call plan_variant,dp-implicit-fine,dp-implicit,mesh.size=0.025))
plan_names += $(plan_variants)
