# Writes a C++ source with a page's style and scripts as text, and their SHA-256 hashes for the
# content security policy. Run with:
#
#   cmake -D OUTPUT=FILE -D "STYLES=a.css;b.css" -D "LICENCE=FILE" -D "LIBRARIES=lib.js"
#         -D "SCRIPTS=a.js;b.js" -D "SCENE_LICENCE=FILE" -D "SCENE=bundle.js" -P embed_page.cmake
#
# The project's own scripts share a private scope. SCENE is a separate script that includes its
# libraries.

function(join_files out)
  set(text "")
  foreach(file IN LISTS ARGN)
    file(READ "${file}" part)
    string(APPEND text "${part}\n")
  endforeach()
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

join_files(style ${STYLES})
join_files(licence ${LICENCE})
join_files(libraries ${LIBRARIES})
join_files(scripts ${SCRIPTS})
join_files(scene_licence ${SCENE_LICENCE})
join_files(scene ${SCENE})
string(CONCAT script "\n/*\n${licence}*/\n${libraries}(() => {\n\"use strict\";\n${scripts}})();\n")
string(CONCAT scene_script "\n/*\n${scene_licence}*/\n${scene}")
foreach(text IN ITEMS script scene_script)
  if(${text} MATCHES "</[Ss][Cc][Rr][Ii][Pp][Tt]|<!--")
    message(FATAL_ERROR "a script of the page contains </script or <!--, which ends its element")
  endif()
endforeach()

set(delimiter "qsmpc_page")
set(source "// Made by scripts/cmake/embed_page.cmake.\n#include \"harness/report/page_assets.hpp\"\n\n")
string(APPEND source "namespace qsmpc::harness {\n\n")
foreach(asset style script scene_script)
  string(SHA256 hash "${${asset}}")
  string(APPEND source
    "std::string_view page_${asset}() {\n  return R\"${delimiter}(${${asset}})${delimiter}\";\n}\n\n"
    "std::string_view page_${asset}_sha256() { return \"${hash}\"; }\n\n")
endforeach()
string(APPEND source "}  // namespace qsmpc::harness\n")
file(WRITE "${OUTPUT}" "${source}")
