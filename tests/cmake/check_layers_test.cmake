# cmake -DSOURCE_DIR=<project> -DWORK_DIR=<scratch> -P check_layers_test.cmake
#
# CheckLayers.cmake on a tree without a fault, then on that tree with one fault at a time.
cmake_minimum_required(VERSION 3.25)

set(licence "// SPDX-License-Identifier: MIT\n")

function(write_good_tree)
  file(REMOVE_RECURSE ${WORK_DIR})
  foreach(folder common/support common/model common/motion common/io common/io/bytes common/io/c3d common/io/mmm
                 common/io/recording common/label/search common/label/track common/label/learn
                 common/contacts common/retarget common/judge common/pipeline common/pipeline/input common/pipeline/comparison
                 common/pipeline/dynamics common/live common/dynamics plugins/one plugins/two MMMConverterS2KF
                 MMMConverterS2KF/terminal MMMConverterS2KF/report examples tests)
    file(WRITE ${WORK_DIR}/${folder}/used.h "${licence}#include <Eigen/Core>\n#include <vector>\n")
  endforeach()
  file(WRITE ${WORK_DIR}/common/io/user.cc "${licence}#include <fmt/core.h>\n#include <fstream>\n
#include \"common/motion/used.h\"\n")
  file(WRITE ${WORK_DIR}/common/pipeline/user.cc "${licence}#include \"common/retarget/used.h\"\n")
  file(WRITE ${WORK_DIR}/common/formats.cc "${licence}#include \"common/retarget/used.h\"\n")
  file(WRITE ${WORK_DIR}/common/dynamics/user.h "${licence}#include \"common/motion/used.h\"\n")
  file(WRITE ${WORK_DIR}/common/io/recording/user.cc "${licence}#include \"common/io/c3d/used.h\"\n#include \"common/io/used.h\"\n")
  file(WRITE ${WORK_DIR}/MMMConverterS2KF/user.cc "${licence}#include \"MMMConverterS2KF/report/used.h\"\n")
  file(WRITE ${WORK_DIR}/common/pipeline/dynamics/user.cc "${licence}#include \"common/dynamics/used.h\"\n")
  file(WRITE ${WORK_DIR}/MMMConverterS2KF/report/user.cc "${licence}#include \"common/pipeline/dynamics/used.h\"\n")
  file(WRITE ${WORK_DIR}/MMMConverterS2KF/report/json.h "${licence}#include <nlohmann/json_fwd.hpp>\n")
  file(WRITE ${WORK_DIR}/tests/user.cc "${licence}#include \"plugins/one/used.h\"\n")
endfunction()

function(expect_output pattern)
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${WORK_DIR} -P ${SOURCE_DIR}/cmake/CheckLayers.cmake
                  RESULT_VARIABLE result ERROR_VARIABLE output)
  if(pattern STREQUAL "" AND NOT result EQUAL 0)
    message(SEND_ERROR "a good tree is refused: ${output}")
  elseif(NOT pattern STREQUAL "" AND (result EQUAL 0 OR NOT output MATCHES "${pattern}"))
    message(SEND_ERROR "expected a failure that says \"${pattern}\", found ${result}: ${output}")
  endif()
endfunction()

function(expect_fault file text pattern)
  write_good_tree()
  file(WRITE ${WORK_DIR}/${file} "${text}")
  expect_output("${file}: ${pattern}")
endfunction()

write_good_tree()
expect_output("")

expect_fault(common/model/a.h "${licence}#include \"common/motion/used.h\"\n"
             "common/model must not include common/motion")
expect_fault(common/io/a.cc "${licence}#include \"common/dynamics/used.h\"\n"
             "common/io must not include common/dynamics")
expect_fault(plugins/one/a.cc "${licence}#include \"common/dynamics/used.h\"\n"
             "plugins must not include common/dynamics")
expect_fault(common/dynamics/a.cc "${licence}#include \"common/io/used.h\"\n"
             "common/dynamics must not include common/io")
expect_fault(plugins/one/a.cc "${licence}#include \"common/front.h\"\n"
             "plugins must not include common ")
expect_fault(common/pipeline/a.cc "${licence}#include \"common/front.h\"\n"
             "common/pipeline must not include common ")
expect_fault(plugins/one/a.cc "${licence}#include \"plugins/two/used.h\"\n"
             "a plugin must not include another")
expect_fault(MMMConverterS2KF/a.cc "${licence}#include \"plugins/one/used.h\"\n"
             "MMMConverterS2KF must not include plugins")
expect_fault(common/io/c3d/a.cc "${licence}#include \"common/io/recording/used.h\"\n"
             "common/io/c3d must not include common/io/recording")
expect_fault(common/io/c3d/a.cc "${licence}#include \"common/io/mmm/used.h\"\n"
             "common/io/c3d must not include common/io/mmm")
