// SPDX-License-Identifier: MIT
#include "common/io/tables/trc_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/tables/column_names.h"
#include "common/io/tables/trc_reader.h"
#include "common/support/error.h"
#include "tests/support/stick_model.h"
#include "tests/support/strict_tables.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using testing::ReadStrictTrc;
using testing::StickModel;
using testing::StrictTrc;

// Two labels in three frames; RKNE is not seen in the last, nobody in the second.
MarkerSequence Measured() {
  MarkerSequence markers({"L KNE", "RKNE"}, 3, 120, 0.25);
  markers.frame(0) << 0.1, 0.4, -0.25, 0.5, 1, 0.00000006;
  markers.frame(2).col(0) << 1, 2, 3;
  return markers;
}

// Upright, then turned by a right angle about the upward axis, then with both knees bent.
PoseTrajectory Moves() {
  PoseTrajectory trajectory;
  trajectory.rate = 120;
  trajectory.first_time = 0.25;
  trajectory.joint_names = {"hip", "knee"};
  Posture q;
  q.joint_angles = Eigen::Vector2d::Zero();
  trajectory.postures.push_back(q);
  q.orientation = Eigen::Quaterniond(0.5, 0, 0, 0.5).normalized();
  trajectory.postures.push_back(q);
  q.orientation.setIdentity();
  q.joint_angles = Eigen::Vector2d(0, 1);
  trajectory.postures.push_back(q);
  return trajectory;
}

TEST(TrcWriterTest, WritesEveryByteOfTheFormat) {
  const MarkerSequence measured = Measured();
  EXPECT_EQ(Join(FormatTrc({"my walk.trc", 41, &measured, {}, nullptr, nullptr})),
            "PathFileType\t4\t(X/Y/Z)\tmy_walk.trc\n"
            "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
            "OrigNumFrames\n"
            "120\t120\t3\t2\tmm\t120\t41\t3\n"
            "Frame#\tTime\tL_KNE\t\t\tRKNE\t\t\t\n"
            "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\t\n"
            "\n"
            "41\t0.25\t100\t1000\t250\t400\t0.0001\t-500\t\n"
            "42\t0.258333333\t\t\t\t\t\t\t\n"
            "43\t0.266666667\t1000\t3000\t-2000\t\t\t\t\n");
}

TEST(TrcWriterTest, TheModelsMarkersStandBehindUnderTheirLabels) {
  const MarkerSequence measured = Measured();
  const KinematicModel model = StickModel();
  const PoseTrajectory trajectory = Moves();
  const StrictTrc trc =
      ReadStrictTrc(Join(FormatTrc({"a.trc",
                                    1,
                                    &measured,
                                    {{LabelIx(1), MarkerIx(0)}, {LabelIx(0), MarkerIx(3)}},
                                    &model,
                                    &trajectory})));
  EXPECT_THAT(trc.labels, ElementsAre("L_KNE", "RKNE", "RKNE_model", "L_KNE_model"));
  EXPECT_THAT(trc.numbers, ElementsAre(1, 2, 3));
  const auto expect = [&](std::size_t frame, const std::string& label, double x, double y,
                          double z) {
    // Four decimals.
    EXPECT_LE((trc.At(frame, label) - Eigen::Vector3d(x, y, z)).cwiseAbs().maxCoeff(), 5.1e-5)
        << frame << label;
  };
  expect(0, "RKNE_model", 100, 0, 0);
  expect(0, "L_KNE_model", 0, 1300, 0);
  expect(1, "RKNE_model", 0, 0, -100);
  // The knee at 0.5 m bends by 1 rad about x, which lowers what is 0.8 m above it and moves it to
  // -y of W, +z of the file.
  expect(2, "L_KNE_model", 0, 500 + 800 * std::cos(1), 800 * std::sin(1));
  EXPECT_TRUE(trc.At(1, "L_KNE").hasNaN());
  expect(2, "L_KNE", 1000, 3000, -2000);
}

TEST(TrcWriterTest, OurReaderHasTheMarkersBack) {
  const MarkerSequence measured = Measured();
  Warnings warnings;
  const MarkerTable trc =
      ParseTrc(Join(FormatTrc({"a.trc", 41, &measured, {}, nullptr, nullptr})), "a.trc", &warnings);
  EXPECT_EQ(trc.unit, "mm");
  EXPECT_EQ(trc.first_frame, 41);
  EXPECT_THAT(warnings.texts(), ElementsAre());
  EXPECT_EQ(trc.markers.rate(), 120);
  EXPECT_EQ(trc.markers.first_time(), 0.25);
  EXPECT_EQ(trc.markers.frame(2).col(0), Eigen::Vector3d(1000, 3000, -2000));
  EXPECT_FALSE(IsSeen(trc.markers.frame(2).col(1)));
}

TEST(TrcWriterTest, LabelsBecomeWordsThatDiffer) {
  const MarkerSequence measured({"a\tb", "a b", "", "x\ny", "a_b", "A_model", "A", "a_b_2"}, 1, 100,
                                0);
  const KinematicModel model = StickModel();
  PoseTrajectory trajectory = Moves();
  trajectory.postures.resize(1);
  const StrictTrc trc = ReadStrictTrc(Join(
      FormatTrc({"a\n\tb.trc", 1, &measured, {{LabelIx(6), MarkerIx(0)}}, &model, &trajectory})));
  EXPECT_THAT(trc.labels, ElementsAre("a_b", "a_b_2", "unnamed", "x_y", "a_b_3", "A_model", "A",
                                      "a_b_2_2", "A_model_2"));
}

TEST(TrcWriterTest, AJointThatTheModelDoesNotHaveIsAnError) {
  const MarkerSequence measured = Measured();
  const KinematicModel model = StickModel();
  PoseTrajectory trajectory = Moves();
  trajectory.joint_names[0] = "ankle";
  EXPECT_THROW(
      Join(FormatTrc({"a.trc", 1, &measured, {{LabelIx(0), MarkerIx(0)}}, &model, &trajectory})),
      Error);
}

TEST(ColumnNamesTest, AreLeftAsTheyAreWhereTheyAreWords) {
  EXPECT_THAT(ColumnNames({"C7", "*12", "\xC3\x84rm", "Anna:LKNE"}),
              ElementsAre("C7", "*12", "\xC3\x84rm", "Anna:LKNE"));
}

}  // namespace
}  // namespace mmm_converter
