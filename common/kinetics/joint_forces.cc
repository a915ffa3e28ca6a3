// SPDX-License-Identifier: MIT
#include "common/kinetics/joint_forces.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/kinetics/inverse_dynamics.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/foot_motion.h"
#include "common/motion/low_pass.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/spline_derivatives.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kCarried = 0.25;  // of the weight: residuals of walks are below a tenth
constexpr double kLoaded = 20;     // [N] of a foot on a plate

/// By joint: whether the foot hangs on it, or it on the foot, which touches with all that it has.
std::vector<bool> JointsOfFoot(const KinematicModel& model, int foot) {
  const std::vector<Segment>& segments = model.segments();
  std::vector<bool> is_of(model.num_joints(), false);
  const auto mark = [&](int segment) {
    if (segments[segment].joint >= 0) is_of[segments[segment].joint] = true;
  };
  int top = foot;  // of the foot's own segments, which no joint moves
  while (segments[top].joint < 0 && segments[top].parent > 0) top = segments[top].parent;
  for (int i = foot; i > 0; i = segments[i].parent) mark(i);
  for (int i = 0; i < static_cast<int>(segments.size()); ++i) {
    if (top > 0 && model.IsBelow(i, top)) mark(i);
  }
  return is_of;
}

/// What the columns are, and which joint each is of; -1: of the root.
class Columns {
 public:
  Columns(const KinematicModel& model, JointForces* found) {
    for (const Side side : kSides) legs_.push_back(JointsOfFoot(model, FootSegment(model, side)));
    if (!model.coordinates()) {
      for (int j = 0; j < model.num_joints(); ++j) {
        Add(model.joint(j).name, j, model.joint(j).type != JointType::kSliding, found);
      }
      return;
    }
    for (const ModelCoordinate& one : model.coordinates()->coordinates()) {
      const int joint = one.root >= 0 ? -1 : model.FindJoint(one.name);
      Add(one.name, joint, one.kind == ModelCoordinate::Kind::kTurn, found);
    }
  }

  int joint(std::size_t column) const { return joints_[column]; }

  bool IsKnown(int joint, int frame, const FootWrenches& feet) const {
    for (std::size_t side = 0; side < feet.size(); ++side) {
      if (IsOfLeg(joint, side) && !feet[side].is_known[static_cast<std::size_t>(frame)]) {
        return false;
      }
    }
    return true;
  }

 private:
  void Add(const std::string& name, int joint, bool is_moment, JointForces* found) {
    joints_.push_back(joint);
    found->names.push_back(name);
    found->is_moment.push_back(is_moment);
    found->is_of_leg.push_back(joint >= 0 && (IsOfLeg(joint, 0) || IsOfLeg(joint, 1)));
  }

  /// The root carries both.
  bool IsOfLeg(int joint, std::size_t side) const { return joint < 0 || legs_[side][joint]; }

  std::vector<int> joints_;
  std::vector<std::vector<bool>> legs_;
};

/// Frames in which the ground carries the body by a foot that was taken for lifted: where more than
/// a part of the weight is missing, the feet without plates are not known. Returns how many frames.
int LeaveOutUnmeasured(const std::vector<VectorXd>& forces, double mass, int reach,
                       FootWrenches* feet) {
  const int frames = static_cast<int>(forces.size());
  int count = 0;
  std::array<std::vector<bool>, 2> is_known = {(*feet)[0].is_known, (*feet)[1].is_known};
  for (int k = 0; k < frames; ++k) {
    if (forces[k][2] < kCarried * mass * kStandardGravity) continue;
    bool is_unmeasured = false;
    for (std::size_t side = 0; side < feet->size(); ++side) {
      const FootWrench& foot = (*feet)[side];
      if (!foot.is_known[k] || foot.force.col(k).norm() > kLoaded) continue;
      is_unmeasured = true;
      for (int i = std::max(0, k - reach); i <= std::min(frames - 1, k + reach); ++i) {
        is_known[side][i] = false;
      }
    }
    if (is_unmeasured) ++count;
  }
  for (std::size_t side = 0; side < feet->size(); ++side) (*feet)[side].is_known = is_known[side];
  return count;
}

}  // namespace

PoseTrajectory SmoothMotion(const KinematicModel& model, const PoseTrajectory& motion,
                            double cutoff) {
  PoseTrajectory whole;
  whole.rate = motion.rate;
  whole.first_time = motion.first_time;
  for (int j = 0; j < model.num_joints(); ++j) whole.joint_names.push_back(model.joint(j).name);
  for (int k = 0; k < motion.num_frames(); ++k) {
    whole.postures.push_back(ModelPosture(model, motion, k));
  }
  if (cutoff > 0) whole = LowPassed(whole, cutoff);
  DifferentiateSplines(&whole);
  return whole;
}

std::vector<BodyWrench> WrenchesAt(int frame, const KinematicModel& model,
                                   const FootWrenches& feet) {
  std::vector<BodyWrench> wrenches;
  for (const Side side : kSides) {
    const FootWrench& foot = feet[static_cast<std::size_t>(side)];
    wrenches.push_back({FootSegment(model, side), foot.force.col(frame), foot.moment.col(frame)});
  }
  return wrenches;
}

