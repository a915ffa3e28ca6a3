// SPDX-License-Identifier: MIT
// Whether the standard deviations tell the size of the errors. Bounds are the project's targets for
// people. As the errors of a session are constant, what counts is the number of persons; a test
// fails where the share of those drawn here misses a target by more than three standard errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/math/statistics.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/anatomical_angles.h"
#include "common/motion/marker_synthesis.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/coverage.h"
#include "tests/plugins/s2kf/session.h"
#include "tests/plugins/s2kf/session_motions.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/changed_markers.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::s2kf {
namespace {

constexpr int kFirstPerson = 301;
constexpr int kPersons = 20;
constexpr int kNoises = 8;  // of the exact body, whose errors are not constant
constexpr int kMotions = 5;
constexpr int kSessionFrames = 150;
constexpr int kHiddenFrames = 300;
constexpr int kSettled = 25;
const std::set<std::string> kLeftOut = {"shoulder", "elbow", "wrist", "neck"};

/// A share of all samples, with room for what it is off by as so many persons were drawn.
struct Share {
  double value = 0;
  double room = 0;  ///< three standard errors

  /// wanted: a person's samples that count, and all.
  template <typename Wanted>
  Share(const std::vector<Coverage>& persons, Wanted wanted) {
    double count = 0;
    double all = 0;
    for (const Coverage& person : persons) {
      count += wanted(person).first;
      all += wanted(person).second;
    }
    value = count / all;
    // Of the ratio of two sums over persons.
    double squares = 0;
    for (const Coverage& person : persons) {
      squares += std::pow(wanted(person).first - value * wanted(person).second, 2);
    }
    const auto n = static_cast<double>(persons.size());
    room = 3 * std::sqrt(squares * n / (n - 1)) / all;
  }
};

Share Within(const std::vector<Coverage>& persons, const std::string& group,
             long Coverage::Counts::*count) {
  return {persons, [&](const Coverage& person) {
            const auto found = person.groups().find(group);
            return found == person.groups().end()
                       ? std::pair(0.0, 0.0)
                       : std::pair<double, double>(found->second.*count, found->second.samples);
          }};
}

void ExpectAtLeast(const Share& share, double least, const std::string& what) {
  EXPECT_GE(share.value, least - share.room) << what << ", at least " << least;
}

void ExpectAtMost(const Share& share, double most, const std::string& what) {
  EXPECT_LE(share.value, most + share.room) << what << ", at most " << most;
}

/// persons: one for each. most: of the joints within one deviation. is_limit_covered: whether it
/// holds for joints estimated at a limit.
void ExpectHonest(const std::vector<Coverage>& persons, const std::string& what, double most = 0.80,
                  bool is_limit_covered = true) {
  Coverage all;
  for (const Coverage& person : persons) all.Add(person);
  all.Print(what);
  for (const auto& [group, counts] : all.groups()) {
    const Share one = Within(persons, group, &Coverage::Counts::within_one);
    const Share two = Within(persons, group, &Coverage::Counts::within_two);
    std::printf("  %s within one %.3f +- %.3f, two %.3f +- %.3f\n", group.c_str(), one.value,
                one.room, two.value, two.room);
    if (group == "limit" && !is_limit_covered) continue;
    const bool is_all = group == "joints";
    ExpectAtLeast(one, is_all ? 0.60 : 0.50, group + " within one");
    ExpectAtLeast(two, is_all ? 0.90 : 0.85, group + " within two");
    if (group == "limit") continue;  // more caution there does no harm
    // Not reached by necks and trunks, of which the motion model expects more: .92.
    const bool is_of_spine = group == "neck" || group.starts_with("trunk");
    const double most_of_group = is_of_spine ? 0.95 : 0.88;
    ExpectAtMost(one, is_all ? most : most_of_group, group + " within one");
    if (is_all) ExpectAtMost(two, 0.98, group + " within two");
  }
  // Of the limbs; bends of spine and neck, and all together, err by more than one look tells.
  for (const auto& [group, nees] : all.NeesTogether()) {
    const Share share(persons, [&group = group](const Coverage& person) {
      return std::pair(person.NeesTogether().at(group), 1.0);
    });
    std::printf("  %s NEES %.2f +- %.2f\n", group.c_str(), share.value, share.room);
    if (group == "spine" || group == "neck" || group == "whole") continue;
    ExpectAtMost(share, 2.5, group + "'s NEES");
  }
}

/// By preset.
class DeviationsTest : public ::testing::TestWithParam<const char*> {
 protected:
  ConversionResult Convert(const KinematicModel& model, const std::vector<int>& joints,
                           const MarkerSequence& seen) const {
    return Convert(model, joints, seen, AssignAll(model, seen));
  }
  ConversionResult Convert(const KinematicModel& model, const std::vector<int>& joints,
                           const MarkerSequence& seen,
                           const std::vector<MarkerAssignment>& assignments) const {
    S2kfConverter converter(SetupOf(model, joints, assignments),
                            ReadSettings(ReadConverterConfig(testing::SourcePath(
                                "xml_config/converters/" + std::string(GetParam()) + ".xml"))));
    converter.KeepCovariances();
    return converter.Convert(seen, {});
  }

