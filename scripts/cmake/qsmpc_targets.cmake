# What every target of the project shares: warnings, sanitizers, the include root.

add_library(qsmpc_options INTERFACE)
target_include_directories(qsmpc_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_features(qsmpc_options INTERFACE cxx_std_20)
target_compile_options(qsmpc_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  -Woverloaded-virtual -Wnull-dereference -Wdouble-promotion -Werror
  # A contraction into a fused multiply-add would make results depend on the processor.
  -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 reports false positives from inside Eigen and the standard library at -O3.
  target_compile_options(qsmpc_options INTERFACE
    -Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-null-dereference
    -Wno-restrict)
endif()
if(QSMPC_SANITIZE)
  # Left out are the checks of pointers before every access, which double the time to compile: the
  # address sanitizer, or the processor, stops at what they would find.
  target_compile_options(qsmpc_options INTERFACE
    -fsanitize=${QSMPC_SANITIZE} -fno-sanitize=null,alignment,object-size,vptr
    -fno-omit-frame-pointer -fno-sanitize-recover=all -g1)
  target_link_options(qsmpc_options INTERFACE -fsanitize=${QSMPC_SANITIZE})
endif()

# qsmpc_library(NAME SOURCES… [ALONE sources…] LINK libraries…): one room as a static library.
# ALONE: sources that no batch can hold, such as SIMD kernels, which Highway compiles once for every
# instruction set; or that are edited so often that they should not wait for others.
function(qsmpc_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;ALONE;LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES} ${ARG_ALONE})
  set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_link_libraries(${name} PUBLIC qsmpc_options ${ARG_LINK})
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()