JointForces ComputeJointForces(const KinematicModel& model, const PoseTrajectory& motion,
                               const Contacts& contacts, const RecordedForces& forces,
                               const JointForcesOptions& options) {
  JointForces found;
  found.mass = model.total_mass();
  if (!(found.mass > 0)) throw Error(model.name() + ": has no masses, hence no dynamics");
  found.rate = motion.rate;
  found.first_time = motion.first_time;
  found.cutoff = std::min(options.cutoff, LargestCutoff(motion.rate));
  const int frames = motion.num_frames();
  const PoseTrajectory smooth = SmoothMotion(model, motion, found.cutoff);
  FootWrenches feet =
      WrenchesOnFeet(contacts, forces, {motion.rate, motion.first_time, frames}, found.cutoff);
  const Columns columns(model, &found);
  found.forces.setConstant(static_cast<Index>(found.names.size()), frames, kNaN);
  found.residuals.setConstant(6, frames, kNaN);
  found.external = feet[0].force + feet[1].force;
  const int unsettled =
      found.cutoff > 0 ? static_cast<int>(std::ceil(motion.rate / found.cutoff)) : 0;
  std::optional<CoordinateSeries> coordinates;
  if (model.coordinates()) coordinates.emplace(model);
  const std::array<int, 2> feet_of_model = {FootSegment(model, Side::kLeft),
                                            FootSegment(model, Side::kRight)};
  double lowest = HUGE_VAL;
  std::vector<VectorXd> all(frames);
  std::vector<VectorXd> of_columns(frames);
  std::vector<Eigen::Vector3d> carried;
  found.held.assign(options.holding.size(), Eigen::Matrix3Xd(3, frames));
  for (int k = 0; k < frames; ++k) {
    const Posture& posture = smooth.postures[k];
    const VectorXd values = coordinates ? coordinates->Next(posture) : VectorXd();
    found.height += CenterOfMass(model, posture).z() / frames;
    const auto X_WS = SegmentPoses(model, posture);
    for (const int foot : feet_of_model) lowest = std::min(lowest, X_WS[foot].translation().z());
    all[k] = InverseDynamics(model, posture, smooth.velocities.col(k), smooth.accelerations.col(k),
                             WrenchesAt(k, model, feet), kStandardGravity,
                             options.holding.empty() ? nullptr : &carried);
    for (std::size_t i = 0; i < options.holding.size(); ++i) {
      found.held[i].col(k) = carried[options.holding[i]];
    }
    of_columns[k] = coordinates ? ForcesOfCoordinates(model, posture, values, all[k])
                                : VectorXd(all[k].tail(model.num_joints()));
  }
  found.unmeasured_frames = LeaveOutUnmeasured(all, found.mass, unsettled, &feet);
  for (int k = unsettled; k < frames - unsettled; ++k) {
    if (feet[0].is_known[k] && feet[1].is_known[k]) found.residuals.col(k) = all[k].head<6>();
    for (std::size_t i = 0; i < found.names.size(); ++i) {
      const auto row = static_cast<Index>(i);
      if (columns.IsKnown(columns.joint(i), k, feet)) found.forces(row, k) = of_columns[k][row];
    }
  }
  for (std::size_t i = 0; i < options.holding.size(); ++i) {
    const int joint = model.segments()[options.holding[i]].joint;
    for (int k = 0; k < frames; ++k) {
      const bool is_settled = k >= unsettled && k < frames - unsettled;
      if (!is_settled || !columns.IsKnown(joint, k, feet)) found.held[i].col(k).setConstant(kNaN);
    }
  }
  found.height -= lowest;
  return found;
}

Residuals MeasureResiduals(const JointForces& found) {
  Residuals all;
  const auto add = [](double size, ResidualSize* to) {
    to->rms += size * size;
    to->peak = std::max(to->peak, size);
  };
  for (Index k = 0; k < found.residuals.cols(); ++k) {
    const VectorXd one = found.residuals.col(k);
    if (!one.allFinite()) continue;
    ++all.frames;
    add(one.head<3>().norm(), &all.force);
    add(one.tail<3>().norm(), &all.moment);
    for (Index i = 0; i < 6; ++i)
      add(std::abs(one[i]), &all.components[static_cast<std::size_t>(i)]);
    all.external = std::max(all.external, found.external.col(k).norm());
  }
  const auto end = [&all](ResidualSize* of) {
    of->rms = std::sqrt(of->rms / std::max(all.frames, 1));
  };
  end(&all.force);
  end(&all.moment);
  for (ResidualSize& one : all.components) end(&one);
  all.most_force = kMostResidualForce * all.external;
  all.most_moment = kMostResidualMoment * all.external * found.height;
  all.is_within =
      all.frames > 0 && all.force.peak <= all.most_force && all.moment.peak <= all.most_moment;
  return all;
}

}  // namespace mmm_converter