  // Of a session's motion, after the start.
  void Cover(const KinematicModel& model, const std::vector<int>& joints,
             const PoseTrajectory& truth, const MarkerSequence& seen, Coverage* coverage) const {
    const ConversionResult result = Convert(model, joints, seen);
    coverage->Add(model, joints, truth, result.trajectory, kSettled, seen.num_frames());
    coverage->AddTogether(model, joints, truth, result, kSettled, seen.num_frames());
    const AnatomicalAngles found = ComputeAnatomicalAngles(model, result.trajectory);
    const AnatomicalAngles true_angles = ComputeAnatomicalAngles(model, truth);
    for (Eigen::Index i = 0; i < found.values.rows(); ++i) {
      const AnatomicalAngle& angle = found.angles[static_cast<std::size_t>(i)];
      // An arm that is abducted by 90 degrees has no flexion; what is known of a neck's bends
      // together is too sure, by half at most.
      if (kLeftOut.contains(angle.joint)) continue;
      for (Eigen::Index k = kSettled; k < seen.num_frames(); k += 5) {
        const double error = found.values(i, k) - true_angles.values(i, k);
        coverage->Count(std::string(angle.joint) + " " + angle.motion,
                        std::remainder(error, 2 * std::numbers::pi), found.deviations(i, k));
      }
    }
  }

