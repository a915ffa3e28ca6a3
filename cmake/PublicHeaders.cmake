cmake_minimum_required(VERSION 3.25)  # for the policies of a script

# mmm_converter_public_headers(out root): the headers that are installed, relative to the project's root: the front door and
# the interface of converter plugins, what the project's plugins and examples/external_plugin include, and all that these do.
function(mmm_converter_public_headers out root)
  file(GLOB_RECURSE users RELATIVE ${root} ${root}/plugins/*.cc ${root}/plugins/*.h ${root}/examples/external_plugin/*.cc)
  set(next common/mmm_converter.h common/convert/motion_converter.h ${users})
  set(known "")
  while(next)
    list(POP_FRONT next file)
    if(file IN_LIST known)
      continue()
    endif()
    list(APPEND known ${file})
    file(STRINGS ${root}/${file} lines REGEX "^ *# *include \"common/")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE ".*\"(.+)\".*" "\\1" included "${line}")
      list(APPEND next ${included})
    endforeach()
  endwhile()
  list(FILTER known INCLUDE REGEX "^common/")
  list(SORT known)
  set(${out} ${known} PARENT_SCOPE)
endfunction()
