# What `cmake --install` and `cpack` put where. All run-time paths are relative to the files that use
# them (Layout.cmake), so an installed tree can be moved. Plugins install themselves.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/MMMConverterS2KF)
set(header_dir ${CMAKE_INSTALL_INCLUDEDIR}/MMMConverterS2KF)

install(TARGETS mmm_converter_common EXPORT MMMConverterS2KFTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(TARGET MMMConverterS2KF)
  install(TARGETS MMMConverterS2KF RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(DIRECTORY common DESTINATION ${header_dir} FILES_MATCHING PATTERN "*.h"
        PATTERN dynamics EXCLUDE PATTERN calibrate EXCLUDE PATTERN label EXCLUDE)  # not exported
install(DIRECTORY xml_config/ DESTINATION ${MMM_CONVERTER_DATA_DIR}
        PATTERN CMakeLists.txt EXCLUDE)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(EXECUTABLE ${CMAKE_INSTALL_BINDIR}/MMMConverterS2KF)
configure_package_config_file(cmake/MMMConverterS2KFConfig.cmake.in
  ${PROJECT_BINARY_DIR}/MMMConverterS2KFConfig.cmake INSTALL_DESTINATION ${package_dir}
  PATH_VARS EXECUTABLE MMM_CONVERTER_DATA_DIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/MMMConverterS2KFConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(EXPORT MMMConverterS2KFTargets NAMESPACE MMMConverterS2KF:: DESTINATION ${package_dir})
install(FILES ${PROJECT_BINARY_DIR}/MMMConverterS2KFConfig.cmake
              ${PROJECT_BINARY_DIR}/MMMConverterS2KFConfigVersion.cmake
              cmake/MMMConverterS2KFPlugin.cmake
        DESTINATION ${package_dir})

set(pc_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH prefix_from_pc /prefix/${pc_dir} /prefix)
string(REGEX REPLACE "/$" "" prefix_from_pc ${prefix_from_pc})
get_target_property(definitions mmm_converter_common INTERFACE_COMPILE_DEFINITIONS)
list(TRANSFORM definitions PREPEND -D)
list(JOIN definitions " " definitions)
configure_file(cmake/MMMConverterS2KF.pc.in ${PROJECT_BINARY_DIR}/MMMConverterS2KF.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/MMMConverterS2KF.pc DESTINATION ${pc_dir})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME mmm-converter-s2kf)
set(CPACK_PACKAGE_CONTACT "MMMConverterS2KF team <team@mmmconverters2kf.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS libeigen3-dev)
if(MMM_CONVERTER_PYTHON)
  set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libeigen3-dev, python3-numpy")
endif()
include(CPack)
