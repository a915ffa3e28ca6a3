# cmake -DPROGRAM=<program> -DOUTPUT=<folder> -P PrintManual.cmake
#
# Lets the program print its manual pages, man1/*.1.gz, its completion, completions/MMMConverterS2KF, and the schema of
# manifests, schema/batch.xsd.
cmake_minimum_required(VERSION 3.25)

function(print file)
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_FILE ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${OUTPUT})
file(MAKE_DIRECTORY ${OUTPUT}/man1 ${OUTPUT}/completions ${OUTPUT}/schema)
print(${OUTPUT}/schema/batch.xsd print-config batch-schema)
print(${OUTPUT}/completions/MMMConverterS2KF help --completion)
print(${OUTPUT}/man1/MMMConverterS2KF.1 help --man)
execute_process(COMMAND ${PROGRAM} help --list commands OUTPUT_VARIABLE commands COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" commands "${commands}")
foreach(command IN LISTS commands)
  print(${OUTPUT}/man1/MMMConverterS2KF-${command}.1 help --man ${command})
endforeach()
file(GLOB pages ${OUTPUT}/man1/*.1)
execute_process(COMMAND gzip -9 -n ${pages} COMMAND_ERROR_IS_FATAL ANY)
