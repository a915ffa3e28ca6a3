# The build tree mirrors the installed tree, so that the application finds its plugins and data by the
# same relative paths in both: bin/, lib/, lib/MMMConverterS2KF/plugins/, share/MMMConverterS2KF/.
set(MMM_CONVERTER_PLUGIN_DIR ${CMAKE_INSTALL_LIBDIR}/MMMConverterS2KF/plugins)
set(MMM_CONVERTER_DATA_DIR ${CMAKE_INSTALL_DATADIR}/MMMConverterS2KF)

# Components: program (with the shared library, plugins and data), development, python.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})

file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_DATADIR})
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/xml_config ${PROJECT_BINARY_DIR}/${MMM_CONVERTER_DATA_DIR} SYMBOLIC)
