# cmake -DROOT=<project> -DCLANG_FORMAT=<program> -P CheckFormat.cmake
#
# Every source is formatted as .clang-format says (clang-format 14, Debian 12's; others differ in detail).
cmake_minimum_required(VERSION 3.25)

foreach(top common plugins MMMConverterS2KF examples tests)
  file(GLOB_RECURSE found RELATIVE ${ROOT} ${ROOT}/${top}/*.cc ${ROOT}/${top}/*.h)
  list(APPEND files ${found})
endforeach()
list(FILTER files EXCLUDE REGEX "/build[^/]*/")
execute_process(COMMAND ${CLANG_FORMAT} --dry-run -Werror ${files} WORKING_DIRECTORY ${ROOT}
                RESULT_VARIABLE result ERROR_VARIABLE output)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "run ${CLANG_FORMAT} -i on the files below\n${output}")
endif()
