// SPDX-License-Identifier: MIT
#include "tests/support/made_skeleton.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <functional>

#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"

namespace mmm_converter::testing {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

struct MadeJoint {
  const char* names[3];  // of SkeletonStyle::Names, with % for the side
  const char* place;     // segment where it is
  const char* turn;      // segment that turns with its bone
  int parent;
};

// Of the left; those of the right follow it.
const MadeJoint kJoints[] = {
    {{"Hips", "Hips", "Pelvis"}, "", "", -1},
    {{"%UpLeg", "%Hip", "#_Hip"}, "%Hsegment_joint", "%Hy_joint", 0},
    {{"%Leg", "%Knee", "#_Knee"}, "%Ksegment_joint", "%Kx_joint", 1},
    {{"%Foot", "%Ankle", "#_Ankle"}, "%Asegment_joint", "%Ay_joint", 2},
    {{"%Toe", "%Toe", "#_Foot"}, "%Mrot_joint", "%Mrot_joint", 3},
    {{"Spine", "Chest", "Spine1"}, "BPSegment_joint", "BPy_joint", 0},
    {{"Spine1", "Chest2", "Spine2"}, "BTSegment_joint", "BTy_joint", 5},
    {{"Neck", "Neck", "Neck"}, "BLNsegment_joint", "BLNy_joint", 6},
    {{"Head", "Head", "Head"}, "BUNsegment_joint", "BUNy_joint", 7},
    {{"%Shoulder", "%Collar", "#_Collar"}, "%SCsegment_joint", "%SCy_joint", 6},
    {{"%Arm", "%Shoulder", "#_Shoulder"}, "%Ssegment_joint", "%Sy_joint", 9},
    {{"%ForeArm", "%Elbow", "#_Elbow"}, "%Esegment_joint", "%Ez_joint", 10},
    {{"%Hand", "%Wrist", "#_Wrist"}, "%Wsegment_joint", "%Wy_joint", 11},
};

struct OneJoint {
  std::string name;
  int parent = -1;
  int place = 0, turn = 0;  // segments
  Matrix3d zero = Matrix3d::Identity();
};

std::string Replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  if (at != std::string::npos) text.replace(at, what.size(), by);
  return text;
}

/// The orientation of a segment in the zero pose, z up.
Matrix3d ZeroOf(const std::string& name, bool is_left, SkeletonStyle::Zero zero) {
  const bool is_arm =
      name.find("Arm") != std::string::npos || name.find("Shoulder") != std::string::npos ||
      name.find("Elbow") != std::string::npos || name.find("Hand") != std::string::npos ||
      name.find("Wrist") != std::string::npos;
  if (zero == SkeletonStyle::Zero::kAllAlongX) {
    const bool hangs =
        is_arm || name.find("Leg") != std::string::npos || name.find("Knee") != std::string::npos ||
        name.find("Hip") != std::string::npos || name.find("Foot") != std::string::npos ||
        name.find("Ankle") != std::string::npos;
    return AngleAxisd((hangs ? -0.5 : 0.5) * EIGEN_PI, Vector3d::UnitY()).toRotationMatrix();
  }
  if (!is_arm) return Matrix3d::Identity();
  const double lifted = (zero == SkeletonStyle::Zero::kT ? 0.5 : 0.25) * EIGEN_PI;
  return AngleAxisd(is_left ? lifted : -lifted, Vector3d::UnitY()).toRotationMatrix();
}

std::vector<OneJoint> JointsOf(const KinematicModel& model, const SkeletonStyle& style) {
  std::vector<OneJoint> joints;
  std::vector<int> index[2];
  const auto names = static_cast<std::size_t>(style.names);
  for (const MadeJoint& made : kJoints) {
    const bool has_side = std::string(made.names[0]).find('%') != std::string::npos;
    for (const int side : {0, 1}) {
      if (side == 1 && !has_side) {
        index[1].push_back(index[0].back());
        continue;
      }
      const char* const letter = side == 0 ? "L" : "R";
      OneJoint one;
      one.name =
          Replaced(Replaced(made.names[names], "%", side == 0 ? "Left" : "Right"), "#", letter);
      one.parent = made.parent < 0 ? -1 : index[side][static_cast<std::size_t>(made.parent)];
      const auto segment = [&](const char* name) {
        return *name == '\0' ? 0 : model.FindSegment(Replaced(name, "%", letter));
      };
      one.place = segment(made.place);
      one.turn = segment(made.turn);
      one.zero = ZeroOf(Replaced(made.names[0], "%", ""), side == 0, style.zero);
      index[side].push_back(static_cast<int>(joints.size()));
      joints.push_back(one);
    }
  }
  return joints;
}