expect_fault(common/label/a.h "${licence}#include \"common/label/search/used.h\"\n"
             "common/label must not include common/label/search")
expect_fault(common/label/search/a.h "${licence}#include \"common/label/track/used.h\"\n"
             "common/label/search must not include common/label/track")
expect_fault(common/label/learn/a.h "${licence}#include \"common/label/track/used.h\"\n"
             "common/label/learn must not include common/label/track")
expect_fault(common/judge/a.cc "${licence}#include \"common/retarget/used.h\"\n"
             "common/judge must not include common/retarget")
expect_fault(common/retarget/a.cc "${licence}#include \"common/contacts/used.h\"\n"
             "common/retarget must not include common/contacts")
expect_fault(common/live/a.cc "${licence}#include \"common/label/track/used.h\"\n"
             "common/live must not include common/label/track")
expect_fault(plugins/one/a.cc "${licence}#include \"common/contacts/used.h\"\n"
             "plugins must not include common/contacts")
expect_fault(common/judge/a.cc "${licence}#include \"common/pipeline/used.h\"\n"
             "common/judge must not include common/pipeline")
expect_fault(common/pipeline/a.cc "${licence}#include \"MMMConverterS2KF/report/used.h\"\n"
             "common/pipeline must not include MMMConverterS2KF/report")
expect_fault(common/pipeline/a.cc "${licence}#include \"common/live/used.h\"\n"
             "common/pipeline must not include common/live")
expect_fault(common/live/a.cc "${licence}#include \"common/pipeline/used.h\"\n"
             "common/live must not include common/pipeline")
expect_fault(common/pipeline/a.cc "${licence}#include \"common/dynamics/used.h\"\n"
             "common/pipeline must not include common/dynamics")
expect_fault(common/pipeline/dynamics/a.cc "${licence}#include \"common/pipeline/comparison/used.h\"\n"
             "common/pipeline/dynamics must not include common/pipeline/comparison")
expect_fault(MMMConverterS2KF/terminal/a.cc "${licence}#include \"MMMConverterS2KF/used.h\"\n"
             "MMMConverterS2KF/terminal must not include MMMConverterS2KF ")
expect_fault(MMMConverterS2KF/report/a.cc "${licence}#include \"MMMConverterS2KF/terminal/used.h\"\n"
             "MMMConverterS2KF/report must not include MMMConverterS2KF/terminal")
expect_fault(MMMConverterS2KF/python/a.cc "${licence}#include \"MMMConverterS2KF/terminal/used.h\"\n"
             "MMMConverterS2KF/python must not include MMMConverterS2KF/terminal")
expect_fault(MMMConverterS2KF/report/a.cc "${licence}#include \"plugins/one/used.h\"\n"
             "MMMConverterS2KF/report must not include plugins")
expect_fault(MMMConverterS2KF/new/a.cc "${licence}" "its folder is no layer")
expect_fault(common/model/a.cc "${licence}const char kText[] = \"use --height\";\n" "--height: the library does not know")
expect_fault(common/io/a.h "${licence}#include <nlohmann/json_fwd.hpp>\n" "<nlohmann/json_fwd.hpp> belongs in a .cc file")
expect_fault(common/io/a.cc "${licence}  #  include \"used.h\"\n" "\"used.h\" does not start at")
expect_fault(common/io/a.h "${licence}#include <tinyxml2.h>\n" "<tinyxml2.h> belongs in a .cc file")
expect_fault(common/io/a.h "${licence}#include <boost/dll.hpp>\n" "<boost/dll.hpp> belongs in")
expect_fault(common/model/a.cc "${licence}#include <fstream>\n" "files are opened in common/io")
expect_fault(common/io/a.cc "#include <vector>\n" "the first line is not")
expect_fault(common/new/a.cc "${licence}" "its folder is no layer")

write_good_tree()
file(WRITE ${WORK_DIR}/MMMConverterS2KF/terminal/json.h "${licence}#include <nlohmann/json_fwd.hpp>\n")
expect_output("belongs in one header")

# Rooms of three times 350 lines: a folder of a layer with the folders in it, a plugin, a folder of tests.
string(REPEAT "//\n" 349 comment)
foreach(room common/convert plugins/two tests/cli)
  write_good_tree()
  foreach(file a.cc b.cc in/c.cc)
    file(WRITE ${WORK_DIR}/${room}/${file} "${licence}${comment}")
  endforeach()
  expect_output("${room}: a room of 10[0-9][0-9] lines has no README.md")
  file(WRITE ${WORK_DIR}/${room}/README.md "")
  expect_output("")
endforeach()

write_good_tree()
foreach(folder search track learn)
  file(WRITE ${WORK_DIR}/common/label/${folder}/a.cc "${licence}${comment}")
endforeach()
expect_output("common/label: a room of 10[0-9][0-9] lines has no README.md")
