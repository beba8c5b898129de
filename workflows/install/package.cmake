# `cpack` in the folder of a build makes Debian packages: `suffuse`; `suffuse-mpi` with the solver for
# several processes, where the build has it; and `suffuse-dev` with the reader of results. `make -C workflows package` calls it with the preset `package`.
set(SUFFUSE_MAINTAINER "The Suffuse authors <suffuse@example.org>" CACHE STRING "Name and address in Debian packages")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME suffuse)
set(CPACK_PACKAGE_VENDOR "The Suffuse authors")
set(CPACK_PACKAGE_CONTACT ${SUFFUSE_MAINTAINER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "suffusion of soils by the material point method")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/workflows/install/debian_documents.cmake)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL programs development)
if(TARGET suffuse-solver-mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME suffuse)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
# Mesa draws pictures off the screen; no program links to it.
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS "libegl-mesa0, libgl1-mesa-dri, python3:any")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/workflows/install/prerm)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "python3-h5py, python3-numpy")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "bash-completion, gmsh, paraview, suffuse-dev, suffuse-mpi")
set(CPACK_DEBIAN_PROGRAMS_DESCRIPTION
"Computes suffusion: water that seeps through a soil takes its fine grains
along. Three programs work one after the other: suffuse-mesher makes mesh and
material points from a scene, suffuse-solver computes flow, erosion and
transport of fines over time, suffuse-post makes balances, tables and figures.
ParaView opens the results; suffuse.py reads them into numpy.")

# Libraries of MPI and PETSc are found by dpkg-shlibdeps.
set(CPACK_DEBIAN_MPI_PACKAGE_NAME suffuse-mpi)
set(CPACK_DEBIAN_MPI_PACKAGE_SECTION science)
set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "suffuse (= ${PROJECT_VERSION}), openmpi-bin")
set(CPACK_DEBIAN_MPI_DESCRIPTION
"Runs of Suffuse on several processes, on one machine or on many, with MPI:
suffuse-solver-mpi, which suffuse-solver --ranks starts.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME suffuse-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libhdf5-dev, libtomlplusplus-dev, zlib1g-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
"Headers, static libraries and CMake files for programs that read the results
of Suffuse: find_package(Suffuse) gives the target Suffuse::results.")
include(CPack)
