// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "common/math/rotation.h"
#include "common/math/seeded_random.h"
#include "common/model/kinematic_model.h"

namespace mmm_converter::testing {

/// One free body, its centre of mass beside its origin, with markers at the corners of a box of
/// 0.4 m around it.
inline KinematicModel Brick() {
  ModelDescription description;
  description.name = "brick";
  description.segments.resize(1);
  Segment& body = description.segments[0];
  body.name = "brick";
  body.mass = 3;
  body.p_SB = {0.02, -0.03, 0.05};
  body.inertia = Eigen::Vector3d(0.02, 0.03, 0.04).asDiagonal();
  for (int i = 0; i < 8; ++i) {
    description.markers.push_back(
        {"corner_" + std::to_string(i),
         0,
         {(i & 1) == 0 ? -0.2 : 0.2, (i & 2) == 0 ? -0.2 : 0.2, (i & 4) == 0 ? -0.2 : 0.2}});
  }
  return KinematicModel(description);
}

/// A body with a chain of `links` on it, all with mass, inertia and turned frames.
inline KinematicModel Chain(int links) {
  SeededRandom random(3);
  const auto vector = [&random](double size) {
    return Eigen::Vector3d(size * random.Normal(), size * random.Normal(), size * random.Normal());
  };
  ModelDescription description;
  description.name = "chain";
  for (int i = 0; i <= links; ++i) {
    Segment segment;
    segment.name = "link_" + std::to_string(i);
    segment.parent = i - 1;
    if (i > 0) {
      segment.type = JointType::kRevolute;
      segment.axis = vector(1).normalized();
      segment.lower = -3;
      segment.upper = 3;
      segment.X_PF.linear() = Exp(vector(1)).toRotationMatrix();
      segment.X_PF.translation() = vector(0.3);
    }
    segment.mass = 1 + random.Uniform();
    segment.p_SB = vector(0.1);
    const Eigen::Matrix3d R = Exp(vector(1)).toRotationMatrix();
    segment.inertia = R * Eigen::Vector3d(0.02, 0.03, 0.04).asDiagonal() * R.transpose();
    description.segments.push_back(segment);
  }
  return KinematicModel(description);
}

/// Of its joints the fourth is curved and follows the third, the fifth slides and follows it too.
inline KinematicModel CoupledChain() {
  ModelDescription description = DescriptionOf(Chain(6));
  Segment& curved = description.segments[4];
  curved.leader = 3;
  curved.function =
      std::make_shared<const ScalarFunction>(ScalarFunction::Polynomial({0.3, -0.5, 0.2}));
  Segment& slides = description.segments[5];
  slides.type = JointType::kSliding;
  slides.leader = 3;
  slides.function = std::make_shared<const ScalarFunction>(ScalarFunction::Linear(-0.4, 0.1));
  description.markers.push_back({"tip", 6, {0.1, 0, 0}});
  return KinematicModel(description);
}

}  // namespace mmm_converter::testing
