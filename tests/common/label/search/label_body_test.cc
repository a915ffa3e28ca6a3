// SPDX-License-Identifier: MIT
#include "common/label/search/label_body.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/label/tuning.h"
#include "tests/common/label/made_person.h"

namespace mmm_converter::testing {
namespace {

TEST(LabelBodyTest, OfTheHeightAlonePlacesAreAsTheNoiseScaleSays) {
  MadePerson made(1);
  made.setup.mapping.assignments[0].noise_scale = 1.5;
  made.setup.mapping.assignments[1].noise_scale = 10;
  const LabelBody body(made.setup);
  EXPECT_DOUBLE_EQ(body.place[0], 0.045);
  EXPECT_DOUBLE_EQ(body.place[1], 0.06);
  EXPECT_DOUBLE_EQ(body.place[2], 0.03);
  EXPECT_DOUBLE_EQ(body.skin[2], 0.006);
}

TEST(LabelBodyTest, ACalibratedPlaceIsKnownBetter) {
  const MadePerson made(1);
  Subject subject = DrawPerson(made.model, 2);
  for (MarkerOffset& offset : subject.offsets) {
    offset.standard_deviations.setConstant(0.03);
    offset.skin_deviation = 0.002;
  }
  subject.offsets[0].standard_deviations.setConstant(0.001);
  const KinematicModel person = FitToSubject(made.model, subject);
  const LabelBody body(SetupOf(person, made.setup.joints, made.setup.assignments()));
  int best_known = 0;
  for (int m = 0; m < body.num_markers(); ++m) {
    const ModelMarker& marker = person.markers()[body.kinematics.markers()[m]];
    ASSERT_TRUE(marker.deviation.has_value()) << marker.name;
    EXPECT_DOUBLE_EQ(body.place[m], std::max(0.4 * *marker.deviation, 0.008)) << marker.name;
    EXPECT_DOUBLE_EQ(body.skin[m], 0.005) << marker.name;
    best_known += body.place[m] == 0.008 ? 1 : 0;
  }
  EXPECT_EQ(best_known, 1);
}

TEST(LabelBodyTest, LimbsHangOnTheTrunkAndShareNothing) {
  const MadePerson made(1);
  const LabelBody& body = made.body;
  EXPECT_GE(body.limbs.size(), 5U);  // arms, legs, head
  std::vector<int> joints, markers;
  for (std::size_t i = 0; i < body.limbs.size(); ++i) {
    const LabelBody::Limb& limb = body.limbs[i];
    EXPECT_LE(3 * static_cast<int>(limb.markers.size()), body.num_markers());
    EXPECT_TRUE(std::is_sorted(limb.joints.begin(), limb.joints.end()));
    for (const int m : limb.markers) EXPECT_EQ(body.limb_of_marker[m], static_cast<int>(i));
    joints.insert(joints.end(), limb.joints.begin(), limb.joints.end());
    markers.insert(markers.end(), limb.markers.begin(), limb.markers.end());
  }
  for (std::vector<int>* all : {&joints, &markers}) {
    std::sort(all->begin(), all->end());
    EXPECT_EQ(std::adjacent_find(all->begin(), all->end()), all->end());
  }
  // No joint of a limb moves a marker of another, nor of the trunk.
  for (std::size_t i = 0; i < body.limbs.size(); ++i) {
    for (const int j : body.limbs[i].joints) {
      for (int m = 0; m < body.num_markers(); ++m) {
        if (!body.kinematics.Moves(j, m)) continue;
        EXPECT_EQ(body.limb_of_marker[m], static_cast<int>(i));
      }
    }
  }
}

TEST(LabelBodyTest, JointsOfAMarkerAreThoseThatMoveIt) {
  const MadePerson made(1);
  for (int m = 0; m < made.body.num_markers(); ++m) {
    const std::vector<int>& joints = made.body.joints_of_marker[m];
    EXPECT_TRUE(std::is_sorted(joints.begin(), joints.end()));
    for (int j = 0; j < made.body.kinematics.num_joints(); ++j) {
      EXPECT_EQ(std::count(joints.begin(), joints.end(), j),
                made.body.kinematics.Moves(j, m) ? 1 : 0);
    }
  }
}

TEST(LabelBodyTest, TemplatesAreInsideTheLimitsAndDiffer) {
  const MadePerson made(1);
  const auto& templates = made.body.templates;
  EXPECT_EQ(templates.size(), 55U);
  for (std::size_t i = 0; i < templates.size(); ++i) {
    const Eigen::VectorXd& angles = templates[i].joint_angles;
    EXPECT_TRUE((angles.array() >= made.body.kinematics.lower().array()).all());
    EXPECT_TRUE((angles.array() <= made.body.kinematics.upper().array()).all());
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(angles, templates[j].joint_angles);
  }
}

}  // namespace
}  // namespace mmm_converter::testing
