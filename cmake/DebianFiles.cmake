# Run by cpack when the files of all components stand in CPACK_TEMPORARY_INSTALL_DIRECTORY, before it packs them: Debian's
# files of documentation, and no run-time paths, as /usr/lib is searched anyway.
cmake_minimum_required(VERSION 3.25)

set(source ${CPACK_MMM_CONVERTER_SOURCE_DIR})
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH, where it is set
file(READ ${source}/LICENSE licence)
file(READ ${source}/MMMConverterS2KF/report/page/licences.txt licences_of_page)

function(gzip file)
  execute_process(COMMAND gzip -9 -n -f ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  set(package ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  set(usr ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${component}/usr)
  set(doc ${usr}/share/doc/${package})

  file(GLOB_RECURSE files LIST_DIRECTORIES FALSE ${usr}/*)
  foreach(file IN LISTS files)
    if(NOT IS_SYMLINK ${file} AND file MATCHES "/bin/[^/]+$|\\.so(\\.[0-9.]+)?$")
      file(RPATH_REMOVE FILE ${file})
    endif()
  endforeach()

  if(component STREQUAL program)
    file(MAKE_DIRECTORY ${doc})
    file(RENAME ${usr}/${CPACK_MMM_CONVERTER_DOCDIR}/README.md ${doc}/README.md)
    file(REMOVE_RECURSE ${usr}/${CPACK_MMM_CONVERTER_DOCDIR})
  endif()
  if(component STREQUAL development AND EXISTS ${usr}/${CPACK_MMM_CONVERTER_DOCDIR}/html)
    file(MAKE_DIRECTORY ${doc})
    file(RENAME ${usr}/${CPACK_MMM_CONVERTER_DOCDIR}/html ${doc}/html)
    file(REMOVE_RECURSE ${usr}/${CPACK_MMM_CONVERTER_DOCDIR})
  endif()
  file(WRITE ${doc}/copyright "MMMConverterS2KF, packaged from its own source tree.\n\n${licence}\n")
  if(NOT component STREQUAL development)
    file(APPEND ${doc}/copyright "\nThe pages that the program writes contain libraries in JavaScript.\n${licences_of_page}")
  endif()
  file(COPY_FILE ${source}/CHANGELOG.md ${doc}/changelog)
  file(WRITE ${doc}/changelog.Debian
       "mmm-converter-s2kf (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium\n\n"
       "  * Packages of version ${CPACK_PACKAGE_VERSION}; changelog.gz says what is new.\n\n"
       " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  gzip(${doc}/changelog)
  gzip(${doc}/changelog.Debian)
endforeach()
