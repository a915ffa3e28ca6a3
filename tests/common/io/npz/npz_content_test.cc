// SPDX-License-Identifier: MIT
// Motions of SMPL and places of joints that are read as recordings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>

#include "common/io/npz/npz_file.h"
#include "common/io/npz/smpl_model.h"
#include "common/io/recording/recording.h"
#include "common/io/tables/npz_writer.h"
#include "common/math/rotation.h"
#include "common/support/error.h"
#include "common/support/text_pieces.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kFrames = 12;

std::string Bytes(const std::vector<NpyArray>& arrays) {
  std::string bytes;
  FormatNpz(arrays)([&](std::string_view piece) { bytes += piece; });
  return bytes;
}

std::string FileOf(const std::string& bytes, const std::string& name = "walk.npz") {
  std::string file = testing::TestFolder() + "/" + name;
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

NpyArray Numbers(const std::string& name, std::vector<std::int64_t> shape,
                 const std::vector<double>& numbers) {
  return {name, std::move(shape), numbers, {}};
}

/// Rotation vectors of someone who steps, z up.
std::vector<double> Poses(std::size_t columns) {
  std::vector<double> poses(kFrames * columns, 0);
  for (std::size_t k = 0; k < kFrames; ++k) {
    double* const row = poses.data() + k * columns;
    const double swing = 0.6 * std::sin(0.5 * static_cast<double>(k));
    row[0] = EIGEN_PI / 2;
    row[3 * 1] = swing, row[3 * 2] = -swing;                     // hips
    row[3 * 4] = 0.3 + swing / 3, row[3 * 5] = 0.3 - swing / 3;  // knees
    row[3 * 16 + 2] = -1.2, row[3 * 17 + 2] = 1.2;               // shoulders
    row[3 * 18 + 1] = -0.5 + swing / 4, row[3 * 19 + 1] = 0.4;
    row[3 * 3 + 1] = 0.1 * swing;
  }
  return poses;
}

std::vector<double> Translation() {
  std::vector<double> translation;
  for (int k = 0; k < kFrames; ++k) translation.insert(translation.end(), {0.1 * k, 0.2, 1});
  return translation;
}

/// What the equations of SMPL give.
std::vector<Matrix3Xd> PlacesOf(const std::vector<double>& poses, const Matrix3Xd& rest) {
  const std::size_t columns = poses.size() / kFrames;
  const std::vector<double> translation = Translation();
  std::vector<Matrix3Xd> places;
  for (std::size_t k = 0; k < kFrames; ++k) {
    Matrix3Xd p(3, kSmplJoints);
    std::vector<Matrix3d> R;
    for (int j = 0; j < kSmplJoints; ++j) {
      const auto at = static_cast<std::size_t>(j);
      const Vector3d turn(poses.data() + k * columns + 3 * at);
      const Matrix3d local =
          Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix();
      const int parent = SmplJoints()[at].parent;
      const Matrix3d above =
          parent < 0 ? Matrix3d(Matrix3d::Identity()) : R[static_cast<std::size_t>(parent)];
      R.push_back(above * local);
      if (parent < 0)
        p.col(j) = rest.col(j) + Vector3d(translation.data() + 3 * k);
      else
        p.col(j) = p.col(parent) + above * (rest.col(j) - rest.col(parent));
    }
    places.push_back(p);
  }
  return places;
}

void ExpectPlaces(const Recording& recording, const std::vector<Matrix3Xd>& places) {
  ASSERT_EQ(recording.markers.num_frames(), static_cast<int>(places.size()));
  for (int j = 0; j < kSmplJoints; ++j) {
    const std::string name = SmplJoints()[static_cast<std::size_t>(j)].name;
    const int label = recording.markers.FindLabel(name);
    ASSERT_GE(label, 0) << name;
    for (std::size_t k = 0; k < places.size(); ++k) {
      EXPECT_LT((recording.markers.frame(static_cast<int>(k)).col(label) - places[k].col(j)).norm(),
                1e-9)
          << name << " in frame " << k;
    }
  }
}

std::string LabelOf(const Recording& recording, BodyJoint joint, const std::string& side) {
  for (const SkeletonJoint& one : recording.body) {
    if (one.joint == joint && one.side == side) {
      return recording.markers.labels()[static_cast<std::size_t>(one.label)];
    }
  }
  return "";
}

std::vector<NpyArray> Amass() {
  return {Numbers("poses", {kFrames, 156}, Poses(156)),
          Numbers("trans", {kFrames, 3}, Translation()), Numbers("mocap_framerate", {}, {120})};
}

TEST(NpzContent, JointsAreThoseOfTheBodyModel) {
  SmplModel model = StandInSmplModel(SmplKind::kSmplH);
  model.directions = {0.1 * model.joints, -0.05 * model.joints};
  // A vertex for each joint.
  const std::int64_t count = kSmplJoints;
  std::vector<double> vertices(model.joints.data(), model.joints.data() + 3 * count);
  std::vector<double> shapes, weights(count * count, 0);
  for (const double coordinate : vertices) {
    for (const double share : {0.1, -0.05}) shapes.push_back(share * coordinate);
  }
  for (std::size_t j = 0; j < kSmplJoints; ++j) weights[j * (kSmplJoints + 1)] = 1;
  const std::string file = FileOf(Bytes({Numbers("v_template", {count, 3}, vertices),
                                         Numbers("shapedirs", {count, 3, 2}, shapes),
                                         Numbers("J_regressor", {count, count}, weights)}),
                                  "model.npz");
  std::vector<NpyArray> arrays = Amass();
  arrays.push_back(Numbers("betas", {1, 3}, {0.5, -1, 7}));
  const auto truth = PlacesOf(Poses(156), model.Joints({0.5, -1}));
  const Recording recording = ReadRecording(FileOf(Bytes(arrays)), {.smpl_model = file});
  ExpectPlaces(recording, truth);
  EXPECT_EQ(recording.format, "AMASS");
  EXPECT_EQ(recording.markers.rate(), 120);
  EXPECT_EQ(recording.up_axis, UpAxis::kZ);
  EXPECT_EQ(LabelOf(recording, BodyJoint::kKnee, "L"), "L_Knee");
  EXPECT_EQ(recording.body.size(), 18U);
  // The same in parts.
  const std::vector<double> poses = Poses(66);
  std::vector<double> roots, bodies;
  for (std::size_t i = 0; i < poses.size(); ++i) (i % 66 < 3 ? roots : bodies).push_back(poses[i]);
  arrays = {Numbers("root_orient", {kFrames, 3}, roots),
            Numbers("pose_body", {kFrames, 63}, bodies),
            Numbers("trans", {kFrames, 3}, Translation()), Numbers("betas", {2}, {0.5, -1}),
            Numbers("mocap_time_length", {}, {kFrames / 60.0})};
  const Recording parts = ReadRecording(FileOf(Bytes(arrays)), {.smpl_model = file});
  ExpectPlaces(parts, truth);
  EXPECT_EQ(parts.markers.rate(), 60);
}

TEST(NpzContent, WithoutAModelTheBodyIsOneOfUsualSize) {
  Warnings warnings;
  const Recording recording = ReadRecording(FileOf(Bytes(Amass())), {}, &warnings);
  ExpectPlaces(recording, PlacesOf(Poses(156), StandInSmplModel(SmplKind::kSmplH).joints));
  EXPECT_THAT(warnings.texts(), ::testing::Contains(HasSubstr("SMPL's own model is not given")));
  std::vector<NpyArray> arrays = Amass();
  arrays.front() = Numbers("poses", {kFrames, 165}, Poses(165));
  ExpectPlaces(ReadRecording(FileOf(Bytes(arrays)), {}),
               PlacesOf(Poses(165), StandInSmplModel(SmplKind::kSmplX).joints));
}

TEST(NpzContent, RotationsHaveTheShapesOfThese) {
  const auto refusal = [](const std::vector<std::int64_t>& shape) -> std::string {
    std::int64_t size = 1;
    for (const std::int64_t length : shape) size *= length;
    std::vector<NpyArray> arrays = Amass();
    arrays.front() = Numbers("poses", shape, std::vector<double>(static_cast<std::size_t>(size)));
    try {
      ReadRecording(FileOf(Bytes(arrays)), {});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  for (const std::int64_t columns : {66, 72, 156, 165, 198, 216}) {
    EXPECT_THAT(refusal({kFrames, columns}), Not(HasSubstr("expected"))) << columns;
    EXPECT_THAT(refusal({kFrames, 1, columns}), Not(HasSubstr("expected"))) << columns;
    EXPECT_THAT(refusal({kFrames, columns / 3, 3}), Not(HasSubstr("expected"))) << columns;
  }
  EXPECT_THAT(refusal({kFrames, 24, 3, 3}), Not(HasSubstr("expected")));
  EXPECT_THAT(refusal({kFrames, 22, 9}), Not(HasSubstr("expected")));
  // Quaternions, the six numbers of which networks learn, batches, features.
  for (const std::vector<std::int64_t>& shape : {std::vector<std::int64_t>{kFrames, 24, 4},
                                                 {kFrames, 24, 6},
                                                 {kFrames, 132},
                                                 {kFrames, 144},
                                                 {1, kFrames, 165},
                                                 {kFrames, 263},
                                                 {kFrames, 63}}) {
    EXPECT_THAT(refusal(shape), HasSubstr("expected rotation vectors or matrices of 22 joints"));
  }
}

TEST(NpzContent, ArraysOfOneAxisAreAFrame) {
  std::vector<double> poses = Poses(72);
  poses.resize(72);
  const Recording recording =
      ReadRecording(FileOf(Bytes({Numbers("poses", {72}, poses), Numbers("trans", {3}, {0, 0.2, 1}),
                                  Numbers("mocap_framerate", {1}, {120})})),
                    {});
  ASSERT_EQ(recording.markers.num_frames(), 1);
  const auto truth = PlacesOf(Poses(72), StandInSmplModel(SmplKind::kSmplH).joints);
  ExpectPlaces(recording, {truth.front()});
}

TEST(NpzContent, FramesWithWhatIsNoNumberAreNotKnown) {
  std::vector<NpyArray> arrays = Amass();
  arrays[0].numbers[3 * 156 + 20] = NAN;
  arrays[1].numbers[3 * 5] = 1e300;
  const Recording recording = ReadRecording(FileOf(Bytes(arrays)), {});
  for (int k = 0; k < kFrames; ++k) {
    EXPECT_EQ(recording.markers.frame(k).array().isNaN().all(), k == 3 || k == 5) << k;
  }
}

TEST(NpzContent, PlacesOfJointsAreSmplsOrLafans) {
  const auto truth = PlacesOf(Poses(66), StandInSmplModel(SmplKind::kSmplH).joints);
  constexpr std::size_t kLafan[] = {0, 1,  4,  7,  10, 2,  5,  8,  11, 3,  6,
                                    9, 12, 15, 13, 16, 18, 20, 14, 17, 19, 21};
  std::vector<double> smpl, lafan;
  for (const Matrix3Xd& p : truth) {
    for (std::size_t j = 0; j < kSmplJoints; ++j) {
      for (int a = 0; a < 3; ++a) {
        smpl.push_back(p(a, static_cast<int>(j)));
        lafan.push_back(100 * p(a, static_cast<int>(kLafan[j])));
      }
    }
  }
  const std::vector<std::int64_t> shape = {kFrames, kSmplJoints, 3};
  const Recording npz = ReadRecording(
      FileOf(Bytes({Numbers("global_joint_positions", shape, smpl), Numbers("fps", {}, {30})})),
      {});
  ExpectPlaces(npz, truth);
  EXPECT_EQ(npz.markers.rate(), 30);
  EXPECT_EQ(npz.unit, "m");
  const std::string npy = FileOf(FormatNpy(Numbers("", shape, lafan)), "walk.npy");
  EXPECT_THAT([&] { ReadRecording(npy, {}); },
              ::testing::ThrowsMessage<Error>(HasSubstr("gives no frame rate")));
  const Recording of_npy = ReadRecording(npy, {.rate = 30});
  EXPECT_EQ(LabelOf(of_npy, BodyJoint::kKnee, "R"), "RightLeg");
  EXPECT_EQ(of_npy.unit, "cm");
  EXPECT_LT((of_npy.markers.frame(3).col(4) - truth[3].col(10)).norm(), 1e-9);
}

TEST(NpzContent, PlacesOfJointsInAnotherOrderAreRefused) {
  const auto truth = PlacesOf(Poses(66), StandInSmplModel(SmplKind::kSmplH).joints);
  constexpr int kChains[] = {0,  3,  6,  9, 12, 15, 13, 16, 18, 20, 14,
                             17, 19, 21, 1, 4,  7,  10, 2,  5,  8,  11};
  std::vector<double> places;
  for (const Matrix3Xd& p : truth) {
    for (const int j : kChains) places.insert(places.end(), p.col(j).begin(), p.col(j).end());
  }
  const std::string file =
      FileOf(FormatNpy(Numbers("", {kFrames, kSmplJoints, 3}, places)), "walk.npy");
  EXPECT_THAT([&] { ReadRecording(file, {.rate = 30}); },
              ::testing::ThrowsMessage<Error>(HasSubstr("in another order")));
}

TEST(NpzContent, RowsOfMotionXAreMotions) {
  constexpr std::size_t kColumns = 322;
  std::vector<double> rows(kFrames * kColumns, 0);
  const std::vector<double> poses = Poses(66), translation = Translation();
  for (std::size_t k = 0; k < kFrames; ++k) {
    std::copy_n(poses.data() + 66 * k, 66, rows.data() + kColumns * k);
    std::copy_n(translation.data() + 3 * k, 3, rows.data() + kColumns * k + 309);
  }
  const std::string file = FileOf(FormatNpy(Numbers("", {kFrames, kColumns}, rows)), "walk.npy");
  const Recording recording = ReadRecording(file, {.rate = 30});
  ExpectPlaces(recording, PlacesOf(poses, StandInSmplModel(SmplKind::kSmplX).joints));
  EXPECT_EQ(recording.format, "Motion-X");
  const std::string features =
      FileOf(FormatNpy(Numbers("", {2, 263}, std::vector<double>(526))), "features.npy");
  EXPECT_THAT([&] { ReadRecording(features, {.rate = 20}); },
              ::testing::ThrowsMessage<Error>(HasSubstr("features of HumanML3D")));
}

TEST(NpzContent, BrokenArchivesAreRefused) {
  const std::string whole = Bytes(Amass());
  const auto refusal = [](const std::string& bytes) -> std::string {
    try {
      ReadRecording(FileOf(bytes), {});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  for (const std::size_t size : {std::size_t{80}, whole.size() / 2, whole.size() - 1}) {
    EXPECT_THAT(refusal(whole.substr(0, size)), HasSubstr("walk.npz: ")) << size;
  }
  std::string changed = whole;
  changed[2000] = static_cast<char>(changed[2000] ^ 1);
  EXPECT_THAT(refusal(changed), HasSubstr("poses is damaged"));
  std::string huge = whole;
  const std::size_t directory = huge.find("PK\x01\x02");
  huge.replace(directory + 24, 4, "\xff\xff\xff\x7f");
  EXPECT_THAT(refusal(huge), HasSubstr("poses would have 2.1 GB"));
  EXPECT_THAT(refusal(Bytes({Numbers("foo", {1}, {1})})), HasSubstr("it has foo"));
  EXPECT_THAT(refusal(Bytes({Numbers("poses", {2, 3}, {1, 2, 3, 4, 5, 6})})),
              HasSubstr("poses has the shape (2, 3)"));
  EXPECT_THAT(refusal(Bytes({Numbers("joints", {1, 2, 3}, {1, 2, 3, 4, 5, 6})})),
              HasSubstr("joints: has the shape (1, 2, 3)"));
}

TEST(NpzContent, NamesThatArePathsAreNames) {
  std::vector<NpyArray> arrays = Amass();
  arrays.insert(arrays.begin(), Numbers("../../evil", {1}, {1}));
  const std::string file = FileOf(Bytes(arrays));
  EXPECT_EQ(ReadRecording(file, {}).markers.num_frames(), kFrames);
  EXPECT_TRUE(NpzFile(file).Has("../../evil"));
  EXPECT_FALSE(std::filesystem::exists(testing::TestFolder() + "/../../evil.npy"));
}

}  // namespace
}  // namespace mmm_converter
