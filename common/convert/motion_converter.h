// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/convert/interface_layout.h"
#include "common/convert/marker_incidents.h"
#include "common/convert/tracking_setup.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"
#include "common/support/error.h"

namespace mmm_converter {

/// What a converter knows of one frame. All vectors keep their size from frame to frame.
struct FrameEstimate {
  Posture posture;                      ///< joint_angles: all joints of the model, untracked ones 0
  Eigen::VectorXd standard_deviations;  ///< as PoseTrajectory, all joints; NaN where not tracked
  Eigen::VectorXd residuals;  ///< per assignment |p_measured - p_model| [m]; NaN: not seen
  /// Per assignment, kAsLabelled or what is wrong with it; empty: the converter does not judge.
  Eigen::VectorXi verdicts;
  int markers_seen = 0;
  int markers_downweighted = 0;  ///< seen, but far from where the model has them
  int markers_wrong = 0;         ///< seen, but left out or taken for another
  double nis = 0;                ///< normalised innovation squared, over its degrees of freedom
  bool reassembled = false;      ///< the track was lost here; the posture was assembled again
  bool converged = false;
};

struct FrameDiagnostic {
  int markers_seen = 0;
  int markers_downweighted = 0;
  int markers_wrong = 0;
  double nis = 0;
  bool reassembled = false;
  bool converged = false;
  double seconds = 0;  ///< time spent on this frame
};

struct ConversionResult {
  PoseTrajectory trajectory;  ///< joint_names: the tracked joints, in configuration order
  Eigen::MatrixXd residuals;  ///< assignments x frames [m]; NaN: not seen, or not tracked yet
  std::vector<FrameDiagnostic> frames;
  /// Factor on the variances of the process noise that the recording asked for, where the converter
  /// chose one.
  std::optional<double> process_noise_scale;
  std::vector<MarkerIncident> incidents;  ///< by first frame
  /// By frame, where they were asked for; of frames in which the converter computed them anew: the
  /// others have the deviations of the one before.
  std::vector<PoseCovariance> covariances;
};

/// Tracks one person through one recording or live stream. Not thread-safe; use one for each.
class MotionConverter {
 public:
  explicit MotionConverter(TrackingSetup setup);
  virtual ~MotionConverter();

  const TrackingSetup& setup() const { return setup_; }

  /// Estimates the posture of a first frame from nothing. frame: 3 x labels of the setup [m], NaN =
  /// not seen. May be called again to start over.
  /// @throws Error where fewer than three assigned markers are seen.
  virtual const FrameEstimate& Assemble(const Eigen::Ref<const Eigen::Matrix3Xd>& frame) = 0;

  /// Estimates the posture dt seconds after the last frame; allocates nothing. Any number of
  /// markers may be unseen. The result is valid until the next call.
  virtual const FrameEstimate& Track(const Eigen::Ref<const Eigen::Matrix3Xd>& frame,
                                     double dt) = 0;

  /// Between frames: does ahead what Track does dt seconds after the last frame and what does not
  /// need the frame. Changes no result; Track with another dt is only slower. Allocates nothing.
  virtual void Prepare(double dt);

  /// A whole recording, whose labels are those of the setup: Assemble on the frame in which
  /// tracking starts (TrackingStart; where it never does, on that which shows most), Track on the
  /// next ones and then backward from there while it finds three. Earlier frames take the first
  /// posture, not converged. progress(k): frames done, 0 while tracking goes backward; may be
  /// empty; returning false cancels (an Error is thrown).
  /// @throws Error where no frame shows three assigned markers.
  virtual ConversionResult Convert(const MarkerSequence& recording,
                                   const std::function<bool(int)>& progress);

  /// From now on results of Convert have covariances. False, as here: the converter knows none.
  virtual bool KeepCovariances();

 private:
  TrackingSetup setup_;
};

/// Makes converters; what a plugin exports.
class MotionConverterFactory {
 public:
  virtual ~MotionConverterFactory();
  virtual std::string name() const = 0;         ///< `ConverterConfig@type`
  virtual std::string description() const = 0;  ///< one line
  /// The documented configuration template, all settings at their defaults (XML).
  virtual std::string config_template() const = 0;
  /// Of the configuration the plugin's own elements count; setup has what the others ask for.
  /// @throws Error for an unknown element, attribute or value of these (file and line).
  virtual std::unique_ptr<MotionConverter> Create(const TrackingSetup& setup,
                                                  const ConverterConfig& config) const = 0;
};

/// The number grows whenever a type that crosses the border between host and plugin changes; which
/// these are is tested (interface_layout_test.cc). Behind it stands how the compiler laid them out.
/// Not inline: a plugin must not be given the host's when it is loaded.
constexpr auto kConverterInterfaceText = InterfaceText(
    "MMMConverterS2KF-9",
    LayoutHash<MotionConverter, MotionConverterFactory, FrameEstimate, FrameDiagnostic,
               ConversionResult, PoseCovariance, PoseTrajectory, Posture, MarkerIncident,
               MarkerSequence, TrackingSetup, MarkerMapping, MarkerAssignment, KinematicModel,
               Segment, ModelMarker, ConverterConfig, MarkerPair, ConfigJoint, XmlElement, Error,
               Eigen::Ref<const Eigen::Matrix3Xd>, std::function<bool(int)>>());

/// What a plugin says that it was built against; a host refuses one that says something else.
constexpr const char* kConverterInterfaceVersion = kConverterInterfaceText.data();

}  // namespace mmm_converter

/// Every plugin exports these two with C linkage: the factory (the host owns it and deletes it
/// before it unloads the plugin) and the interface version that it was built against (static text).
using GetFactoryFunction = mmm_converter::MotionConverterFactory*();
using GetVersionFunction = const char*();
