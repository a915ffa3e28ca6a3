// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/report/info_markers.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "MMMConverterS2KF/terminal/version.h"
#include "common/convert/converter_config.h"
#include "common/convert/plugin_loader.h"
#include "common/io/bytes/file_content.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/model_file.h"
#include "common/io/recording/recording.h"
#include "common/io/xml/xml_document.h"
#include "common/io/xml/xml_text.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

const std::vector<OptionGroup> kOptions = {
    {"Options",
     {{"json", "", "machine-readable", ""},
      {"subject", "NAME", "label prefix of the subject, if a recording has several", ""},
      {"unit", "mm|cm|m|in", "overrides the unit that the file states", ""},
      {"up", "AXIS", "the recording's axis that points up: x, y, z, -x, -y or -z", ""},
      {"log", "LEVEL", "off, error, warning, info or debug; default: info", ""},
      {"version", "", "print this program's version", ""},
      {"help,h", "", "print this help", ""}}}};

constexpr const char* kUsage = R"(MMMConverterS2KF info FILE [--json]
What is in a recording (C3D, TRC), an MMM motion, a model, a configuration or a plugin.

{}Examples
  MMMConverterS2KF info walk.c3d
  MMMConverterS2KF info xml_config/models/mmm.xml --json
  MMMConverterS2KF info lib/MMMConverterS2KF/plugins/s2kf.so
)";

// What a file is, as text and as JSON.
struct Description {
  std::string text;
  std::string json;
};

Description DescribeRecording(const std::string& file, const Arguments& arguments) {
  ReadRecordingOptions options;
  options.subject = arguments.Get("subject").value_or("");
  options.unit = arguments.Get("unit");
  if (const auto axis = arguments.Get("up")) options.up_axis = ParseUpAxis(*axis);
  Warnings warnings;
  const Recording recording = ReadRecording(file, options, &warnings);
  LogWarnings(warnings);
  const MarkerSequence& markers = recording.markers;
  Description description;
  description.text = fmt::format(
      "{}: {} recording\nframes     {} at {:.6g} Hz ({:.3f} s), the first is number {}\n"
      "unit       {}{}\nup         {}{}\nsubjects   {}\nlabels     {}\n{}",
      file, recording.format, markers.num_frames(), markers.rate(),
      markers.num_frames() / markers.rate(), recording.first_frame, recording.unit,
      recording.unit_was_guessed ? " (guessed)" : "", Name(recording.up_axis),
      recording.up_axis_was_decided ? " (decided from the markers)" : "",
      recording.subjects.empty() ? "not named" : JoinNames(recording.subjects, ", "),
      markers.num_labels(), FormatMarkers(markers));
  Json json = {{"kind", "recording"},
               {"file", file},
               {"format", recording.format},
               {"frames", markers.num_frames()},
               {"rate_hz", markers.rate()},
               {"first_frame", recording.first_frame},
               {"unit", recording.unit},
               {"unit_guessed", recording.unit_was_guessed},
               {"up_axis", Name(recording.up_axis)},
               {"up_axis_decided_from_markers", recording.up_axis_was_decided},
               {"subjects", recording.subjects},
               {"subject", recording.subject},
               {"labels", ToJson(markers)},
               {"warnings", warnings.texts()}};
  description.json = FormatJson(json);
  return description;
}

Description DescribeMotions(const std::string& file) {
  Warnings warnings;
  const MmmMotionFile motions = ReadMmmMotionFile(file, &warnings);
  LogWarnings(warnings);
  Description description;
  description.text = fmt::format("{}: MMM {} file, {} motion{}\n", file, motions.version,
                                 motions.motions.size(), motions.motions.size() == 1 ? "" : "s");
  Json json = {{"kind", "motion"},
               {"file", file},
               {"format", "MMM " + motions.version},
               {"name", motions.name},
               {"motions", Json::array()},
               {"warnings", warnings.texts()}};
  for (const MmmMotion& motion : motions.motions) {
    const PoseTrajectory& poses = motion.trajectory;
    description.text += fmt::format(
        "\nmotion     {}{}\nmodel      {}\nperson     height {}, mass {}\n"
        "postures   {} at {:.6g} Hz, {} joints\nmarkers    {} in {} frames\n{}",
        motion.name, motion.type.empty() ? "" : " (" + motion.type + ")",
        motion.model_path.empty() ? "none" : motion.model_path,
        motion.size.height ? fmt::format("{:.6g} m", *motion.size.height) : "not stated",
        motion.size.mass ? fmt::format("{:.6g} kg", *motion.size.mass) : "not stated",
        poses.num_frames(), poses.rate, poses.joint_names.size(), motion.markers.num_labels(),
        motion.markers.num_frames(),
        motion.markers.num_labels() > 0 ? FormatMarkers(motion.markers) : "");
    Json entry = {{"name", motion.name},
                  {"type", motion.type},
                  {"model", motion.model_path},
                  {"height_m", motion.size.height ? Json(*motion.size.height) : Json(nullptr)},
                  {"mass_kg", motion.size.mass ? Json(*motion.size.mass) : Json(nullptr)},
                  {"frames", poses.num_frames()},
                  {"rate_hz", poses.rate},
                  {"joints", poses.joint_names},
                  {"marker_frames", motion.markers.num_frames()},
                  {"marker_rate_hz", motion.markers.rate()},
                  {"labels", ToJson(motion.markers)}};
    json["motions"].push_back(entry);
  }
  description.json = FormatJson(json);
  return description;
}

