# mmm_converter_embed_file(<target> <function> <file>): the bytes of a text file as
# std::string_view <function>(), with its namespace, compiled into the target.
#
# As a script (-DINPUT= -DOUTPUT= -DFUNCTION=) it writes the source that does so.
if(CMAKE_SCRIPT_MODE_FILE)
  file(READ ${INPUT} bytes HEX)
  string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  get_filename_component(name ${INPUT} NAME)
  string(REGEX REPLACE "^(.*)::([^:]+)$" "\\1;\\2" parts "${FUNCTION}")
  list(GET parts 0 namespace)
  list(GET parts 1 function)
  file(WRITE ${OUTPUT} "// Made from ${name}.
#include <string_view>
namespace ${namespace} {
namespace {
constexpr char kBytes[] = {
${bytes}0};
}
std::string_view ${function}();
std::string_view ${function}() { return {kBytes, sizeof(kBytes) - 1}; }
}
")
  return()
endif()

set(MMM_CONVERTER_EMBED_FILE ${CMAKE_CURRENT_LIST_FILE})

function(mmm_converter_embed_file target function file)
  get_filename_component(input ${file} ABSOLUTE)
  get_filename_component(name ${file} NAME)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${name}.cc)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DINPUT=${input} -DOUTPUT=${output} -DFUNCTION=${function}
            -P ${MMM_CONVERTER_EMBED_FILE}
    DEPENDS ${input} ${MMM_CONVERTER_EMBED_FILE}
    COMMENT "Embedding ${name}" VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
