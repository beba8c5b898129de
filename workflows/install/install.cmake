# What `cmake --install` installs, and what other CMake projects find. There are three components:
# `programs`; `mpi`, the solver for several processes, where the build has it; and `development`, the
# reader of results for programs of users.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
find_package(Python3 REQUIRED COMPONENTS Interpreter)

set(SUFFUSE_PYTHON_DIR ${CMAKE_INSTALL_DATADIR}/suffuse/python CACHE STRING
    "Folder for suffuse.py, which reads results; a relative one is below the prefix")
set(install_sources ${PROJECT_SOURCE_DIR}/workflows/install)
set(install_texts ${PROJECT_BINARY_DIR}/install)
set(command_line ${Python3_EXECUTABLE} ${install_sources}/command_line.py)
set(programs suffuse-mesher suffuse-solver suffuse-post)
set(documents ${CMAKE_INSTALL_DOCDIR})

# --- Texts made from the output of the programs ---
file(MAKE_DIRECTORY ${install_texts})
foreach(program IN LISTS programs)
  set(page ${install_texts}/${program}.1)
  set(template ${PROJECT_SOURCE_DIR}/docs/man/${program}.1.in)
  add_custom_command(OUTPUT ${page}
    COMMAND ${command_line} man ${template} ${PROJECT_VERSION} ${CMAKE_INSTALL_FULL_DOCDIR} $<TARGET_FILE:${program}> > ${page}
    DEPENDS ${program} ${template} ${PROJECT_SOURCE_DIR}/docs/man/exit-status.man ${install_sources}/command_line.py
    COMMENT "Manual page of ${program}" VERBATIM)
  list(APPEND manual_pages ${page})
  list(APPEND program_files $<TARGET_FILE:${program}>)
endforeach()
set(completion ${install_texts}/completion.bash)
add_custom_command(OUTPUT ${completion}
  COMMAND ${command_line} complete ${install_sources}/completion.bash.in ${program_files} > ${completion}
  DEPENDS ${programs} ${install_sources}/completion.bash.in ${install_sources}/command_line.py
  COMMENT "Completion of command lines" VERBATIM)
add_custom_target(suffuse_install_texts ALL DEPENDS ${manual_pages} ${completion})

# --- Programs ---
install(TARGETS ${programs} RUNTIME COMPONENT programs)
install(FILES ${manual_pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT programs)
foreach(program IN LISTS programs)
  install(FILES ${completion} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program}
          COMPONENT programs)
endforeach()
# suffuse-solver-mpi has the manual page and the completion of suffuse-solver.
if(TARGET suffuse-solver-mpi)
  install(TARGETS suffuse-solver-mpi RUNTIME COMPONENT mpi)
  set(page ${install_texts}/suffuse-solver-mpi.1)
  file(WRITE ${page} ".so man1/suffuse-solver.1\n")
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT mpi)
  install(FILES ${completion} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
          RENAME suffuse-solver-mpi COMPONENT mpi)
  install(PROGRAMS workflows/cluster/suffuse.sbatch DESTINATION ${CMAKE_INSTALL_DATADIR}/suffuse COMPONENT mpi)
endif()
install(FILES post/python/suffuse.py DESTINATION ${SUFFUSE_PYTHON_DIR} COMPONENT programs)
install(FILES workflows/paraview/show_results.py DESTINATION ${CMAKE_INSTALL_DATADIR}/suffuse COMPONENT programs)

# --- Documents and examples; links between the documents hold. A folder `changelog` would stand where
# Debian has its file of this name. ---
install(FILES README.md CHANGELOG.md CITATION.cff LICENSE DESTINATION ${documents} COMPONENT programs)
install(DIRECTORY docs changes DESTINATION ${documents} COMPONENT programs PATTERN man EXCLUDE)
# Pages refer to the scenes as they do in the sources; examples/ leads there too.
foreach(folder examples paper)
  install(DIRECTORY workflows/${folder} DESTINATION ${documents}/workflows COMPONENT programs
          FILES_MATCHING PATTERN *.toml PATTERN *.geo PATTERN *.md)
endforeach()
install(CODE "file(CREATE_LINK workflows/examples \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${documents}/examples\" SYMBOLIC)"
        COMPONENT programs)

# --- find_package(Suffuse): the reader of results ---
foreach(library physics case results)
  set_target_properties(suffuse_${library} PROPERTIES EXPORT_NAME ${library})
  target_include_directories(suffuse_${library} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/suffuse>)
endforeach()
target_compile_features(suffuse_physics INTERFACE $<INSTALL_INTERFACE:cxx_std_20>)
if(SUFFUSE_NATIVE)
  # The alignment of Eigen's memory depends on the processor; both sides of a library must agree.
  target_compile_options(suffuse_physics INTERFACE $<INSTALL_INTERFACE:-march=native>)
endif()
install(TARGETS suffuse_physics suffuse_case suffuse_results EXPORT SuffuseTargets
        ARCHIVE COMPONENT development)
foreach(folder mesher/common mesher/mesh mesher/scene mesher/case solver/physics solver/files solver/results)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/suffuse COMPONENT development
          FILES_MATCHING PATTERN *.hpp)
endforeach()
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/Suffuse)
install(EXPORT SuffuseTargets NAMESPACE Suffuse:: DESTINATION ${config} COMPONENT development)
write_basic_package_version_file(${install_texts}/SuffuseConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${install_sources}/SuffuseConfig.cmake ${install_texts}/SuffuseConfigVersion.cmake
        DESTINATION ${config} COMPONENT development)
