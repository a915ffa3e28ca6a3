// SPDX-License-Identifier: MIT
#include "common/io/tables/bvh_writer.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/io/tables/column_names.h"
#include "common/io/xml/xml_text.h"
#include "common/math/rotation.h"
#include "common/math/up_axis.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kCentimetres = 100;  // in a metre
constexpr int kCentimetreDecimals = 6;
constexpr int kOffsetDecimals = 8;
constexpr int kBvhDegreeDecimals = 6;
constexpr double kSamePlace = 1e-9;    // [m]
constexpr double kShortestEnd = 1e-3;  // of an end that is worth showing [m]
constexpr double kStump = 0.05;        // of a limb whose end is not known [m]

// The MMM model's joints as programs for characters call them.
constexpr std::pair<const char*, const char*> kBvhNames[] = {
    {"BP", "Spine"},          {"BT", "Spine1"},          {"BLN", "Neck"},
    {"BUN", "Head"},          {"LSC", "LeftShoulder"},   {"RSC", "RightShoulder"},
    {"LS", "LeftArm"},        {"RS", "RightArm"},        {"LE", "LeftForeArm"},
    {"RE", "RightForeArm"},   {"LW", "LeftHand"},        {"RW", "RightHand"},
    {"LH", "LeftUpLeg"},      {"RH", "RightUpLeg"},      {"LK", "LeftLeg"},
    {"RK", "RightLeg"},       {"LA", "LeftFoot"},        {"RA", "RightFoot"},
    {"LMrot", "LeftMidFoot"}, {"RMrot", "RightMidFoot"}, {"LF", "LeftToeBase"},
    {"RF", "RightToeBase"}};

// "LSx_joint" is "LS".
std::string JointStem(const std::string& segment) {
  constexpr std::string_view kEnding = "_joint";
  std::string stem = segment;
  if (stem.ends_with(kEnding)) stem.resize(stem.size() - kEnding.size());
  const bool has_axis = stem.size() > 1 && stem.back() >= 'x' && stem.back() <= 'z' &&
                        stem[stem.size() - 2] >= 'A' && stem[stem.size() - 2] <= 'Z';
  if (has_axis) stem.pop_back();
  return stem;
}

// nullptr: it has no other name.
const char* CharacterName(const std::string& stem) {
  for (const auto& [joint, name] : kBvhNames) {
    if (stem == joint) return name;
  }
  return nullptr;
}

struct BvhJoint {
  std::string name;
  int parent = -1;
  int segment = 0;                    // that turns with it
  Vector3d place = Vector3d::Zero();  // at rest, W [m]
  Vector3d end = Vector3d::Zero();    // of a joint without children: its End Site, likewise
  std::vector<int> children;
};

class BvhSkeleton {
 public:
  BvhSkeleton(const KinematicModel& model, const PoseTrajectory& trajectory, BvhUnit unit)
      : model_(model), unit_(unit) {
    Posture rest = ZeroPosture(model);
    rest.joint_angles.setZero();
    rest_ = SegmentPoses(model, rest);
    std::vector<bool> moves(model.segments().size());
    for (const std::string& name : trajectory.joint_names) {
      const int joint = model.FindJoint(name);
      if (joint >= 0) moves[model.joint_segment(joint)] = true;
    }
    AddJoints(moves);
    FindEnds();
    GiveNames();
  }

  const std::vector<BvhJoint>& joints() const { return joints_; }
  const std::vector<Isometry3d>& rest() const { return rest_; }

  /// A vector of the world in the file's axes and unit.
  Vector3d InFile(const Vector3d& p_W) const {
    return (unit_ == BvhUnit::kMetres ? 1 : kCentimetres) *
           (RotationToZUp(UpAxis::kY).transpose() * p_W);
  }

  int decimals() const { return unit_ == BvhUnit::kMetres ? kOffsetDecimals : kCentimetreDecimals; }

  Vector3d Offset(const BvhJoint& joint) const {
    return joint.parent < 0 ? Vector3d::Zero().eval() : joint.place - joints_[joint.parent].place;
  }

 private:
  bool IsShown(std::size_t segment, const std::vector<bool>& moves) const {
    const Segment& one = model_.segments()[segment];
    return moves[segment] || (one.joint >= 0 && CharacterName(JointStem(one.name)) != nullptr);
  }

  void AddJoints(const std::vector<bool>& moves) {
    std::vector<int> children(model_.segments().size());
    for (const Segment& segment : model_.segments()) {
      if (segment.parent >= 0) ++children[segment.parent];
    }
    joints_.push_back({"Hips", -1, 0, rest_[0].translation(), {}, {}});
    joint_of_.assign(model_.segments().size(), 0);
    for (std::size_t i = 1; i < rest_.size(); ++i) {
      const int parent = model_.segments()[i].parent;
      const int above = joint_of_[parent];
      joint_of_[i] = above;
      if (!IsShown(i, moves)) continue;
      const Vector3d place = rest_[i].translation();
      const bool goes_on = above > 0 && joints_[above].segment == parent && children[parent] == 1 &&
                           (place - joints_[above].place).norm() < kSamePlace;
      if (goes_on) {
        joints_[above].segment = static_cast<int>(i);
        continue;
      }
      joint_of_[i] = static_cast<int>(joints_.size());
      joints_[above].children.push_back(joint_of_[i]);
      joints_.push_back(
          {JointStem(model_.segments()[i].name), above, static_cast<int>(i), place, {}, {}});
    }
  }

