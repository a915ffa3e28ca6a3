// SPDX-License-Identifier: MIT
#include "common/io/recording/recording.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "common/io/bytes/file_content.h"
#include "common/io/c3d/c3d_reader.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/marker_labels.h"
#include "common/io/recording/recording_axes.h"
#include "common/io/tables/trc_reader.h"
#include "common/io/xml/xml_text.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMostBytesBeforeTheRoot = 1 << 20;
constexpr const char* kAxisNames[] = {"+x", "+y", "+z", "-x", "-y", "-z"};

bool IsText(std::string_view start) {
  return std::all_of(start.begin(), start.end(), [](char c) {
    return static_cast<unsigned char>(c) >= 0x20 || c == '\t' || c == '\n' || c == '\r' ||
           c == '\f';
  });
}

bool SeesAnything(const MarkerSequence& markers) {
  for (int k = 0; k < markers.num_frames(); ++k) {
    if (!markers.frame(k).array().isNaN().all()) return true;
  }
  return false;
}

/// Takes the labels over and throws if none is left.
void TakeSelection(const LabelSelection& selection, Recording* recording) {
  recording->subjects = selection.subjects;
  recording->subject = selection.subject;
  if (selection.labels.empty()) {
    throw Error(fmt::format("{}: there are no labelled markers", recording->file));
  }
}

/// From file units and axes to metres and z up.
void BringToMetresAndZUp(const std::string& said_unit, const ReadRecordingOptions& options,
                         Recording* recording, Warnings* warnings) {
  const UnitDecision unit =
      options.unit ? ParseUnit(*options.unit) : DecideUnit(recording->markers, said_unit);
  recording->unit = unit.unit;
  recording->unit_was_guessed = unit.guessed;
  if (!unit.warning.empty()) Warn(warnings, unit.warning);
  if (options.up_axis) {
    recording->up_axis = *options.up_axis;
  } else {
    const UpAxisDecision up = DecideUpAxis(recording->markers);
    recording->up_axis = up.axis;
    recording->up_axis_was_decided = up.decided;
    if (!up.warning.empty()) Warn(warnings, up.warning);
  }
  ToMetresAndZUp(unit.metres, recording->up_axis, &recording->markers);
}

void ReadC3d(const ReadRecordingOptions& options, Recording* recording, Warnings* warnings) {
  C3dReader reader(recording->file, warnings);
  const C3dInfo& info = reader.info();
  recording->format = "C3D";
  recording->first_frame = info.layout.first_frame;
  recording->comment = info.comment;
  const double rate = options.rate.value_or(info.layout.rate);
  if (!(rate > 0)) {
    throw Error(fmt::format("{}: gives no frame rate; give it", recording->file), Remedy::kRate);
  }
  const LabelSelection selection = SelectLabels(info.labels, info.outputs, info.label_prefixes,
                                                options.subject, recording->file, warnings);
  TakeSelection(selection, recording);
  recording->markers =
      reader.ReadPoints(selection.indices, selection.labels, rate, options.ignore_residuals);
  if (!SeesAnything(recording->markers)) {
    throw Error(fmt::format("{}: no marker is marked valid in any frame; if they are good "
                            "nevertheless, ignore the marks",
                            recording->file),
                Remedy::kIgnoreResiduals);
  }
  BringToMetresAndZUp(info.unit, options, recording, warnings);
}

void ReadTrc(std::string_view content, const ReadRecordingOptions& options, Recording* recording,
             Warnings* warnings) {
  const TrcFile trc = ParseTrc(content, recording->file, warnings);
  recording->format = "TRC";
  recording->first_frame = trc.first_frame;
  const LabelSelection selection =
      SelectLabels(trc.markers.labels(), {}, {}, options.subject, recording->file, warnings);
  TakeSelection(selection, recording);
  const double rate = options.rate.value_or(trc.markers.rate());
  recording->markers =
      MarkerSequence(selection.labels, trc.markers.num_frames(), rate, trc.markers.first_time());
  for (int k = 0; k < trc.markers.num_frames(); ++k) {
    recording->markers.frame(k) = trc.markers.frame(k)(Eigen::all, selection.indices);
  }
  if (!SeesAnything(recording->markers)) {
    throw Error(fmt::format("{}: no marker is seen in any frame", recording->file));
  }
  BringToMetresAndZUp(trc.unit, options, recording, warnings);
}

