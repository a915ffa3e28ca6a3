// SPDX-License-Identifier: MIT
#include "common/label/learn/body_sites.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/model/forward_kinematics.h"
#include "tests/common/label/made_person.h"

namespace mmm_converter::testing {
namespace {

using Eigen::Vector3d;

class BodySitesTest : public ::testing::Test {
 protected:
  BodySitesTest() : made_(51), sites_(made_.model, made_.setup.joints) {}

  int num_sites() const { return static_cast<int>(sites_.sites().size()); }

  MadePerson made_;
  BodySites sites_;
};

TEST_F(BodySitesTest, EveryMarkerIsOnOneSite) {
  std::vector<int> markers;
  for (const BodySite& site : sites_.sites()) {
    EXPECT_EQ(site.markers.size(), site.places.size());
    EXPECT_EQ(site.markers.size(), site.nodes.size());
    EXPECT_FALSE(site.bones.empty());
    markers.insert(markers.end(), site.markers.begin(), site.markers.end());
  }
  std::sort(markers.begin(), markers.end());
  EXPECT_EQ(markers.size(), made_.model.markers().size());
  EXPECT_EQ(std::adjacent_find(markers.begin(), markers.end()), markers.end());
}

TEST_F(BodySitesTest, SidesMirrorEachOther) {
  int mirrored = 0;
  for (int s = 0; s < num_sites(); ++s) {
    const BodySite& site = sites_.sites()[s];
    if (site.mirror < 0) continue;
    ++mirrored;
    EXPECT_EQ(sites_.sites()[site.mirror].mirror, s);
    EXPECT_NE(sites_.sites()[site.mirror].side, site.side);
    EXPECT_FALSE(site.side.empty());
  }
  EXPECT_GE(mirrored, 12);
}

TEST_F(BodySitesTest, NeighboursAreEachOthers) {
  for (int s = 0; s < num_sites(); ++s) {
    const std::vector<int> neighbours = sites_.Neighbours(s);
    EXPECT_EQ(std::count(neighbours.begin(), neighbours.end(), s), 0);
    for (const int other : neighbours) {
      const std::vector<int> back = sites_.Neighbours(other);
      EXPECT_EQ(std::count(back.begin(), back.end(), s), 1) << s << " and " << other;
    }
  }
}

TEST_F(BodySitesTest, PosesCarryTheModelsMarkers) {
  const Posture posture = made_.PostureAt(5);
  const std::vector<Eigen::Isometry3d> poses = sites_.Poses(posture);
  Posture whole = posture;
  whole.joint_angles.setZero(made_.model.num_joints());
  for (std::size_t j = 0; j < made_.setup.joints.size(); ++j) {
    whole.joint_angles[made_.setup.joints[j]] = posture.joint_angles[static_cast<Eigen::Index>(j)];
  }
  const Eigen::Matrix3Xd p_WM = MarkerPositions(made_.model, whole);
  for (int s = 0; s < num_sites(); ++s) {
    const BodySite& site = sites_.sites()[s];
    for (std::size_t i = 0; i < site.markers.size(); ++i) {
      EXPECT_LT((poses[s] * site.places[i] - p_WM.col(site.markers[i])).norm(), 1e-9);
    }
  }
}

TEST_F(BodySitesTest, DistancesAreZeroInPlaceAndGrowAway) {
  for (int s = 0; s < num_sites(); ++s) {
    const BodySite& site = sites_.sites()[s];
    EXPECT_EQ(sites_.DistanceFromMarkers(s, site.places[0]), 0);
    const auto& [from, to] = site.bones[0];
    EXPECT_LT(sites_.DistanceFromBones(s, (from + to) / 2), 1e-12);
    EXPECT_LT(sites_.DistanceFromJoints(s, from), 1e-12);
    const Vector3d far = site.places[0] + Vector3d(5, 0, 0);
    EXPECT_GT(sites_.DistanceFromBones(s, far), 3);
    EXPECT_GE(sites_.DistanceFromJoints(s, far), sites_.DistanceFromBones(s, far));
  }
}

TEST_F(BodySitesTest, AModelsMarkerIsOnItsOwnNodeAtItsOwnPlace) {
  for (int s = 0; s < num_sites(); ++s) {
    const BodySite& site = sites_.sites()[s];
    for (std::size_t i = 0; i < site.markers.size(); ++i) {
      const auto [node, p_SM] = sites_.OnUsualNode(s, site.places[i]);
      const ModelMarker& marker = made_.model.markers()[site.markers[i]];
      EXPECT_EQ(node, marker.segment) << marker.name;
      EXPECT_LT((p_SM - marker.p_SM).norm(), 1e-9) << marker.name;
    }
  }
}

}  // namespace
}  // namespace mmm_converter::testing
