// SPDX-License-Identifier: MIT
// Made persons whose labels are those of other laboratories: names alone have to give the joints'
// centres that KIT's names of the same markers give.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/convert/understood_labels.h"
#include "common/fit/posture_search.h"
#include "common/io/mmm/mmm_model.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "tests/common/convert/vocabularies.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {
namespace {

enum class BodyPart { kFull, kLegs, kThoraxAndLegs, kUpperBody };

bool IsWorn(const std::string& key, BodyPart part) {
  const auto is_one_of = [&](std::string_view all) {
    return all.find(" " + key + " ") != std::string_view::npos;
  };
  const bool is_leg = is_one_of(" %ASI %PSI %HIP %THI %KNE %TIP %ANK %HEE %MT1 %MT5 %TOE ");
  const bool is_trunk = is_one_of(" C7 CLAV STRN T10 L3 %SHO %BAK ");
  if (part == BodyPart::kLegs) return is_leg;
  if (part == BodyPart::kThoraxAndLegs) return is_leg || is_trunk;
  if (part == BodyPart::kUpperBody) return !is_leg || key == "%ASI" || key == "%PSI";
  return true;
}

/// Names of joints whose centres a part shows.
std::vector<std::string> JointsOf(BodyPart part) {
  std::vector<std::string> names;
  for (const char* side : {"L", "R"}) {
    for (const char* joint : {"Hx", "Kx", "Ax"}) {
      if (part != BodyPart::kUpperBody) names.push_back(side + std::string(joint) + "_joint");
    }
    for (const char* joint : {"Sx", "Ex", "Wx"}) {
      const bool is_shown = part == BodyPart::kFull || part == BodyPart::kUpperBody;
      if (is_shown) names.push_back(side + std::string(joint) + "_joint");
    }
  }
  return names;
}

class NamedPersons : public ::testing::Test {
 protected:
  NamedPersons()
      : reference_(ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml"))),
        joints_(testing::TrackedJoints(reference_)),
        table_(testing::SourcePath("xml_config/landmarks.xml")) {}

  /// The reference with KIT's markers where the vocabulary's names of them say that they are worn.
  KinematicModel Worn(const Vocabulary& vocabulary) const {
    ModelDescription description = DescriptionOf(reference_);
    std::vector<std::string> labels, kit;
    for (const auto& [key, label] : vocabulary.labels) {
      AddNames(vocabulary, key, label, &labels, &kit);
    }
    const NamedMarkers named =
        ComposeNamedMarkers(MarkerLabels{labels, {}, ""}, reference_, table_);
    for (const MarkerPlace& place : named.set.places) {
      const auto at = std::find(labels.begin(), labels.end(), place.marker) - labels.begin();
      const int marker = reference_.FindMarker("MARKER_" + kit[static_cast<std::size_t>(at)]);
      ModelMarker& worn = description.markers[static_cast<std::size_t>(marker)];
      worn.segment = reference_.FindSegment(place.segment);
      worn.p_SM = place.p_SM;
    }
    return KinematicModel(std::move(description));
  }

  static void AddNames(const Vocabulary& vocabulary, const std::string& key,
                       const std::string& label, std::vector<std::string>* labels,
                       std::vector<std::string>* kit) {
    const bool has_side = key[0] == '%';
    for (const bool is_left : {true, false}) {
      if (!is_left && !has_side) continue;
      std::string renamed = label;
      if (const auto at = renamed.find('%'); at != std::string::npos) {
        renamed.replace(at, 1, is_left ? vocabulary.left : vocabulary.right);
      }
      labels->push_back(renamed);
      kit->push_back(has_side ? (is_left ? "L" : "R") + key.substr(1) : key);
    }
  }

  MarkerSequence Record(const Vocabulary& vocabulary, std::uint64_t seed,
                        double seconds = 2) const {
    const KinematicModel scaled = ScaleWinter(Worn(vocabulary), {kHeight, 70, {}});
    const KinematicModel person = FitToSubject(scaled, testing::DrawPerson(scaled, seed, kWorn));
    return testing::RecordPerson(person, testing::RangeOfMotion(scaled, seconds, 0.6, seed), seed);
  }

  /// Some of the markers under other labels, and KIT's names of these.
  MarkerSequence Rename(const MarkerSequence& recording, const Vocabulary& vocabulary,
                        BodyPart part, std::vector<std::string>* kit) const {
    std::vector<int> columns;
    std::vector<std::string> labels;
    kit->clear();
    for (const auto& [key, label] : vocabulary.labels) {
      if (IsWorn(key, part)) AddNames(vocabulary, key, label, &labels, kit);
    }
    for (const std::string& name : *kit) columns.push_back(recording.FindLabel(name));
    MarkerSequence renamed(labels, recording.num_frames(), recording.rate(), 0);
    for (int k = 0; k < recording.num_frames(); ++k) {
      renamed.frame(k) = recording.frame(k)(Eigen::all, columns);
    }
    return renamed;
  }

  /// Centres of joints [m] in some frames, by the least-squares postures.
  std::vector<Eigen::Vector3d> Centres(const KinematicModel& reference,
                                       const std::vector<MarkerAssignment>& assignments,
                                       const MarkerSequence& recording, BodyPart part) const {
    const KinematicModel model = ScaleWinter(reference, {kHeight, 70, {}});
    const MarkerKinematics kinematics(model, joints_, MarkerIndices(assignments));
    PostureSearch search(kinematics);
    PostureFitOptions options;
    options.robust_distance = 0.1;
    std::vector<Eigen::Vector3d> centres;
    for (int k = 0; k < recording.num_frames(); k += 50) {
      Posture posture;
      search.Assemble(recording.frame(k)(Eigen::all, LabelIndices(assignments)),
                      NoiseScales(assignments), options, 8, &posture);
      Posture whole = ZeroPosture(model);
      whole.position = posture.position;
      whole.orientation = posture.orientation;
      whole.joint_angles(joints_) = posture.joint_angles;
      const auto poses = SegmentPoses(model, whole);
      for (const std::string& name : JointsOf(part)) {
        centres.push_back(poses[static_cast<std::size_t>(model.FindSegment(name))].translation());
      }
    }
    return centres;
  }

  struct Outcome {
    double mean = 0;  ///< distance of centres from those by KIT's names [m]
    int num_used = 0, num_labels = 0;
    std::string notes;
  };

  Outcome Compare(const Vocabulary& vocabulary, BodyPart part, std::uint64_t seed) const {
    std::vector<std::string> kit;
    const MarkerSequence renamed = Rename(Record(vocabulary, seed), vocabulary, part, &kit);
    std::vector<MarkerAssignment> by_kit;
    for (std::size_t i = 0; i < kit.size(); ++i) {
      by_kit.push_back(
          {LabelIx(static_cast<int>(i)), MarkerIx(reference_.FindMarker("MARKER_" + kit[i])), 1});
    }
    // As a mapping has them: the search is random by their order.
    std::sort(by_kit.begin(), by_kit.end(),
              [](const auto& a, const auto& b) { return a.marker < b.marker; });
    const NamedMarkers named =
        UnderstandLabels(LabelsOf(renamed), renamed, reference_, table_, {joints_, true});
    const KinematicModel placed = PlaceMarkers(named.set, {reference_, true, {}});
    MarkerMapping mapping =
        ResolveMarkerMapping(PairsInModel(named.set, placed), LabelsOf(renamed), placed);
    for (MarkerAssignment& one : mapping.assignments) one.noise_scale = 1;  // as KIT's
    const auto expected = Centres(Worn(vocabulary), by_kit, renamed, part);
    const auto found = Centres(placed, mapping.assignments, renamed, part);
    Outcome outcome;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      outcome.mean += (found[i] - expected[i]).norm() / static_cast<double>(expected.size());
    }
    outcome.num_used = named.num_used();
    outcome.num_labels = static_cast<int>(named.labels.size());
    for (const NamedLabel& one : named.labels) {
      if (!one.note.empty()) outcome.notes += one.label + ": " + one.note + "; ";
    }
    return outcome;
  }

