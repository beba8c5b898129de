# Studies of levels.
#>   critical-level SCENE=FILE BOUNDARY=NAME FROM=A TO=B   the level (m) of the head at a boundary at which each mechanism
#>                      begins (erosion, heave, uplift, backward erosion, slope), which governs, a table and a chart of
#>                      the factors; SCAN=5 levels first, then brackets down to TOLERANCE_LEVEL (1 % of B - A); STEADY=1
#>                      for a level that stands for ever in the place of a hydrograph; BOUNDARY="A B" where
#>                      several border the same water; SET="KEY=VALUE ..." other keys
#>                                                       -> workflows/out/critical-level/ (docs/use/assessment.md)
#>   fragility SCENE=FILE BOUNDARY=NAME LEVELS=A,B,... SWEEP=FILE.csv   the probability of failure at each level, by each
#>                      mechanism, with bounds: the draws of a sampled table at all levels
#>                                                       -> workflows/out/fragility/ (docs/use/assessment.md)

script_critical-level := level/critical_level.py
script_fragility      := level/fragility.py
