# cmake -DROOT=<project> -P CheckLayers.cmake
#
# The include rules of the house, and a few of its other rules that a machine can check:
#   - a folder of `layers` includes only folders before it; those joined by | do not include each other
#   - a part (what some people need: `parts`) includes the core and no other part; the core includes no part: only pipeline,
#     the list of formats beside it (common/*.cc), the application and what stands above it do
#   - common/dynamics uses model and motion (and what lies below model); only the part of pipeline for it, the application
#     and the tests use dynamics
#   - plugins never include each other, the application includes no plugin; of its rooms python includes report alone
#   - include paths start at the project root; a file is opened only in io, support and above plugins
#   - headers of other projects, except Eigen, appear only in .cc files (and in tests); one header of the
#     application includes <nlohmann/json_fwd.hpp> for all, and those of python may include pybind11
#   - the library and the plugins name no option of the command line
#   - every source starts with its licence line
#   - a room of more than a thousand lines has a README.md; a room is a folder of `layers`, one of plugins or one of tests;
#     the layers of common/label are one room
cmake_minimum_required(VERSION 3.25)

set(layers
    common/support common/math common/model common/motion common/fit
    common/io/bytes common/io/xml "common/io/c3d|common/io/tables|common/io/mmm" common/io/mesh "common/io/urdf|common/io/osim|common/io/mjcf" common/io/robot
    common/io common/io/landmarks common/io/skeleton "common/io/bvh|common/io/npz" common/io/recording
    common/convert common/calibrate common/study common/judge
    common/forces common/contacts "common/angles|common/kinetics" common/osim common/retarget
    common/label common/label/search "common/label/track|common/label/learn"
    common/pipeline/input common/pipeline "common/pipeline/comparison|common/pipeline/dynamics" common/live common/pipeline/live
    "common|plugins"
    "MMMConverterS2KF/terminal|MMMConverterS2KF/report"
    "MMMConverterS2KF/batch|MMMConverterS2KF/live"
    "MMMConverterS2KF/commands|MMMConverterS2KF/python" MMMConverterS2KF
    examples tests)
# Folders of each part, with those in them.
set(parts
    "common/forces|common/contacts|common/angles|common/kinetics" common/label common/live "common/io/osim|common/osim"
    "common/retarget|common/io/urdf|common/io/mjcf|common/io/robot|common/io/mesh" common/dynamics common/pipeline/comparison)
# Of these the files alone are a layer: each of their folders is a layer of its own.
set(divided common common/io common/label common/pipeline MMMConverterS2KF)
set(tops cmake common plugins MMMConverterS2KF xml_config examples tests)
set(problems "")
string(REPLACE "|" ";" folders_of_layers "${layers};common/dynamics")

macro(problem text)
  string(APPEND problems "  ${file}: ${text}\n")
endmacro()