  static constexpr double kHeight = 1.75;
  static constexpr double kWorn = 0.012;  // of landmarks from their places, on each axis [m]
  KinematicModel reference_;
  std::vector<int> joints_;
  LandmarkTable table_;
};

TEST_F(NamedPersons, HaveTheJointsThatKitsNamesGive) {
  constexpr std::pair<BodyPart, const char*> kParts[] = {
      {BodyPart::kFull, "full"},
      {BodyPart::kLegs, "legs"},
      {BodyPart::kThoraxAndLegs, "thorax and legs"},
      {BodyPart::kUpperBody, "upper body"}};
  for (const Vocabulary& vocabulary : Vocabularies()) {
    for (const auto& [part, name] : kParts) {
      const Outcome outcome = Compare(vocabulary, part, 11);
      const std::string what = fmt::format("{}, {}: {}", vocabulary.name, name, outcome.notes);
      EXPECT_EQ(outcome.num_used, outcome.num_labels) << what;
      EXPECT_LT(outcome.mean, 0.02) << what;  // the search is random by the markers' order
    }
  }
}

// Hip and ankle leave the knee anywhere about the line between them.
TEST_F(NamedPersons, WhoseThighsWearClustersAloneAreBelieved) {
  Vocabulary vocabulary = Vocabularies()[3];
  vocabulary.labels.erase("%KNE");
  vocabulary.labels["%THI"] = "%thigh1_study";
  vocabulary.labels["%TIP"] = "%sh1_study";
  for (const std::uint64_t seed : {21, 22, 23, 24}) {
    std::vector<std::string> kit;
    const MarkerSequence legs = Rename(Record(vocabulary, seed), vocabulary, BodyPart::kLegs, &kit);
    const NamedMarkers named =
        UnderstandLabels(LabelsOf(legs), legs, reference_, table_, {joints_, true});
    for (const NamedLabel& one : named.labels) {
      EXPECT_FALSE(one.is_contradicted) << seed << " " << one.label << ": " << one.note;
      EXPECT_FALSE(one.marker.empty()) << seed << " " << one.label << ": " << one.note;
    }
  }
}

// "THA" is a thigh to some, the upper front of a tibia to others.
TEST_F(NamedPersons, WhoseClustersCanBeOfTwoSegmentsWearThemOnTheNearer) {
  Vocabulary vocabulary = Vocabularies()[0];
  vocabulary.labels["%TIP"] = "%THA";
  std::vector<std::string> kit;
  const MarkerSequence legs =
      Rename(Record(Vocabularies()[0], 21), vocabulary, BodyPart::kLegs, &kit);
  const NamedMarkers named =
      UnderstandLabels(LabelsOf(legs), legs, reference_, table_, {joints_, true});
  for (const NamedLabel& one : named.labels) {
    EXPECT_FALSE(one.is_contradicted) << one.label << ": " << one.note;
    if (one.label == "L_THA") {
      EXPECT_EQ(one.part, "left shank");
    }
  }
}

// Clusters would take up what exchanged sides do to the other labels.
TEST_F(NamedPersons, WhoseLegsHaveExchangedSidesAreContradicted) {
  Vocabulary vocabulary = Vocabularies()[3];
  vocabulary.labels["%THI"] = "%thigh1_study";
  vocabulary.labels["%TIP"] = "%sh1_study";
  for (const bool are_exchanged : {false, true}) {
    if (are_exchanged) std::swap(vocabulary.left, vocabulary.right);
    std::vector<std::string> kit;
    const MarkerSequence legs =
        Rename(Record(Vocabularies()[3], 12), vocabulary, BodyPart::kLegs, &kit);
    const NamedMarkers named =
        UnderstandLabels(LabelsOf(legs), legs, reference_, table_, {joints_, true});
    const auto contradicted =
        std::count_if(named.labels.begin(), named.labels.end(),
                      [](const NamedLabel& one) { return one.is_contradicted; });
    if (are_exchanged) {
      EXPECT_GT(2 * contradicted, static_cast<std::ptrdiff_t>(named.labels.size()));
    } else {
      EXPECT_EQ(contradicted, 0);
    }
  }
}

// Of MT1 and MT5 each is far from its place, and the foot turns between them.
TEST_F(NamedPersons, WhosePairsAreExchangedAreTold) {
  constexpr std::pair<const char*, const char*> kPairs[] = {
      {"%MT1", "%MT5"}, {"%FHD", "%BHD"}, {"%ASI", "%PSI"}, {"%HEE", "%KNE"}};
  for (const auto& [one, other] : kPairs) {
    Vocabulary vocabulary = Vocabularies()[0];
    std::swap(vocabulary.labels.at(one), vocabulary.labels.at(other));
    std::vector<std::string> kit;
    const MarkerSequence renamed =
        Rename(Record(Vocabularies()[0], 31), vocabulary, BodyPart::kFull, &kit);
    const NamedMarkers named =
        UnderstandLabels(LabelsOf(renamed), renamed, reference_, table_, {joints_, true});
    for (std::size_t i = 0; i < kit.size(); ++i) {
      const auto is_of = [&](const std::string& key) {
        return key[0] == '%' ? kit[i].substr(1) == key.substr(1) : kit[i] == key;
      };
      const NamedLabel& label = named.labels[i];
      const bool is_exchanged = is_of(one) || is_of(other);
      EXPECT_EQ(label.is_contradicted, is_exchanged) << label.label << ": " << label.note;
      EXPECT_EQ(label.note.starts_with("exchanged with "), is_exchanged) << label.note;
    }
  }
}

// Of clusters names tell the segment, to which each moves with the other's.
TEST_F(NamedPersons, WhoseClustersAreExchangedAreTold) {
  Vocabulary right = Vocabularies()[3];
  right.labels["%THI"] = "%thigh1_study";
  right.labels["%TIP"] = "%sh1_study";
  Vocabulary wrong = right;
  std::swap(wrong.labels.at("%THI"), wrong.labels.at("%TIP"));
  std::vector<std::string> kit;
  const MarkerSequence legs = Rename(Record(right, 22), wrong, BodyPart::kLegs, &kit);
  const NamedMarkers named =
      UnderstandLabels(LabelsOf(legs), legs, reference_, table_, {joints_, true});
  for (std::size_t i = 0; i < kit.size(); ++i) {
    const NamedLabel& label = named.labels[i];
    const bool is_thigh = kit[i].ends_with("THI"), is_shank = kit[i].ends_with("TIP");
    EXPECT_EQ(label.is_contradicted, is_thigh || is_shank) << label.label << ": " << label.note;
    if (is_thigh) {
      EXPECT_TRUE(label.part.ends_with("thigh")) << label.part;
    }
    if (is_shank) {
      EXPECT_TRUE(label.part.ends_with("shank")) << label.part;
    }
  }
}

TEST(NamedMarkers, WithTheSameToSayAreToldTogether) {
  NamedMarkers named;
  for (const char* label : {"LASI", "RASI", "C7", "LTHI"}) {
    NamedLabel& one = named.labels.emplace_back();
    one.label = label;
    one.is_contradicted = one.label != "C7";
    one.note = one.label == "LTHI" ? "elsewhere" : "exchanged";
  }
  EXPECT_EQ(DescribeContradictions(named),
            (std::vector<std::string>{"LASI, RASI (exchanged)", "LTHI (elsewhere)"}));
}

// A tracker crosses the legs, and its markers are not far from the model.
TEST_F(NamedPersons, WhoseLegsAloneHaveExchangedSidesGetThemBack) {
  Vocabulary vocabulary = Vocabularies()[2];
  vocabulary.labels["%THI"] = "%Thigh.Front";
  vocabulary.labels["%TIP"] = "%Shank.Front";
  for (const BodyPart part : {BodyPart::kFull, BodyPart::kThoraxAndLegs}) {
    std::vector<std::string> kit, labels;
    const MarkerSequence right = Rename(Record(vocabulary, 13), vocabulary, part, &kit);
    std::vector<bool> is_leg;
    for (std::size_t i = 0; i < kit.size(); ++i) {
      const bool is_pelvis = kit[i].ends_with("ASI") || kit[i].ends_with("PSI");
      is_leg.push_back(!is_pelvis && IsWorn("%" + kit[i].substr(1), BodyPart::kLegs));
      labels.push_back(right.labels()[i]);
      if (is_leg[i]) labels[i][0] = labels[i][0] == 'L' ? 'R' : 'L';
    }
    MarkerSequence wrong(labels, right.num_frames(), right.rate(), 0);
    for (int k = 0; k < right.num_frames(); ++k) wrong.frame(k) = right.frame(k);
    const NamedMarkers named =
        UnderstandLabels(LabelsOf(wrong), wrong, reference_, table_, {joints_, true});
    for (std::size_t i = 0; i < kit.size(); ++i) {
      const NamedLabel& one = named.labels[i];
      const bool is_left = one.readings.front().side == BodySide::kLeft;
      EXPECT_EQ(one.is_contradicted, is_leg[i]) << one.label << ": " << one.note;
      const bool is_named_left = labels[i][0] == 'L';
      if (kit[i][0] != 'C' && kit[i] != "STRN") {
        EXPECT_EQ(is_left, is_named_left != is_leg[i]) << one.label;
      }
    }
  }
}

}  // namespace
}  // namespace mmm_converter
