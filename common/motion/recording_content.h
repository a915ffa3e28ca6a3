// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/math/up_axis.h"
#include "common/model/body_size.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/skeleton.h"

namespace mmm_converter {

/// What only MMM motion files say of a recording.
struct MmmPart {
  std::string motion;         ///< name of the motion that was read
  int num_motions = 1;        ///< in the file
  bool is_of_person = false;  ///< it states a height, joints, or the type "mmm"
  BodySize size;
  std::string model_path;  ///< the model as the file names it; empty: none
};

/// What a file says of its making, as UTF-8; empty: it does not say.
struct RecordingOrigin {
  std::string subject;  ///< name or number of who was recorded
  std::string date;     ///< as the file has it; of numbers year-month-day
  std::string system;   ///< company and program that recorded it
};

/// What a user says of how a file is to be read, as far as the format is concerned.
struct ContentOptions {
  bool ignore_residuals = false;            ///< C3D: also use points that are marked invalid
  std::string motion = {};                  ///< MMM: motion to read; empty: that with most markers
  std::string smpl_model = {};              ///< SMPL: the file of the body model; empty: none
  std::optional<std::string> subject = {};  ///< of skeletons: whose is read
  bool all_subjects = false;                ///< of skeletons: any
};

/// What a file of any format holds, in the file's own unit and axes: nothing is chosen or decided
/// yet. Readers of all formats return it; ReadRecording makes a Recording of it.
struct RecordingContent {
  std::string format;                                ///< "C3D", "TRC", "MMM 1.0", "MMM 2.0"
  std::vector<std::string> labels;                   ///< of all points
  std::vector<std::string> outputs, label_prefixes;  ///< what the file says of them: SelectLabels
  /// The points of the file are labelled markers in `unit`, and z is up: there is nothing to choose
  /// or to decide. `read` then gives metres.
  bool is_settled = false;
  bool marks_points_valid = false;  ///< C3D
  std::string unit;                 ///< as the file says it; may be empty or nonsense
  std::string stated_up;            ///< the axis that points up, as the file says it; may be empty
  std::vector<UpAxis> usual_up_axes;  ///< in files of the format
  double rate = 0;                    ///< [Hz]; 0: the file does not say
  long first_frame = 1;               ///< number of the first stored frame in the capture
  long declared_frames = 0;           ///< that the file says it holds; 0: it does not say
  std::string comment;                ///< what the file says of itself
  RecordingOrigin origin;
  std::optional<MmmPart> mmm;
  /// Of a skeleton that is a body's: which labels are its joints; the length of its legs has told
  /// the unit. Else none.
  std::vector<SkeletonJoint> body;
  double metres = 0;                 ///< of a body: length of the unit
  std::vector<std::string> persons;  ///< whose skeletons there are, where there are several
  std::string person;                ///< of them who was read
  std::string doubt;                 ///< of it; empty: none
  std::string doubt_of_names;        ///< of a skeleton's joints; empty: none
  BodySize stated_size;              ///< of the person, as the file says
  /// The chosen points (indices into labels) under new labels, with this rate [Hz]; missing: NaN.
  /// To be called once.
  std::function<MarkerSequence(const std::vector<int>& points,
                               const std::vector<std::string>& labels, double rate)>
      read;
};

}  // namespace mmm_converter
