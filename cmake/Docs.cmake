# The target `docs` of -DMMM_CONVERTER_DOCS=ON: pages of the library by Doxygen, of the module for Python by Sphinx (Debian:
# doxygen, python3-sphinx), in build/docs/html. Any warning is an error.
find_package(Doxygen 1.9 REQUIRED)
find_package(Python REQUIRED COMPONENTS Interpreter)

set(docs_source ${PROJECT_SOURCE_DIR}/cmake/docs)
set(docs_output ${PROJECT_BINARY_DIR}/docs/html)
set(docs_work ${PROJECT_BINARY_DIR}/docs)
set(docs_list ${docs_work}/pages.txt)

# Headers that are installed, and the READMEs of all folders that users may look into.
include(cmake/PublicHeaders.cmake)
mmm_converter_public_headers(docs_headers ${PROJECT_SOURCE_DIR})
list(TRANSFORM docs_headers PREPEND ${PROJECT_SOURCE_DIR}/)
set(docs_pages ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md)
foreach(folder common plugins MMMConverterS2KF xml_config examples)
  file(GLOB_RECURSE pages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.md)
  list(APPEND docs_pages ${pages})
endforeach()
list(FILTER docs_pages EXCLUDE REGEX "/build[^/]*/")
list(JOIN docs_pages "\n" lines)
file(CONFIGURE OUTPUT ${docs_list} CONTENT "${lines}\n")
list(TRANSFORM docs_pages REPLACE "(.+)" "\"\\1\"" OUTPUT_VARIABLE quoted_pages)
list(TRANSFORM docs_headers REPLACE "(.+)" "\"\\1\"" OUTPUT_VARIABLE quoted_headers)
list(JOIN quoted_pages " " quoted_pages)
list(JOIN quoted_headers " " quoted_headers)
set(docs_input "${quoted_pages} ${quoted_headers}")
configure_file(${docs_source}/Doxyfile.in ${docs_work}/Doxyfile @ONLY)

set(docs_commands COMMAND ${CMAKE_COMMAND} -E make_directory ${docs_output}
                  COMMAND ${DOXYGEN_EXECUTABLE} ${docs_work}/Doxyfile)
set(docs_python_link "")
if(TARGET _mmmconverter)
  find_program(MMM_CONVERTER_SPHINX_BUILD sphinx-build REQUIRED DOC "Sphinx (Debian: python3-sphinx)")
  set(docs_python_link "<li><a href=\"python/index.html\">The module for Python</a></li>")
  configure_file(${docs_source}/conf.py.in ${docs_work}/python/conf.py @ONLY)
  configure_file(${docs_source}/index.rst ${docs_work}/python/index.rst COPYONLY)
  list(APPEND docs_commands COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1
       PYTHONPATH=${PROJECT_BINARY_DIR}/lib/python3/dist-packages
       ${MMM_CONVERTER_SPHINX_BUILD} -q -W --keep-going -E -b html -d ${docs_work}/doctrees ${docs_work}/python ${docs_output}/python)
endif()
configure_file(${docs_source}/index.html.in ${docs_work}/index.html @ONLY)

add_custom_target(docs ${docs_commands} COMMAND ${CMAKE_COMMAND} -E copy ${docs_work}/index.html ${docs_output} VERBATIM)
if(TARGET _mmmconverter)
  add_dependencies(docs _mmmconverter)
endif()
install(DIRECTORY ${docs_output} DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development OPTIONAL)  # where it was built
