// SPDX-License-Identifier: MIT
#include "common/calibrate/landmark_body.h"

#include <gtest/gtest.h>

#include "common/convert/marker_set.h"
#include "common/convert/named_markers.h"
#include "common/io/mmm/mmm_model.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "common/support/units.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {
namespace {

constexpr double kHeight = 1.7;

/// A person of other lengths under Plug-in Gait's names, walking on the spot with flat feet.
class LandmarkBodyTest : public ::testing::Test {
 protected:
  LandmarkBodyTest()
      : reference_(ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml"))),
        table_(testing::SourcePath("xml_config/landmarks.xml")) {
    for (const char* name : {"LASI", "RASI", "LPSI", "RPSI", "LKNE", "RKNE", "LANK", "RANK", "LHEE",
                             "RHEE", "LTOE", "RTOE"}) {
      labels_.names.emplace_back(name);
    }
    names_ = ComposeNamedMarkers(labels_, reference_, table_);
    setup_.model = std::make_shared<const KinematicModel>(
        ScaleWinter(PlaceMarkers(names_.set, {reference_, true, {}}), {kHeight, 70, {}}));
  }

  MarkerSequence Record(const Subject& person) const {
    const KinematicModel model = FitToSubject(*setup_.model, person);
    MarkerSequence recording(labels_.names, 100, 100, 0);
    for (int k = 0; k < recording.num_frames(); ++k) {
      Posture posture = ZeroPosture(model);
      const double bend = k < 50 ? 0 : 0.4 * std::sin(0.1 * (k - 50));
      posture.joint_angles[model.FindJoint("LHx_joint")] = bend;
      posture.joint_angles[model.FindJoint("RHx_joint")] = -bend;
      const Eigen::Matrix3Xd p = MarkerPositions(model, posture);
      for (int i = 0; i < recording.num_labels(); ++i) {
        recording.frame(k).col(i) =
            p.col(model.FindMarker(labels_.names[static_cast<std::size_t>(i)]));
      }
    }
    return recording;
  }

  static double ScaleOf(const Subject& body, const std::string& segment) {
    for (const SegmentScale& one : body.scales) {
      if (one.segment == segment) return one.scale;
    }
    return 0;
  }

  KinematicModel reference_;
  LandmarkTable table_;
  MarkerLabels labels_;
  NamedMarkers names_;
  TrackingSetup setup_;
};

TEST_F(LandmarkBodyTest, ShanksAndThighsAreAsLongAsTheyAre) {
  Subject person;
  for (const char* side : {"L", "R"}) {
    person.scales.push_back({std::string(side) + "Ksegment_joint", 1.06, 0, 0});
    person.scales.push_back({std::string(side) + "Asegment_joint", 0.95, 0, 0});
  }
  const MarkerSequence wearer = Record(person), model = Record({});
  const Subject found = FindLandmarkBody(setup_, names_, wearer);
  const Subject usual = FindLandmarkBody(setup_, names_, model);
  // The marker at the knee moves with the thigh's scale, too.
  EXPECT_NEAR(ScaleOf(found, "LAsegment_joint"), 0.95, 0.01);
  EXPECT_NEAR(ScaleOf(found, "LKsegment_joint") / ScaleOf(usual, "LKsegment_joint"), 1.06, 0.01);
  EXPECT_EQ(ScaleOf(found, "LKsegment_joint"), ScaleOf(found, "RKsegment_joint"));
}

// Markers leave 15 mm of the difference open: of 40 mm, 25 are the legs'.
TEST_F(LandmarkBodyTest, LegsDifferByWhatIsMoreThanMarkersLeaveOpen) {
  const auto length = [&](const char* segment) {
    const int index = setup_.model->FindSegment(segment);
    return setup_.model->segments()[static_cast<std::size_t>(index)].X_PF.translation().norm();
  };
  const auto difference = [&](double of_shanks) {
    Subject person;
    person.scales = {{"LAsegment_joint", 1 + of_shanks / length("LAsegment_joint"), 0, 0}};
    const Subject found = FindLandmarkBody(setup_, names_, Record(person));
    return (ScaleOf(found, "LAsegment_joint") - ScaleOf(found, "RAsegment_joint")) *
               length("LAsegment_joint") +
           (ScaleOf(found, "LKsegment_joint") - ScaleOf(found, "RKsegment_joint")) *
               length("LKsegment_joint");
  };
  EXPECT_EQ(difference(0.01), 0);
  EXPECT_NEAR(difference(0.04), 0.025, 0.002);
  EXPECT_NEAR(difference(-0.04), -0.025, 0.002);
}

// Who walks on toes is never flat: places stay the usual ones.
TEST_F(LandmarkBodyTest, AHeelThatIsNeverDownTellsNoHeights) {
  const MarkerSequence flat = Record({});
  const KinematicModel& model = *setup_.model;
  Posture tiptoe = ZeroPosture(model);
  for (const char* joint : {"LAx_joint", "RAx_joint"}) {
    tiptoe.joint_angles[model.FindJoint(joint)] = -15 / kDegrees;
  }
  const Eigen::Matrix3Xd p = MarkerPositions(model, tiptoe);
  MarkerSequence on_toes = flat;
  for (int k = 0; k < flat.num_frames(); ++k) {
    for (int i = 0; i < flat.num_labels(); ++i) {
      on_toes.frame(k).col(i) = p.col(model.FindMarker(flat.labels()[i]));
    }
  }
  for (const MarkerOffset& one : FindLandmarkBody(setup_, names_, on_toes).offsets) {
    if (one.marker.ends_with("HEE") || one.marker.ends_with("TOE")) {
      EXPECT_LT(one.offset.norm(), 0.003) << one.marker;
    }
  }
}

// Harrington et al. 2007.
TEST_F(LandmarkBodyTest, HipsAreWhereThePelvisLandmarksPutThem) {
  const MarkerSequence recording = Record({});
  const auto at = [&](const char* label) {
    return Eigen::Vector3d(recording.frame(0).col(recording.FindLabel(label)));
  };
  const double width = (at("LASI") - at("RASI")).norm();
  const double depth = (0.5 * (at("LASI") + at("RASI")) - 0.5 * (at("LPSI") + at("RPSI"))).norm();
  const Subject body = FindLandmarkBody(setup_, names_, recording);
  const KinematicModel fitted = WithLandmarkBody(*setup_.model, body);
  const auto X_WS = SegmentPoses(fitted, ZeroPosture(fitted));
  const Eigen::Matrix3Xd p = MarkerPositions(fitted, ZeroPosture(fitted));
  const Eigen::Vector3d front =
      0.5 * (p.col(fitted.FindMarker("LASI")) + p.col(fitted.FindMarker("RASI")));
  const Eigen::Vector3d hip =
      X_WS[static_cast<std::size_t>(fitted.FindSegment("RHsegment_joint"))].translation();
  EXPECT_TRUE((hip - front)
                  .isApprox(Eigen::Vector3d(0.33 * width + 0.0073, -0.24 * depth - 0.0099,
                                            -0.30 * width - 0.0109),
                            1e-6));
  EXPECT_FALSE(fitted.markers()[static_cast<std::size_t>(fitted.FindMarker("LASI"))].deviation);
}

TEST_F(LandmarkBodyTest, FeetHaveTheDistancesAndHeightsOfFlatFeet) {
  Subject person;
  person.offsets.push_back({"LTOE", {0, -0.02, 0.01}});
  const Subject body = FindLandmarkBody(setup_, names_, Record(person));
  const KinematicModel wearer = FitToSubject(*setup_.model, person);
  const KinematicModel found = WithLandmarkBody(*setup_.model, body);
  const auto between = [](const KinematicModel& model, const char* a, const char* b) {
    const Eigen::Matrix3Xd p = MarkerPositions(model, ZeroPosture(model));
    return Eigen::Vector3d(p.col(model.FindMarker(a)) - p.col(model.FindMarker(b)));
  };
  for (const auto& [a, b] : {std::pair("LTOE", "LANK"), std::pair("LTOE", "LHEE")}) {
    const Eigen::Vector3d expected = between(wearer, a, b), is = between(found, a, b);
    EXPECT_NEAR(is.norm(), expected.norm(), 0.002);
    EXPECT_NEAR(is.z(), expected.z(), 0.004);
  }
}

TEST_F(LandmarkBodyTest, WrongLabelsShowNothing) {
  MarkerSequence recording = Record({});
  for (int k = 0; k < recording.num_frames(); ++k) {
    recording.frame(k).col(recording.FindLabel("LKNE")).array() += 1;
    recording.frame(k).col(recording.FindLabel("RKNE")).array() += 1;
    recording.frame(k).col(recording.FindLabel("LASI")).array() += 1;
  }
  const Subject body = FindLandmarkBody(setup_, names_, recording);
  EXPECT_TRUE(body.scales.empty());
}

TEST_F(LandmarkBodyTest, JoinedSubjectsAreTheOneUponTheOther) {
  Subject body, calibrated;
  body.scales = {{"LKsegment_joint", 1.1, 0, 0}, {"LAsegment_joint", 0.9, 0, 0}};
  body.offsets = {{"LKNE", {0.01, 0, 0}}, {"LASI", {0, 0.01, 0}}};
  calibrated.scales = {{"LKsegment_joint", 1.05, 0, 0}};
  calibrated.offsets = {{"LKNE", {0, 0.02, 0}}};
  const KinematicModel& model = *setup_.model;
  const KinematicModel in_turn = FitToSubject(WithLandmarkBody(model, body), calibrated);
  const KinematicModel joined = FitToSubject(model, JoinSubjects(body, calibrated, model));
  const Posture zero = ZeroPosture(model);
  EXPECT_TRUE(MarkerPositions(in_turn, zero).isApprox(MarkerPositions(joined, zero), 1e-12));
}

TEST_F(LandmarkBodyTest, APersonWearsABoundedNumberOfMarkers) {
  MarkerLabels many;
  for (int i = 0; i < 3000; ++i) many.names.push_back("LeftHand" + std::to_string(i));
  const NamedMarkers named = ComposeNamedMarkers(many, reference_, table_);
  EXPECT_EQ(named.labels.size(), 3000);
  EXPECT_LE(named.set.pairs.size(), 500);
  EXPECT_EQ(named.labels.back().note, "a person wears fewer markers");
}

}  // namespace
}  // namespace mmm_converter
