# What `cpack` makes: a Debian package of each component. Installed to /usr, they need no run-time path of their own;
# DebianFiles.cmake makes of the installed files what Debian expects.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME mmm-converter-s2kf)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each component has its own first line
set(CPACK_PACKAGE_CONTACT "MMMConverterS2KF team <team@mmmconverters2kf.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/DebianFiles.cmake)
set(CPACK_MMM_CONVERTER_SOURCE_DIR ${PROJECT_SOURCE_DIR})
set(CPACK_MMM_CONVERTER_DOCDIR ${CMAKE_INSTALL_DOCDIR})
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)

# mmm_converter_control_files(<component> <name> <content>...): files of the package's control archive.
function(mmm_converter_control_files component)
  set(files "")
  while(ARGN)
    list(POP_FRONT ARGN name content)
    set(file ${PROJECT_BINARY_DIR}/debian/${component}/${name})
    file(WRITE ${file} "${content}")
    set(executable "")
    if(content MATCHES "^#!")
      set(executable OWNER_EXECUTE GROUP_EXECUTE WORLD_EXECUTE)
    endif()
    file(CHMOD ${file} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ ${executable})
    list(APPEND files ${file})
  endwhile()
  string(TOUPPER ${component} component)
  set(CPACK_DEBIAN_${component}_PACKAGE_CONTROL_EXTRA "${files}" PARENT_SCOPE)
endfunction()

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME mmm-converter-s2kf)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "libmmm-converter-s2kf-dev, python3-mmmconverter, gnuplot-nox")
mmm_converter_control_files(program
  triggers "activate-noawait ldconfig\n"
  shlibs "libmmm_converter_common ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} mmm-converter-s2kf (= ${PROJECT_VERSION}-1)
libmmm_converter_pipeline ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} mmm-converter-s2kf (= ${PROJECT_VERSION}-1)\n")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "motion capture markers to motions of the human body
Converts recordings of optical motion capture (C3D, TRC, MMM) into motions of
the Master Motor Map: root poses and joint angles of a model of the human body,
of a robot (URDF) or of rigid objects, with their uncertainty. Markers are
tracked with the Smart Sampling Kalman Filter, an unscented or extended Kalman
filter, or least squares, from files or while a motion capture system streams.
.
Persons can be calibrated, missing labels found, and motions checked by their
dynamics. Results come as motions, tables and pages for a browser.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libmmm-converter-s2kf-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "cmake (>= 3.25), pkg-config")
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS program)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "library of MMMConverterS2KF (development files)
Headers of the library behind the program MMMConverterS2KF, found by CMake
(find_package) and pkg-config: readers and writers of motion capture files,
kinematic models, and the interface of converters.
.
With it programs are built that use the library, and converters that the
program loads as plugins.")

if(MMM_CONVERTER_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  string(REGEX MATCH "^3\\.([0-9]+)" python "${MMM_CONVERTER_PYTHON_VERSION}")
  math(EXPR next_minor "${CMAKE_MATCH_1} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-mmmconverter)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= ${python}), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib, python3-pandas")
  set(CPACK_COMPONENT_PYTHON_DEPENDS program)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "motion capture markers to motions of the human body (Python)
The functions of the program MMMConverterS2KF as a module for Python:
recordings of motion capture, their conversion into joint angles, calibration
of persons, labels and dynamics, with the numbers as arrays of NumPy.
.
Frames can be tracked one by one as they come, and poses of all segments are
computed for whole motions at once.")
  # Where only root writes, byte code is made and removed with the package.
  mmm_converter_control_files(python
    postinst "#!/bin/sh\nset -e\nif command -v py3compile > /dev/null\nthen\n  py3compile -p python3-mmmconverter\nfi\n"
    prerm "#!/bin/sh\nset -e\nif command -v py3clean > /dev/null\nthen\n  py3clean -p python3-mmmconverter\nfi\n")
endif()
include(CPack)
