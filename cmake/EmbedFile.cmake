# mmm_converter_embed_file(<target> <function> <file>...): the bytes of text files, one after the
# other, as std::string_view <function>(), with its namespace, compiled into the target;
# <function>Sha256() has the 32 bytes of their SHA-256.
#
# As a script (-DINPUT= -DOUTPUT= -DFUNCTION=) it writes the source that does so.
if(CMAKE_SCRIPT_MODE_FILE)
  set(names "")
  foreach(file IN LISTS INPUT)
    get_filename_component(name ${file} NAME)
    string(APPEND names " ${name}")
  endforeach()
  set(joined ${OUTPUT}.joined)
  execute_process(COMMAND ${CMAKE_COMMAND} -E cat ${INPUT} OUTPUT_FILE ${joined} COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${joined} bytes HEX)
  file(SHA256 ${joined} hash)
  file(REMOVE ${joined})
  string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," hash "${hash}")
  string(REGEX REPLACE "^(.*)::([^:]+)$" "\\1;\\2" parts "${FUNCTION}")
  list(GET parts 0 namespace)
  list(GET parts 1 function)
  file(WRITE ${OUTPUT} "// Made from${names}.
#include <string_view>
namespace ${namespace} {
std::string_view ${function}();
std::string_view ${function}() {
  static constexpr unsigned char kBytes[] = {
${bytes}0};
  return {reinterpret_cast<const char*>(kBytes), sizeof(kBytes) - 1};
}
std::string_view ${function}Sha256();
std::string_view ${function}Sha256() {
  static constexpr unsigned char kHash[] = {${hash}};
  return {reinterpret_cast<const char*>(kHash), sizeof(kHash)};
}
}
")
  return()
endif()

set(MMM_CONVERTER_EMBED_FILE ${CMAKE_CURRENT_LIST_FILE})

function(mmm_converter_embed_file target function)
  set(inputs "")
  foreach(file IN LISTS ARGN)
    get_filename_component(input ${file} ABSOLUTE)
    list(APPEND inputs ${input})
  endforeach()
  string(REGEX REPLACE "^.*::" "" name ${function})
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${name}.cc)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} "-DINPUT=${inputs}" -DOUTPUT=${output} -DFUNCTION=${function}
            -P ${MMM_CONVERTER_EMBED_FILE}
    DEPENDS ${inputs} ${MMM_CONVERTER_EMBED_FILE}
    COMMENT "Embedding ${name}" VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
