// SPDX-License-Identifier: MIT
#include "common/motion/anatomical_angles.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "common/math/rotation.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Of the three turns about the axes left, forward and along, the sign by which one grows; 0: none.
struct Sense {
  const char* motion;
  int turn;          ///< 0: about left, 1: about forward, 2: along
  double sign;       ///< of a right or a middle joint
  bool is_mirrored;  ///< the other sign on the left
};

struct Anatomy {
  const char* joint;
  // Segments of MMM's model and of OpenSim's, with | between other names; of the right side, or of
  // the middle.
  const char* mmm_proximal;  ///< empty: the laboratory
  const char* mmm_distal;
  const char* osim_proximal;
  const char* osim_distal;
  std::array<Sense, 3> senses;
  bool is_sided;
};

constexpr std::array<Sense, 3> kPelvis = {
    {{"tilt", 0, 1, false}, {"obliquity", 1, 1, false}, {"rotation", 2, 1, false}}};
constexpr std::array<Sense, 3> kSpine = {
    {{"flexion", 0, 1, false}, {"lateral bending", 1, 1, false}, {"rotation", 2, 1, false}}};
constexpr std::array<Sense, 3> kBall = {
    {{"flexion", 0, -1, false}, {"adduction", 1, 1, true}, {"internal rotation", 2, 1, true}}};
constexpr std::array<Sense, 3> kKnee = {
    {{"flexion", 0, 1, false}, {"adduction", 1, 1, true}, {"internal rotation", 2, 1, true}}};
constexpr std::array<Sense, 3> kAnkle = {
    {{"dorsiflexion", 0, -1, false}, {"inversion", 1, 1, true}, {"internal rotation", 2, 1, true}}};
constexpr std::array<Sense, 3> kElbow = {
    {{"flexion", 0, -1, false}, {"adduction", 1, 1, true}, {"pronation", 2, 1, true}}};
constexpr std::array<Sense, 3> kWrist = {{{"flexion", 1, 1, true},
                                          {"radial deviation", 0, -1, false},
                                          {"internal rotation", 2, 1, true}}};

constexpr Anatomy kAnatomy[] = {
    {"pelvis", "", "root_joint", "", "pelvis", kPelvis, false},
    {"trunk", "root_joint", "BTy_joint", "pelvis", "torso|thorax", kSpine, false},
    {"neck", "BTy_joint", "BUNy_joint", "torso|thorax", "head|skull|head_neck", kSpine, false},
    {"hip", "root_joint", "RHy_joint", "pelvis", "femur_r", kBall, true},
    {"knee", "RHy_joint", "RKx_joint", "femur_r", "tibia_r", kKnee, true},
    {"ankle", "RKx_joint", "RAy_joint", "tibia_r", "calcn_r|foot_r", kAnkle, true},
    {"shoulder", "BTy_joint", "RSy_joint", "torso|thorax", "humerus_r", kBall, true},
    {"elbow", "RSy_joint", "REz_joint", "humerus_r", "radius_r|ulna_r", kElbow, true},
    {"wrist", "REz_joint", "RWy_joint", "radius_r|ulna_r", "hand_r", kWrist, true}};

// Derivatives of angles by differences [rad], and the least one that makes it an angle of a joint.
constexpr double kStep = 1e-5;
constexpr double kLeastEffect = 0.3;

/// The segment of one of these names, with | between them; -1: the model has none.
int SegmentOf(const KinematicModel& model, std::string_view names, bool is_left) {
  const bool is_osim = model.coordinates() != nullptr;
  while (!names.empty()) {
    std::string name(names.substr(0, names.find('|')));
    names.remove_prefix(std::min(names.size(), name.size() + 1));
    if (is_left && is_osim && name.ends_with("_r")) name.back() = 'l';
    if (is_left && !is_osim && name.starts_with('R')) name.front() = 'L';
    const int segment = model.FindSegment(name);
    if (segment >= 0) return segment;
  }
  return -1;
}

/// Columns: forward, left, up of a person who stands in the posture that is all zero, W.
Matrix3d StandingAxes(const KinematicModel& model) {
  Matrix3d axes;
  if (model.coordinates()) {
    axes << Vector3d::UnitX(), -Vector3d::UnitZ(), Vector3d::UnitY();
    return model.coordinates()->R_WG() * axes;
  }
  axes << Vector3d::UnitY(), -Vector3d::UnitX(), Vector3d::UnitZ();
  return axes;
}

