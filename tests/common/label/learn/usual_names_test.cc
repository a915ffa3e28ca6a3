// SPDX-License-Identifier: MIT
#include "common/label/learn/usual_names.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/support/synthetic_person.h"

namespace mmm_converter::testing {
namespace {

// The likeliest of KIT's markers; empty: the name means nothing.
std::string FirstNear(const std::string& label) {
  const std::vector<std::string_view> near = UsuallyNear(label);
  return near.empty() ? "" : std::string(near.front());
}

TEST(UsualNamesTest, NamesOfManyLaboratoriesInAnySpelling) {
  const std::map<std::string, std::string> expected = {{"LASI", "ASI"},
                                                       {"R.ASIS", "ASI"},
                                                       {"left_psis", "ASI"},
                                                       {"SACR", "PSI"},
                                                       {"V.Sacral", "PSI"},
                                                       {"HeelR", "HEE"},
                                                       {"LHEE", "HEE"},
                                                       {"Right Calcaneus", "HEE"},
                                                       {"R_5meta", "MT1"},
                                                       {"L.Shoulder", "SHO"},
                                                       {"RightAcromion", "SHO"},
                                                       {"LKNE", "KNE"},
                                                       {"Knee_Lat_R", "KNE"},
                                                       {"lateral knee left", "KNE"},
                                                       {"RKneeMed", "KNE"},
                                                       {"C7", "C7"},
                                                       {"STRN", "C7"},
                                                       {"clavicle", "C7"},
                                                       {"T10", "C7"},
                                                       {"L3", "L3"},
                                                       {"LWRA", "WTS"},
                                                       {"wrist_ulnar_R", ""},
                                                       {"R.Wrist.Lateral", "WTS"},
                                                       {"LELB", "AEL"},
                                                       {"RElbowMedial", "AEL"},
                                                       {"LeftAnkleLateral", "ANK"},
                                                       {"RMMAL", "ANK"},
                                                       {"L_Thigh_3", "THI"},
                                                       {"RTH2", "THI"},
                                                       {"LTIB", "TIP"},
                                                       {"R_Shank_Upper", "TIP"},
                                                       {"LFHD", "FHD"},
                                                       {"Head_Front", "FHD"},
                                                       {"RBHD", "FHD"},
                                                       {"LTOE", "TOE"},
                                                       {"RFIN", "HTS"}};
  for (const auto& [label, near] : expected) EXPECT_EQ(FirstNear(label), near) << label;
}

TEST(UsualNamesTest, OtherNamesMeanNothing) {
  for (const char* label :
       {"", "m1", "m22", "*12", "marker_7", "A", "L", "R", "knee", "PVUL", "x:y", "Left", "lateral",
        "inininininininininininininininininin", "\xc3\xa4"}) {
    EXPECT_EQ(FirstNear(label), "") << label;
  }
}

TEST(UsualNamesTest, ASiteOfEitherSideIsWhatANameSays) {
  const KinematicModel model = ScaledReferenceModel(1.7);
  const BodySites sites(model, TrackedJoints(model));
  const Eigen::MatrixXi said = WhatNamesSay({"L.Heel", "m1", "RTHI"}, sites);
  ASSERT_EQ(said.cols(), static_cast<Eigen::Index>(sites.sites().size()));
  int heels = 0, thighs = 0;
  for (Eigen::Index s = 0; s < said.cols(); ++s) {
    const BodySite& site = sites.sites()[static_cast<std::size_t>(s)];
    const std::string& node = model.segments()[site.segment].name;
    heels += said(0, s) > 0;
    thighs += said(2, s) > 0;
    EXPECT_NE(said(0, s), 0);
    EXPECT_EQ(said(1, s), 0);
    EXPECT_EQ(said(0, s) > 0, node == "LAy_joint" || node == "RAy_joint") << node;
  }
  EXPECT_EQ(heels, 2);
  EXPECT_EQ(thighs, 2);
}

TEST(UsualNamesTest, AModelWithoutKitsMarkersIsNotToldOf) {
  const KinematicModel model = ScaledReferenceModel(1.7);
  ModelDescription description{model.name(), model.segments(), {}, {}};
  for (const ModelMarker& marker : model.markers()) {
    description.markers.push_back(
        {"x" + std::to_string(description.markers.size()), marker.segment, marker.p_SM, {}, {}});
  }
  const KinematicModel other(std::move(description));
  const BodySites sites(other, TrackedJoints(other));
  EXPECT_TRUE(WhatNamesSay({"LHEE", "RASI"}, sites).isZero());
}

}  // namespace
}  // namespace mmm_converter::testing
