// SPDX-License-Identifier: MIT
#include "common/pipeline/input/osim_setup.h"

#include <fmt/format.h>

#include <filesystem>

#include "common/io/bytes/file_content.h"
#include "common/io/osim/ik_tasks.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_xml.h"
#include "common/io/osim/tool_setup.h"
#include "common/support/error.h"
#include "common/support/folder.h"
#include "common/support/text.h"

namespace mmm_converter {

void FillFromOsimSetup(const std::string& setup_file, InputRequest* request, Warnings* warnings) {
  const OsimToolSetup setup =
      ParseOsimToolSetup(ReadFileContent(setup_file, kMaxOsimBytes), setup_file);
  request->setup_file = setup_file;
  const auto fill = [&](const std::string& named, const char* what, std::string* to) {
    if (to->empty() && !named.empty()) {
      *to = FindFileOfSetup(setup_file, named, what, warnings);
    }
  };
  fill(setup.marker_file, "recording", &request->file);
  if (request->file.empty()) {
    const std::string of_motion =
        setup.coordinates_file.empty()
            ? ""
            : fmt::format(", but the motion {}, which is converted already",
                          setup.coordinates_file);
    throw Error(fmt::format("{}: <{}> names no recording of markers{}; name it, too", setup_file,
                            setup.tool, of_motion));
  }
  fill(setup.model_file, "model", &request->model_file);
  if (request->model_file.empty()) {
    throw Error(fmt::format("{}: <{}> names no model; give it", setup_file, setup.tool),
                Remedy::kModel);
  }
  fill(setup.marker_set_file, "marker set", &request->marker_file);
  fill(setup.loads_file, "external loads", &request->forces_file);
  if (request->marker_set.empty() && setup.has_tasks) request->marker_set = setup_file;
  fill(setup.tasks_file, "task set", &request->marker_set);
  if (!request->first_frame && !request->end_frame) request->time_range = setup.time_range;
  if (setup.tool == "ScaleTool") {
    Warn(warnings, fmt::format("{} is a ScaleTool's: its model is of nobody, and the recording is "
                               "converted with it as it is; calibrate makes the person's of it",
                               setup_file));
  }
}

std::string FileWithTasks(const std::string& file) {
  try {
    const std::string content = ReadFileContent(file, kMaxOsimBytes);
    if (!IsOsimToolSetup(content)) return file;
    const OsimToolSetup setup = ParseOsimToolSetup(content, file);
    return setup.tasks_file.empty() ? file
                                    : FindFileOfSetup(file, setup.tasks_file, "task set", nullptr);
  } catch (const Error&) {
    return file;
  }
}

std::string FindWeightsBeside(const std::string& model_file, const KinematicModel& model) {
  constexpr std::size_t kHeadBytes = 1 << 16, kMostFiles = 100, kFewestKnown = 3;
  const std::filesystem::path folder = std::filesystem::path(model_file).parent_path();
  std::vector<std::string> files = FilesIn(folder.empty() ? "." : folder.string(), ".xml");
  if (files.size() > kMostFiles) files.resize(kMostFiles);
  std::string best;
  std::size_t most = 0;
  for (const std::string& file : files) {
    try {
      if (!IsOsimPart(ReadFileStart(file, kHeadBytes), "IKTaskSet")) continue;
      const std::string content = ReadFileContent(file, kMaxOsimBytes);
      const bool is_setup = IsOsimToolSetup(content);
      // A ScaleTool's weights are those of a standing person.
      if (is_setup && ParseOsimToolSetup(content, file).tool != "InverseKinematicsTool") continue;
      const IkTasks tasks = ParseIkTasks(content, file);
      std::size_t known = 0;
      bool is_equal = true;
      for (const IkTasks::OfMarker& task : tasks.markers) {
        known += model.FindMarker(task.name) >= 0 ? 1 : 0;
        is_equal &= task.weight == tasks.markers.front().weight;
      }
      // Of two that know as many markers, that which is not called after scaling.
      const bool is_of_scaling =
          ToLower(std::filesystem::path(file).filename().string()).find("scal") !=
          std::string::npos;
      const std::size_t rank = 2 * known + (is_of_scaling ? 0 : 1);
      if (is_equal || known < kFewestKnown || rank <= most) continue;
      most = rank;
      best = file;
    } catch (const Error&) {
      continue;  // whoever names it will be told
    }
  }
  return best;
}

}  // namespace mmm_converter
