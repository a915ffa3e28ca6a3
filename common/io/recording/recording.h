// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/math/up_axis.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/recording_content.h"
#include "common/support/error.h"
#include "common/support/warnings.h"

namespace mmm_converter {

struct ReadRecordingOptions {
  std::optional<std::string> unit = {};  ///< overrides the file's: "mm", "cm", "m", "in"
  std::optional<UpAxis> up_axis = {};    ///< overrides the file's and the decision from the markers
  std::optional<double> rate = {};       ///< [Hz] overrides the file's
  bool ignore_residuals = false;         ///< C3D: also use points that are marked invalid
  bool with_unlabelled = false;          ///< also points without a label, as `*` and a number
  /// Label prefix to keep where a file has several subjects; "": labels without.
  std::optional<std::string> subject = {};
  bool all_subjects = false;    ///< keep those of all, with their prefixes: Subject:LABEL
  std::string motion = {};      ///< MMM: motion to read; empty: that with most markers
  std::string smpl_model = {};  ///< SMPL: the file of the body model; empty: none
};

/// Why something may be read wrong, and what else could be said of it.
struct ReadingDoubt {
  std::string text;
  Remedy remedy = Remedy::kNone;
};

/// An optical recording as a file has it, brought to metres and z up.
struct Recording {
  std::string file;
  std::string format;             ///< "C3D", "TRC", "MMM 1.0", "MMM 2.0"
  MarkerSequence markers;         ///< p_WM [m], W: z up; labels trimmed and without subject prefix
  std::vector<int> points;        ///< of each marker, among those that the file lists
  std::string unit;               ///< what coordinates were read as
  bool unit_was_guessed = false;  ///< the file's unit was absent or implausible
  UpAxis up_axis = UpAxis::kZ;    ///< in the file's own axes
  std::optional<UpAxis> stated_up_axis;  ///< what the file says
  bool up_axis_was_decided = false;      ///< from the markers; else given, stated or assumed
  bool up_axis_is_doubtful = false;      ///< something contradicts it
  std::vector<ReadingDoubt> doubts;      ///< why unit, axis or length may be wrong; warned of too
  std::vector<std::string> subjects;     ///< label prefixes found
  std::string subject;                   ///< the one that was read; empty: no prefix
  long first_frame = 1;                  ///< number of the first stored frame in the capture
  std::string comment;                   ///< C3D files of this project: what they say of themselves
  RecordingOrigin origin;
  std::optional<MmmPart> mmm;       ///< of MMM files only
  std::vector<SkeletonJoint> body;  ///< of skeletons only: which labels are joints of a body
  BodySize stated_size;             ///< of the person, as a C3D file's processing says

  std::string motion() const { return mmm ? mmm->motion : ""; }  ///< empty: not named
  /// As the file says.
  BodySize size() const { return mmm ? mmm->size : stated_size; }
};

/// Reads a recording of any format of RecordingFormats, told from the content, not the name.
/// @throws Error (no such file, empty, not a recording, no whole frame, several subjects or motions
/// and none chosen: the message lists them).
Recording ReadRecording(const std::string& path, const ReadRecordingOptions& options,
                        Warnings* warnings = nullptr);

/// All motions of an MMM motion file, in its order; those without markers have no labels.
/// options.motion does not count. warnings: what there is to say of the file as a whole; what there
/// is to say of a motion stands beside it.
/// @throws Error as ReadRecording, and for a file of another format.
std::vector<WithWarnings<Recording>> ReadAllMotions(const std::string& path,
                                                    const ReadRecordingOptions& options,
                                                    Warnings* warnings);

}  // namespace mmm_converter
