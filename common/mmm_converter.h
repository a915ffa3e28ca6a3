// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The front door of the library: all that a program needs which reads recordings, converts them,
/// calibrates persons, or tracks them frame by frame. A complete program, which converts a
/// recording (C3D, TRC, MMM, BVH, ...) of a person 1.80 m tall:
///
///     #include <iostream>
///
///     #include "common/mmm_converter.h"
///
///     int main(int argc, char** argv) try {
///       if (argc != 3) return 2;
///       mmm::Conversion walk = mmm::Convert(argv[1], {{"height", 1.80}});
///       std::cout << "mean marker distance " << 1e3 * walk.mean_distance() << " mm; "
///                 << DescribeVerdict(walk.verdict()) << '\n';
///       walk.Save(argv[2]);
///       return 0;
///     } catch (const mmm::Error& error) {
///       std::cerr << error.what() << '\n';
///       return 1;
///     }
///
/// It is built with
///
///     find_package(MMMConverterS2KF 1.0 REQUIRED)
///     target_link_libraries(walk PRIVATE MMMConverterS2KF::pipeline)
///
/// or by pkg-config MMMConverterS2KF. Lengths are metres, angles radians, times seconds; the world
/// W has z up. A marker that is not seen is NaN in all three coordinates. Matrices have a column
/// for each frame.
///
/// All that goes wrong is an Error (WriteError where the system can't write), whose text says where
/// it is, what was found, what was expected, and what to do. Nothing is then changed: a file is as
/// it was before. What is imperfect and used nevertheless stands in warnings(), and whether a
/// result can be trusted in verdict(), with reasons.
///
/// A copy of one of these objects is the same object. Different ones may be used in different
/// threads.

#include <Eigen/Core>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/judge/verdict.h"
#include "common/model/posture.h"
#include "common/model/subject.h"
#include "common/motion/anatomical_angles.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"
#include "common/support/error.h"

namespace mmm_converter {
struct FinishedCalibration;
struct FinishedConversion;
}  // namespace mmm_converter

namespace mmm {

using mmm_converter::AnatomicalAngle;
using mmm_converter::AnatomicalAngles;
using mmm_converter::Error;
using mmm_converter::MarkerSequence;
using mmm_converter::PoseTrajectory;
using mmm_converter::Posture;
using mmm_converter::Subject;
using mmm_converter::Verdict;
using mmm_converter::WriteError;

/// The value of an option: a switch, a number [SI], a text or file, or several.
class Value {
 public:
  Value(bool is_on);
  Value(int number);
  Value(double number);
  Value(const char* text);
  Value(std::string text);
  Value(std::vector<std::string> texts);

  const std::vector<std::string>& texts() const { return texts_; }

 private:
  std::vector<std::string> texts_;
};

/// What is asked for, by name; what is not has its default. The names are those of the module for
/// Python, and DescribeOptions has all. An unknown name is an Error, as is a value that an option
/// does not have. Those that most programs need:
///   "height"          [m] of the person; else from the files, else estimated from the markers
///   "mass"            [kg]
///   "subject"         file of a calibrated person: Person::Save
///   "self_calibrate"  true: estimate the person from the recording itself first
///   "config"          file, or the name of a shipped one: "s2kf_default" (causal), "s2kf_offline"
///                     (smoothed, with velocities), "jacobian_least_squares"
///   "converter"       another converter, by its name; "plugin": its file
///   "marker_set"      which labels are which markers; else what the labels mean is found out
///   "model"           MMM, URDF or OpenSim's, else the shipped MMM model
///   "frames"          "A:B", frames A to B-1
///   "prefix"          label prefix of one of several persons in a recording
///   "unit", "up"      "mm", "z": instead of what the file says
///   "label"           true: find the names of points that have none
using Options = std::map<std::string, Value>;

/// Whose options.
enum class Task { kRead, kConvert, kCalibrate, kTrack };

/// Of each option of a task what it is, in words.
std::map<std::string, std::string> DescribeOptions(Task task);

/// Is told how far the work is: of a conversion frames, of a calibration recordings read. False
/// ends the work with an Error.
using Progress = std::function<bool(int done, int all)>;

/// A recording as it was read.
class Recording {
 public:
  /// Of markers that a program has [m], z up. name: for messages, and of the motion.
  /// @throws Error where a label is there twice, nothing is, a coordinate is infinite, or the rate
  /// is not one of 1 to 100,000 Hz.
  Recording(MarkerSequence markers, const std::string& name);

  /// The file, or the name.
  const std::string& file() const;
  /// "C3D", "TRC", "MMM 2.0", "BVH", ...
  const std::string& format() const;
  /// Labels, rate [Hz], first time [s], and in each frame p_WM of each label, 3 x labels [m].
  const MarkerSequence& markers() const;
  std::vector<std::string> warnings() const;

 private:
  struct Content;
  friend Recording Read(const std::string& file, const Options& options);
  friend class Requests;
  explicit Recording(std::shared_ptr<const Content> content) : content_(std::move(content)) {}

  std::shared_ptr<const Content> content_;
};

/// Reads a file of any format that the converter knows, told from its content.
/// @throws Error where there is no such file, or it is no recording.
Recording Read(const std::string& file, const Options& options = {});

/// A recording converted into a motion.
class Conversion {
 public:
  /// level: kGood, kCheck or kFailed; reasons: in words and numbers, the gravest first.
  const Verdict& verdict() const;
  std::vector<std::string> warnings() const;

