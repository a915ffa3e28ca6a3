# mmm_converter_add_plugin(<name> SOURCES <file>... [LIBS <target>...])
#
# A converter plugin: a loadable module <name>.so that exports getFactory and getVersion (see
# common/convert/motion_converter.h), linked to MMMConverterS2KF::common and LIBS, and installed into
# the folder where an application of the same prefix looks for plugins. The same function serves the
# plugins of this project and those of projects that use find_package(MMMConverterS2KF).
function(mmm_converter_add_plugin name)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "SOURCES;LIBS")
  if(ARG_UNPARSED_ARGUMENTS OR NOT ARG_SOURCES)
    message(FATAL_ERROR "use mmm_converter_add_plugin(<name> SOURCES <file>... [LIBS <target>...])")
  endif()
  add_library(${name} MODULE ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE MMMConverterS2KF::common ${ARG_LIBS})
  set_target_properties(${name} PROPERTIES
    PREFIX ""
    INSTALL_RPATH "$ORIGIN/../.."
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${MMM_CONVERTER_PLUGIN_DIR})
  install(TARGETS ${name} LIBRARY DESTINATION ${MMM_CONVERTER_PLUGIN_DIR})
endfunction()
