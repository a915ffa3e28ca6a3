// SPDX-License-Identifier: MIT
// Persons of other lengths than the model's, markers beside its places, soft tissue; their labels
// taken away, points shuffled in every frame. Truth is known to the point.

#include "common/label/track/label_recording.h"

#include <gtest/gtest.h>

#include <numeric>

#include "common/math/seeded_random.h"
#include "common/support/error.h"
#include "common/support/units.h"
#include "tests/support/all_indices.h"
#include "tests/support/changed_markers.h"
#include "tests/support/synthetic_person.h"
#include "tests/support/unnamed_points.h"

namespace mmm_converter::testing {
namespace {

constexpr double kHeight = 1.78;

struct RecordedPerson {
  MarkerSequence recording;
  TrackingSetup calibrated;    // the true body and places
  TrackingSetup uncalibrated;  // the model of the person's height
  std::vector<int> names;      // 0, 1, ...
};

RecordedPerson Record(std::uint64_t seed, double seconds, double marker_deviation = 0.028,
                      const std::string& far_marker = "",
                      const Eigen::Vector3d& far = Eigen::Vector3d::Zero()) {
  const KinematicModel model = ScaledReferenceModel(kHeight);
  Subject subject = DrawPerson(model, seed, marker_deviation);
  for (MarkerOffset& offset : subject.offsets) {
    if (offset.marker == far_marker) offset.offset += far;
    offset.standard_deviations.setConstant(0.005);
    offset.skin_deviation = 0.004;
  }
  const KinematicModel person = FitToSubject(model, subject);
  RecordedPerson made;
  made.recording = RecordPerson(person, RangeOfMotion(model, seconds, 0.6, seed), seed);
  const auto assignments = AssignAll(model, made.recording);
  made.calibrated = SetupOf(person, TrackedJoints(model), assignments);
  made.uncalibrated = SetupOf(model, TrackedJoints(model), assignments);
  made.names.resize(made.recording.num_labels());
  std::iota(made.names.begin(), made.names.end(), 0);
  return made;
}

TEST(LabelRecordingTest, ACalibratedPersonsPointsGetTheirNames) {
  const RecordedPerson made = Record(901, 3);
  const UnnamedPoints points = MakeUnnamed(made.recording, {}, 1);
  const Labelling labelling =
      LabelRecording({{made.calibrated}}, made.recording.labels(), points.points, {}, {});
  const LabelScore score = ScoreLabels(points, labelling, made.names);
  EXPECT_GE(score.right, 0.999);
  EXPECT_LE(score.wrong, 0.0001);
}

TEST(LabelRecordingTest, HiddenMarkersAndGhosts) {
  const RecordedPerson made = Record(902, 3);
  UnnamedErrors errors;
  errors.hidden = 0.3;
  errors.ghosts = 5;
  const UnnamedPoints points = MakeUnnamed(made.recording, errors, 2);
  const Labelling labelling =
      LabelRecording({{made.calibrated}}, made.recording.labels(), points.points, {}, {});
  const LabelScore score = ScoreLabels(points, labelling, made.names);
  EXPECT_GE(score.right, 0.99);
  EXPECT_LE(score.wrong, 0.003);
}

// Markers that were put on 28 mm (rms per axis) from the model's places can be nearer to their
// neighbour's: such pairs may change names, whole limbs and sides may not.
TEST(LabelRecordingTest, HeightAloneTellsAllButNeighbours) {
  const RecordedPerson made = Record(903, 3);
  const UnnamedPoints points = MakeUnnamed(made.recording, {}, 3);
  const Labelling labelling =
      LabelRecording({{made.uncalibrated}}, made.recording.labels(), points.points, {}, {});
  const LabelScore score = ScoreLabels(points, labelling, made.names);
  EXPECT_GE(score.right, 0.95);
  EXPECT_LE(score.right + score.wrong, 1);
  for (const NamedPiece& piece : labelling.pieces) {
    const int truth = points.truth[piece.begin][piece.point];
    if (piece.name < 0 || truth < 0 || truth == piece.name) continue;
    const auto place = [&](int label) -> Eigen::Vector3d {
      return made.recording.frame(piece.begin).col(label);
    };
    EXPECT_LT((place(truth) - place(piece.name)).norm(), 0.12)
        << made.recording.labels()[truth] << " as " << made.recording.labels()[piece.name];
  }
}

int FramesRightlyNamed(const UnnamedPoints& points, const Labelling& labelling, int name) {
  int right = 0;
  for (const NamedPiece& piece : labelling.pieces) {
    for (int k = piece.begin; k < piece.end; ++k) {
      if (piece.name == name && points.truth[k][piece.point] == name) ++right;
    }
  }
  return right;
}

// As markers of the shin and the thigh are: without a look elsewhere that point has no name.
TEST(LabelRecordingTest, OfTheHeightAloneAMarkerMayBeFarFromTheModelsPlace) {
  const RecordedPerson made = Record(905, 3, 0.008, "MARKER_RTIP", {0, 0.02, -0.13});
  const UnnamedPoints points = MakeUnnamed(made.recording, {}, 5);
  const Labelling labelling =
      LabelRecording({{made.uncalibrated}}, made.recording.labels(), points.points, {}, {});
  const int far = made.recording.FindLabel("RTIP");
  EXPECT_GE(FramesRightlyNamed(points, labelling, far), 0.95 * made.recording.num_frames());
  EXPECT_LE(ScoreLabels(points, labelling, made.names).wrong, 0.005);
}

TEST(LabelRecordingTest, AMarkerMayHaveBeenPutOnElsewhereSince) {
  const RecordedPerson before = Record(906, 3);
  const RecordedPerson now = Record(906, 3, 0.028, "MARKER_LTHI", {0.02, 0, 0.06});
  const UnnamedPoints points = MakeUnnamed(now.recording, {}, 6);
  const Labelling labelling =
      LabelRecording({{before.calibrated}}, now.recording.labels(), points.points, {}, {});
  const int moved = now.recording.FindLabel("LTHI");
  EXPECT_GE(FramesRightlyNamed(points, labelling, moved), 0.95 * now.recording.num_frames());
  EXPECT_LE(ScoreLabels(points, labelling, now.names).wrong, 0.001);
}

// For a second, and turned round on the other side of the room.
TEST(LabelRecordingTest, WhoLeavesAndReturnsIsFoundAgain) {
  const RecordedPerson made = Record(907, 3);
  MarkerSequence recording = made.recording;
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ()));
  for (int k = 100; k < recording.num_frames(); ++k) {
    if (k < 200) {
      recording.frame(k).setConstant(kNaN);
    } else {
      recording.frame(k) = (turn * recording.frame(k)).colwise() + Eigen::Vector3d(2, 1, 0);
    }
  }
  const UnnamedPoints points = MakeUnnamed(recording, {}, 7);
  const Labelling labelling =
      LabelRecording({{made.calibrated}}, recording.labels(), points.points, {}, {});
  const LabelScore score = ScoreLabels(points, labelling, made.names);
  EXPECT_GE(score.right, 0.99);
  EXPECT_LE(score.wrong, 0.001);
}

