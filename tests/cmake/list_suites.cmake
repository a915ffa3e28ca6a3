# cmake -DPROGRAM=<GoogleTest program> -DOUTPUT=<file> [-DLABELS=<label>] [-DLONG=<suite>...] -P list_suites.cmake
#
# Writes a ctest entry for each test suite of a program. A process for each case would start a program some 900 times, and
# make again what the cases of a suite share.
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE list COMMAND_ERROR_IS_FATAL ANY)
# Suites start at the beginning of a line and end with a dot; cases are indented.
string(REGEX MATCHALL "\n[^ \n]+\\.[^\n]*" suites "\n${list}")
get_filename_component(program ${PROGRAM} NAME)
set(entries "")
# The long ones begin first, so that none runs alone at the end.
set(cost 1)
if(program MATCHES "_accuracy_test$")
  set(cost 100)
endif()
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "^\n([^ ]+)\\..*$" "\\1" suite "${suite}")
  # Those of real files, which are skipped where these are missing (support/shared_data.h).
  set(labels "${LABELS}")
  if(suite MATCHES "Real")
    list(APPEND labels real)
  endif()
  string(REGEX REPLACE "^.*/" "" name "${suite}")
  if(name IN_LIST LONG)
    list(APPEND labels long)
  endif()
  string(APPEND entries "add_test([=[${program}.${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
    # Skipped are suites of which nothing was run, and nothing failed.
    "set_tests_properties([=[${program}.${suite}]=] PROPERTIES COST ${cost} LABELS \"${labels}\" SKIP_REGULAR_EXPRESSION "
    "[=[\\[  PASSED  \\] 0 tests\\.\n\\[  SKIPPED \\] [0-9]+ tests?, listed below:\n(\\[  SKIPPED \\] [^\n]*\n)*$]=])\n")
endforeach()
file(WRITE ${OUTPUT} "${entries}")
