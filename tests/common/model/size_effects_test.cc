// SPDX-License-Identifier: MIT
#include "common/model/size_effects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_scaling.h"
#include "tests/support/osim_texts.h"
#include "tests/support/test_models.h"

namespace mmm_converter {
namespace {

using testing::MakeFullKinematics;
using testing::RandomPosture;

constexpr SizeDeviations kDeviations{0.05, 0.03};
constexpr double kEffectRounding = 1e-14;

/// What sizes move the markers by in some posture.
struct Scene {
  explicit Scene(const KinematicModel& model)
      : kinematics(MakeFullKinematics(model)),
        effects(model, kinematics, kDeviations),
        at(kinematics.MakeJacobian()),
        moved(3 * kinematics.num_markers(), effects.num_effects()) {
    std::mt19937 random(4);
    posture = RandomPosture(kinematics, 0.7, &random);
    Place(kinematics, &at);
    effects.Compute(at, &moved);
  }

  void Place(const MarkerKinematics& of, MarkerJacobian* places) const {
    of.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                      posture.joint_angles, places);
  }

  MarkerKinematics kinematics;
  SizeEffects effects;
  MarkerJacobian at;
  PaddedMatrix moved;
  Posture posture;
};

TEST(SizeEffectsTest, AllPartsTogetherScaleTheBodyAboutItsRoot) {
  const Scene scene(testing::MakeBranchedModel());
  for (int m = 0; m < scene.kinematics.num_markers(); ++m) {
    Eigen::Vector3d whole = Eigen::Vector3d::Zero();
    Eigen::Vector3d along = Eigen::Vector3d::Zero();
    for (int i = 0; i < scene.effects.num_effects(); ++i) {
      (i % 4 == 0 ? whole : along) += scene.moved.view().block<3, 1>(3 * m, i);
    }
    const Eigen::Vector3d from_root = scene.at.p_WM.col(m) - scene.posture.position;
    EXPECT_LT((whole - kDeviations.whole * from_root).norm(), kEffectRounding);
    EXPECT_LT((along - kDeviations.along * from_root).norm(), kEffectRounding);
  }
}

/// A pelvis with a leg on each side, whose femurs are larger by `factor`.
std::string Legs(double factor) {
  std::string bodies = testing::OsimBodyText("pelvis");
  std::string joints = testing::OsimJointText("FreeJoint", "root", "ground", "pelvis");
  std::string markers = testing::OsimMarkerText("front", "pelvis", "0.1 0.02 0.03");
  for (const std::string side : {"r", "l"}) {
    const auto pin = [&](const std::string& joint, const std::string& parent,
                         const std::string& child) {
      bodies += testing::OsimBodyText(child);
      joints += testing::OsimJointText("PinJoint", joint, parent, child);
      markers += testing::OsimMarkerText("of_" + child, child, "-0.05 0.1 0.02");
    };
    pin("hip_" + side, "pelvis", "femur_" + side);
    pin("knee_" + side, "femur_" + side, "tibia_" + side);
  }
  OsimScaling scaling;
  for (const char* body : {"femur_r", "femur_l"}) {
    scaling.factors[body] = Eigen::Vector3d::Constant(factor);
  }
  return ScaleOsim(testing::OsimText(bodies, joints, "", markers), "legs", scaling, nullptr);
}

TEST(SizeEffectsTest, BothSidesOfAModelOfOpenSimAreScaledAsOne) {
  constexpr double kStep = 1e-6;
  const Scene scene(ParseOsimModel(Legs(1), "legs"));
  ASSERT_EQ(scene.effects.num_effects(), 3 * 4);
  const MarkerKinematics larger = MakeFullKinematics(ParseOsimModel(Legs(1 + kStep), "legs"));
  MarkerJacobian at = larger.MakeJacobian();
  scene.Place(larger, &at);
  const Eigen::VectorXd step = (at.p_WM - scene.at.p_WM).reshaped() / kStep;
  ASSERT_GT(step.norm(), 0.1);
  double nearest = 1;
  for (int i = 0; i < scene.effects.num_effects(); i += 4) {
    const Eigen::VectorXd part = scene.moved.view().col(i) / kDeviations.whole;
    nearest = std::min(nearest, (step - part).norm());
  }
  EXPECT_LT(nearest, 10 * kStep);
}

}  // namespace
}  // namespace mmm_converter
