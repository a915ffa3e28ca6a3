// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter::s2kf {

inline constexpr double kMillimetres = 1000;

/// How far joint centres are from where they should be [m], by joint group; "all" is all.
class CentreErrors {
 public:
  /// Every third frame from `begin` on.
  void Add(const KinematicModel& person, const PoseTrajectory& truth, const KinematicModel& model,
           const PoseTrajectory& estimate, const std::vector<int>& joints, int begin = 0);
  void Add(const CentreErrors& other);

  std::map<std::string, double> Means() const;
  double largest() const { return largest_; }

 private:
  std::map<std::string, std::pair<double, double>> groups_;  // sum, samples
  double largest_ = 0;
};

/// What events of a kind cost: the largest change of a joint's centre against the clean run.
class Damages {
 public:
  /// most: what an event may cost [m].
  explicit Damages(double most) : most_(most) {}

  /// One event; what costs more is printed.
  void Add(const std::string& kind, int person, const std::string& what, double damage);
  /// Of a kind that is to be named: so many events were.
  void Named(const std::string& kind, bool is_named) { named_[kind] += is_named; }
  /// A line for each kind.
  void Print() const;

 private:
  double most_;
  std::map<std::string, std::vector<double>> damages_;
  std::map<std::string, int> named_;
};

/// Rates of joint angles and their errors over those of the truth, rms by joint group.
class RateRatios {
 public:
  /// Both have velocities and accelerations.
  void Add(const PoseTrajectory& truth, const PoseTrajectory& estimate);
  void Print(const std::string& title) const;

 private:
  struct Squares {
    void Add(const Eigen::RowVectorXd& its, const Eigen::RowVectorXd& mine);

    double truth = 0;
    double estimate = 0;
    double error = 0;
  };
  struct Group {
    Squares velocity;
    Squares acceleration;
  };
  std::map<std::string, Group> groups_;
};

}  // namespace mmm_converter::s2kf