Posture StandingPosture(const KinematicModel& model) {
  if (!model.coordinates()) return ZeroPosture(model);
  const auto count = static_cast<Eigen::Index>(model.coordinates()->coordinates().size());
  return PostureOf(model, Eigen::VectorXd::Zero(count));
}

/// A joint angle by which a segment turns against another, and the segment that turns.
struct Turning {
  int segment = 0;
  int joint = 0;
};

/// What is computed of one joint of the body.
struct JointFrames {
  const Anatomy* anatomy = nullptr;
  bool is_left = false;
  int proximal = -1, distal = -1;  // -1: the laboratory
  Matrix3d R_PA = Matrix3d::Identity(), R_DA = Matrix3d::Identity();
  std::vector<Turning> turnings;
};

/// False: the one does not hang on the other.
bool AddTurnings(const KinematicModel& model, JointFrames* frames) {
  int at = frames->distal;
  for (; at >= 0 && at != frames->proximal; at = model.segments()[at].parent) {
    const Segment& segment = model.segments()[at];
    if (segment.type != JointType::kRevolute) continue;
    if (segment.joint >= 0) frames->turnings.push_back({at, segment.joint});
  }
  return at == frames->proximal;
}

std::vector<JointFrames> FindJointFrames(const KinematicModel& model) {
  const bool is_osim = model.coordinates() != nullptr;
  const Matrix3d R_WA = StandingAxes(model);
  const auto X_WS = SegmentPoses(model, StandingPosture(model));
  std::vector<JointFrames> found;
  for (const Anatomy& anatomy : kAnatomy) {
    for (const bool is_left : {true, false}) {
      if (is_left && !anatomy.is_sided) continue;
      const std::string_view proximal = is_osim ? anatomy.osim_proximal : anatomy.mmm_proximal;
      JointFrames one;
      one.anatomy = &anatomy;
      one.is_left = is_left;
      one.distal = SegmentOf(model, is_osim ? anatomy.osim_distal : anatomy.mmm_distal, is_left);
      one.proximal = SegmentOf(model, proximal, is_left);
      if (one.distal < 0 || (one.proximal < 0 && !proximal.empty())) continue;
      one.R_DA = X_WS[one.distal].linear().transpose() * R_WA;
      one.R_PA = R_WA;
      if (one.proximal >= 0) one.R_PA = X_WS[one.proximal].linear().transpose() * R_WA;
      if (one.proximal < 0 || AddTurnings(model, &one)) found.push_back(one);
    }
  }
  return found;
}

/// Turns about left, forward and along (axes y, x, z of R): R = Ry Rx Rz; of the laboratory's child
/// R = Rz Rx Ry. Both are MMM's Rz Ry Rx in other axes.
Vector3d TurnsOf(const Matrix3d& R, bool is_of_laboratory) {
  Matrix3d axes;
  if (is_of_laboratory) {
    axes << 0, 1, 0, 1, 0, 0, 0, 0, 1;  // left-handed: angles change their sign
    const Vector3d rpy = RpyFromRotation(axes * R * axes.transpose());
    return -rpy;
  }
  axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  return RpyFromRotation(axes * R * axes.transpose()).reverse();
}

Matrix3d Against(const JointFrames& joint, const std::vector<Eigen::Isometry3d>& X_WS) {
  const Matrix3d R_WD = X_WS[joint.distal].linear() * joint.R_DA;
  if (joint.proximal < 0) return joint.R_PA.transpose() * R_WD;
  return (X_WS[joint.proximal].linear() * joint.R_PA).transpose() * R_WD;
}

/// d turns by a turn of the distal segment about w (axes of the proximal one).
Vector3d Derivative(const Matrix3d& R, const Vector3d& w, bool is_of_laboratory) {
  const Vector3d after = TurnsOf(Exp(kStep * w).toRotationMatrix() * R, is_of_laboratory);
  const Vector3d before = TurnsOf(Exp(-kStep * w).toRotationMatrix() * R, is_of_laboratory);
  Vector3d change = after - before;
  for (double& angle : change) angle = std::remainder(angle, 2 * std::numbers::pi);
  return change / (2 * kStep);
}

