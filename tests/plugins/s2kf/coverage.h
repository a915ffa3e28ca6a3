// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/convert/motion_converter.h"
#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter::s2kf {

/// Whether standard deviations tell the size of errors, by group: neck, spine, shoulder, elbow,
/// wrist, hip, knee, ankle, foot, root position, root rotation; "joints" is all angles, "limit"
/// those estimated within 1 % of their range from a limit. Right are .68 within one deviation, .95
/// within two, and a NEES of 1.
class Coverage {
 public:
  struct Counts {
    long samples = 0;
    long within_one = 0;
    long within_two = 0;
    double squares = 0;  ///< of errors over their deviations
    double error_squares = 0;
    double variances = 0;

    double One() const { return static_cast<double>(within_one) / static_cast<double>(samples); }
    double Two() const { return static_cast<double>(within_two) / static_cast<double>(samples); }
    /// Normalised estimation error squared, per coordinate.
    double Nees() const { return squares / static_cast<double>(samples); }
  };

  /// Every fifth frame in [begin, end). model, joints: what was tracked. only: nothing, or the
  /// beginning of the names of the joints that count.
  void Add(const KinematicModel& model, const std::vector<int>& joints, const PoseTrajectory& truth,
           const PoseTrajectory& estimate, int begin, int end, const std::string& only = "");
  void Add(const Coverage& other);
  /// One error and what was expected of it.
  void Count(const std::string& group, double error, double deviation);

  /// The errors of a limb's angles in that joint (a shoulder's three) together, and of all,
  /// "whole", in the frames of [begin, end) of which there is a covariance.
  void AddTogether(const KinematicModel& model, const std::vector<int>& joints,
                   const PoseTrajectory& truth, const ConversionResult& estimate, int begin,
                   int end);

  const std::map<std::string, Counts>& groups() const { return groups_; }
  const Counts& Of(const std::string& group) const { return groups_.at(group); }
  /// By group, of errors e and their covariance P: e^T P^-1 e over its degrees of freedom, the
  /// means over frames.
  std::map<std::string, double> NeesTogether() const;
  /// One line.
  void Print(const std::string& title) const;

 private:
  struct Together {
    long samples = 0;
    double squares = 0;
  };

  std::map<std::string, Counts> groups_;
  std::map<std::string, Together> together_;
};

/// The group of a tracked joint.
std::string GroupOf(const std::string& joint);

}  // namespace mmm_converter::s2kf
