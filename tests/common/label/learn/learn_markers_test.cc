// SPDX-License-Identifier: MIT
// Labels that mean nothing: those of made persons and of real recordings, renamed and shuffled.

#include "common/label/learn/learn_markers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "common/convert/converter_config.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/recording/recording.h"
#include "common/label/learn/body_sites.h"
#include "common/math/seeded_random.h"
#include "common/model/model_scaling.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::testing {
namespace {

constexpr double kWearerHeight = 1.78;

struct Renamed {
  MarkerSequence recording;  // m1, m2, ...
  std::vector<int> from;     // by label, column of the recording that was renamed
};

Renamed Rename(const MarkerSequence& recording, std::uint64_t seed) {
  Renamed renamed;
  renamed.from.resize(static_cast<std::size_t>(recording.num_labels()));
  std::iota(renamed.from.begin(), renamed.from.end(), 0);
  SeededRandom random(seed);
  for (std::size_t i = renamed.from.size(); i > 1; --i) {
    std::swap(renamed.from[i - 1], renamed.from[random.UniformIndex(static_cast<int>(i))]);
  }
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < renamed.from.size(); ++i) {
    labels.push_back("m" + std::to_string(i + 1));
  }
  renamed.recording = MarkerSequence(labels, recording.num_frames(), recording.rate(), 0);
  for (int k = 0; k < recording.num_frames(); ++k) {
    renamed.recording.frame(k) = recording.frame(k)(Eigen::all, renamed.from);
  }
  return renamed;
}

struct SiteScore {
  int right = 0, wrong = 0, other_side = 0, left_out = 0;
};

// truth: the segment of each column; empty: not known.
SiteScore ScoreOf(const KinematicModel& model, const std::vector<int>& joints,
                  const LearnedMarkers& learned, const Renamed& renamed,
                  const std::vector<std::string>& truth) {
  const BodySites sites(model, joints);
  const auto site_of = [&](const std::string& segment) {
    const int node = model.FindSegment(segment);
    for (const BodySite& site : sites.sites()) {
      if (std::count(site.nodes.begin(), site.nodes.end(), node) > 0) return &site;
    }
    return static_cast<const BodySite*>(nullptr);
  };
  SiteScore score;
  for (std::size_t i = 0; i < learned.markers.size(); ++i) {
    const LearnedMarker& marker = learned.markers[i];
    const std::string& true_segment = truth[renamed.from[i]];
    if (true_segment.empty()) continue;
    if (!marker.left_out.empty()) {
      ++score.left_out;
      continue;
    }
    const BodySite* const found = site_of(marker.segment);
    const BodySite* const right = site_of(true_segment);
    ++(found == right ? score.right : score.wrong);
    if (found != nullptr && right != nullptr && !found->side.empty() && !right->side.empty() &&
        found->side != right->side) {
      ++score.other_side;
    }
    if (found != right) {
      ADD_FAILURE() << renamed.from[i] << " (" << true_segment << ") on " << marker.segment;
    }
  }
  return score;
}

std::vector<std::string> SegmentsOf(const KinematicModel& model, int labels,
                                    const std::vector<MarkerAssignment>& assignments) {
  std::vector<std::string> segments(static_cast<std::size_t>(labels));
  for (const MarkerAssignment& one : assignments) {
    segments[one.label] = model.segments()[model.markers()[one.marker].segment].name;
  }
  return segments;
}

LearnedMarkers Learn(double height, const MarkerSequence& recording) {
  const KinematicModel reference = ReadMmmModel(SourcePath("xml_config/models/mmm.xml"));
  const auto scale = [height](const KinematicModel& model) {
    return ScaleWinter(model, {height, 70, {}});
  };
  return LearnMarkers({reference, scale, TrackedJoints(reference)}, {&recording}, {});
}

SiteScore LearnMadePerson(std::uint64_t seed) {
  const KinematicModel model = ScaledReferenceModel(kWearerHeight);
  const KinematicModel person = FitToSubject(model, DrawPerson(model, seed));
  const MarkerSequence recorded = RecordPerson(person, RangeOfMotion(model, 6, 0.6, seed), seed);
  const Renamed renamed = Rename(recorded, seed);
  const std::vector<int> joints = TrackedJoints(model);
  const LearnedMarkers learned = Learn(kWearerHeight, renamed.recording);
  return ScoreOf(model, joints, learned, renamed,
                 SegmentsOf(model, recorded.num_labels(), AssignAll(model, recorded)));
}

TEST(LearnMarkersTest, AMadePersonsMarkersAreOnTheRightSegmentsOrLeftOut) {
  for (const std::uint64_t seed : {921, 922}) {
    SCOPED_TRACE(seed);
    const SiteScore score = LearnMadePerson(seed);
    EXPECT_EQ(score.wrong, 0);
    EXPECT_EQ(score.other_side, 0);
    EXPECT_GE(score.right, 43);
  }
}

SiteScore LearnReal(const std::string& file, double height) {
  const Recording recording = ReadRecording(SharedData(file), {});
  const KinematicModel model = ScaledReferenceModel(height);
  ConverterConfig config;
  const auto reference = std::make_shared<const KinematicModel>(model);
  const TrackingSetup setup = MatchMarkers(LabelsOf(recording.markers), reference, config);
  const Renamed renamed = Rename(recording.markers, 5);
  const LearnedMarkers learned = Learn(height, renamed.recording);
  return ScoreOf(model, setup.joints, learned, renamed,
                 SegmentsOf(model, recording.markers.num_labels(), setup.assignments()));
}

