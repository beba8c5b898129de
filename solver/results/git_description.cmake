# Writes OUTPUT, a header with the commit that last changed the solver's sources, `-dirty` when they
# differ from it; leaves it alone when nothing changed. Run at every build, so that a results folder names
# the sources its program was built from. Only what the solver is built from counts: a commit or an edit
# elsewhere, a scene included, must not make a new program and with it every result anew.
set(sources solver mesher/case CMakeLists.txt CMakePresets.json)
set(description "unknown")
find_program(GIT git)
if(GIT AND EXISTS "${SOURCE_DIR}/.git")
  execute_process(COMMAND ${GIT} --no-optional-locks log -1 --format=%h -- ${sources}
                  WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE commit RESULT_VARIABLE status
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(status EQUAL 0 AND NOT commit STREQUAL "")
    set(description "${commit}")
    execute_process(COMMAND ${GIT} --no-optional-locks diff --quiet HEAD -- ${sources}
                    WORKING_DIRECTORY ${SOURCE_DIR} RESULT_VARIABLE status ERROR_QUIET)
    if(NOT status EQUAL 0)
      string(APPEND description "-dirty")
    endif()
  endif()
endif()

set(content "#pragma once\n\nnamespace suffuse {\n
inline constexpr const char* git_description = \"${description}\";\n
}  // namespace suffuse\n")
if(EXISTS "${OUTPUT}")
  file(READ "${OUTPUT}" present)
endif()
if(NOT content STREQUAL "${present}")
  file(WRITE "${OUTPUT}" "${content}")
endif()
