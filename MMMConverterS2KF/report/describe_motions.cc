// SPDX-License-Identifier: MIT
// What is in MMM motions.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/describe.h"
#include "MMMConverterS2KF/report/info_markers.h"
#include "common/io/mmm/mmm_motion.h"

namespace mmm_converter {
namespace {

std::string MotionText(const MmmMotion& motion) {
  const PoseTrajectory& poses = motion.trajectory;
  return fmt::format(
      "\nmotion     {}{}\nmodel      {}\nperson     height {}, mass {}\n"
      "postures   {} at {:.6g} Hz, {} joints\nmarkers    {} in {} frames\n{}",
      motion.name, motion.type.empty() ? "" : " (" + motion.type + ")",
      motion.model_path.empty() ? "none" : motion.model_path,
      motion.size.height ? fmt::format("{:.6g} m", *motion.size.height) : "not stated",
      motion.size.mass ? fmt::format("{:.6g} kg", *motion.size.mass) : "not stated",
      poses.num_frames(), poses.rate, poses.joint_names.size(), motion.markers.num_labels(),
      motion.markers.num_frames(),
      motion.markers.num_labels() > 0 ? FormatMarkers(motion.markers) : "");
}

Json MotionJson(const MmmMotion& motion) {
  const PoseTrajectory& poses = motion.trajectory;
  return {{"name", motion.name},
          {"type", motion.type},
          {"model", motion.model_path},
          {"height_m", motion.size.height ? Json(*motion.size.height) : Json(nullptr)},
          {"mass_kg", motion.size.mass ? Json(*motion.size.mass) : Json(nullptr)},
          {"frames", poses.num_frames()},
          {"rate_hz", poses.rate},
          {"joints", poses.joint_names},
          {"marker_frames", motion.markers.num_frames()},
          {"marker_rate_hz", motion.markers.rate()},
          {"labels", MarkersJson(motion.markers)}};
}

}  // namespace

Description DescribeMotions(const FileStart& file, const ReadRecordingOptions&) {
  Warnings warnings;
  const MmmMotionFile motions = ReadMmmMotionFile(file.path, &warnings);
  std::string text = fmt::format("{}: MMM {} file, {} motion{}\n", file.path, motions.version,
                                 motions.motions.size(), motions.motions.size() == 1 ? "" : "s");
  Json json = {
      {"kind", "motion"},     {"file", file.path},        {"format", "MMM " + motions.version},
      {"name", motions.name}, {"motions", Json::array()}, {"warnings", warnings.texts()}};
  for (const MmmMotion& motion : motions.motions) {
    text += MotionText(motion);
    json["motions"].push_back(MotionJson(motion));
  }
  return {text, FormatJson(json), warnings};
}

}  // namespace mmm_converter
