// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/bytes/file_content.h"
#include "common/model/body_size.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"
#include "common/support/text_pieces.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// One `<Motion>` of an MMM file. Frames follow an even time grid at the file's median step: a
/// repeated timestamp counts once, missing frames have NaN markers and interpolated postures.
struct MmmMotion {
  std::string name;
  std::string type;        ///< "mmm", "object"; empty: not stated
  std::string model_path;  ///< as the file names it; empty: none
  BodySize size;           ///< from ModelProcessorConfig
  /// ModelPose and all Kinematic sensors (1.0: the frames), on ModelPose's time grid; joint angles
  /// outside of their sensor's time are NaN; no frames where the motion has neither sensor.
  PoseTrajectory trajectory;
  /// All MoCapMarker sensors, labelled markers only, labels sorted; may be empty.
  MarkerSequence markers;
  Eigen::Matrix3Xd
      center_of_mass;  ///< [m] per frame of the trajectory as stored; 1.0 only, may be empty
};

struct MmmMotionFile {
  std::string version;  ///< "1.0" or "2.0"
  std::string name;     ///< of the recording; 2.0 only, may be empty
  std::vector<MmmMotion> motions;

  const MmmMotion* Find(std::string_view motion_name) const;  ///< the first; nullptr: none
};

/// True if XML text that starts like this can be an MMM motion file (its root is `<MMM>`).
bool LooksLikeMmmMotion(std::string_view content);

/// `file` is only named in messages.
/// @throws Error with all problems as `file:line: ...`: not XML, no `<MMM>`, a malformed number, a
/// time that runs
///         backwards, a duplicate joint or marker, gaps that would blow up memory.
MmmMotionFile ParseMmmMotionFile(std::string_view content, const std::string& file,
                                 Warnings* warnings = nullptr);

/// @throws Error as ReadFileContent and ParseMmmMotionFile.
MmmMotionFile ReadMmmMotionFile(const std::string& path, Warnings* warnings = nullptr,
                                std::size_t max_bytes = kMaxFileBytes);

/// What is written as one `<Motion>`. Lengths are written in mm with 4 decimals, angles in rad with
/// 8, times in s with 9, without trailing zeros; reading that back and writing it again gives the
/// same bytes.
struct MmmMotionOutput {
  std::string recording_name;  ///< 2.0: MMM's name attribute; empty: none
  std::string motion_name;
  std::string model_path;             ///< see ModelPathFor
  double height = 0;                  ///< [m]; 0: the model is not scaled
  double mass = 0;                    ///< [kg]
  std::optional<double> hand_length;  ///< [m]
  std::string comment;                ///< stands in the model's element; empty: none
  /// 1.0 has fields for velocities and accelerations of joints, 0 where the trajectory has none, as
  /// in real files; 2.0 has none. Null, in 2.0 only: nothing but markers is written or replaced.
  const PoseTrajectory* trajectory = nullptr;
  const MarkerSequence* markers =
      nullptr;  ///< 2.0: MoCapMarker; unseen markers are left out of their frame
};

/// The text of a whole file with one motion, in 2.0 also those of objects beside it; 1.0 must have
/// a trajectory. Trajectories and markers must outlive it.
/// @throws Error where a posture is not finite.
TextPieces FormatMmmMotion2(const MmmMotionOutput& output,
                            const std::vector<MmmMotionOutput>& objects = {});
TextPieces FormatMmmMotion1(const MmmMotionOutput& output);

/// The MMM 2.0 file `content` with the motions called motion_name of each output converted: Model
/// and ModelProcessorConfig, the ModelPose sensors and those Kinematic sensors that have one of the
/// converted joints are replaced, where there is a trajectory; the MoCapMarker sensors if `markers`
/// is given. Every other byte stays: other motions, other sensors, annotations, comments. `file` is
/// only named in messages. Trajectories and markers must outlive the text.
/// @throws Error where `content` is not an MMM 2.0 file or has not exactly one motion of such a
/// name, or a posture is not finite.
TextPieces WithConvertedMotions(const ByteSource& content, const std::string& file,
                                const std::vector<MmmMotionOutput>& outputs);

/// The path to write for a model: relative to the output file's folder, with forward slashes;
/// absolute where there is no relative one. Neither file needs to exist. A relative argument counts
/// from the working directory.
std::string ModelPathFor(const std::string& model_file, const std::string& output_file);

}  // namespace mmm_converter
