# Calibrations.
#>   fit SCENE=FILE MEASURED=FILE.csv KEYS=KEYS AGAINST=OUTPUT   calibrates keys of the scene by what was measured: least
#>                      squares with standard errors, correlations, a chart and a paragraph; KEY:LOW:HIGH gives bounds;
#>                      without files a column of two soils                  -> workflows/out/fit/ (docs/use/calibration.md)
#>   fit-study          twenty calibrations of known values with noise: how often their intervals hold the values; takes ten
#>                      minutes                                              -> workflows/out/fit-study/

script_fit       := fit/fit.py
script_fit-study  = fit/study.py $(OUT)/fit-study --programs $(BIN)
