# What `cmake --install` puts where; what is not said to be of another component is of `program` (Layout.cmake). All run-time paths are relative to the files that use
# them (Layout.cmake), so an installed tree can be moved. Plugins install themselves.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/MMMConverterS2KF)
set(header_dir ${CMAKE_INSTALL_INCLUDEDIR}/MMMConverterS2KF)

install(TARGETS mmm_converter_common mmm_converter_pipeline EXPORT MMMConverterS2KFTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} NAMELINK_COMPONENT development)
if(TARGET MMMConverterS2KF)
  install(TARGETS MMMConverterS2KF RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
# Which headers these are is found while they are installed: what a source includes may have changed since the project was
# configured.
install(CODE "
  include(\"${PROJECT_SOURCE_DIR}/cmake/PublicHeaders.cmake\")
  mmm_converter_public_headers(headers \"${PROJECT_SOURCE_DIR}\")
  foreach(header IN LISTS headers)
    cmake_path(GET header PARENT_PATH folder)
    file(INSTALL \"${PROJECT_SOURCE_DIR}/\${header}\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${header_dir}/\${folder}\")
  endforeach()" COMPONENT development)
install(DIRECTORY xml_config/ DESTINATION ${MMM_CONVERTER_DATA_DIR}
        PATTERN CMakeLists.txt EXCLUDE)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(EXECUTABLE ${CMAKE_INSTALL_BINDIR}/MMMConverterS2KF)
set(PYTHON_MODULES lib/python3/dist-packages)
configure_package_config_file(cmake/MMMConverterS2KFConfig.cmake.in
  ${PROJECT_BINARY_DIR}/MMMConverterS2KFConfig.cmake INSTALL_DESTINATION ${package_dir}
  PATH_VARS EXECUTABLE PYTHON_MODULES MMM_CONVERTER_DATA_DIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/MMMConverterS2KFConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(EXPORT MMMConverterS2KFTargets NAMESPACE MMMConverterS2KF:: DESTINATION ${package_dir} COMPONENT development)
install(FILES ${PROJECT_BINARY_DIR}/MMMConverterS2KFConfig.cmake
              ${PROJECT_BINARY_DIR}/MMMConverterS2KFConfigVersion.cmake
              cmake/MMMConverterS2KFPlugin.cmake
        DESTINATION ${package_dir} COMPONENT development)

set(pc_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH prefix_from_pc /prefix/${pc_dir} /prefix)
string(REGEX REPLACE "/$" "" prefix_from_pc ${prefix_from_pc})
get_target_property(definitions mmm_converter_common INTERFACE_COMPILE_DEFINITIONS)
list(TRANSFORM definitions PREPEND -D)
list(JOIN definitions " " definitions)
configure_file(cmake/MMMConverterS2KF.pc.in ${PROJECT_BINARY_DIR}/MMMConverterS2KF.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/MMMConverterS2KF.pc DESTINATION ${pc_dir} COMPONENT development)
