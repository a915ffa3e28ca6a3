# cmake -DNM=<nm> -DSOURCE_DIR=<project> -DWORK_DIR=<scratch> -DOBJECT=<kernels for avx2> -P check_kernels_test.cmake
#
# Functions of avx2 in what is called an object for avx512 are found by CheckKernels.cmake.
cmake_minimum_required(VERSION 3.25)

set(impostor ${WORK_DIR}/wrong_kernels_avx512.o)
file(COPY_FILE ${OBJECT} ${impostor})
execute_process(COMMAND ${CMAKE_COMMAND} -DNM=${NM} -DOBJECTS=${impostor} -P ${SOURCE_DIR}/cmake/CheckKernels.cmake
                RESULT_VARIABLE result ERROR_VARIABLE output)
if(result EQUAL 0 OR NOT output MATCHES "only some processors can run")
  message(SEND_ERROR "expected a failure, found ${result}: ${output}")
endif()
