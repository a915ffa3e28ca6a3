// SPDX-License-Identifier: MIT
#include "common/pipeline/gait_forces.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "common/kinetics/foot_wrenches.h"
#include "common/motion/anatomical_angles.h"
#include "common/pipeline/conversion.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr const char* kPower = "power";

/// Between the frames beside each [1/s].
Eigen::RowVectorXd RateOf(const Eigen::RowVectorXd& values, double rate) {
  const Eigen::Index last = values.size() - 1;
  Eigen::RowVectorXd rates = Eigen::RowVectorXd::Zero(values.size());
  for (Eigen::Index k = 0; k <= last && last > 0; ++k) {
    const Eigen::Index before = std::max<Eigen::Index>(0, k - 1), after = std::min(k + 1, last);
    rates[k] = rate * (values[after] - values[before]) / static_cast<double>(after - before);
  }
  return rates;
}

/// The moment against the one that makes an angle grow.
const char* OppositeOf(std::string_view motion) {
  if (motion == "flexion") return "extension moment";
  if (motion == "dorsiflexion") return "plantar flexion moment";
  if (motion == "adduction") return "abduction moment";
  if (motion == "inversion") return "eversion moment";
  return motion == "internal rotation" ? "external rotation moment" : nullptr;
}

/// By the model's joints, as far as they are known.
Eigen::MatrixXd ByJoints(const KinematicModel& model, const JointForces& found) {
  Eigen::MatrixXd forces = Eigen::MatrixXd::Constant(model.num_joints(), found.num_frames(), kNaN);
  for (std::size_t i = 0; i < found.names.size(); ++i) {
    const int joint = model.FindJoint(found.names[i]);
    if (joint >= 0) forces.row(joint) = found.forces.row(static_cast<Eigen::Index>(i));
  }
  return forces;
}

/// In body weights; NaN: no plate measures it.
AnatomicalAngles VerticalForces(const ConversionReport& report, const GroundStudy& ground) {
  const PoseTrajectory& motion = report.result.trajectory;
  const FootWrenches feet = WrenchesOnFeet(
      ground.contacts, *ground.forces, {motion.rate, motion.first_time, motion.num_frames()}, 0);
  AnatomicalAngles rows;
  rows.rate = motion.rate;
  rows.first_time = motion.first_time;
  rows.values.resize(2, motion.num_frames());
  const double weight = KnownMass(report, ground) * kStandardGravity;
  for (const Side side : kSides) {
    rows.angles.push_back({"ground", Name(side), "vertical force"});
    const FootWrench& foot = feet[static_cast<std::size_t>(side)];
    for (int k = 0; k < motion.num_frames(); ++k) {
      rows.values(static_cast<Eigen::Index>(side), k) =
          foot.is_known[static_cast<std::size_t>(k)] ? foot.force(2, k) / weight : kNaN;
    }
  }
  return rows;
}

/// What the root would still need, for the strides of each foot.
AnatomicalAngles ResidualRows(const JointForces& found) {
  AnatomicalAngles rows;
  rows.rate = found.rate;
  rows.first_time = found.first_time;
  rows.values.resize(4, found.num_frames());
  for (const Side side : kSides) {
    rows.angles.push_back({"residual", Name(side), "force"});
    rows.angles.push_back({"residual", Name(side), "moment"});
  }
  for (Eigen::Index i = 0; i < rows.values.rows(); i += 2) {
    rows.values.row(i) =
        found.residuals.topRows<3>().colwise().norm() / (found.mass * kStandardGravity);
    rows.values.row(i + 1) = found.residuals.bottomRows<3>().colwise().norm() / found.mass;
  }
  return rows;
}

