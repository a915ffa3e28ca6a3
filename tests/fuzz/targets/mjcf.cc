// SPDX-License-Identifier: MIT
#include "common/io/mjcf/mjcf_robot.h"
#include "common/model/forward_kinematics.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

/// Includes are found: each is the model itself under another name.
void ReadMjcfBytes(std::string_view bytes) {
  Warnings warnings;
  const auto read_part = [bytes](const std::string& name) {
    return name.size() > 64 ? std::nullopt : std::make_optional(std::string(bytes));
  };
  const Robot robot = ParseMjcf(bytes, kInputName, read_part, &warnings);
  const auto X_WS = SegmentPoses(robot.model, ZeroPosture(robot.model));
  const auto is_segment = [&](int segment) {
    return segment >= 0 && static_cast<std::size_t>(segment) < X_WS.size();
  };
  for (const Robot::Link& link : robot.links) {
    Require(is_segment(link.segment), "the segment of a body");
  }
  for (const ContactShape& shape : robot.shapes) {
    Require(is_segment(shape.segment), "the segment of a shape");
    const double z = LowestHeight(shape, X_WS[static_cast<std::size_t>(shape.segment)]);
    Require(z == z, "a lowest point");
  }
  for (std::size_t i = 0; i < X_WS.size(); ++i) {
    FindSole(robot, static_cast<int>(i), {}, nullptr);
  }
}

}  // namespace mmm_converter::testing