  void FindEnds() {
    for (BvhJoint& joint : joints_) joint.end = joint.place;
    const auto extend = [this](int segment, const Vector3d& to) {
      BvhJoint& joint = joints_[joint_of_[segment]];
      if ((to - joint.place).norm() > (joint.end - joint.place).norm()) joint.end = to;
    };
    for (std::size_t i = 0; i < rest_.size(); ++i) {
      extend(static_cast<int>(i), rest_[i].translation());
    }
    const std::vector<BvhJoint> by_segments = joints_;
    for (const ModelMarker& marker : model_.markers()) {
      const BvhJoint& joint = by_segments[joint_of_[marker.segment]];
      if ((joint.end - joint.place).norm() > kShortestEnd) continue;
      extend(marker.segment, rest_[marker.segment] * marker.p_SM);
    }
    for (BvhJoint& joint : joints_) {
      if ((joint.end - joint.place).norm() > kShortestEnd) continue;
      const Vector3d along = Offset(joint);
      joint.end = joint.place + kStump * (along.norm() > kShortestEnd ? along.normalized()
                                                                      : Vector3d::UnitZ().eval());
    }
  }

  void GiveNames() {
    std::vector<std::string> names;
    for (const BvhJoint& joint : joints_) {
      const char* known = CharacterName(joint.name);
      names.push_back(known != nullptr ? known : joint.name);
    }
    names = ColumnNames(names);
    for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i].name = names[i];
  }

  const KinematicModel& model_;
  BvhUnit unit_;
  std::vector<Isometry3d> rest_;  // of all segments
  std::vector<BvhJoint> joints_;  // parents first
  std::vector<int> joint_of_;     // of each segment
};

void AppendTriple(const Vector3d& values, int decimals, std::string* out) {
  for (const double value : values) {
    *out += ' ';
    AppendDecimal(value, decimals, out);
  }
}

// The joint with all below it, and in which order frames have them.
void AppendHierarchy(const BvhSkeleton& skeleton, int index, int depth, std::string* out,
                     std::vector<int>* order) {
  const BvhJoint& joint = skeleton.joints()[index];
  const std::string indent(depth, '\t');
  order->push_back(index);
  *out += fmt::format("{}{} {}\n{}{{\n{}\tOFFSET", indent, depth == 0 ? "ROOT" : "JOINT",
                      joint.name, indent, indent);
  AppendTriple(skeleton.InFile(skeleton.Offset(joint)), skeleton.decimals(), out);
  *out += fmt::format("\n{}\tCHANNELS {}Zrotation Xrotation Yrotation\n", indent,
                      depth == 0 ? "6 Xposition Yposition Zposition " : "3 ");
  for (const int child : joint.children) {
    AppendHierarchy(skeleton, child, depth + 1, out, order);
  }
  if (joint.children.empty()) {
    *out += fmt::format("{}\tEnd Site\n{}\t{{\n{}\t\tOFFSET", indent, indent, indent);
    AppendTriple(skeleton.InFile(joint.end - joint.place), skeleton.decimals(), out);
    *out += fmt::format("\n{}\t}}\n", indent);
  }
  *out += indent + "}\n";
}

// Roll, pitch and yaw of a rotation with x and y exchanged are the negative angles about y, x and z
// of Rz Rx Ry.
Vector3d ExchangedRpy(const Eigen::Matrix3d& R) {
  const Eigen::PermutationMatrix<3> exchange(Eigen::Vector3i(1, 0, 2));
  return RpyFromRotation(exchange * R * exchange);
}

void AppendFrames(const KinematicModel& model, const PoseTrajectory& trajectory,
                  const BvhSkeleton& skeleton, const std::vector<int>& order, PieceWriter* pieces) {
  const std::vector<BvhJoint>& joints = skeleton.joints();
  const Eigen::Matrix3d to_y_up = RotationToZUp(UpAxis::kY).transpose();
  std::vector<Vector3d> rpy(joints.size(), Vector3d::Zero());
  std::vector<Eigen::Matrix3d> R(joints.size());  // from rest, axes of the file
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const std::vector<Isometry3d> X_WS = SegmentPoses(model, ModelPosture(model, trajectory, k));
    std::string frame;
    AppendTriple(skeleton.InFile(X_WS[0].translation()), skeleton.decimals(), &frame);
    for (const int j : order) {
      const BvhJoint& joint = joints[j];
      const Eigen::Matrix3d turn =
          X_WS[joint.segment].linear() * skeleton.rest()[joint.segment].linear().transpose();
      R[j] = to_y_up * turn * to_y_up.transpose();
      const Eigen::Matrix3d local =
          joint.parent < 0 ? R[j] : Eigen::Matrix3d(R[joint.parent].transpose() * R[j]);
      rpy[j] = k == 0 ? ExchangedRpy(local) : ContinuousRpy(ExchangedRpy(local), rpy[j]);
      AppendTriple(-kDegrees * Vector3d(rpy[j].z(), rpy[j].y(), rpy[j].x()), kBvhDegreeDecimals,
                   &frame);
    }
    *pieces->text() += frame.substr(1) + "\n";
    pieces->EndPart();
  }
}

}  // namespace

TextPieces FormatBvh(const KinematicModel& model, const PoseTrajectory& trajectory, BvhUnit unit) {
  const auto skeleton = std::make_shared<const BvhSkeleton>(model, trajectory, unit);
  return [&model, &trajectory, skeleton](const TextSink& sink) {
    PieceWriter pieces(sink);
    std::vector<int> order;
    *pieces.text() += "HIERARCHY\n";
    AppendHierarchy(*skeleton, 0, 0, pieces.text(), &order);
    *pieces.text() += fmt::format("MOTION\nFrames: {}\nFrame Time: ", trajectory.num_frames());
    AppendDecimal(1 / trajectory.rate, 12, pieces.text());
    *pieces.text() += '\n';
    AppendFrames(model, trajectory, *skeleton, order, &pieces);
    pieces.Flush();
  };
}

}  // namespace mmm_converter