/// Moments and powers of muscles, by mass.
AnatomicalAngles LegMoments(const ConversionReport& report, const JointForces& found) {
  const KinematicModel& model = *report.plan.setup.model;
  const PoseTrajectory motion = TrackedMotion(report.result);
  const AnatomicalAngles angles =
      ComputeAnatomicalAngles(model, SmoothMotion(model, motion, found.cutoff));
  const Eigen::MatrixXd moments =
      AnatomicalMoments(model, motion, ByJoints(model, found)) / found.mass;
  AnatomicalAngles rows;
  rows.rate = motion.rate;
  rows.first_time = motion.first_time;
  const std::vector<HeldAxis> held_axes = FindHeldAxes(model);
  const Eigen::MatrixXd held = HeldMoments(model, motion, held_axes, found.held) / found.mass;
  rows.values.resize(2 * moments.rows() + held.rows(), moments.cols());
  const auto add = [&](const AnatomicalAngle& angle, const Eigen::RowVectorXd& values) {
    rows.values.row(static_cast<Eigen::Index>(rows.angles.size())) = values;
    rows.angles.push_back(angle);
  };
  for (std::size_t begin = 0, end = 0; begin < angles.angles.size(); begin = end) {
    const AnatomicalAngle& first = angles.angles[begin];
    Eigen::RowVectorXd power = Eigen::RowVectorXd::Zero(moments.cols());
    for (; end < angles.angles.size(); ++end) {
      const AnatomicalAngle& angle = angles.angles[end];
      if (std::string_view(angle.joint) != first.joint ||
          std::string_view(angle.side) != first.side) {
        break;
      }
      const auto row = static_cast<Eigen::Index>(end);
      power += moments.row(row).cwiseProduct(RateOf(angles.values.row(row), motion.rate));
      const char* name = OppositeOf(angle.motion);
      if (IsOfLeg(angle.joint) && name != nullptr) {
        add({angle.joint, angle.side, name}, -moments.row(row));
      }
    }
    for (std::size_t i = 0; i < held_axes.size(); ++i) {
      const AnatomicalAngle& angle = held_axes[i].angle;
      if (std::string_view(angle.joint) != first.joint ||
          std::string_view(angle.side) != first.side) {
        continue;
      }
      add({angle.joint, angle.side, OppositeOf(angle.motion)},
          -held.row(static_cast<Eigen::Index>(i)));
    }
    if (IsOfLeg(first.joint)) add({first.joint, first.side, kPower}, power);
  }
  rows.values.conservativeResize(static_cast<Eigen::Index>(rows.angles.size()), Eigen::NoChange);
  return rows;
}

/// What each leg's joints give and take in each stride in which their power is known, means.
std::vector<JointWork> WorkOf(const AnatomicalAngles& rows, const std::vector<Stride>& strides) {
  std::vector<JointWork> works;
  for (std::size_t i = 0; i < rows.angles.size(); ++i) {
    const AnatomicalAngle& angle = rows.angles[i];
    if (std::string_view(angle.motion) != kPower) continue;
    JointWork work = {angle.joint, angle.side};
    for (const Stride& stride : strides) {
      if (std::string_view(Name(stride.side)) != angle.side) continue;
      const auto frame = [&](double time) {
        return static_cast<Eigen::Index>(std::lround((time - rows.first_time) * rows.rate));
      };
      const Eigen::Index begin = std::max<Eigen::Index>(0, frame(stride.begin));
      const Eigen::Index end = std::min(frame(stride.end), rows.values.cols());
      if (end <= begin) continue;
      const auto power = rows.values.row(static_cast<Eigen::Index>(i)).segment(begin, end - begin);
      if (!power.allFinite()) continue;
      work.generated += power.cwiseMax(0).sum() / rows.rate;
      work.absorbed -= power.cwiseMin(0).sum() / rows.rate;
      ++work.strides;
    }
    if (work.strides == 0) continue;
    work.generated /= work.strides;
    work.absorbed /= work.strides;
    works.push_back(work);
  }
  return works;
}

/// Nothing: there are no plates, or the model has no mass.
std::optional<JointForces> FindJointForces(const ConversionReport& report,
                                           const GroundStudy& ground) {
  if (ground.forces->plates.empty() || !(report.plan.setup.model->total_mass() > 0)) return {};
  return ground.joint_forces ? *ground.joint_forces : JointForcesOf(report, ground, false);
}

}  // namespace

bool IsOfLeg(std::string_view joint) {
  return joint == "hip" || joint == "knee" || joint == "ankle";
}

std::optional<AnatomicalAngles> LegMomentsOf(const ConversionReport& report,
                                             const GroundStudy& ground) {
  const std::optional<JointForces> found = FindJointForces(report, ground);
  if (!found) return {};
  return LegMoments(report, *found);
}

void AddForces(const ConversionReport& report, const GroundStudy& ground, Gait* gait) {
  if (gait->strides.empty()) return;
  const std::optional<JointForces> found = FindJointForces(report, ground);
  if (!found) return;
  const AnatomicalAngles legs = LegMoments(report, *found);
  for (const AnatomicalAngles& rows :
       {VerticalForces(report, ground), legs, ResidualRows(*found)}) {
    const std::vector<GaitCycle> more = CyclesOf(rows, gait->strides);
    gait->forces.insert(gait->forces.end(), more.begin(), more.end());
  }
  gait->work = WorkOf(legs, gait->strides);
}

void AddEmg(const Emg& emg, Gait* gait) {
  AnatomicalAngles rows;
  rows.rate = emg.rate;
  rows.first_time = emg.first_time;
  rows.values = emg.envelopes;
  for (const EmgChannel& one : emg.channels) {
    rows.angles.push_back({one.muscle.c_str(), one.side.c_str(), "EMG"});
  }
  const std::vector<GaitCycle> cycles = CyclesOf(rows, gait->strides);
  gait->forces.insert(gait->forces.end(), cycles.begin(), cycles.end());
}

}  // namespace mmm_converter
