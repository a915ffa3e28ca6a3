// SPDX-License-Identifier: MIT
#include "tests/plugins/s2kf/coverage.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdio>

#include "common/math/rotation.h"
#include "common/motion/marker_synthesis.h"

namespace mmm_converter::s2kf {

namespace {

constexpr int kStride = 5;
constexpr double kNearLimit = 0.01;  // of the range

}  // namespace

std::string GroupOf(const std::string& joint) {
  const auto starts = [&](const char* prefix) { return joint.rfind(prefix, 0) == 0; };
  if (starts("BLN") || starts("BUN")) return "neck";
  if (starts("B")) return "spine";
  if (joint.size() < 2) return "other";
  if (joint[1] == 'M') return "foot";
  const std::map<char, std::string> groups = {{'S', "shoulder"}, {'E', "elbow"}, {'W', "wrist"},
                                              {'H', "hip"},      {'K', "knee"},  {'A', "ankle"},
                                              {'F', "foot"}};
  const auto found = groups.find(joint[1]);
  return found == groups.end() ? "other" : found->second;
}

void Coverage::Count(const std::string& group, double error, double deviation) {
  Counts& counts = groups_[group];
  ++counts.samples;
  counts.within_one += std::abs(error) <= deviation;
  counts.within_two += std::abs(error) <= 2 * deviation;
  counts.squares += (error / deviation) * (error / deviation);
  counts.error_squares += error * error;
  counts.variances += deviation * deviation;
}

void Coverage::Add(const KinematicModel& model, const std::vector<int>& joints,
                   const PoseTrajectory& truth, const PoseTrajectory& estimate, int begin, int end,
                   const std::string& only) {
  for (int k = begin; k < end; k += kStride) {
    const Posture q_true = ModelPosture(model, truth, k);
    const Posture q = ModelPosture(model, estimate, k);
    const auto deviations = estimate.standard_deviations.col(k);
    if (only.empty()) {
      const Eigen::Vector3d turn = Log(q.orientation.conjugate() * q_true.orientation);
      for (int i = 0; i < 3; ++i) {
        Count("root position", q_true.position[i] - q.position[i], deviations[i]);
        Count("root rotation", turn[i], deviations[3 + i]);
      }
    }
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const Segment& joint = model.joint(joints[j]);
      if (joint.name.rfind(only, 0) != 0) continue;
      const double angle = q.joint_angles[joints[j]];
      const double error = q_true.joint_angles[joints[j]] - angle;
      const double deviation = deviations[static_cast<Eigen::Index>(6 + j)];
      Count(GroupOf(joint.name), error, deviation);
      Count("joints", error, deviation);
      const double margin = std::min(angle - joint.lower, joint.upper - angle);
      if (margin < kNearLimit * (joint.upper - joint.lower)) Count("limit", error, deviation);
    }
  }
}

void Coverage::Add(const Coverage& other) {
  for (const auto& [group, counts] : other.groups_) {
    Counts& mine = groups_[group];
    mine.samples += counts.samples;
    mine.within_one += counts.within_one;
    mine.within_two += counts.within_two;
    mine.squares += counts.squares;
    mine.error_squares += counts.error_squares;
    mine.variances += counts.variances;
  }
}

void Coverage::AddTogether(const KinematicModel& model, const std::vector<int>& joints,
                           const PoseTrajectory& truth, const ConversionResult& estimate, int begin,
                           int end) {
  std::map<std::string, std::vector<int>> parts;  // rows of the covariance, by side and joint
  std::map<std::string, std::string> groups;
  const int size = 6 + static_cast<int>(joints.size());
  for (int i = 0; i < size; ++i) {
    parts["whole"].push_back(i);
    if (i < 6) continue;
    const std::string& name = model.joint(joints[i - 6]).name;
    const std::string group = GroupOf(name);
    const std::string part = name.substr(0, 1) + group;
    parts[part].push_back(i);
    groups[part] = group;
  }
  groups["whole"] = "whole";
  for (const PoseCovariance& one : estimate.covariances) {
    if (one.frame < begin || one.frame >= end) continue;
    const Posture q_true = ModelPosture(model, truth, one.frame);
    const Posture q = ModelPosture(model, estimate.trajectory, one.frame);
    Eigen::VectorXd error(size);
    error << q_true.position - q.position, Log(q.orientation.conjugate() * q_true.orientation),
        q_true.joint_angles(joints) - q.joint_angles(joints);
    for (const auto& [part, rows] : parts) {
      const Eigen::VectorXd e = error(rows);
      const Eigen::MatrixXd P = one.covariance(rows, rows);
      Together& group = together_[groups.at(part)];
      ++group.samples;
      group.squares += e.dot(P.ldlt().solve(e)) / static_cast<double>(rows.size());
    }
  }
}

std::map<std::string, double> Coverage::NeesTogether() const {
  std::map<std::string, double> nees;
  for (const auto& [group, sum] : together_) {
    nees[group] = sum.squares / static_cast<double>(sum.samples);
  }
  return nees;
}

void Coverage::Print(const std::string& title) const {
  std::printf("[ measured ] %s:", title.c_str());
  for (const auto& [group, counts] : groups_) {
    const auto n = static_cast<double>(counts.samples);
    const bool is_length = group == "root position";
    std::printf(" %s %.2f/%.2f (NEES %.2f, rms %.1f, claimed %.1f %s);", group.c_str(),
                counts.One(), counts.Two(), counts.Nees(),
                (is_length ? 1000 : 57.3) * std::sqrt(counts.error_squares / n),
                (is_length ? 1000 : 57.3) * std::sqrt(counts.variances / n),
                is_length ? "mm" : "deg");
  }
  for (const auto& [group, nees] : NeesTogether()) {
    std::printf(" %s together NEES %.2f;", group.c_str(), nees);
  }
  std::printf("\n");
}

}  // namespace mmm_converter::s2kf