TEST(LabelRecordingTest, ExchangedLabelsAreMendedAndNothingElseChanges) {
  const RecordedPerson made = Record(904, 3);
  const MarkerSequence swapped = testing::SwapMarkers(made.recording, "LANK", "RANK", 100, 200);
  LabelOptions options;
  options.stored = AllIndices<LabelIx>(swapped.labels().size());
  const Labelling labelling =
      LabelRecording({{made.calibrated}}, swapped.labels(), swapped, options, {});
  const int left = swapped.FindLabel("LANK");
  const int right = swapped.FindLabel("RANK");
  for (const NamedPiece& piece : labelling.pieces) {
    for (int k = piece.begin; k < piece.end; ++k) {
      const bool is_swapped = k >= 100 && k < 200 && (piece.point == left || piece.point == right);
      const int expected = is_swapped ? left + right - piece.point : static_cast<int>(piece.point);
      EXPECT_EQ(piece.name, expected) << "frame " << k;
    }
  }
}

TEST(LabelRecordingTest, PiecesCoverWhatIsSeenAndDoNotOverlap) {
  const RecordedPerson made = Record(905, 1);
  UnnamedErrors errors;
  errors.hidden = 0.2;
  errors.ghosts = 3;
  const UnnamedPoints points = MakeUnnamed(made.recording, errors, 5);
  const Labelling labelling =
      LabelRecording({{made.calibrated}}, made.recording.labels(), points.points, {}, {});
  Eigen::MatrixXi covered =
      Eigen::MatrixXi::Zero(points.points.num_labels(), points.points.num_frames());
  Eigen::MatrixXi named =
      Eigen::MatrixXi::Zero(made.recording.num_labels(), points.points.num_frames());
  for (const NamedPiece& piece : labelling.pieces) {
    EXPECT_GE(piece.probability, 0);
    EXPECT_LE(piece.probability, 1);
    for (int k = piece.begin; k < piece.end; ++k) {
      covered(static_cast<int>(piece.point), k) += 1;
      if (piece.name >= 0) named(piece.name, k) += 1;
    }
  }
  for (int k = 0; k < points.points.num_frames(); ++k) {
    for (int c = 0; c < points.points.num_labels(); ++c) {
      EXPECT_EQ(covered(c, k), IsSeen(points.points.frame(k).col(c)) ? 1 : 0);
    }
  }
  EXPECT_LE(named.maxCoeff(), 1);
}

