# The library as others use it: one shared library, its public headers, and the files by which CMake
# and pkg-config find it.
#
# Components, each a Debian package: program (with what it ships), library, development, documentation,
# and python where the module is for Debian's Python.

set(qsmpc_rooms
  qsmpc_models qsmpc_controller qsmpc_render
  qsmpc_text qsmpc_errors qsmpc_files qsmpc_statistics qsmpc_threads qsmpc_mujoco
  qsmpc_scenario qsmpc_control qsmpc_assembly qsmpc_plant qsmpc_trace qsmpc_episode qsmpc_video)

# Made of what the rooms were compiled to. Their archives are linked for the libraries that they need.
list(TRANSFORM qsmpc_rooms REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)
add_library(qsmpc_library SHARED ${objects})
set_target_properties(qsmpc_library PROPERTIES
  OUTPUT_NAME qsmpc
  EXPORT_NAME qsmpc
  VERSION ${PROJECT_VERSION}
  # Before 1.0 each minor version may break what is linked to it.
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}
  LINKER_LANGUAGE CXX
  LINK_DEPENDS ${CMAKE_SOURCE_DIR}/scripts/cmake/exports.map)
target_link_libraries(qsmpc_library PRIVATE ${qsmpc_rooms})
target_link_options(qsmpc_library PRIVATE
  LINKER:--version-script=${CMAKE_SOURCE_DIR}/scripts/cmake/exports.map)
if(NOT QSMPC_SANITIZE)  # whose run-time library comes with the program, by Clang
  target_link_options(qsmpc_library PRIVATE LINKER:--no-undefined)
endif()
target_include_directories(qsmpc_library INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(qsmpc_library INTERFACE cxx_std_20)
target_link_libraries(qsmpc_library INTERFACE $<INSTALL_INTERFACE:Eigen3::Eigen>)
install(TARGETS qsmpc_library EXPORT qsmpc_targets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)

# One target a room, each with the rooms below it; all of them are the one library.
foreach(room models controller harness render)
  add_library(qsmpc_public_${room} INTERFACE)
  set_target_properties(qsmpc_public_${room} PROPERTIES EXPORT_NAME ${room})
  target_link_libraries(qsmpc_public_${room} INTERFACE qsmpc_library)
  install(TARGETS qsmpc_public_${room} EXPORT qsmpc_targets)
endforeach()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/qsmpc)
install(EXPORT qsmpc_targets NAMESPACE qsmpc:: DESTINATION ${package_folder} COMPONENT development)
include(CMakePackageConfigHelpers)
configure_package_config_file(${CMAKE_SOURCE_DIR}/scripts/cmake/qsmpc-config.cmake.in
  ${CMAKE_BINARY_DIR}/qsmpc-config.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/qsmpc-config-version.cmake
  VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/qsmpc-config.cmake ${CMAKE_BINARY_DIR}/qsmpc-config-version.cmake
  DESTINATION ${package_folder} COMPONENT development)
