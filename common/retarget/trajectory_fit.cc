// SPDX-License-Identifier: MIT
#include "common/retarget/trajectory_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "common/math/rotation.h"
#include "common/retarget/trajectory_limits.h"
#include "common/retarget/trajectory_window.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr int kWindow = 600;               // frames that are solved at once, of
constexpr double kWindowBytes = 64 << 20;  // at most
constexpr int kOverlap = 100;              // of them, that are solved again with those behind them
constexpr int kFrameIterations = 3;
constexpr double kFrameDamping = 20;
constexpr double kUnhurried = 20;    // [1/rad^2] by which a frame's joints stay as those before it
constexpr int kAnew = 12;            // postures from which a frame is begun anew
constexpr int kMostAnew = 4;         // frames that are
constexpr double kBetter = 0.7;      // of the cost, that makes another posture the better one
constexpr double kShortStep = 1e-4;  // [rad] after which a fit does not change
constexpr double kTurned = 1e-3;     // [rad] of a correction that does not count
constexpr double kLifted = 1e-3;     // [m]

void ClampIntoLimits(const KinematicModel& model, Posture* posture) {
  for (int j = 0; j < model.num_joints(); ++j) {
    const Segment& joint = model.joint(j);
    posture->joint_angles[j] = std::clamp(posture->joint_angles[j], joint.lower, joint.upper);
  }
}

/// Joints at a limit that the step would leave: they stay.
bool HoldAtLimits(const KinematicModel& model, const Posture& posture, const Eigen::VectorXd& step,
                  Eigen::MatrixXd* H, Eigen::VectorXd* b) {
  bool holds = false;
  for (int j = 0; j < model.num_joints(); ++j) {
    const Segment& joint = model.joint(j);
    const double q = posture.joint_angles[j], change = step[6 + j];
    const bool leaves = (q <= joint.lower && change < 0) || (q >= joint.upper && change > 0);
    if (!leaves) continue;
    H->row(6 + j).setZero();
    H->col(6 + j).setZero();
    (*H)(6 + j, 6 + j) = 1;
    (*b)[6 + j] = 0;
    holds = true;
  }
  return holds;
}

/// One frame alone by damped least squares within the limits.
class FrameFit {
 public:
  explicit FrameFit(const TrajectoryProblem& problem)
      : problem_(problem),
        equations_(problem),
        H_(6 + problem.model->num_joints(), 6 + problem.model->num_joints()),
        b_(H_.rows()) {}

  /// Returns the cost of what it began with in the last iteration. stays: how much the joints stay
  /// where they were [1/rad^2].
  double Fit(int frame, int iterations, double damping, double stays, Posture* posture) {
    const KinematicModel& model = *problem_.model;
    const Eigen::VectorXd before = posture->joint_angles;
    double cost = 0;
    for (int i = 0; i < iterations; ++i) {
      H_.setZero();
      b_.setZero();
      cost = equations_.AddAims(frame, *posture, &H_, &b_);
      H_.diagonal().array() += damping;
      H_.diagonal().tail(before.size()).array() += stays;
      b_.tail(before.size()) += stays * (before - posture->joint_angles);
      Eigen::VectorXd step = H_.selfadjointView<Eigen::Lower>().llt().solve(b_);
      if (HoldAtLimits(model, *posture, step, &H_, &b_)) {
        step = H_.selfadjointView<Eigen::Lower>().llt().solve(b_);
      }
      const double longest = step.tail(step.size() - 3).cwiseAbs().maxCoeff();
      *posture = Retract(*posture, step * std::min(1.0, 0.5 / longest));
      ClampIntoLimits(model, posture);
      if (longest < 1e-3) break;
    }
    return cost;
  }