/// Recordings side by side; of each its labels' indices among all.
struct Together {
  MarkerSequence recording;
  std::vector<std::vector<LabelIx>> labels;
};

Together PutTogether(const std::vector<MarkerSequence>& parts) {
  Together together;
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    together.labels.emplace_back();
    for (const std::string& label : parts[i].labels()) {
      together.labels.back().emplace_back(static_cast<int>(labels.size()));
      labels.push_back(std::to_string(i) + ":" + label);
    }
  }
  together.recording = MarkerSequence(labels, parts[0].num_frames(), parts[0].rate(), 0);
  for (int k = 0; k < parts[0].num_frames(); ++k) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      for (int c = 0; c < parts[i].num_labels(); ++c) {
        together.recording.frame(k).col(together.labels[i][c]) = parts[i].frame(k).col(c);
      }
    }
  }
  return together;
}

/// The recording, moved along x: `from` [m] in the first frame, `to` in the last.
MarkerSequence Shifted(MarkerSequence recording, double from, double to) {
  for (int k = 0; k < recording.num_frames(); ++k) {
    const double share = static_cast<double>(k) / recording.num_frames();
    recording.frame(k).row(0).array() += from + share * (to - from);
  }
  return recording;
}

/// Five markers that swing and turn, 1 m from the origin, with a noise of 0.5 mm.
MarkerSequence SwingingBox(const Eigen::Matrix3Xd& p_OM, int frames, std::uint64_t seed) {
  SeededRandom random(seed);
  MarkerSequence box({"1", "2", "3", "4", "5"}, frames, 100, 0);
  for (int k = 0; k < frames; ++k) {
    const Eigen::Matrix3d R(Eigen::AngleAxisd(0.02 * k, Eigen::Vector3d(1, 2, 2) / 3));
    const Eigen::Vector3d p(std::sin(0.03 * k), std::cos(0.03 * k), 1);
    box.frame(k) = (R * p_OM).colwise() + p;
    for (double& x : box.frame(k).reshaped()) x += 0.0005 * random.Normal();
  }
  return box;
}

