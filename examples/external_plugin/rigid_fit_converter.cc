// SPDX-License-Identifier: MIT
//
// A converter of your own, complete: the person as one rigid body in its zero posture, placed in
// every frame so that the markers fit best. See README.md for how to build and use it.

#include <Eigen/SVD>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "common/convert/motion_converter.h"
#include "common/convert/settings.h"
#include "common/model/forward_kinematics.h"
#include "common/support/diagnostics.h"
#include "common/support/error.h"

namespace {

using mmm_converter::FrameEstimate;
using mmm_converter::TrackingSetup;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// What a user can set. From the one table come the reader, its error messages and the template that
// print-config shows.
struct Settings {
  int minimum_markers = 3;
};

mmm_converter::SettingTable MakeTable(Settings* settings) {
  mmm_converter::SettingTable table;
  table.AddElement("Fit", "The rigid fit of the markers of one frame.");
  table.Add("Fit", "minimumMarkers", &settings->minimum_markers, 3, 1000,
            "a frame in which fewer markers are seen keeps the pose of the frame before");
  return table;
}

class RigidFitConverter : public mmm_converter::MotionConverter {
 public:
  // All that depends on the setup happens here: a frame allocates nothing.
  RigidFitConverter(const TrackingSetup& setup, const Settings& settings)
      : MotionConverter(setup),
        settings_(settings),
        labels_(mmm_converter::LabelIndices(setup.assignments())) {
    const mmm_converter::KinematicModel& model = *setup.model;
    estimate_.posture = mmm_converter::ZeroPosture(model);
    estimate_.standard_deviations.setConstant(6 + model.num_joints(), kNaN);
    estimate_.residuals.setConstant(static_cast<int>(labels_.size()), kNaN);
    p_SM_ = mmm_converter::MarkerPositions(model, estimate_.posture)(
        Eigen::all, mmm_converter::MarkerIndices(setup.assignments()));
    seen_.reserve(labels_.size());
  }

  const FrameEstimate& Assemble(const Eigen::Ref<const Eigen::Matrix3Xd>& frame) override {
    if (!Track(frame, 0).converged) {
      throw mmm_converter::Error("the first frame shows " + std::to_string(seen_.size()) +
                                 " assigned markers; the rigid fit needs " +
                                 std::to_string(settings_.minimum_markers));
    }
    return estimate_;
  }

  const FrameEstimate& Track(const Eigen::Ref<const Eigen::Matrix3Xd>& frame,
                             double /*dt*/) override {
    seen_.clear();
    for (int i = 0; i < p_SM_.cols(); ++i) {
      if (mmm_converter::IsSeen(frame.col(labels_[i]))) seen_.push_back(i);
    }
    estimate_.markers_seen = static_cast<int>(seen_.size());
    estimate_.converged = estimate_.markers_seen >= settings_.minimum_markers;
    if (estimate_.converged) FitRoot(frame);
    estimate_.residuals.setConstant(kNaN);
    for (int i : seen_) {
      const Eigen::Vector3d p_WM =
          estimate_.posture.orientation * p_SM_.col(i) + estimate_.posture.position;
      estimate_.residuals[i] = (frame.col(labels_[i]) - p_WM).norm();
    }
    return estimate_;
  }

 private:
  // The pose that minimises the sum of |X_WS p_SM - p_WM|^2 over the seen markers, from the
  // singular value decomposition of the cross-covariance of the two point sets (Kabsch 1976).
  void FitRoot(const Eigen::Ref<const Eigen::Matrix3Xd>& frame) {
    Eigen::Vector3d model_mean = Eigen::Vector3d::Zero();
    Eigen::Vector3d measured_mean = Eigen::Vector3d::Zero();
    for (int i : seen_) {
      model_mean += p_SM_.col(i) / seen_.size();
      measured_mean += frame.col(labels_[i]) / seen_.size();
    }
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (int i : seen_) {
      covariance +=
          (frame.col(labels_[i]) - measured_mean) * (p_SM_.col(i) - model_mean).transpose();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
    const Eigen::Matrix3d R_WS =
        svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
    estimate_.posture.orientation = R_WS;
    estimate_.posture.position = measured_mean - R_WS * model_mean;
  }

  Settings settings_;
  std::vector<mmm_converter::LabelIx> labels_;  // by assignment
  Eigen::Matrix3Xd p_SM_;  // by assignment, zero posture, in axes of the root [m]
  std::vector<int> seen_;  // assignments seen in the present frame
  FrameEstimate estimate_;
};

class RigidFitFactory : public mmm_converter::MotionConverterFactory {
 public:
  std::string name() const override { return "RigidFitConverter"; }
  std::string description() const override {
    return "the person as one rigid body in its zero posture (example)";
  }
  std::string config_template() const override {
    Settings defaults;
    return mmm_converter::FormatConfigTemplate(name(), MakeTable(&defaults));
  }
  std::unique_ptr<mmm_converter::MotionConverter> Create(
      const TrackingSetup& setup, const mmm_converter::ConverterConfig& config) const override {
    Settings settings;
    mmm_converter::Diagnostics diagnostics(config.file);
    MakeTable(&settings).Read(config.plugin_elements, &diagnostics);
    diagnostics.ThrowIfErrors();
    return std::make_unique<RigidFitConverter>(setup, settings);
  }
};

}  // namespace

extern "C" {
// The host deletes the factory before it unloads the plugin.
mmm_converter::MotionConverterFactory* getFactory() { return new RigidFitFactory; }
const char* getVersion() { return mmm_converter::kConverterInterfaceVersion; }
}