# Found from where the file itself is, so that what is installed can be moved.
file(RELATIVE_PATH prefix_from_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" prefix_from_pc "${prefix_from_pc}")
configure_file(${CMAKE_SOURCE_DIR}/scripts/cmake/qsmpc.pc.in ${CMAKE_BINARY_DIR}/qsmpc.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/qsmpc.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# The public headers: what ROOM/ROOM.hpp includes, and what those include.
install(CODE "
  execute_process(COMMAND \"${CMAKE_COMMAND}\"
      -D SOURCE=${CMAKE_SOURCE_DIR} -D GENERATED=${CMAKE_BINARY_DIR}/generated
      -D \"OUTPUT=\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/qsmpc\"
      -P ${CMAKE_SOURCE_DIR}/scripts/cmake/install_headers.cmake
    COMMAND_ERROR_IS_FATAL ANY)" COMPONENT development)

install(DIRECTORY models/campaigns models/contests models/mjcf models/scenarios models/tracks
  DESTINATION ${CMAKE_INSTALL_DATADIR}/qsmpc/models COMPONENT program)

# Manual pages and completion, which the program makes of its own commands.
set(pages ${CMAKE_BINARY_DIR}/manual)
add_custom_command(
  OUTPUT ${pages}/made
  DEPENDS qsmpc
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${pages}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${pages}/man1
  COMMAND qsmpc help --write-manual ${pages}/man1
  COMMAND sh -c "gzip -9n ${pages}/man1/*.1"
  COMMAND sh -c "$<TARGET_FILE:qsmpc> completion bash > ${pages}/qsmpc"
  COMMAND sh -c "$<TARGET_FILE:qsmpc> completion zsh > ${pages}/_qsmpc"
  COMMAND ${CMAKE_COMMAND} -E touch ${pages}/made
  VERBATIM)
if(NOT QSMPC_SANITIZE)
  add_custom_target(manual ALL DEPENDS ${pages}/made)
  install(DIRECTORY ${pages}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
  install(FILES ${pages}/qsmpc
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
  install(FILES ${pages}/_qsmpc
    DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
endif()

# The reference of the public headers, by Doxygen, for those who ask for the target.
find_program(DOXYGEN doxygen)
if(DOXYGEN)
  set(reference ${CMAKE_BINARY_DIR}/reference)
  configure_file(${CMAKE_SOURCE_DIR}/scripts/cmake/Doxyfile.in ${CMAKE_BINARY_DIR}/Doxyfile @ONLY)
  add_custom_target(reference
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${reference} ${CMAKE_BINARY_DIR}/public
    COMMAND ${CMAKE_COMMAND} -D SOURCE=${CMAKE_SOURCE_DIR} -D GENERATED=${CMAKE_BINARY_DIR}/generated
      -D OUTPUT=${CMAKE_BINARY_DIR}/public/qsmpc -P ${CMAKE_SOURCE_DIR}/scripts/cmake/install_headers.cmake
    COMMAND ${DOXYGEN} ${CMAKE_BINARY_DIR}/Doxyfile
    VERBATIM)
  install(DIRECTORY ${reference}/html DESTINATION ${CMAKE_INSTALL_DOCDIR}-doc/reference
    COMPONENT documentation OPTIONAL)
endif()
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}-doc COMPONENT documentation)

# Debian packages: cpack --config build/…/CPackConfig.cmake
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME qsmpc)
set(CPACK_PACKAGE_CONTACT "qsmpc developers <qsmpc@example.org>")
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program library development documentation)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(library_package libqsmpc${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME qsmpc)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${library_package})
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libqsmpc-dev)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_NAME qsmpc-doc)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
# Loaded at run time, where something is drawn.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libosmesa6, fonts-dejavu-core, fonts-liberation")
# The shipped scenarios, which the library finds by name.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "qsmpc, libosmesa6, fonts-dejavu-core")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${library_package} (= ${PROJECT_VERSION}-1), libeigen3-dev")
# Written here: CPack would look for a version in the name of the Python module, too.
set(control ${CMAKE_BINARY_DIR}/debian/library)
file(WRITE ${control}/triggers "activate-noawait ldconfig\n")
file(WRITE ${control}/shlibs "libqsmpc ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} ${library_package} (= ${PROJECT_VERSION}-1)\n")
file(CHMOD ${control}/triggers ${control}/shlibs PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${control}/triggers ${control}/shlibs)
string(CONCAT what
  "Plans under uncertainty: turns a Gaussian belief into particles, certifies\n"
  "the probability of being unsafe, and drives MuJoCo vehicles to see whether\n"
  "that holds.")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "certified stochastic model predictive control on MuJoCo\n${what}")
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION
  "certified stochastic model predictive control - library\n${what}\n.\nThis package has the shared library.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "certified stochastic model predictive control - headers\n${what}\n.\nThis package has what programs are built with.")
