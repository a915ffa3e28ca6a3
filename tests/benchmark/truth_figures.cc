// SPDX-License-Identifier: MIT
#include "tests/benchmark/truth_figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "tests/plugins/s2kf/coverage.h"

namespace mmm_converter::s2kf {

void CentreErrors::Add(const KinematicModel& person, const PoseTrajectory& truth,
                       const KinematicModel& model, const PoseTrajectory& estimate,
                       const std::vector<int>& joints, int begin) {
  for (int k = begin; k < std::min(truth.num_frames(), estimate.num_frames()); k += 3) {
    const auto X_true = SegmentPoses(person, ModelPosture(person, truth, k));
    const auto X = SegmentPoses(model, ModelPosture(model, estimate, k));
    for (const int joint : joints) {
      const int s = model.joint_segment(joint);
      const double error = (X[s].translation() - X_true[s].translation()).norm();
      for (const std::string& group : {GroupOf(model.joint(joint).name), std::string("all")}) {
        groups_[group].first += error;
        groups_[group].second += 1;
      }
      largest_ = std::max(largest_, error);
    }
  }
}

void CentreErrors::Add(const CentreErrors& other) {
  for (const auto& [group, sum] : other.groups_) {
    groups_[group].first += sum.first;
    groups_[group].second += sum.second;
  }
}

std::map<std::string, double> CentreErrors::Means() const {
  std::map<std::string, double> means;
  for (const auto& [group, sum] : groups_) means[group] = sum.first / sum.second;
  return means;
}

void Damages::Add(const std::string& kind, int person, const std::string& what, double damage) {
  damages_[kind].push_back(damage);
  if (damage <= most_) return;
  std::printf("  person %d, %s, %s: %.0f mm\n", person, kind.c_str(), what.c_str(),
              kMillimetres * damage);
  std::fflush(stdout);
}

void Damages::Print() const {
  for (const auto& [kind, damages] : damages_) {
    const auto bad =
        std::count_if(damages.begin(), damages.end(), [&](double d) { return d > most_; });
    std::printf("%-36s beyond %.0f mm in %d of %d, worst %.0f mm", kind.c_str(),
                kMillimetres * most_, static_cast<int>(bad), static_cast<int>(damages.size()),
                kMillimetres * *std::max_element(damages.begin(), damages.end()));
    if (named_.count(kind) > 0) std::printf("; %d named", named_.at(kind));
    std::printf("\n");
  }
}

void RateRatios::Add(const PoseTrajectory& truth, const PoseTrajectory& estimate) {
  for (std::size_t j = 0; j < estimate.joint_names.size(); ++j) {
    const std::string& name = estimate.joint_names[j];
    const auto found = std::find(truth.joint_names.begin(), truth.joint_names.end(), name);
    if (found == truth.joint_names.end()) continue;
    const auto row = static_cast<Eigen::Index>(6 + j);
    const Eigen::Index true_row = 6 + (found - truth.joint_names.begin());
    Group& group = groups_[GroupOf(name)];
    group.velocity.Add(truth.velocities.row(true_row), estimate.velocities.row(row));
    group.acceleration.Add(truth.accelerations.row(true_row), estimate.accelerations.row(row));
  }
}

void RateRatios::Squares::Add(const Eigen::RowVectorXd& its, const Eigen::RowVectorXd& mine) {
  truth += its.squaredNorm();
  estimate += mine.squaredNorm();
  error += (mine - its).squaredNorm();
}

void RateRatios::Print(const std::string& title) const {
  std::printf("%s\n", title.c_str());
  const auto print = [](const char* what, const Squares& sums) {
    std::printf(" %s %.2f, error %.2f;", what, std::sqrt(sums.estimate / sums.truth),
                std::sqrt(sums.error / sums.truth));
  };
  for (const auto& [name, group] : groups_) {
    std::printf("  %-9s", name.c_str());
    print("velocity", group.velocity);
    print("acceleration", group.acceleration);
    std::printf("\n");
  }
}

}  // namespace mmm_converter::s2kf