/// By each joint angle, a column; of the laboratory's child by the root's turns about its own axes.
Eigen::Matrix3Xd DerivativesOf(const KinematicModel& model, const JointFrames& joint,
                               const Posture& posture, const std::vector<Eigen::Isometry3d>& X_WS,
                               std::vector<int>* columns) {
  const Matrix3d R = Against(joint, X_WS);
  columns->clear();
  Eigen::Matrix3Xd derivatives;
  if (joint.proximal < 0) {
    derivatives.resize(3, 3);
    for (int i = 0; i < 3; ++i) {
      const Vector3d w = joint.R_PA.transpose() * X_WS[0].linear().col(i);
      derivatives.col(i) = Derivative(R, w, true);
      columns->push_back(3 + i);
    }
    return derivatives;
  }
  const Matrix3d R_AW = (X_WS[joint.proximal].linear() * joint.R_PA).transpose();
  derivatives.setZero(3, static_cast<Eigen::Index>(joint.turnings.size()));
  for (const Turning& one : joint.turnings) {
    const Segment& segment = model.segments()[one.segment];
    double slope = 1;
    if (segment.function) segment.function->Value(posture.joint_angles[one.joint], &slope);
    const Vector3d w = R_AW * X_WS[one.segment].linear() * segment.axis;
    const int column = 6 + one.joint;
    const auto known = std::find(columns->begin(), columns->end(), column);
    const auto at = known - columns->begin();
    if (known == columns->end()) columns->push_back(column);
    derivatives.col(at) += slope * Derivative(R, w, false);
  }
  return derivatives.leftCols(static_cast<Eigen::Index>(columns->size())).eval();
}

/// An angle that the model has, and of which turn it is made.
struct Row {
  int joint = 0;  // of JointFrames
  Sense sense;
  double sign = 1;
  std::vector<int> joints;  // of the model, that change it
};

std::vector<Row> RowsOf(const KinematicModel& model, const std::vector<JointFrames>& joints) {
  const Posture standing = StandingPosture(model);
  const auto X_WS = SegmentPoses(model, standing);
  std::vector<Row> rows;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    std::vector<int> columns;
    const Eigen::Matrix3Xd effects = DerivativesOf(model, joints[j], standing, X_WS, &columns);
    for (const Sense& sense : joints[j].anatomy->senses) {
      if (effects.cols() == 0) continue;
      if (effects.row(sense.turn).cwiseAbs().maxCoeff() < kLeastEffect) continue;
      const double side = sense.is_mirrored && joints[j].is_left ? -1 : 1;
      Row row{static_cast<int>(j), sense, side * sense.sign, {}};
      for (std::size_t i = 0; i < columns.size() && joints[j].proximal >= 0; ++i) {
        const double effect = effects(sense.turn, static_cast<Eigen::Index>(i));
        if (std::abs(effect) >= kLeastEffect) row.joints.push_back(columns[i] - 6);
      }
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

/// Ry(a) Rx(b) Rz(c) is Ry(a + pi) Rx(pi - b) Rz(c + pi) too, and near b of 90 degrees one runs
/// into the other. Between these times the angles of a joint are those that are nearest 0, as a
/// whole: an arm that hangs after it was raised to the side hangs at 0.
void ChooseTurns(Eigen::Matrix3Xd* turns) {
  constexpr double kClear = 0.26;  // the cosine: 15 degrees from there
  const Eigen::Index frames = turns->cols();
  const auto is_clear = [&](Eigen::Index k) { return std::abs(std::cos((*turns)(1, k))) > kClear; };
  // The same turns, as a whole nearest 0.
  const auto nearest = [](Eigen::Matrix3Xd run) {
    for (auto row : run.rowwise()) {
      row.array() -= 2 * std::numbers::pi * std::round(row.mean() / (2 * std::numbers::pi));
    }
    return run;
  };
  for (Eigen::Index begin = 0, end = 0; begin < frames; begin = end) {
    end = begin + 1;
    if (!is_clear(begin)) continue;
    while (end < frames && is_clear(end)) ++end;
    auto run = turns->middleCols(begin, end - begin);
    Eigen::Matrix3Xd other = run;
    other.row(1) *= -1;
    other.array() += std::numbers::pi;
    const Eigen::Matrix3Xd one = nearest(run);
    other = nearest(std::move(other));
    run = other.cwiseAbs().sum() < one.cwiseAbs().sum() ? other : one;
  }
  for (Eigen::Index k = 1; k < frames; ++k) {
    if (!is_clear(k)) turns->col(k) = ContinuousRpy(turns->col(k), turns->col(k - 1));
  }
}

/// The errors of a motion, by [6; joints of the model].
class ErrorsOfModel {
 public:
  ErrorsOfModel(const KinematicModel& model, const PoseTrajectory& motion) : motion_(motion) {
    of_motion_.assign(6 + static_cast<std::size_t>(model.num_joints()), -1);
    for (int i = 0; i < 6; ++i) of_motion_[static_cast<std::size_t>(i)] = i;
    for (std::size_t i = 0; i < motion.joint_names.size(); ++i) {
      const int joint = model.FindJoint(motion.joint_names[i]);
      if (joint >= 0) of_motion_[6 + static_cast<std::size_t>(joint)] = 6 + static_cast<int>(i);
    }
  }

  /// Standard deviations of what changes with these by D. Frames are asked for in their order.
  Vector3d SpreadOf(const Eigen::Matrix3Xd& D, const std::vector<int>& columns, int k) {
    const auto& all = motion_.correlations;
    while (at_ + 1 < all.size() && all[at_ + 1].time <= motion_.time(k)) ++at_;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const int row = of_motion_[static_cast<std::size_t>(columns[i])];
      if (row < 0) continue;
      const Vector3d own =
          D.col(static_cast<Eigen::Index>(i)) * motion_.standard_deviations(row, k);
      covariance += own * own.transpose();
      for (std::size_t j = 0; j < i && !all.empty(); ++j) {
        const int other = of_motion_[static_cast<std::size_t>(columns[j])];
        if (other < 0) continue;
        const Eigen::Matrix3d both = all[at_].correlation(row, other) *
                                     motion_.standard_deviations(other, k) * own *
                                     D.col(static_cast<Eigen::Index>(j)).transpose();
        covariance += both + both.transpose();
      }
    }
    return covariance.diagonal().cwiseMax(0).cwiseSqrt();
  }

 private:
  const PoseTrajectory& motion_;
  std::vector<int> of_motion_;  // rows of its deviations; -1: it does not have this joint
  std::size_t at_ = 0;          // of its correlations
};

}  // namespace