Description DescribeModel(const std::string& file) {
  Warnings warnings;
  const LoadedModel parsed = ReadModelFile(file, &warnings);
  LogWarnings(warnings);
  const KinematicModel& model = parsed.model;
  Description description;
  description.text = fmt::format(
      "{}: model {}\nsegments   {}\nmass       {:.6g} kg\nnode sets  {}\njoints     {}\n", file,
      model.name(), model.segments().size(), model.total_mass(), model.node_sets().size(),
      model.num_joints());
  Json json = {{"kind", "model"},
               {"file", file},
               {"name", model.name()},
               {"segments", model.segments().size()},
               {"mass_kg", model.total_mass()},
               {"joints", Json::array()},
               {"markers", Json::array()},
               {"node_sets", Json::array()},
               {"warnings", warnings.texts()}};
  for (int j = 0; j < model.num_joints(); ++j) {
    const Segment& joint = model.joint(j);
    description.text += IsEndless(joint) ? fmt::format("  {:<24} without limits\n", joint.name)
                                         : fmt::format("  {:<24} {:9.6f} to {:9.6f} rad\n",
                                                       joint.name, joint.lower, joint.upper);
    json["joints"].push_back(
        {{"name", joint.name}, {"lower_rad", joint.lower}, {"upper_rad", joint.upper}});
  }
  description.text += fmt::format("markers    {}\n", model.markers().size());
  for (const ModelMarker& marker : model.markers()) {
    const std::string& segment = model.segments()[marker.segment].name;
    description.text +=
        fmt::format("  {:<14} on {:<24} at {:7.4f} {:7.4f} {:7.4f} m\n", marker.name, segment,
                    marker.p_SM.x(), marker.p_SM.y(), marker.p_SM.z());
    json["markers"].push_back({{"name", marker.name},
                               {"segment", segment},
                               {"offset_m", {marker.p_SM.x(), marker.p_SM.y(), marker.p_SM.z()}}});
  }
  for (const auto& [name, unused] : model.node_sets()) {
    json["node_sets"].push_back(name);
  }
  description.json = FormatJson(json);
  return description;
}

Description DescribeConfig(const std::string& file) {
  Warnings warnings;
  const ConverterConfig config = ReadConverterConfig(file, &warnings);
  LogWarnings(warnings);
  std::vector<std::string> elements;
  for (const XmlElement& element : config.plugin_elements) elements.push_back(element.name);
  const std::string mapping = config.marker_pairs.empty()
                                  ? "set " + config.marker_set
                                  : fmt::format("{} pairs", config.marker_pairs.size());
  const std::string joints =
      config.joints.empty() ? "set " + config.joint_set : std::to_string(config.joints.size());
  return {fmt::format("{}: configuration for {}\nmapping    {}\njoints     {}\nsettings   {}\n",
                      file, config.type.empty() ? "another converter" : config.type, mapping,
                      joints, JoinNames(elements, ", ")),
          FormatJson({{"kind", "configuration"},
                      {"file", file},
                      {"converter", config.type},
                      {"marker_mapping", mapping},
                      {"joints", joints},
                      {"elements", elements},
                      {"warnings", warnings.texts()}})};
}

Description DescribePlugin(const std::string& file) {
  const LoadedPlugin plugin(file);
  const MotionConverterFactory& factory = plugin.factory();
  return {fmt::format("{}: converter plugin\nname       {}\nversion    {}\nwhat       {}\n", file,
                      factory.name(), plugin.version(), factory.description()),
          FormatJson({{"kind", "plugin"},
                      {"file", file},
                      {"name", factory.name()},
                      {"version", plugin.version()},
                      {"description", factory.description()}})};
}

// The kind is told from the content.
Description Describe(const std::string& file, const Arguments& arguments) {
  constexpr std::size_t kHeadBytes = 1 << 20;
  const std::string head = ReadFileStart(file, kHeadBytes);
  if (head.starts_with("\x7f"
                       "ELF") ||
      std::filesystem::path(file).extension() == ".so") {
    return DescribePlugin(file);
  }
  if (!Trim(std::string_view(head).substr(0, 256)).starts_with("<")) {
    return DescribeRecording(file, arguments);
  }
  const std::string_view root = RootName(head);
  if (EqualIgnoringCase(root, "MMM")) return DescribeMotions(file);
  if (EqualIgnoringCase(root, "Robot")) return DescribeModel(file);
  if (EqualIgnoringCase(root, "ConverterConfig")) return DescribeConfig(file);
  throw Error(fmt::format(
      "{}:{}: is an XML file of <{}>; expected <MMM> (motion), <Robot> (model, URDF) or "
      "<ConverterConfig>",
      file, ReadXmlFile(file).line, root));
}

}  // namespace

int RunInfo(const std::vector<std::string>& words) {
  const Arguments arguments = ParseArguments("info", kOptions, words);
  if (arguments.Has("help")) {
    std::cout << fmt::format(kUsage, FormatOptions(kOptions));
    return 0;
  }
  if (arguments.Has("version")) {
    std::cout << VersionText();
    return 0;
  }
  if (!arguments.positional()) {
    throw UsageError("info: which file? For instance: MMMConverterS2KF info walk.c3d");
  }
  StartLog(arguments.Get("log").value_or("info"));
  const Description description = Describe(*arguments.positional(), arguments);
  std::cout << (arguments.Has("json") ? description.json : description.text);
  return 0;
}

}  // namespace mmm_converter
