# Shared by every target of the project: warnings, sanitizers, the include root.

add_library(qsmpc_options INTERFACE)
target_include_directories(qsmpc_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_features(qsmpc_options INTERFACE cxx_std_20)
target_compile_options(qsmpc_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  -Woverloaded-virtual -Wnull-dereference -Wdouble-promotion -Werror
  # The shared library exports only what the public headers declare between visibility pragmas.
  -fvisibility=hidden -fvisibility-inlines-hidden
  # Contraction into fused multiply-adds would make results depend on the processor.
  -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 reports false positives from inside Eigen and the standard library at -O3.
  target_compile_options(qsmpc_options INTERFACE
    -Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-null-dereference
    -Wno-restrict
    # GCC does not warn in the main file about a class whose private implementation has members from
    # an anonymous namespace, but in a batch no source is the main file.
    -Wno-subobject-linkage)
endif()
if(QSMPC_SANITIZE)
  # Reports name functions; lines, with CMAKE_CXX_FLAGS=-g1, take a sixth more time to compile.
  # Excluded are the checks of pointers before every access, which double the compile time: the
  # address sanitizer or the processor stops at the same errors. Clang's pointer arithmetic check
  # rejects an offset to the null pointer, such as Eigen's for a block of an empty matrix.
  target_compile_options(qsmpc_options INTERFACE
    -fsanitize=${QSMPC_SANITIZE} -fno-sanitize=null,alignment,object-size,vptr,pointer-overflow
    -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(qsmpc_options INTERFACE -fsanitize=${QSMPC_SANITIZE})
endif()
if(QSMPC_FUZZ)
  # Coverage is measured in all of the project's code.
  target_compile_options(qsmpc_options INTERFACE -fsanitize=fuzzer-no-link)
  target_link_options(qsmpc_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

# Headers included by nearly every source are precompiled once per group of targets: controller (all
# that plans and certifies, at -O3), harness (the rest of the program, whose own loops take no time)
# and tests. Sources include what they use all the same; scripts/check-style reads them without it.
set(qsmpc_common_headers
  <algorithm> <array> <cmath> <cstddef> <cstdint> <filesystem> <functional> <limits> <map> <memory>
  <mutex> <optional> <stdexcept> <string> <string_view> <utility> <vector> <Eigen/Core>)
set(qsmpc_controller_options "")
set(qsmpc_harness_options $<$<CONFIG:Release>:-O2>)
set(qsmpc_tests_options $<$<CONFIG:Release>:-O1>)
if(QSMPC_SANITIZE)
  # Clang takes six times as long for instrumented tests with optimisation as without.
  set(qsmpc_tests_options -O0)
endif()

# qsmpc_headers(GROUP [LINK libraries…] [HEADERS …]): the precompiled header of a group.
function(qsmpc_headers group)
  cmake_parse_arguments(ARG "" "" "LINK;HEADERS" ${ARGN})
  set(source ${CMAKE_BINARY_DIR}/precompiled_${group}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "")
  add_library(qsmpc_${group}_headers OBJECT ${source})
  target_link_libraries(qsmpc_${group}_headers PRIVATE qsmpc_options ${ARG_LINK})
  target_compile_options(qsmpc_${group}_headers PRIVATE ${qsmpc_${group}_options})
  if(NOT group STREQUAL "tests")
    set_target_properties(qsmpc_${group}_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  target_precompile_headers(qsmpc_${group}_headers PRIVATE ${qsmpc_common_headers} ${ARG_HEADERS})
endfunction()

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
qsmpc_headers(controller LINK Eigen3::Eigen)
qsmpc_headers(harness LINK Eigen3::Eigen fmt::fmt HEADERS <fmt/format.h>)

# qsmpc_library(NAME SOURCES… [ALONE sources…] LINK libraries…): one room as a static library.
# ALONE: sources that cannot be in a batch, such as SIMD kernels, which Highway compiles once per
# instruction set, or that are edited so often that they should not wait for others.
function(qsmpc_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;ALONE;LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES} ${ARG_ALONE})
  set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_link_libraries(${name} PUBLIC qsmpc_options ${ARG_LINK})
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  if(CMAKE_CURRENT_SOURCE_DIR MATCHES "/(controller|models)$")
    set(group controller)
  else()
    set(group harness)
    target_link_libraries(${name} PRIVATE Eigen3::Eigen fmt::fmt)  # needed by the precompiled
                                                                   # header
  endif()
  target_compile_options(${name} PRIVATE ${qsmpc_${group}_options})
  target_precompile_headers(${name} REUSE_FROM qsmpc_${group}_headers)
endfunction()