  static std::string Titled(const std::string& what) { return what + ", " + GetParam(); }
};

// A suite for each, which ctest can run beside the others.
class UncalibratedDeviationsTest : public DeviationsTest {};
class CalibratedDeviationsTest : public DeviationsTest {};
class ExactBodyDeviationsTest : public DeviationsTest {};

TEST_P(UncalibratedDeviationsTest, AreHonest) {
  std::vector<Coverage> persons(kPersons);
  for (int i = 0; i < kPersons; ++i) {
    const std::uint64_t seed = kFirstPerson + i;
    const Session session(seed);
    for (const NamedMotion& named : SessionMotions(session.model, kSessionFrames, seed)) {
      const MarkerSequence seen = HideBlocks(session.Record(named.motion), seed);
      Cover(session.model, session.joints, named.motion, seen, &persons[i]);
    }
  }
  ExpectHonest(persons, Titled("uncalibrated"));
}

constexpr double kClusterDeviation = 0.084;  // xml_config/landmarks.xml, thigh [m]

/// Of a plate on a thigh or a shank, [m] from its segment.
std::vector<ModelMarker> Cluster(const KinematicModel& model, const std::string& segment) {
  std::vector<ModelMarker> markers;
  for (const double x : {-0.03, 0.03}) {
    for (const double z : {0.09, 0.17}) {
      markers.push_back({"MARKER_" + segment + std::to_string(markers.size()),
                         model.FindSegment(segment),
                         {x, 0.04, z}});
    }
  }
  return markers;
}

KinematicModel With(const KinematicModel& model, const std::vector<ModelMarker>& markers) {
  ModelDescription description = DescriptionOf(model);
  description.markers.insert(description.markers.end(), markers.begin(), markers.end());
  return KinematicModel(std::move(description));
}

/// Where a marker is on its segment in the postures of `motion`, as names are judged.
Eigen::Vector3d PlaceBy(const KinematicModel& model, const PoseTrajectory& motion, int segment,
                        const MarkerSequence& seen, int label) {
  std::array<std::vector<double>, 3> places;
  for (int k = 0; k < motion.num_frames(); k += 5) {
    const auto X_WS = SegmentPoses(model, ModelPosture(model, motion, k));
    const Eigen::Vector3d p =
        X_WS[static_cast<std::size_t>(segment)].inverse() * seen.frame(k).col(label);
    for (int axis = 0; axis < 3; ++axis) places[static_cast<std::size_t>(axis)].push_back(p[axis]);
  }
  return {Median(places[0]), Median(places[1]), Median(places[2])};
}

std::vector<MarkerAssignment> AtBonesOfLegs(const KinematicModel& model,
                                            const MarkerSequence& seen) {
  static const std::set<std::string> kBones = {"ASI", "PSI", "THI", "KNE",
                                               "TIP", "ANK", "HEE", "TOE"};
  std::vector<MarkerAssignment> assignments = AssignAll(model, seen);
  std::erase_if(assignments, [&](const MarkerAssignment& one) {
    const std::string& name = seen.labels()[one.label];
    return name.size() != 4 || !kBones.contains(name.substr(1));
  });
  return assignments;
}

// Clusters whose places the posture by the few other markers told, as names are judged, tell
// nothing of how far that posture is off.
TEST_P(UncalibratedDeviationsTest, AreHonestOfLegsWithClusters) {
  std::vector<Coverage> persons(kPersons / 2);
  for (int i = 0; i < kPersons / 2; ++i) {
    Session session(kFirstPerson + i);
    std::vector<int> joints = session.joints;
    std::erase_if(joints, [&](int joint) {
      const std::string group = GroupOf(session.model.joint(joint).name);
      return group != "hip" && group != "knee" && group != "ankle" && group != "foot";
    });
    std::vector<ModelMarker> clusters;
    for (const char* segment :
         {"LKsegment_joint", "RKsegment_joint", "LAsegment_joint", "RAsegment_joint"}) {
      for (ModelMarker& one : Cluster(session.model, segment)) clusters.push_back(std::move(one));
    }
    session.person = With(session.person, clusters);
    const auto motions = SessionMotions(session.model, kSessionFrames, session.seed);
    for (const std::size_t m : {0, 2}) {  // walking and a run
      const NamedMotion& named = motions[m];
      const MarkerSequence seen = session.Record(named.motion);
      std::vector<MarkerAssignment> assignments = AtBonesOfLegs(session.model, seen);
      const PoseTrajectory alone = Convert(session.model, joints, seen, assignments).trajectory;
      std::vector<ModelMarker> placed = clusters;
      for (ModelMarker& one : placed) {
        const auto label = std::find(seen.labels().begin(), seen.labels().end(),
                                     one.name.substr(std::string("MARKER_").size()));
        one.deviation = kClusterDeviation;
        const auto index = static_cast<int>(label - seen.labels().begin());
        one.p_SM = PlaceBy(session.model, alone, one.segment, seen, index);
        const auto marker = session.model.markers().size() + (&one - placed.data());
        assignments.push_back({LabelIx(index), MarkerIx(static_cast<int>(marker)), 1.1});
      }
      const KinematicModel model = With(session.model, placed);
      const ConversionResult result = Convert(model, joints, seen, assignments);
      persons[i].Add(model, joints, named.motion, result.trajectory, kSettled, seen.num_frames());
      persons[i].AddTogether(model, joints, named.motion, result, kSettled, seen.num_frames());
    }
  }
  ExpectHonest(persons, Titled("legs with clusters"));
}

/// The person as calibrated; kept, as both presets want it.
const KinematicModel& Calibrated(const Session& session) {
  static std::map<std::uint64_t, KinematicModel> known;
  const auto found = known.find(session.seed);
  if (found != known.end()) return found->second;
  return known.emplace(session.seed, session.Calibrate()).first->second;
}

TEST_P(CalibratedDeviationsTest, AreHonest) {
  std::vector<Coverage> persons(kPersons);
  for (int i = 0; i < kPersons; ++i) {
    const std::uint64_t seed = kFirstPerson + i;
    const Session session(seed);
    const KinematicModel& known = Calibrated(session);
    for (const NamedMotion& named : SessionMotions(session.model, kSessionFrames, seed)) {
      const MarkerSequence seen = HideBlocks(session.Record(named.motion), seed);
      Cover(known, session.joints, named.motion, seen, &persons[i]);
    }
  }
  ExpectHonest(persons, Titled("calibrated"));
}

// The right arm for 2 s, in two of the motions of each person. The arm counts, while hidden and in
// the 0.5 s after.
TEST_P(CalibratedDeviationsTest, AreHonestOfAnArmThatIsHidden) {
  std::vector<Coverage> hidden(kPersons);
  for (int i = 0; i < kPersons; ++i) {
    const std::uint64_t seed = kFirstPerson + i;
    const Session session(seed);
    const KinematicModel& known = Calibrated(session);
    const std::vector<NamedMotion> motions = SessionMotions(session.model, kHiddenFrames, seed);
    for (const int m : {i % kMotions, (i + 2) % kMotions}) {
      const PoseTrajectory& motion = motions[m].motion;
      const MarkerSequence seen = testing::HideMarkers(session.Record(motion), RightArm(), 40, 240);
      const PoseTrajectory estimate = Convert(known, session.joints, seen).trajectory;
      for (const char* joint : {"RS", "RE", "RW"}) {
        hidden[i].Add(known, session.joints, motion, estimate, 40, 290, joint);
      }
    }
  }
  // Not reached: arms estimated at a limit, where the filter is lost.
  ExpectHonest(hidden, Titled("calibrated, an arm hidden for 2 s"), 0.83, false);
}

// The model is the person, and markers have nothing but the filter's own white noise.
TEST_P(ExactBodyDeviationsTest, AreHonest) {
  std::vector<Coverage> runs(kNoises);
  const KinematicModel model = ScaledReferenceModel(1.8);
  const std::vector<int> joints = testing::TrackedJoints(model);
  for (int i = 0; i < kNoises; ++i) {
    const std::uint64_t seed = kFirstPerson + i;
    for (const NamedMotion& named : SessionMotions(model, kSessionFrames, seed)) {
      const MarkerErrors errors = {0, 0, 0.3, S2kfSettings{}.marker_deviation};
      const MarkerSequence seen =
          HideBlocks(SynthesizeMarkers(model, named.motion, errors, seed), seed);
      Cover(model, joints, named.motion, seen, &runs[i]);
    }
  }
  ExpectHonest(runs, Titled("exact body"));
}

std::string PresetName(const ::testing::TestParamInfo<const char*>& test) { return test.param; }
const auto kPresets = ::testing::Values("s2kf_default", "s2kf_offline");
INSTANTIATE_TEST_SUITE_P(Presets, UncalibratedDeviationsTest, kPresets, PresetName);
INSTANTIATE_TEST_SUITE_P(Presets, CalibratedDeviationsTest, kPresets, PresetName);
INSTANTIATE_TEST_SUITE_P(Presets, ExactBodyDeviationsTest, kPresets, PresetName);

}  // namespace
}  // namespace mmm_converter::s2kf