TrackingSetup WithLabels(TrackingSetup setup, const std::vector<LabelIx>& labels) {
  for (MarkerAssignment& one : setup.mapping.assignments) one.label = labels[one.label];
  return setup;
}

// From 2 m apart until each reaches behind the other.
TEST(LabelRecordingTest, PointsOfTwoPersonsAndABoxGoToTheirs) {
  constexpr std::uint64_t kSeed = 921;
  const RecordedPerson anna = Record(kSeed, 2);
  const RecordedPerson ben = Record(kSeed + 1, 2);
  Eigen::Matrix3Xd p_OM(3, 5);
  p_OM << 0, 0.2, 0.2, 0, 0.1, 0, 0, 0.14, 0.11, 0.05, 0, 0.01, 0, 0, 0.12;
  const Together together =
      PutTogether({Shifted(anna.recording, -1, -0.4), Shifted(ben.recording, 1, 0.4),
                   SwingingBox(p_OM, anna.recording.num_frames(), kSeed)});
  UnnamedErrors errors;
  errors.hidden = 0.15;
  errors.ghosts = 4;
  const UnnamedPoints points = MakeUnnamed(together.recording, errors, kSeed);
  LabelScene scene;
  scene.persons = {WithLabels(anna.calibrated, together.labels[0]),
                   WithLabels(ben.calibrated, together.labels[1])};
  scene.objects = {{{}, p_OM}};
  for (const LabelIx label : together.labels[2]) scene.objects[0].names.push_back(label);
  const Labelling labelling =
      LabelRecording(scene, together.recording.labels(), points.points, {}, {});
  std::vector<int> names(together.recording.labels().size());
  std::iota(names.begin(), names.end(), 0);
  const LabelScore score = ScoreLabels(points, labelling, names);
  EXPECT_GE(score.right, 0.98);
  EXPECT_LE(score.wrong, 0.005);
}

TEST(LabelRecordingTest, AnObjectThatIsNotThereTakesNoPoints) {
  const RecordedPerson made = Record(925, 1);
  const UnnamedPoints points = MakeUnnamed(made.recording, {}, 7);
  std::vector<std::string> labels = made.recording.labels();
  const int first = static_cast<int>(labels.size());
  labels.insert(labels.end(), {"a", "b", "c", "d"});
  Eigen::Matrix3Xd p_OM(3, 4);
  p_OM << 0, 0.3, 0, 0.1, 0, 0, 0.4, 0.1, 0, 0, 0, 0.25;
  const LabelScene scene = {{made.calibrated}, {{{first, first + 1, first + 2, first + 3}, p_OM}}};
  const Labelling labelling = LabelRecording(scene, labels, points.points, {}, {});
  for (const NamedPiece& piece : labelling.pieces) EXPECT_LT(piece.name, first);
}

TEST(LabelRecordingTest, NobodyIsNotFound) {
  const RecordedPerson made = Record(906, 0.2);
  MarkerSequence noise(made.recording.labels(), 20, 100, 0);
  SeededRandom random(6);
  for (int k = 0; k < 20; ++k) {
    for (int c = 0; c < noise.num_labels(); ++c) {
      for (int i = 0; i < 3; ++i) noise.frame(k)(i, c) = 20 * random.Uniform();
    }
  }
  EXPECT_THROW(LabelRecording({{made.calibrated}}, made.recording.labels(), noise, {}, {}), Error);
}

TEST(LabelRecordingTest, TooManyPointsAreAnError) {
  const RecordedPerson made = Record(908, 0.1);
  MarkerSequence many(std::vector<std::string>(1001, "*"), 1, 100, 0);
  many.frame(0).setZero();
  EXPECT_THROW(LabelRecording({{made.calibrated}}, made.recording.labels(), many, {}, {}), Error);
}

}  // namespace
}  // namespace mmm_converter::testing
