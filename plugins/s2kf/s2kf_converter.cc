// SPDX-License-Identifier: MIT
#include "plugins/s2kf/s2kf_converter.h"

#include <utility>
#include <vector>

#include "common/motion/trajectory_derivatives.h"
#include "common/support/units.h"
#include "plugins/s2kf/correlation_log.h"
#include "plugins/s2kf/misplaced_markers.h"
#include "plugins/s2kf/offline_tracker.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3Xd;
using Eigen::Ref;

namespace {

// So often markers that are misplaced are looked for.
constexpr int kMostRounds = 3;

}  // namespace

S2kfConverter::S2kfConverter(const TrackingSetup& setup, const S2kfSettings& settings)
    : S2kfConverter(setup, settings, TrackedMarkers(setup)) {}

S2kfConverter::S2kfConverter(const TrackingSetup& setup, const S2kfSettings& settings,
                             TrackedMarkers worn, Deviations deviations)
    : MotionConverter(setup),
      settings_(settings),
      markers_(setup),
      worn_(std::move(worn)),
      tracker_(worn_, settings),
      frame_(worn_.kinematics()),
      covariance_(markers_, settings),
      has_deviations_(deviations == Deviations::kOfEachFrame),
      of_model_(markers_.kinematics().MakeJacobian()) {
  own_deviations_.setZero(markers_.kinematics().num_dofs());
  estimate_.posture.joint_angles = RestAngles(*setup.model);
  estimate_.standard_deviations.setConstant(6 + setup.model->num_joints(), kNaN);
  estimate_.residuals.setConstant(markers_.kinematics().num_markers(), kNaN);
  estimate_.verdicts.setConstant(markers_.kinematics().num_markers(), kAsLabelled);
}

const FrameEstimate& S2kfConverter::Assemble(const Ref<const Matrix3Xd>& frame) {
  tracker_.Start(frame, &track_, &frame_);
  covariance_.Restart();
  FillEstimate(0);
  return estimate_;
}

const FrameEstimate& S2kfConverter::Track(const Ref<const Matrix3Xd>& frame, double dt) {
  tracker_.Track(frame, dt, &track_, &frame_);
  FillEstimate(dt);
  return estimate_;
}

void S2kfConverter::FillEstimate(double dt) {
  markers_.kinematics().ComputeMarkers(frame_.posture.position,
                                       frame_.posture.orientation.toRotationMatrix(),
                                       frame_.posture.joint_angles, &of_model_);
  if (has_deviations_) {
    covariance_.Look(frame_.z, of_model_, dt);
    has_new_deviations_ = covariance_.IsDue();
    if (has_new_deviations_) {
      tracker_.filter().Deviations(track_.belief, &own_deviations_);
      covariance_.Compute(frame_.posture.joint_angles, own_deviations_, &of_model_);
    }
  }
  const Eigen::VectorXd& deviations = covariance_.deviations();
  estimate_.posture.position = frame_.posture.position;
  estimate_.posture.orientation = frame_.posture.orientation;
  estimate_.standard_deviations.head<6>() = deviations.head<6>();
  const std::vector<int>& joints = setup().joints;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    estimate_.posture.joint_angles[joints[j]] = frame_.posture.joint_angles[i];
    estimate_.standard_deviations[6 + joints[j]] = deviations[6 + i];
  }
  for (Eigen::Index m = 0; m < estimate_.residuals.size(); ++m) {
    estimate_.residuals[m] = (frame_.measured.col(m) - of_model_.p_WM.col(m)).norm();
  }
  FillVerdicts();
  estimate_.markers_seen = frame_.outcome.seen;
  estimate_.markers_downweighted = frame_.outcome.downweighted;
  estimate_.nis = frame_.outcome.nis;
  estimate_.reassembled = frame_.reassembled;
  estimate_.converged = frame_.outcome.seen > 0 && !track_.watch.is_far;
}

