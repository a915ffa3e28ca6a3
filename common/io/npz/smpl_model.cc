// SPDX-License-Identifier: MIT
#include "common/io/npz/smpl_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/io/npz/npz_file.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kHeight = 1.7;  // of the stand-in [m]
constexpr std::size_t kMostBetas = 300;

constexpr std::array<SmplJoint, kSmplJoints> kJoints = {
    {{"Pelvis", -1},  {"L_Hip", 0},       {"R_Hip", 0},       {"Spine1", 0},   {"L_Knee", 1},
     {"R_Knee", 2},   {"Spine2", 3},      {"L_Ankle", 4},     {"R_Ankle", 5},  {"Spine3", 6},
     {"L_Foot", 7},   {"R_Foot", 8},      {"Neck", 9},        {"L_Collar", 9}, {"R_Collar", 9},
     {"Head", 12},    {"L_Shoulder", 13}, {"R_Shoulder", 14}, {"L_Elbow", 16}, {"R_Elbow", 17},
     {"L_Wrist", 18}, {"R_Wrist", 19}}};

/// A bone of a limb, from its joint's parent to it.
struct Bone {
  int joint;           ///< of the left; the right one follows
  double length;       ///< of the MMM model of 1 m [m]
  Vector3d direction;  ///< roughly, at the zero pose, whose arms stretch sideways: x outwards
};

const Bone kBones[] = {{4, 0.245, {0.1, -1, 0}},      {7, 0.246, {-0.05, -1, -0.1}},
                       {10, 0.08, {0.2, -0.4, 0.9}},  {16, 0.075, {0.95, 0.3, -0.1}},
                       {18, 0.188, {1, -0.05, -0.1}}, {20, 0.145, {1, 0, 0}}};

}  // namespace

const std::array<SmplJoint, kSmplJoints>& SmplJoints() { return kJoints; }

Matrix3Xd SmplModel::Joints(const std::vector<double>& betas) const {
  Matrix3Xd shaped = joints;
  for (std::size_t b = 0; b < std::min(betas.size(), directions.size()); ++b) {
    shaped += betas[b] * directions[b];
  }
  return shaped;
}

SmplModel StandInSmplModel(SmplKind kind) {
  Matrix3Xd rest(3, kSmplJoints);
  // The pelvis is not at the origin, which is near the chest.
  rest.col(0) << 0, kind == SmplKind::kSmplH ? -0.13 : -0.2, 0.01;
  const auto above = [&](int joint, double height, double front) {
    rest.col(joint) = rest.col(0) + Vector3d(0, height, front);
  };
  above(3, 0.06, -0.01);
  above(6, 0.14, -0.01);
  above(9, 0.17, 0);
  above(12, 0.3, -0.02);
  above(15, 0.34, 0.01);
  for (const int side : {0, 1}) {
    const double x = side == 0 ? 1 : -1;
    rest.col(1 + side) = rest.col(0) + Vector3d(0.052 * x, -0.05, 0);
    rest.col(13 + side) = rest.col(0) + Vector3d(0.04 * x, 0.24, -0.01);
    for (const Bone& bone : kBones) {
      Vector3d along = bone.direction.normalized();
      along.x() *= x;
      const int joint = bone.joint + side;
      rest.col(joint) =
          rest.col(kJoints[static_cast<std::size_t>(joint)].parent) + bone.length * along;
    }
  }
  return {kHeight * rest, {}};
}

SmplModel ReadSmplModel(const std::string& file) {
  const NpzFile archive(file);
  const NumpyArray vertices = archive.Read("v_template"), weights = archive.Read("J_regressor");
  const NumpyArray shapes = archive.Read("shapedirs");
  const std::size_t count = vertices.rows();
  const bool is_right = count > 0 && vertices.head().shape == std::vector<std::size_t>{count, 3} &&
                        weights.head().shape.size() == 2 && weights.rows() >= kSmplJoints &&
                        weights.row_size() == count && shapes.head().shape.size() == 3 &&
                        shapes.rows() == count && shapes.head().shape[1] == 3 &&
                        !vertices.head().is_text() && !weights.head().is_text() &&
                        !shapes.head().is_text();
  if (!is_right) {
    throw Error(fmt::format(
        "{}: is no body model of SMPL: v_template is {}, shapedirs {}, J_regressor {}; "
        "expected (V, 3), (V, 3, B), (J, V)",
        file, ShapeText(vertices.head()), ShapeText(shapes.head()), ShapeText(weights.head())));
  }
  const std::size_t all = shapes.head().shape[2];
  // Behind those of the shape SMPL-X has those of the face: 10 of 20, or 100 of 400.
  const std::size_t betas = all == 20 ? 10 : std::min(all, kMostBetas);
  SmplModel model;
  model.num_joints = static_cast<int>(weights.rows());
  model.joints = Matrix3Xd::Zero(3, kSmplJoints);
  model.directions.assign(betas, model.joints);
  for (std::size_t v = 0; v < count; ++v) {
    for (int j = 0; j < kSmplJoints; ++j) {
      const double weight = weights.Number(static_cast<std::size_t>(j), v);
      if (weight == 0) continue;
      for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        model.joints(a, j) += weight * vertices.Number(v, axis);
        for (std::size_t b = 0; b < betas; ++b) {
          model.directions[b](a, j) += weight * shapes.Number(v, axis * all + b);
        }
      }
    }
  }
  const bool is_finite =
      model.joints.allFinite() &&
      std::all_of(model.directions.begin(), model.directions.end(),
                  [](const Matrix3Xd& direction) { return direction.allFinite(); });
  if (!is_finite) throw Error(fmt::format("{}: has something that is no number", file));
  return model;
}

}  // namespace mmm_converter