  /// From several postures between the limits: the nearest counts.
  double FitAnew(int frame, const Posture& first, Posture* best) {
    double lowest = std::numeric_limits<double>::infinity();
    std::mt19937 random(1);
    for (int n = 0; n < kAnew; ++n) {
      Posture tried = first;
      for (int j = 0; j < problem_.model->num_joints(); ++j) {
        const Segment& joint = problem_.model->joint(j);
        const double lower = std::max(joint.lower, -3.0), upper = std::min(joint.upper, 3.0);
        const double part = n < 2 ? 0.5 : static_cast<double>(random() % 1024) / 1024;
        const double share = n == 0 ? 0 : n == 1 ? 0.3 : 0.7;
        tried.joint_angles[j] += share * (lower + part * (upper - lower) - tried.joint_angles[j]);
      }
      const double cost = Fit(frame, 60, 5, 0, &tried);
      if (cost < lowest) *best = tried;
      if (cost < lowest) lowest = cost;
    }
    if (std::isfinite(lowest)) return lowest;
    throw Error(
        fmt::format("the robot {}: no posture of it has a distance from the person's in frame "
                    "{} that is a number; look at its lengths, its limits and the map",
                    problem_.model->name(), frame));
  }

 private:
  const TrajectoryProblem& problem_;
  AimEquations equations_;
  Eigen::MatrixXd H_;
  Eigen::VectorXd b_;
};

}  // namespace

std::vector<Posture> StartTrajectory(const TrajectoryProblem& problem, const Posture& first) {
  FrameFit fit(problem);
  std::vector<Posture> postures(problem.num_frames);
  std::vector<double> costs(problem.num_frames, std::numeric_limits<double>::infinity());
  // Goes on from a frame as long as that is better than what there is.
  const auto go_on = [&](int from, int step, Posture posture) {
    for (int k = from; k >= 0 && k < problem.num_frames; k += step) {
      const double cost = fit.Fit(k, kFrameIterations, kFrameDamping, kUnhurried, &posture);
      if (!(cost < kBetter * costs[k])) break;
      postures[k] = posture;
      costs[k] = cost;
    }
  };
  Posture posture;
  fit.FitAnew(0, first, &posture);
  go_on(0, 1, posture);
  // A limb that has got to the end of its joints' limits may get farther the other way round.
  for (int n = 0; n < kMostAnew; ++n) {
    const auto worst = std::max_element(costs.begin(), costs.end());
    const int frame = static_cast<int>(worst - costs.begin());
    const double cost = fit.FitAnew(frame, postures[frame], &posture);
    if (cost >= kBetter * *worst) break;
    go_on(frame, 1, posture);
    costs[frame] = std::numeric_limits<double>::infinity();
    go_on(frame, -1, posture);
  }
  return postures;
}

FitResult FitTrajectory(const TrajectoryProblem& problem, std::vector<Posture> start,
                        const FitEffort& effort) {
  FitResult result;
  result.postures = std::move(start);
  CorrectJoints(problem, &result.postures);
  TrajectoryWindow window(problem);
  const double states = 6 + problem.model->num_joints();
  const double frame_bytes = 4 * states * states * sizeof(double);
  const int window_frames =
      std::clamp(static_cast<int>(kWindowBytes / frame_bytes), 2 * kOverlap, kWindow);
  bool is_solved = true;
  for (int begin = 0; begin < problem.num_frames;) {
    const int end = std::min(begin + window_frames, problem.num_frames);
    window.Begin(begin, end);
    int done = 0;
    while (done < effort.most) {
      const double longest = window.Step(&result.postures);
      ++done;
      if (longest > (done < effort.fewest ? kShortStep : effort.near)) continue;
      if (!effort.meets_limits || window.IsWithinLimits(result.postures)) break;
    }
    result.iterations = std::max(result.iterations, done);
    is_solved &= window.is_solved();
    if (end == problem.num_frames) break;
    begin = end - kOverlap;
  }
  const double turned = CorrectJoints(problem, &result.postures);
  const double lifted = LiftAboveFloor(problem, &result.postures);
  result.has_converged = is_solved && turned <= kTurned && lifted <= kLifted;
  return result;
}

}  // namespace mmm_converter