void S2kfConverter::FillVerdicts() {
  estimate_.verdicts = track_.gate.verdicts;
  estimate_.markers_wrong = 0;
  for (Eigen::Index m = 0; m < estimate_.verdicts.size(); ++m) {
    if (frame_.measured.col(m).allFinite()) {
      estimate_.markers_wrong += estimate_.verdicts[m] != kAsLabelled;
    } else {
      estimate_.verdicts[m] = kAsLabelled;
    }
  }
}

bool S2kfConverter::KeepCovariances() {
  keeps_covariances_ = true;
  return true;
}

ConversionResult S2kfConverter::TrackAll(const MarkerSequence& recording,
                                         const std::function<bool(int)>& progress) {
  std::vector<PoseCovariance> covariances;
  CorrelationLog correlations(recording);
  ConversionResult result = MotionConverter::Convert(recording, [&](int done) {
    if (has_new_deviations_ && done > 0) {
      const int k = done - 1;
      if (keeps_covariances_) covariances.push_back({k, covariance_.Covariance()});
      if (correlations.IsDue(k)) correlations.Keep(k, covariance_.Covariance());
    }
    return !progress || progress(done);
  });
  result.covariances = std::move(covariances);
  result.trajectory.correlations = correlations.Take();
  return result;
}

ConversionResult S2kfConverter::ConvertBy(const FirstLook& look, const MarkerSequence& recording,
                                          const std::function<bool(int)>& progress) const {
  S2kfSettings settings = settings_;
  settings.process_noise_scale *= look.process_noise_scale.value_or(1);
  settings.choose_process_noise_scale = false;
  settings.learn_places = false;
  S2kfConverter converter(setup(), settings, look.places ? markers_.Worn(*look.places) : markers_);
  converter.keeps_covariances_ = keeps_covariances_;
  ConversionResult result = converter.Convert(recording, progress);
  result.process_noise_scale = look.process_noise_scale;
  return result;
}

ConversionResult S2kfConverter::Convert(const MarkerSequence& recording,
                                        const std::function<bool(int)>& progress) {
  if (settings_.choose_process_noise_scale || settings_.learn_places) {
    FirstLook look = LookOver(recording, markers_, settings_, progress);
    ConversionResult result = ConvertBy(look, recording, progress);
    if (!look.places || settings_.gate_probability <= 0) return result;
    MisplacedMarkers misplaced(recording, markers_);
    int rounds = 0;
    for (; rounds < kMostRounds && misplaced.Find(result); ++rounds) {
      const std::vector<FrameDiagnostic> before = std::move(result.frames);
      const MarkerSequence without = misplaced.Without();
      const auto is_to_go_on = [&](int) { return !progress || progress(recording.num_frames()); };
      look = LookOver(without, markers_, settings_, is_to_go_on);
      result = ConvertBy(look, without, is_to_go_on);
      for (std::size_t k = 0; k < before.size(); ++k) result.frames[k].seconds += before[k].seconds;
    }
    if (rounds > 0) misplaced.Tell(&result);
    return result;
  }
  return settings_.smoothing ? Smooth(recording, progress) : TrackAll(recording, progress);
}

ConversionResult S2kfConverter::Smooth(const MarkerSequence& recording,
                                       const std::function<bool(int)>& progress) const {
  S2kfConverter filter(setup(), settings_, worn_, Deviations::kLater);
  OfflineTracker offline(recording, settings_, markers_, &filter.tracker_);
  ConversionResult result = filter.MotionConverter::Convert(recording, [&](int done) {
    if (done > 0) {
      offline.Keep(done - 1, filter.track_, filter.frame_);
    } else {
      offline.KeepEarlier(filter.track_);
    }
    return !progress || progress(done);
  });
  offline.Smooth(keeps_covariances_, &result);
  Differentiate(&result.trajectory);
  return result;
}

}  // namespace mmm_converter::s2kf
