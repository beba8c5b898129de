# Writes OUTPUT, a header with `git describe` of SOURCE_DIR; leaves it alone when nothing changed.
# Run at every build, so that a results folder names the sources its program was built from.
set(description "unknown")
find_program(GIT git)
if(GIT AND EXISTS "${SOURCE_DIR}/.git")
  execute_process(COMMAND ${GIT} --no-optional-locks describe --always --dirty --tags WORKING_DIRECTORY ${SOURCE_DIR}
                  OUTPUT_VARIABLE found RESULT_VARIABLE status
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(status EQUAL 0)
    set(description "${found}")
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
