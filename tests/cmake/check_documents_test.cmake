# cmake -DSOURCE_DIR=<project> -DWORK_DIR=<scratch> -P check_documents_test.cmake
#
# CheckDocuments.cmake on pages without a fault, then on such with one fault at a time.
cmake_minimum_required(VERSION 3.25)

function(expect_output text pattern)
  file(REMOVE_RECURSE ${WORK_DIR})
  file(WRITE ${WORK_DIR}/README.md "[Tests](tests/README.md#how) and [their folder](tests), of [S15]; [elsewhere](https://example.org/a).\n")
  file(WRITE ${WORK_DIR}/tests/README.md "${text}")
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${WORK_DIR} -P ${SOURCE_DIR}/cmake/CheckDocuments.cmake
                  RESULT_VARIABLE result ERROR_VARIABLE output)
  if(pattern STREQUAL "" AND NOT result EQUAL 0)
    message(SEND_ERROR "good pages are refused: ${output}")
  elseif(NOT pattern STREQUAL "" AND (result EQUAL 0 OR NOT output MATCHES "${pattern}"))
    message(SEND_ERROR "expected a failure that says \"${pattern}\", found ${result}: ${output}")
  endif()
endfunction()

string(REPEAT "word; " 19980 words)
expect_output("[Front page](../README.md), cited as README.md too. ${words}" "")
expect_output("${words}${words}" "399[0-9][0-9] words of Markdown; at most 20000")
expect_output("As [above](nothing.cc)." "tests/README.md: there is no nothing.cc")
expect_output("As LOST.md has it, section 9." "tests/README.md: there is no LOST.md")