/// Which motion: the one asked for, or the one with most markers.
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
Recording TakeMotion(const MmmMotionFile& mmm, const ReadRecordingOptions& options,
                     const std::string& file, MmmMotion* motion, Warnings* warnings) {
  const WarningContext context(warnings, file, motion->name);
  Recording recording;
  recording.file = file;
  recording.format = "MMM " + mmm.version;
  recording.num_motions = static_cast<int>(mmm.motions.size());
  recording.motion = motion->name;
  recording.is_of_person =
      motion->height || !motion->trajectory.joint_names.empty() || motion->type == "mmm";
  recording.height = motion->height;
  recording.mass = motion->mass;
  recording.hand_length = motion->hand_length;
  recording.model_path = motion->model_path;
  recording.markers = std::move(motion->markers);
  recording.unit = "mm";
  if (options.unit) Warn(warnings, "MMM files are always in mm; the unit given is not used");
  if (options.up_axis) {
    recording.up_axis = *options.up_axis;
    ToMetresAndZUp(1, recording.up_axis, &recording.markers);
  }
  return recording;
}

void ReadMmm(const ReadRecordingOptions& options, Recording* recording, Warnings* warnings) {
  MmmMotionFile mmm = ReadMmmMotionFile(recording->file, warnings);
  MmmMotion* motion = &mmm.motions[ChooseMotion(mmm, options.motion, recording->file)];
  *recording = TakeMotion(mmm, options, recording->file, motion, warnings);
}

void ReadText(std::string_view start, const ReadRecordingOptions& options, Recording* recording,
              Warnings* warnings) {
  const std::string& file = recording->file;
  const bool markup =
      Trim(start.substr(start.starts_with("\xEF\xBB\xBF") ? 3 : 0)).starts_with('<');
  if (markup) {
    const std::string head = ReadFileStart(file, kMostBytesBeforeTheRoot);
    if (LooksLikeMmmMotion(head)) return ReadMmm(options, recording, warnings);
    throw Error(
        fmt::format("{}: is XML or a web page with the root <{}>, not an MMM motion (<MMM>)", file,
                    RootName(head).substr(0, 40)));
  }
  if (start.starts_with("version https://git-lfs")) {
    throw Error(fmt::format(
        "{}: is a Git LFS pointer, not the file itself; fetch that one (git lfs pull)", file));
  }
  if (LooksLikeTrc(start)) return ReadTrc(ReadFileContent(file), options, recording, warnings);
  throw Error(fmt::format("{}: is text, but neither a TRC file nor an MMM motion", file));
}

}  // namespace

const char* Name(UpAxis axis) { return kAxisNames[static_cast<int>(axis)]; }

UpAxis ParseUpAxis(const std::string& text) {
  const std::string name = ToLower(Trim(text));
  for (int i = 0; i < 6; ++i) {
    if (name == kAxisNames[i] || (i < 3 && name == kAxisNames[i] + 1))
      return static_cast<UpAxis>(i);
  }
  throw Error(fmt::format("unknown up axis \"{}\"; use x, y, z, -x, -y or -z", text));
}

Recording ReadRecording(const std::string& path, const ReadRecordingOptions& options,
                        Warnings* warnings) {
  if (options.rate && !(*options.rate > 0)) {
    throw Error(fmt::format("a frame rate of {} Hz; it must be above 0", *options.rate));
  }
  const WarningContext context(warnings, path);
  Recording recording;
  recording.file = path;
  const std::string start = ReadFileStart(path, 4096);
  if (IsText(start)) {
    ReadText(start, options, &recording, warnings);
  } else {
    ReadC3d(options, &recording, warnings);
  }
  return recording;
}

std::vector<WithWarnings<Recording>> ReadAllMotions(const std::string& path,
                                                    const ReadRecordingOptions& options,
                                                    Warnings* warnings) {
  if (!LooksLikeMmmMotion(ReadFileStart(path, kMostBytesBeforeTheRoot))) {
    throw Error(
        fmt::format("{}: is not an MMM motion file; only these have several motions", path));
  }
  MmmMotionFile mmm = ReadMmmMotionFile(path, warnings);
  std::vector<WithWarnings<Recording>> recordings(mmm.motions.size());
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    recordings[i].value = TakeMotion(mmm, options, path, &mmm.motions[i], &recordings[i].warnings);
  }
  return recordings;
}

}  // namespace mmm_converter
