// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>

#include "common/convert/motion_converter.h"
#include "plugins/s2kf/first_look.h"
#include "plugins/s2kf/online_tracker.h"
#include "plugins/s2kf/reported_covariance.h"
#include "plugins/s2kf/s2kf_settings.h"

namespace mmm_converter::s2kf {

/// OnlineTracker, and for whole recordings OfflineTracker, as a converter.
class S2kfConverter : public MotionConverter {
 public:
  S2kfConverter(const TrackingSetup& setup, const S2kfSettings& settings);

  const FrameEstimate& Assemble(const Eigen::Ref<const Eigen::Matrix3Xd>& frame) override;
  void Prepare(double dt) override { tracker_.Prepare(dt, track_); }
  const FrameEstimate& Track(const Eigen::Ref<const Eigen::Matrix3Xd>& frame, double dt) override;

  /// With smoothing, postures, deviations and residuals are the smoothed ones; what a frame's
  /// diagnostic tells is of the filter.
  ConversionResult Convert(const MarkerSequence& recording,
                           const std::function<bool(int)>& progress) override;

  bool KeepCovariances() override;

 private:
  /// Whether an estimate has its deviations, or they come after the recording (OfflineTracker).
  enum class Deviations { kOfEachFrame, kLater };
  S2kfConverter(const TrackingSetup& setup, const S2kfSettings& settings, TrackedMarkers worn,
                Deviations deviations = Deviations::kOfEachFrame);

  /// dt: since the last frame [s].
  void FillEstimate(double dt);
  void FillVerdicts();
  /// With the settings and the places that a first look tells.
  ConversionResult ConvertBy(const FirstLook& look, const MarkerSequence& recording,
                             const std::function<bool(int)>& progress) const;
  ConversionResult TrackAll(const MarkerSequence& recording,
                            const std::function<bool(int)>& progress);
  ConversionResult Smooth(const MarkerSequence& recording,
                          const std::function<bool(int)>& progress) const;

  S2kfSettings settings_;
  TrackedMarkers markers_;  // as the model has them, which residuals are told against
  TrackedMarkers worn_;     // as they are tracked
  OnlineTracker tracker_;
  TrackState track_;
  TrackedFrame frame_;
  ReportedCovariance covariance_;
  const bool has_deviations_;
  bool keeps_covariances_ = false;
  bool has_new_deviations_ = false;  // of this frame
  Eigen::VectorXd own_deviations_;   // of the filter, which takes all noise for white
  MarkerJacobian of_model_;          // the estimate's, where the model has the markers
  FrameEstimate estimate_;
};

}  // namespace mmm_converter::s2kf