  /// Postures by frame: the root's position [m] and orientation in W, and angles [rad] of the
  /// joints in joint_names; standard_deviations, (6 + joints) x frames: of the root's position [m]
  /// and rotation [rad], then of the joints [rad], NaN where the converter knows none; velocities
  /// and accelerations where the configuration smooths.
  const PoseTrajectory& motion() const;

  /// Angles by the names that clinicians have for them ("knee", "left", "flexion"), angles x frames
  /// [rad], with their standard deviations.
  /// @throws Error where the model has no pelvis and legs.
  AnatomicalAngles anatomical_angles() const;

  /// Labels of the markers that were used.
  std::vector<std::string> markers() const;
  /// How far each of these is from the model's marker, markers x frames [m]; NaN: not seen.
  const Eigen::MatrixXd& distances() const;
  /// Over all that was seen [m].
  double mean_distance() const;

  /// Of the person [m], as it was given, told by a file, or estimated; 0: the model has its own.
  double height() const;
  /// The name of the marker set; empty: the configuration's own list.
  const std::string& marker_set() const;

  /// Writes the motion: MMM XML; of a model of OpenSim ".mot". An MMM 2.0 recording may be replaced
  /// by its own motion, no other file that was read.
  /// @throws Error
  void Save(const std::string& file);

  /// Writes an export, one of DescribeExports: Export("csv", "walk.csv").
  /// @throws Error where there is no such export, or this motion or model does not have what it
  /// needs.
  void Export(const std::string& name, const std::string& file);

 private:
  friend class Requests;
  explicit Conversion(std::shared_ptr<mmm_converter::FinishedConversion> work)
      : work_(std::move(work)) {}

  std::shared_ptr<mmm_converter::FinishedConversion> work_;
};

/// Reads a recording and converts it; writes nothing.
/// @throws Error where it can't be read, nobody is seen in it, or an option says so.
Conversion Convert(const std::string& file, const Options& options = {},
                   const Progress& progress = {});

/// The same of a recording that was read. Options of reading stay as they were given to Read.
Conversion Convert(const Recording& recording, const Options& options = {},
                   const Progress& progress = {});

/// Of each export what it writes, in words.
std::map<std::string, std::string> DescribeExports();

/// A calibrated person: lengths of segments and places of markers on the body.
class Person {
 public:
  /// As of a conversion.
  const Verdict& verdict() const;
  std::vector<std::string> warnings() const;

  /// Height [m], mass [kg], and with their deviations scales of segments, relative to the model
  /// scaled by the height, and offsets of markers [m].
  const Subject& subject() const;
  /// Of the markers, on average, from the calibrated model in its best postures [m], and from the
  /// one that is scaled by the height alone.
  double mean_distance() const;
  double mean_distance_before() const;

  /// Writes what the option "subject" reads. @throws Error
  void Save(const std::string& file) const;
  /// Writes an MMM model of the person. @throws Error
  void SaveModel(const std::string& file) const;

 private:
  friend class Requests;
  explicit Person(std::shared_ptr<const mmm_converter::FinishedCalibration> work)
      : work_(std::move(work)) {}

  std::shared_ptr<const mmm_converter::FinishedCalibration> work_;
};

/// Calibrates a person by recordings in which the markers sit in the same places. The more the
/// joints move, the better.
/// @throws Error where the recordings tell too little, with what is missing.
Person Calibrate(const std::vector<Recording>& recordings, const Options& options = {},
                 const Progress& progress = {});

/// What is known of one frame.
struct TrackedFrame {
  Posture posture;  ///< joint_angles: by Tracker::joint_names
  /// 6 + joints, as of Conversion::motion; NaN: not known.
  Eigen::VectorXd standard_deviations;
  Eigen::VectorXd distances;  ///< by Tracker::markers [m]; NaN: not seen
  int markers_seen = 0;
  int markers_wrong = 0;     ///< seen, but left out or taken for another
  bool converged = false;    ///< else the posture is not to be trusted
  bool reassembled = false;  ///< the track was lost here; the posture was found anew
};

/// Tracks a person frame by frame, as a motion capture system measures:
///
///     mmm::Tracker tracker(labels, 100, {{"subject", "anna.xml"}});
///     while (Receive(&points, &time)) {
///       const mmm::TrackedFrame* frame = tracker.Track(points, time);
///       if (frame != nullptr) Use(frame->posture);
///       tracker.Prepare();
///     }
///
/// It waits until a person is seen, predicts through gaps of up to two seconds, and starts anew
/// after longer ones. On the frames of a recording it gives what a causal configuration gives in
/// Convert from the first frame on that shows enough of the person.
class Tracker {
 public:
  /// labels: of the points of each frame; rate: of the source [Hz]. The height has to be known: by
  /// "height" or "subject".
  /// @throws Error where labels tell no markers of the model, or an option can't be done while
  /// frames come.
  Tracker(const std::vector<std::string>& labels, double rate, const Options& options);

  /// points: p_WM, 3 x labels [m], NaN: not seen; time: of the frame [s], growing. Null: the person
  /// is waited for. The frame is valid until the next call. Allocates nothing.
  /// @throws Error where there are not as many points as labels.
  const TrackedFrame* Track(const Eigen::Ref<const Eigen::Matrix3Xd>& points, double time);

  /// Between frames: does ahead what does not need the next one. Changes no result.
  void Prepare();

  /// The next frame starts anew.
  void Restart();

  /// Of the joints that are tracked.
  const std::vector<std::string>& joint_names() const;
  /// Labels of the markers that are used.
  const std::vector<std::string>& markers() const;
  const std::vector<std::string>& warnings() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace mmm
