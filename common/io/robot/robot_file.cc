// SPDX-License-Identifier: MIT
#include "common/io/robot/robot_file.h"

#include <fmt/format.h>

#include "common/io/bytes/file_content.h"
#include "common/io/mjcf/mjcf_robot.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/urdf/urdf_model_reader.h"
#include "common/io/urdf/urdf_robot.h"
#include "common/io/xml/xml_text.h"
#include "common/support/error.h"

namespace mmm_converter {

Robot ReadRobotFile(const std::string& path, Warnings* warnings) {
  const std::string content = ReadFileContent(path, kMaxModelBytes);
  if (IsMjcf(content)) return ReadMjcf(path, warnings);
  if (IsUrdf(content)) return ParseUrdfRobot(content, path, warnings);
  throw Error(
      fmt::format("{}: is neither a URDF (<robot> of <link>) nor an MJCF (<mujoco>)", path));
}

}  // namespace mmm_converter