bool HasAnatomy(const KinematicModel& model) {
  const auto joints = FindJointFrames(model);
  return std::any_of(joints.begin(), joints.end(),
                     [](const JointFrames& one) { return one.proximal >= 0; });
}

AnatomicalAngles ComputeAnatomicalAngles(const KinematicModel& model,
                                         const PoseTrajectory& motion) {
  if (!HasAnatomy(model)) {
    throw Error(
        "joint angles by their anatomical names need the segments of MMM's or OpenSim's models of "
        "persons, which this one does not have");
  }
  const std::vector<JointFrames> joints = FindJointFrames(model);
  const std::vector<Row> rows = RowsOf(model, joints);
  AnatomicalAngles angles;
  angles.rate = motion.rate;
  angles.first_time = motion.first_time;
  angles.forward = StandingAxes(model).col(0).head<2>();
  for (const Row& row : rows) {
    const JointFrames& joint = joints[row.joint];
    const char* side = joint.is_left ? "left" : "right";
    angles.angles.push_back(
        {joint.anatomy->joint, joint.anatomy->is_sided ? side : "", row.sense.motion});
    angles.joints.push_back(row.joints);
  }
  const bool has_deviations = motion.standard_deviations.size() > 0;
  const auto count = static_cast<Eigen::Index>(rows.size());
  angles.values.resize(count, motion.num_frames());
  if (has_deviations) angles.deviations.resize(count, motion.num_frames());
  ErrorsOfModel errors(model, motion);
  std::vector<Eigen::Matrix3Xd> turns(joints.size(), Eigen::Matrix3Xd(3, motion.num_frames()));
  std::vector<Vector3d> spreads(joints.size(), Vector3d::Zero());
  std::vector<int> columns;
  for (int k = 0; k < motion.num_frames(); ++k) {
    const Posture posture = ModelPosture(model, motion, k);
    const auto X_WS = SegmentPoses(model, posture);
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const Vector3d before = k == 0 ? Vector3d::Zero() : Vector3d(turns[j].col(k - 1));
      turns[j].col(k) =
          ContinuousRpy(TurnsOf(Against(joints[j], X_WS), joints[j].proximal < 0), before);
      if (!has_deviations) continue;
      const auto D = DerivativesOf(model, joints[j], posture, X_WS, &columns);
      spreads[j] = errors.SpreadOf(D, columns, k);
    }
    for (Eigen::Index i = 0; has_deviations && i < count; ++i) {
      const Row& row = rows[static_cast<std::size_t>(i)];
      angles.deviations(i, k) = spreads[row.joint][row.sense.turn];
    }
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].proximal >= 0) ChooseTurns(&turns[j]);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const Row& row = rows[static_cast<std::size_t>(i)];
    angles.values.row(i) = row.sign * turns[row.joint].row(row.sense.turn);
  }
  return angles;
}

