# The library as others use it: one shared library, its public headers, and the files by which CMake
# and pkg-config find it.
#
# Components: program, models (what ships with the program), library, development.

set(qsmpc_rooms
  qsmpc_models qsmpc_controller qsmpc_render
  qsmpc_text qsmpc_errors qsmpc_files qsmpc_statistics qsmpc_random qsmpc_threads qsmpc_mujoco
  qsmpc_scenario qsmpc_assembly qsmpc_plant qsmpc_trace qsmpc_episode qsmpc_video)

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
  LINKER:--version-script=${CMAKE_SOURCE_DIR}/scripts/cmake/exports.map LINKER:--no-undefined)
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

install(DIRECTORY models/campaigns models/mjcf models/scenarios
  DESTINATION ${CMAKE_INSTALL_DATADIR}/qsmpc/models COMPONENT models)
