# cmake -DNM=<nm> -DOBJECTS=<list> -P CheckKernels.cmake
#
# The linker keeps one copy of an inline function for the whole program. An object that is compiled for one instruction
# set may therefore define such functions in the namespace of that set only.
cmake_minimum_required(VERSION 3.25)

set(checked 0)
foreach(object ${OBJECTS})
  if(NOT object MATCHES "_kernels_(avx2|avx512)")
    continue()
  endif()
  set(variant ${CMAKE_MATCH_1})
  execute_process(COMMAND ${NM} --demangle --defined-only ${object}
                  OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^\n]+" lines "${symbols}")
  foreach(line ${lines})
    if(line MATCHES " [TWVuBDR] " AND NOT line MATCHES "::${variant}::" AND NOT line MATCHES "__(asan|ubsan|odr)")
      message(SEND_ERROR "${object} defines a function for all that only some processors can run: ${line}")
    endif()
  endforeach()
  math(EXPR checked "${checked} + 1")
endforeach()
if(checked EQUAL 0)
  message(FATAL_ERROR "no object was checked: ${OBJECTS}")
endif()
