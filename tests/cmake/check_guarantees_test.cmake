# cmake -DSOURCE_DIR=<project> -DWORK_DIR=<scratch> -P check_guarantees_test.cmake
#
# A page of guarantees without fault passes CheckGuarantees.cmake; a row without a test, and one with a test that is not
# there, are found.
cmake_minimum_required(VERSION 3.25)

function(expect_row row expected)
  file(WRITE ${WORK_DIR}/page.md "| guarantee | test |\n|---|---|\n${row}\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${SOURCE_DIR} -DPAGE=${WORK_DIR}/page.md
                          -P ${SOURCE_DIR}/cmake/CheckGuarantees.cmake
                  RESULT_VARIABLE result ERROR_VARIABLE output)
  # CMake breaks the lines of a message where they are too long for its page.
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if(expected STREQUAL "")
    if(NOT result EQUAL 0)
      message(SEND_ERROR "a row without fault is refused: ${output}")
    endif()
  elseif(result EQUAL 0 OR NOT output MATCHES "${expected}")
    message(SEND_ERROR "expected \"${expected}\", found ${result}: ${output}")
  endif()
endfunction()

expect_row("| A file. | `BadInput`, `BadInput.AFolder`, `Faults.Sweep`, `ReportPage` |" "")
expect_row("| A file. | |" "names no test")
expect_row("| A file. | `BadInput.NotThere` |" "no test BadInput.NotThere")
expect_row("| A file. | `BadInp` |" "no test BadInp")
expect_row("| A file. | `BadInput.AFold` |" "no test BadInput.AFold")
