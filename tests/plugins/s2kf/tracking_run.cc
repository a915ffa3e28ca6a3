// SPDX-License-Identifier: MIT
#include "tests/plugins/s2kf/tracking_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "common/convert/converter_config.h"
#include "common/fit/posture_fit.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::s2kf {

namespace {

double Mean(const std::vector<double>& values, int begin, int end) {
  return std::accumulate(values.begin() + begin, values.begin() + end, 0.0) / (end - begin);
}

Posture Tracked(const Posture& full, const std::vector<int>& joints) {
  Posture q = full;
  q.joint_angles = full.joint_angles(joints);
  return q;
}

/// The best of the fits from several postures.
class FrameOptimum {
 public:
  FrameOptimum(const MarkerKinematics& kinematics, const std::vector<MarkerAssignment>& assignments)
      : fit_(kinematics), scale_(kinematics.num_markers()) {
    for (int m = 0; m < kinematics.num_markers(); ++m) scale_[m] = assignments[m].noise_scale;
    options_.tolerance = 1e-6;
    options_.max_iterations = 50;
  }

  double Find(const Eigen::Matrix3Xd& z, const std::vector<Posture>& starts) {
    double least = std::numeric_limits<double>::infinity();
    double distance = 0;
    for (Posture q : starts) {
      const PostureFit::Result result = fit_.Solve(z, scale_, options_, &q);
      if (result.cost >= least) continue;
      least = result.cost;
      distance = result.mean_distance;
      posture_ = q;
    }
    return distance;
  }

  double Distance(const Eigen::Matrix3Xd& z, const Posture& q) {
    return fit_.Evaluate(z, scale_, options_, q).mean_distance;
  }

  const Posture& posture() const { return posture_; }

 private:
  PostureFit fit_;
  Eigen::VectorXd scale_;
  PostureFitOptions options_;
  Posture posture_;
};

void AddErrors(const KinematicModel& model, const std::vector<int>& joints, const Posture& truth,
               const Posture& estimate, double share, double* joint_error, double* centre_error) {
  const auto X_true = SegmentPoses(model, truth);
  const auto X = SegmentPoses(model, estimate);
  for (const int j : joints) {
    const int s = model.joint_segment(j);
    *joint_error += share * std::abs(truth.joint_angles[j] - estimate.joint_angles[j]);
    *centre_error += share * (X_true[s].translation() - X[s].translation()).norm();
  }
}

}  // namespace

std::vector<int> MotionJoints(const KinematicModel& model, int count) {
  ConverterConfig config;
  config.joint_set = count == 40 ? "mmm40" : "mmm44";
  return ResolveJoints(config, model);
}

PoseTrajectory LowPassed(const PoseTrajectory& motion) {
  // The Gaussian whose response is 1/sqrt(2) at 6 Hz.
  const double sigma = std::sqrt(std::numbers::ln2) / (2 * std::numbers::pi * 6.0) * motion.rate;
  const int reach = static_cast<int>(4 * sigma) + 1;
  PoseTrajectory smooth = motion;
  const int n = motion.num_frames();
  for (int k = 0; k < n; ++k) {
    Posture& q = smooth.postures[k];
    q.position.setZero();
    q.joint_angles.setZero();
    Eigen::Vector4d orientation = Eigen::Vector4d::Zero();
    double total = 0;
    for (int i = -reach; i <= reach; ++i) {
      const Posture& other = motion.postures[std::clamp(k + i, 0, n - 1)];
      const double w = std::exp(-0.5 * i * i / (sigma * sigma));
      const double sign = other.orientation.dot(motion.postures[k].orientation) < 0 ? -1.0 : 1.0;
      total += w;
      q.position += w * other.position;
      q.joint_angles += w * other.joint_angles;
      orientation += w * sign * other.orientation.coeffs();
    }
    q.position /= total;
    q.joint_angles /= total;
    q.orientation = Eigen::Quaterniond(Eigen::Vector4d(orientation.normalized()));
  }
  return smooth;
}

S2kfSettings PaperSettings() {
  const ConverterConfig config =
      ReadConverterConfig(testing::SourcePath("xml_config/converters/s2kf_paper.xml"));
  return ReadSettings(config);
}

double TrackedRun::MeanDistance(int begin, int end) const { return Mean(distance, begin, end); }
double TrackedRun::MeanOptimum(int begin, int end) const { return Mean(optimum, begin, end); }
double TrackedRun::Worst() const { return *std::max_element(distance.begin(), distance.end()); }

int TrackedRun::BadFrames(int begin, int end) const {
  int bad = 0;
  for (int k = begin; k < end; ++k) bad += !IsGood(k);
  return bad;
}

TrackedRun RunTracker(const KinematicModel& model, const std::vector<int>& joints,
                      const S2kfSettings& settings, const MarkerSequence& seen,
                      const MarkerSequence& all, const PoseTrajectory* truth,
                      const std::vector<MarkerAssignment>& assignments) {
  S2kfConverter converter(SetupOf(model, joints, assignments), settings);
  const std::vector<LabelIx> labels = LabelIndices(assignments);
  const MarkerKinematics kinematics(model, joints, MarkerIndices(assignments));
  FrameOptimum optimum(kinematics, assignments);
  TrackedRun run;
  const double share = 1.0 / (static_cast<double>(joints.size()) * seen.num_frames());
  Posture previous;
  for (int k = 0; k < seen.num_frames(); ++k) {
    const FrameEstimate& estimate = k == 0 ? converter.Assemble(seen.frame(0))
                                           : converter.Track(seen.frame(k), 1 / seen.rate());
    const Posture q = Tracked(estimate.posture, joints);
    run.lost += estimate.markers_seen >= 3 && !estimate.converged;
    run.inside_limits &= (q.joint_angles.array() >= kinematics.lower().array()).all() &&
                         (q.joint_angles.array() <= kinematics.upper().array()).all();
    if (k > 0) {
      run.largest_step = std::max(run.largest_step,
                                  (q.joint_angles - previous.joint_angles).cwiseAbs().maxCoeff());
    }
    previous = q;
    const Eigen::Matrix3Xd z = all.frame(k)(Eigen::all, labels);
    std::vector<Posture> starts = {q};
    if (k > 0) starts.push_back(optimum.posture());
    if (truth != nullptr) starts.push_back(Tracked(ModelPosture(model, *truth, k), joints));
    run.distance.push_back(optimum.Distance(z, q));
    run.optimum.push_back(optimum.Find(z, starts));
    if (truth == nullptr) continue;
    Posture best;
    best.position = optimum.posture().position;
    best.orientation = optimum.posture().orientation;
    best.joint_angles.setZero(model.num_joints());
    best.joint_angles(joints) = optimum.posture().joint_angles;
    const Posture true_posture = ModelPosture(model, *truth, k);
    AddErrors(model, joints, true_posture, estimate.posture, share, &run.joint_error,
              &run.centre_error);
    AddErrors(model, joints, true_posture, best, share, &run.optimum_joint_error,
              &run.optimum_centre_error);
  }
  return run;
}

}  // namespace mmm_converter::s2kf