# The folder of a layer that a path from the project root belongs to; empty where it is none of ours.
function(layer_of path out)
  set(${out} "" PARENT_SCOPE)
  foreach(folder IN LISTS folders_of_layers)
    set(rest ".+")
    if(folder IN_LIST divided)
      set(rest "[^/]+")
    endif()
    if(path MATCHES "^${folder}/${rest}$")
      set(${out} ${folder} PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# The part that a folder belongs to; empty: to none.
function(part_of folder out)
  set(${out} "" PARENT_SCOPE)
  foreach(part IN LISTS parts)
    if(folder MATCHES "^(${part})(/|$)")
      set(${out} ${part} PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# The number of a folder's layer; the larger, the higher.
function(height_of folder out)
  set(height 0)
  foreach(layer IN LISTS layers)
    string(REPLACE "|" ";" members ${layer})
    if(folder IN_LIST members)
      set(${out} ${height} PARENT_SCOPE)
    endif()
    math(EXPR height "${height} + 1")
  endforeach()
endfunction()

# Whether a file of the folder `from` may include one of the folder `to`.
function(may_include from to out)
  set(${out} FALSE PARENT_SCOPE)
  part_of(${from} own_part)
  part_of(${to} part)
  if(from STREQUAL to)
    set(${out} TRUE PARENT_SCOPE)
  elseif(part AND NOT part STREQUAL own_part AND (own_part OR from MATCHES "^(plugins|common/.+)$")
         AND NOT from MATCHES "^common/pipeline")
    # neither the core nor another part
  elseif(from STREQUAL common/dynamics)
    if(to MATCHES "^common/(support|math|model|motion)$")
      set(${out} TRUE PARENT_SCOPE)
    endif()
  elseif(to STREQUAL common/dynamics)
    if(from MATCHES "^(common/pipeline/dynamics|(MMMConverterS2KF|tests)(/.*)?)$")
      set(${out} TRUE PARENT_SCOPE)
    endif()
  elseif(from STREQUAL common/live AND to MATCHES "^common/(judge|pipeline)")
    # beside them
  elseif(from STREQUAL MMMConverterS2KF/python AND to MATCHES "^MMMConverterS2KF/(terminal|batch|live)$")
    # a module of the library has no command line
  elseif(NOT from MATCHES "^MMMConverterS2KF" OR NOT to STREQUAL plugins)
    height_of(${from} user)
    height_of(${to} used)
    if(used LESS user)
      set(${out} TRUE PARENT_SCOPE)
    endif()
  endif()
endfunction()

macro(check_project_include path)
  layer_of(${path} to)
  if(NOT to)
    problem("\"${path}\" does not start at the project root with a folder of a layer")
  else()
    may_include(${from} ${to} allowed)
    if(NOT allowed)
      problem("${from} must not include ${to} (\"${path}\")")
    elseif(from STREQUAL plugins)
      string(REGEX MATCH "^plugins/[^/]+/" own ${file})
      string(REGEX MATCH "^plugins/[^/]+/" other ${path})
      if(other AND NOT own STREQUAL other)
        problem("a plugin must not include another (\"${path}\")")
      endif()
    endif()
  endif()
endmacro()

macro(check_foreign_include path)
  if(${path} STREQUAL nlohmann/json_fwd.hpp AND file MATCHES "^MMMConverterS2KF/.*\\.h$")
    list(APPEND json_headers ${file})
  elseif(${path} MATCHES "^pybind11/" AND from STREQUAL MMMConverterS2KF/python)
    # its headers stand between pybind11 and the application
  elseif(file MATCHES "\\.h$" AND NOT from STREQUAL tests AND NOT ${path} MATCHES "^([a-z_0-9]+|Eigen/.+)$")
    problem("<${path}> belongs in a .cc file")
  endif()
  if(${path} STREQUAL fstream AND NOT from MATCHES "^(common/(io|support)|examples|tests)(/|$)")
    problem("files are opened in common/io only (<fstream>)")
  endif()
endmacro()

# Adds num_lines of `file` to its room's.
macro(count_in_room)
  layer_of(${file} room)
  if(room MATCHES "^(plugins|tests)$")
    string(REGEX MATCH "^${room}/[^/]+" room ${file})
  elseif(room MATCHES "^common/label/")
    set(room common/label)
  endif()
  if(room)
    list(APPEND rooms ${room})
    math(EXPR lines_of_${room} "${num_lines} + 0${lines_of_${room}}")
  endif()
endmacro()

foreach(top IN LISTS tops)
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${top}/*)
  list(FILTER files EXCLUDE REGEX "/build[^/]*/")
  foreach(file IN LISTS files)
    if(NOT file MATCHES "\\.(cc|h|js|py)$")
      continue()
    endif()
    file(READ ${ROOT}/${file} text)
    string(REGEX MATCHALL "\n" lines "${text}")
    list(LENGTH lines num_lines)
    count_in_room()
    if(file MATCHES "\\.(js|py)$")
      continue()
    endif()
    if(NOT text MATCHES "^// SPDX-License-Identifier: MIT\n")
      problem("the first line is not // SPDX-License-Identifier: MIT")
    endif()
    layer_of(${file} from)
    if(NOT from)
      problem("its folder is no layer of the project")
      continue()
    endif()
    file(STRINGS ${ROOT}/${file} includes REGEX "^ *# *include")
    foreach(include IN LISTS includes)
      if(include MATCHES "\"(.+)\"")
        check_project_include(${CMAKE_MATCH_1})
      elseif(include MATCHES "<(.+)>")
        check_foreign_include(${CMAKE_MATCH_1})
      endif()
    endforeach()
    if(file MATCHES "^(common|plugins)/" AND text MATCHES "\"[^\"\n]*(--[a-z][-a-z]*)")
      problem("${CMAKE_MATCH_1}: the library does not know the options of the application, which gives such advice itself")
    endif()
  endforeach()
endforeach()

list(LENGTH json_headers num_json_headers)
if(num_json_headers GREATER 1)
  set(file "${json_headers}")
  problem("<nlohmann/json_fwd.hpp> belongs in one header")
endif()

list(REMOVE_DUPLICATES rooms)
foreach(room IN LISTS rooms)
  if(lines_of_${room} GREATER 1000 AND NOT EXISTS ${ROOT}/${room}/README.md)
    set(file ${room})
    problem("a room of ${lines_of_${room}} lines has no README.md")
  endif()
endforeach()

if(problems)
  message(FATAL_ERROR "\n${problems}")
endif()
