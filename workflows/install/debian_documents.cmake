# cpack runs this on the folders that it packs, so that documents follow Debian's policy: manual
# pages and changes are compressed, and the licence is in a file `copyright`.
file(READ ${CMAKE_CURRENT_LIST_DIR}/../../LICENSE licence)
string(APPEND licence "\n------------------------------------------------------------------------------\n\n"
  "On Debian systems the GNU General Public License, version 2, is in /usr/share/common-licenses/GPL-2.\n")
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
string(CONCAT changes "suffuse (${CPACK_PACKAGE_VERSION}) stable; urgency=medium\n\n"
  "  * What changed is in CHANGELOG.md of the package suffuse.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  set(tree ${CPACK_TEMPORARY_DIRECTORY}/${component})
  string(TOUPPER ${component} COMPONENT)
  set(documents ${tree}/usr/share/doc/${CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME})
  file(REMOVE ${documents}/LICENSE)
  file(WRITE ${documents}/copyright "${licence}")
  file(WRITE ${documents}/changelog "${changes}")
  file(GLOB pages ${tree}/usr/share/man/man*/*)
  execute_process(COMMAND gzip -9n ${documents}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND chmod -R u=rwX,go=rX ${tree}/usr COMMAND_ERROR_IS_FATAL ANY)
endforeach()