TEST(LearnMarkersRealFilesTest, KitsSet) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const SiteScore score = LearnReal("recordings/kit_bimanual_c3d/Close_1723.c3d", 1.68);
  EXPECT_EQ(score.other_side, 0);
  EXPECT_GE(score.right, 50);
}

TEST(LearnMarkersRealFilesTest, PluginGait) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const SiteScore score = LearnReal("recordings/whole_body/kinematics_tennis_serve.c3d", 1.63);
  EXPECT_EQ(score.other_side, 0);
  EXPECT_GE(score.right, 35);
}

/// The legs' markers under Plug-in Gait's names, in twelve equal frames.
MarkerSequence StandingLegs(const MarkerSequence& recorded, std::vector<int>* columns) {
  std::vector<std::string> labels;
  for (const char* name : {"LASI", "RASI", "LPSI", "RPSI", "LTHI", "RTHI", "LKNE", "RKNE", "LTIP",
                           "RTIP", "LANK", "RANK", "LHEE", "RHEE", "LMT5", "RMT5"}) {
    columns->push_back(recorded.FindLabel(name));
    labels.emplace_back(name);
    if (labels.back().ends_with("TIP")) labels.back().back() = 'B';
  }
  MarkerSequence legs(labels, 12, 100, 0);
  for (int k = 0; k < 12; ++k) legs.frame(k) = recorded.frame(0)(Eigen::all, *columns);
  return legs;
}

TEST(LearnMarkersTest, NamedLegsOfOneWhoStandsAreLegs) {
  const KinematicModel model = ScaledReferenceModel(kWearerHeight);
  const KinematicModel person = FitToSubject(model, DrawPerson(model, 923));
  const MarkerSequence recorded = RecordPerson(person, RangeOfMotion(model, 1, 0.1, 923), 923);
  Renamed legs;
  legs.recording = StandingLegs(recorded, &legs.from);
  const LearnedMarkers learned = Learn(kWearerHeight, legs.recording);
  std::vector<std::string> segments =
      SegmentsOf(model, recorded.num_labels(), AssignAll(model, recorded));
  // The malleoli are the shank's; the model has its own markers on the foot, at the joint's axis.
  for (const char side : {'L', 'R'}) {
    const int ankle = recorded.FindLabel(side + std::string("ANK"));
    segments[static_cast<std::size_t>(ankle)] = side + std::string("Asegment_joint");
  }
  const SiteScore score = ScoreOf(model, TrackedJoints(model), learned, legs, segments);
  EXPECT_EQ(score.wrong, 0);
  EXPECT_GE(score.right, 12);
}

// One who exchanged all sides: told, and the markers are where the body has them.
TEST(LearnMarkersTest, ExchangedSidesAreTold) {
  const KinematicModel model = ScaledReferenceModel(kWearerHeight);
  const KinematicModel person = FitToSubject(model, DrawPerson(model, 924));
  const MarkerSequence recorded = RecordPerson(person, RangeOfMotion(model, 2, 0.4, 924), 924);
  std::vector<std::string> labels = recorded.labels();
  for (std::string& label : labels) {
    if (label.starts_with('R')) {
      label.front() = 'L';
    } else if (label.starts_with('L') && label != "L3") {
      label.front() = 'R';
    }
  }
  MarkerSequence exchanged(labels, recorded.num_frames(), recorded.rate(), 0);
  for (int k = 0; k < recorded.num_frames(); ++k) exchanged.frame(k) = recorded.frame(k);
  const LearnedMarkers learned = Learn(kWearerHeight, exchanged);
  const auto told = [](const std::string& text) { return text.find("xchanged") != text.npos; };
  EXPECT_TRUE(std::any_of(learned.warnings.begin(), learned.warnings.end(), told));
}

TEST(LearnMarkersTest, TooFewLabels) {
  const MarkerSequence recording({"a", "b", "c"}, 10, 100, 0);
  EXPECT_THROW(Learn(kWearerHeight, recording), Error);
}

TEST(LearnMarkersTest, NothingIsSeen) {
  std::vector<std::string> labels;
  for (int i = 0; i < 12; ++i) labels.push_back("m" + std::to_string(i));
  const MarkerSequence recording(labels, 10, 100, 0);
  EXPECT_THROW(Learn(kWearerHeight, recording), Error);
}

TEST(LearnMarkersTest, NoiseIsNobody) {
  SeededRandom random(5);
  std::vector<std::string> labels;
  for (int i = 0; i < 40; ++i) labels.push_back("m" + std::to_string(i));
  MarkerSequence recording(labels, 60, 10, 0);
  for (int k = 0; k < recording.num_frames(); ++k) {
    for (double& x : recording.frame(k).reshaped()) x = 2 * random.Uniform();
  }
  EXPECT_THROW(Learn(kWearerHeight, recording), Error);
}

TEST(LearnMarkersTest, TooManyLabelsAreAnErrorAtOnce) {
  std::vector<std::string> labels;
  for (int i = 0; i < 65535; ++i) labels.push_back("m" + std::to_string(i));
  MarkerSequence recording(labels, 1, 100, 0);
  recording.frame(0).setOnes();
  EXPECT_THROW(Learn(kWearerHeight, recording), Error);
}

}  // namespace
}  // namespace mmm_converter::testing
