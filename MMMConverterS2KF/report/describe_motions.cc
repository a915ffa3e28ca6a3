// SPDX-License-Identifier: MIT
// What is in MMM motions and in models.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/describe.h"
#include "MMMConverterS2KF/report/info_markers.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/model_file.h"

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

Description DescribeModel(const FileStart& file, const ReadRecordingOptions&) {
  Warnings warnings;
  const LoadedModel loaded = ReadModelFile(file.path, &warnings);
  const KinematicModel& model = loaded.model;
  std::string text = fmt::format(
      "{}: model {}\nsegments   {}\nmass       {:.6g} kg\nnode sets  {}\njoints     {}\n",
      file.path, model.name(), model.segments().size(), model.total_mass(),
      model.node_sets().size(), model.num_joints());
  Json json = {{"kind", "model"},
               {"file", file.path},
               {"name", model.name()},
               {"segments", model.segments().size()},
               {"mass_kg", model.total_mass()},
               {"joints", Json::array()},
               {"markers", Json::array()},
               {"node_sets", Json::array()},
               {"warnings", warnings.texts()}};
  for (int j = 0; j < model.num_joints(); ++j) {
    const Segment& joint = model.joint(j);
    text += HasNoLimits(joint) ? fmt::format("  {:<24} without limits\n", joint.name)
                               : fmt::format("  {:<24} {:9.6f} to {:9.6f} rad\n", joint.name,
                                             joint.lower, joint.upper);
    json["joints"].push_back(
        {{"name", joint.name}, {"lower_rad", joint.lower}, {"upper_rad", joint.upper}});
  }
  text += fmt::format("markers    {}\n", model.markers().size());
  for (const ModelMarker& marker : model.markers()) {
    const std::string& segment = model.segments()[marker.segment].name;
    const Eigen::Vector3d& p = marker.p_SM;
    text += fmt::format("  {:<14} on {:<24} at {:7.4f} {:7.4f} {:7.4f} m\n", marker.name, segment,
                        p.x(), p.y(), p.z());
    json["markers"].push_back(
        {{"name", marker.name}, {"segment", segment}, {"offset_m", {p.x(), p.y(), p.z()}}});
  }
  for (const auto& [name, unused] : model.node_sets()) json["node_sets"].push_back(name);
  return {text, FormatJson(json), warnings};
}

}  // namespace mmm_converter
