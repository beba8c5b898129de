# find_package(Suffuse) gives Suffuse::results, which reads the results folders of suffuse-solver:
#   #include "results/reader.hpp"
include(CMakeFindDependencyMacro)
enable_language(C)  # FindHDF5 compiles C
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(HDF5 1.10 COMPONENTS C)
find_dependency(tomlplusplus 3.3)
include(${CMAKE_CURRENT_LIST_DIR}/SuffuseTargets.cmake)
