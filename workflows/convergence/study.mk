# Convergence of a scene.
#>   convergence SCENE=FILE OUTPUTS=NAMES   the scene on finer and finer sizes and tolerances: observed order,
#>                      extrapolated value and grid convergence index of each output, a chart and a paragraph for a
#>                      report; SIZES=A,B,C and TOLERANCES=A,B,C instead of 2, 1, 1/2, 1/4 of mesh.size and 4, 1, 1/4 of
#>                      time.tolerance                               -> workflows/out/convergence/ (docs/use/sweeps.md)

script_convergence := convergence/convergence.py
