// SPDX-License-Identifier: MIT
#include "common/io/mmm/mmm_content.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <utility>

#include "common/io/mmm/mmm_motion.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

std::ptrdiff_t ChooseMotion(const MmmMotionFile& mmm, const std::string& wanted,
                            const std::string& file) {
  std::vector<std::string> names;
  for (const MmmMotion& motion : mmm.motions) {
    names.push_back(fmt::format("{} ({} markers)", motion.name, motion.markers.num_labels()));
  }
  const std::string list = fmt::format("{}", fmt::join(names, ", "));
  if (!wanted.empty()) {
    const MmmMotion* motion = mmm.Find(wanted);
    if (motion == nullptr) {
      throw Error(fmt::format("{}: there is no motion {}; the file has: {}", file, wanted, list));
    }
    if (motion->markers.num_labels() == 0) {
      throw Error(
          fmt::format("{}: motion {} carries no markers (MoCapMarker sensor); the file has: {}",
                      file, wanted, list));
    }
    return motion - mmm.motions.data();
  }
  const MmmMotion* most = nullptr;
  bool unclear = false;
  for (const MmmMotion& motion : mmm.motions) {
    const int count = motion.markers.num_labels();
    if (most != nullptr && count < most->markers.num_labels()) continue;
    unclear = most != nullptr && count == most->markers.num_labels();
    most = &motion;
  }
  if (most == nullptr || most->markers.num_labels() == 0) {
    throw Error(fmt::format("{}: no motion carries markers (MoCapMarker sensor); the file has: {}",
                            file, list));
  }
  if (unclear) {
    throw Error(fmt::format("{}: there are several motions: {}; choose one of them", file, list),
                Remedy::kMotion);
  }
  return most - mmm.motions.data();
}

/// Takes the markers out of the motion.
RecordingContent TakeMotion(const MmmMotionFile& mmm, MmmMotion* motion) {
  RecordingContent content;
  content.format = "MMM " + mmm.version;
  content.labels = motion->markers.labels();
  content.is_settled = true;
  content.unit = "mm";
  content.rate = motion->markers.rate();
  content.mmm = MmmPart{
      motion->name, static_cast<int>(mmm.motions.size()),
      motion->size.height || !motion->trajectory.joint_names.empty() || motion->type == "mmm",
      motion->size, motion->model_path};
  const auto markers = std::make_shared<MarkerSequence>(std::move(motion->markers));
  content.read = [markers](const std::vector<int>& /*points*/,
                           const std::vector<std::string>& /*labels*/,
                           double /*rate*/) { return std::move(*markers); };
  return content;
}

}  // namespace

RecordingContent ReadMmmContent(const std::string& file, const ContentOptions& options,
                                Warnings* warnings) {
  MmmMotionFile mmm = ReadMmmMotionFile(file, warnings);
  return TakeMotion(mmm, &mmm.motions[ChooseMotion(mmm, options.motion, file)]);
}

std::vector<RecordingContent> ReadAllMmmContents(const std::string& file, Warnings* warnings) {
  MmmMotionFile mmm = ReadMmmMotionFile(file, warnings);
  std::vector<RecordingContent> contents;
  contents.reserve(mmm.motions.size());
  for (MmmMotion& motion : mmm.motions) contents.push_back(TakeMotion(mmm, &motion));
  return contents;
}

}  // namespace mmm_converter