AnatomicalAngles SomeOf(const AnatomicalAngles& angles, const std::vector<Eigen::Index>& rows) {
  AnatomicalAngles some;
  some.rate = angles.rate;
  some.first_time = angles.first_time;
  some.forward = angles.forward;
  for (const Eigen::Index row : rows) {
    some.angles.push_back(angles.angles[static_cast<std::size_t>(row)]);
    some.joints.push_back(angles.joints[static_cast<std::size_t>(row)]);
  }
  some.values = angles.values(rows, Eigen::all);
  if (angles.deviations.size() > 0) some.deviations = angles.deviations(rows, Eigen::all);
  return some;
}

Eigen::MatrixXd AnatomicalMoments(const KinematicModel& model, const PoseTrajectory& motion,
                                  const Eigen::MatrixXd& joint_forces) {
  const std::vector<JointFrames> joints = FindJointFrames(model);
  const std::vector<Row> rows = RowsOf(model, joints);
  Eigen::MatrixXd moments =
      Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(rows.size()), motion.num_frames(), kNaN);
  std::vector<int> columns;
  for (int k = 0; k < motion.num_frames(); ++k) {
    const Posture posture = ModelPosture(model, motion, k);
    const auto X_WS = SegmentPoses(model, posture);
    for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
      const JointFrames& joint = joints[rows[begin].joint];
      while (end < rows.size() && rows[end].joint == rows[begin].joint) ++end;
      if (joint.proximal < 0) continue;
      const auto D = DerivativesOf(model, joint, posture, X_WS, &columns);
      const auto count = static_cast<Eigen::Index>(end - begin);
      Eigen::MatrixXd transposed(D.cols(), count);  // d angles / d joints
      Eigen::VectorXd forces(D.cols());
      for (Eigen::Index i = 0; i < D.cols(); ++i) {
        forces[i] = joint_forces(columns[static_cast<std::size_t>(i)] - 6, k);
        for (Eigen::Index r = 0; r < count; ++r) {
          const Row& row = rows[begin + static_cast<std::size_t>(r)];
          transposed(i, r) = row.sign * D(row.sense.turn, i);
        }
      }
      if (!forces.allFinite()) continue;
      moments.block(static_cast<Eigen::Index>(begin), k, count, 1) =
          transposed.colPivHouseholderQr().solve(forces);
    }
  }
  return moments;
}

std::vector<HeldAxis> FindHeldAxes(const KinematicModel& model) {
  const std::vector<JointFrames> joints = FindJointFrames(model);
  const std::vector<Row> rows = RowsOf(model, joints);
  std::vector<HeldAxis> held;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const JointFrames& joint = joints[j];
    if (std::string_view(joint.anatomy->joint) != "knee") continue;
    for (const Sense& sense : joint.anatomy->senses) {
      const bool turns = std::any_of(rows.begin(), rows.end(), [&](const Row& row) {
        return row.joint == static_cast<int>(j) && row.sense.turn == sense.turn;
      });
      if (turns) continue;
      // Columns of the axes are forward, left and up; turns are about left, forward and along.
      constexpr std::array<int, 3> kColumns = {1, 0, 2};
      const double side = sense.is_mirrored && joint.is_left ? -1 : 1;
      held.push_back({{joint.anatomy->joint, joint.is_left ? "left" : "right", sense.motion},
                      joint.distal,
                      side * sense.sign * joint.R_DA.col(kColumns[sense.turn])});
    }
  }
  return held;
}

Eigen::MatrixXd HeldMoments(const KinematicModel& model, const PoseTrajectory& motion,
                            const std::vector<HeldAxis>& axes,
                            const std::vector<Eigen::Matrix3Xd>& held) {
  Eigen::MatrixXd moments(static_cast<Eigen::Index>(axes.size()), motion.num_frames());
  for (int k = 0; k < motion.num_frames(); ++k) {
    const auto X_WS = SegmentPoses(model, ModelPosture(model, motion, k));
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const Vector3d axis =
          X_WS[static_cast<std::size_t>(axes[i].segment)].linear() * axes[i].axis_S;
      moments(static_cast<Eigen::Index>(i), k) = axis.dot(held[i].col(k));
    }
  }
  return moments;
}

}  // namespace mmm_converter