/// Angles [rad] of a rotation about three different axes: R = R(a) R(b) R(c).
Vector3d AnglesOf(const Matrix3d& R, const std::string& order) {
  return R.eulerAngles(order[0] - 'X', order[1] - 'X', order[2] - 'X');
}

}  // namespace

MadeSkeleton MakeSkeleton(const KinematicModel& person, const PoseTrajectory& motion,
                          const SkeletonStyle& style) {
  const std::vector<OneJoint> joints = JointsOf(person, style);
  Matrix3d up = Matrix3d::Identity();  // of the file, by z up
  if (style.has_y_up) up << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  MadeSkeleton made;
  for (const OneJoint& one : joints) made.names.push_back(one.name);
  const std::vector<Eigen::Isometry3d> first =
      SegmentPoses(person, ModelPosture(person, motion, 0));
  const auto offset = [&](const OneJoint& one, const std::vector<Eigen::Isometry3d>& X) {
    const OneJoint& parent = joints[static_cast<std::size_t>(one.parent)];
    const auto& X_P = X[static_cast<std::size_t>(parent.turn)];
    const Vector3d from = X[static_cast<std::size_t>(parent.place)].translation();
    const Vector3d to = X[static_cast<std::size_t>(one.place)].translation();
    return Vector3d(up * parent.zero * X_P.linear().transpose() * (to - from) / style.unit);
  };
  std::vector<int> order;  // of the file
  const std::function<void(int, const std::string&)> append = [&](int j,
                                                                  const std::string& indent) {
    const OneJoint& one = joints[static_cast<std::size_t>(j)];
    order.push_back(j);
    const Vector3d at = one.parent < 0 ? Vector3d::Zero() : offset(one, first);
    made.bvh += fmt::format("{}{} {}\n{}{{\n{}\tOFFSET {:.9f} {:.9f} {:.9f}\n{}\tCHANNELS ", indent,
                            one.parent < 0 ? "ROOT" : "JOINT", one.name, indent, indent, at.x(),
                            at.y(), at.z(), indent);
    const bool moves = one.parent < 0 || style.moves_bones;
    made.bvh += moves ? "6 Xposition Yposition Zposition" : "3";
    for (const char axis : style.order) made.bvh += fmt::format(" {}rotation", axis);
    made.bvh += '\n';
    bool is_end = true;
    for (std::size_t child = 0; child < joints.size(); ++child) {
      if (joints[child].parent != j) continue;
      append(static_cast<int>(child), indent + '\t');
      is_end = false;
    }
    if (is_end)
      made.bvh += fmt::format("{}\tEnd Site\n{}\t{{\n\t\tOFFSET 0 {:.9f} 0\n\t}}\n", indent, indent,
                              0.05 / style.unit);
    made.bvh += indent + "}\n";
  };
  made.bvh = "HIERARCHY\n";
  append(0, "");
  made.bvh +=
      fmt::format("MOTION\nFrames: {}\nFrame Time: {:.7f}\n", motion.num_frames(), 1 / motion.rate);
  for (int k = 0; k < motion.num_frames(); ++k) {
    const std::vector<Eigen::Isometry3d> X = SegmentPoses(person, ModelPosture(person, motion, k));
    Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(joints.size()));
    const auto turned = [&](int j) {
      const OneJoint& one = joints[static_cast<std::size_t>(j)];
      return Matrix3d(up * X[static_cast<std::size_t>(one.turn)].linear() * one.zero.transpose() *
                      up.transpose());
    };
    for (std::size_t j = 0; j < joints.size(); ++j) {
      places.col(static_cast<Eigen::Index>(j)) =
          X[static_cast<std::size_t>(joints[j].place)].translation();
    }
    for (const int j : order) {
      const OneJoint& one = joints[static_cast<std::size_t>(j)];
      const Matrix3d above = one.parent < 0 ? Matrix3d::Identity() : turned(one.parent);
      Vector3d at = up * places.col(j) / style.unit;
      if (one.parent >= 0) at = offset(one, X);
      if (one.parent < 0 || style.moves_bones) {
        made.bvh += fmt::format("{:.9f} {:.9f} {:.9f} ", at.x(), at.y(), at.z());
      }
      const Vector3d angles = 180 / EIGEN_PI * AnglesOf(above.transpose() * turned(j), style.order);
      made.bvh += fmt::format("{:.9f} {:.9f} {:.9f} ", angles.x(), angles.y(), angles.z());
    }
    made.bvh += '\n';
    made.places.push_back(std::move(places));
  }
  return made;
}

}  // namespace mmm_converter::testing
