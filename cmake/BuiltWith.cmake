# What `--version` says: which versions the program was built with.

# mmm_converter_built_with(<name> <version>): one more library. A version that is empty is left out.
function(mmm_converter_built_with name version)
  string(STRIP "${name} ${version}" text)
  set_property(GLOBAL APPEND PROPERTY MMM_CONVERTER_BUILT_WITH ${text})
endfunction()

# mmm_converter_header_version(<out> <header> <prefix>): of a library without a CMake config, from the macros
# <prefix>_MAJOR, _MINOR and _PATCH or _RELEASE of its header.
function(mmm_converter_header_version out header prefix)
  set(version "")
  foreach(part MAJOR MINOR "(PATCH|RELEASE)")
    file(STRINGS ${header} line REGEX "^# *define +${prefix}_${part} +[0-9]+" LIMIT_COUNT 1)
    string(REGEX MATCH "[0-9]+$" number "${line}")
    list(APPEND version ${number})
  endforeach()
  list(JOIN version . version)
  set(${out} ${version} PARENT_SCOPE)
endfunction()

# mmm_converter_soname_version(<out> <target>): of a library that says its version nowhere else.
function(mmm_converter_soname_version out target)
  get_target_property(file ${target} LOCATION)
  file(REAL_PATH ${file} file)
  string(REGEX MATCH "[0-9][0-9.]*$" version ${file})
  set(${out} "${version}" PARENT_SCOPE)
endfunction()