set(CPACK_COMPONENT_DOCUMENTATION_DESCRIPTION
  "certified stochastic model predictive control - documents\n${what}\n.\nThis package has the documents and the reference of the library.")
set(package_names program:qsmpc library:${library_package} development:libqsmpc-dev documentation:qsmpc-doc)

# The Python module, of Debian's Python alone: no other finds what is in dist-packages.
if(QSMPC_PYTHON AND QSMPC_PYTHON_EXECUTABLE MATCHES "^/usr/bin/python3[.0-9]*$")
  list(APPEND CPACK_COMPONENTS_ALL python)
  list(APPEND package_names python:python3-qsmpc)
  string(REGEX MATCH "^([0-9]+)[.]([0-9]+)" python ${QSMPC_PYTHON_VERSION})
  math(EXPR next_minor "${CMAKE_MATCH_2} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-qsmpc)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  string(CONCAT CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "qsmpc (= ${PROJECT_VERSION}-1), python3 (>= ${python}~), "
    "python3 (<< ${CMAKE_MATCH_1}.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-matplotlib)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
    "certified stochastic model predictive control - Python module\n${what}\n.\nThis package has the module for Python 3.")
  # Compiled where it is installed, as other packages of Python modules are.
  set(scripts ${CMAKE_BINARY_DIR}/debian/python)
  file(CONFIGURE OUTPUT ${scripts}/postinst @ONLY CONTENT [[
#!/bin/sh
set -e
if [ "$1" = configure ] && command -v py3compile > /dev/null; then
  py3compile -p python3-qsmpc
fi
]])
  file(CONFIGURE OUTPUT ${scripts}/prerm @ONLY CONTENT [[
#!/bin/sh
set -e
if command -v py3clean > /dev/null; then
  py3clean -p python3-qsmpc
fi
]])
  file(CHMOD ${scripts}/postinst ${scripts}/prerm PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${scripts}/postinst ${scripts}/prerm)
elseif(QSMPC_PYTHON)
  message(STATUS "No package python3-qsmpc: the Python module is for ${QSMPC_PYTHON_EXECUTABLE}")
endif()

# Each package says the licences of what it is linked with, and what has changed.
find_program(GZIP gzip REQUIRED)
execute_process(COMMAND ${GZIP} -9nc INPUT_FILE ${CMAKE_SOURCE_DIR}/CHANGELOG.md
  OUTPUT_FILE ${CMAKE_BINARY_DIR}/debian/changelog.gz COMMAND_ERROR_IS_FATAL ANY)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/debian/changelog CONTENT "qsmpc (@PROJECT_VERSION@-1) unstable; urgency=medium

  * What has changed is in changelog.gz.

 -- @CPACK_PACKAGE_CONTACT@  @date@
" @ONLY)
execute_process(COMMAND ${GZIP} -9nc INPUT_FILE ${CMAKE_BINARY_DIR}/debian/changelog
  OUTPUT_FILE ${CMAKE_BINARY_DIR}/debian/changelog.Debian.gz COMMAND_ERROR_IS_FATAL ANY)
foreach(pair IN LISTS package_names)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 component)
  list(GET pair 1 package)
  install(FILES ${CMAKE_SOURCE_DIR}/scripts/packages/copyright ${CMAKE_BINARY_DIR}/debian/changelog.gz
                ${CMAKE_BINARY_DIR}/debian/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
  # What lintian is to be quiet about.
  set(overrides "# No upload to Debian's archive, where a bug would ask for it.\n")
  string(APPEND overrides "${package}: initial-upload-closes-no-bugs\n")
  if(component STREQUAL "library")
    string(APPEND overrides "# CPack calls ldconfig, whatever triggers there are.\n"
                            "${package}: maintscript-calls-ldconfig\n")
  endif()
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/debian/overrides/${package} CONTENT "${overrides}" @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/debian/overrides/${package}
    DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT ${component})
endforeach()
include(CPack)
