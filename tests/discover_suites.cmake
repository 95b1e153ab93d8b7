# Lists the suites of a test program (with EACH its tests), and writes one ctest test for each.
#
#   cmake -D PROGRAM=… -D NAME=… -D EACH=… -D FILE=… -P discover_suites.cmake
execute_process(COMMAND ${PROGRAM} --gtest_list_tests
                OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
# After a # comes the value or type of a parameter; its brackets and semicolons would join lines.
string(REGEX REPLACE "#[^\n]*" "" listed "${listed}")
string(REGEX MATCHALL "[^\n]+" lines "${listed}")
set(tests "")
function(add_filter filter)
  string(REGEX REPLACE "[.]?[*]$" "" test "${filter}")
  string(APPEND tests
    "add_test([==[${NAME}.${test}]==] \"${PROGRAM}\" [==[--gtest_filter=${filter}]==])\n")
  set(tests "${tests}" PARENT_SCOPE)
endfunction()
foreach(line IN LISTS lines)
  if(line MATCHES "^([^ ]+[.]) *$")
    set(suite ${CMAKE_MATCH_1})
    if(NOT EACH)
      add_filter("${suite}*")
    endif()
  elseif(EACH AND line MATCHES "^ +([^ ]+) *$")
    add_filter("${suite}${CMAKE_MATCH_1}")
  endif()
endforeach()
if(tests STREQUAL "")
  message(FATAL_ERROR "${PROGRAM} lists no tests")
endif()
file(WRITE "${FILE}" "${tests}")
