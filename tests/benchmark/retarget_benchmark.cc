// SPDX-License-Identifier: MIT
// Figures of robots' motions, a line for each robot and motion, and the time of a frame:
//   retarget_benchmark ROBOT... -- MOTION...
//   retarget_benchmark live ROBOT... -- MOTION...   (frame by frame, as a stream's)
// Motions are finished ones (MMM); recordings are converted first, by convert.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "common/io/robot/robot_file.h"
#include "common/pipeline/dynamics/checked_motion.h"
#include "common/retarget/guarded_follower.h"
#include "common/retarget/retarget_figures.h"

namespace mmm_converter {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

void PrintLine(const std::string& robot_file, const CheckedMotion& motion, bool is_live) {
  const Robot robot = ReadRobotFile(robot_file);
  const RobotBody body = FindRobotBody(robot, {}, {});
  const std::clock_t begin = std::clock();  // of the processor: others may use it, too
  const Retargeted made = is_live ? FollowMotion(motion.model, motion.trajectory, robot, body)
                                  : RetargetMotion(motion.model, motion.trajectory, robot, body);
  const double time = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const RetargetFigures of = MeasureRetargeting(made, robot, body);
  fmt::print(
      "{:<12.12} {:<24.24} {:5} {:5.1f} {:5.1f} {:6.2f} {:6.2f} {:4} {:4} {:6.1f} {:7.0f} "
      "{:5.2f} {:5.1f} {:5.1f} {:6.3f} {:5.2f} {:5.1f} {:5.1f}{}\n",
      robot.model.name(), std::filesystem::path(motion.file).stem().string(), of.num_frames,
      100 * of.slide, 100 * of.toe_slide, 1e3 * of.penetration, 1e3 * of.floating,
      of.position_breaks, of.velocity_breaks, of.acceleration, of.jerk, of.largest_jump,
      of.direction * kDegrees, of.direction95 * kDegrees, of.path, 1e3 * time / of.num_frames,
      1e3 * of.body_depth, of.touches.empty() ? 0 : 1e3 * of.touches.front().depth,
      of.is_mirrored || of.is_backwards ? " WRONG SIDES" : "");
}

void Run(std::vector<std::string> robots, const std::vector<std::string>& motions) {
  fmt::print(
      "robot        motion                      n slide   toe  below floats  pos  vel    acc  "
      "  jerk  jump   dir   p95   path    ms  body touch\n");
  const bool is_live = !robots.empty() && robots.front() == "live";
  if (is_live) robots.erase(robots.begin());
  for (const std::string& file : motions) {
    InputRequest request;
    request.file = file;
    const CheckedMotion motion = ReadCheckedMotion(request);
    for (const std::string& robot : robots) PrintLine(robot, motion, is_live);
  }
}

}  // namespace
}  // namespace mmm_converter

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto dashes = std::find(words.begin(), words.end(), "--");
  if (dashes == words.end()) {
    std::fputs("retarget_benchmark ROBOT... -- MOTION...\n", stderr);
    return 2;
  }
  try {
    mmm_converter::Run({words.begin(), dashes}, {dashes + 1, words.end()});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
