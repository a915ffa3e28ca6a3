// SPDX-License-Identifier: MIT
// Figures on persons, motions and errors that were made, so that the truth is known (Session):
//   truth_benchmark WHAT CONFIGURATION FIRST_SEED LAST_SEED
// WHAT is a row of the table in main.
// Every seed is another person, who wears every marker elsewhere.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/calibrate/calibration.h"
#include "common/convert/converter_config.h"
#include "common/math/seeded_random.h"
#include "common/motion/trajectory_derivatives.h"
#include "common/support/error.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/benchmark/truth_figures.h"
#include "tests/plugins/s2kf/session.h"
#include "tests/plugins/s2kf/session_motions.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/changed_markers.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::s2kf {
namespace {

constexpr int kFrames = 300;
constexpr int kSecond = 100;        // frames
constexpr int kMissingFrames = 50;  // of the start
constexpr double kMissingShare = 0.6;
constexpr double kMostDamage = 0.01;  // what an event may cost a joint's centre [m]
constexpr double kWorse = 0.001;      // a group's centres are worse [m]
constexpr int kFirstWrong = 120;
constexpr double kWay = 0.06;              // of a wrong marker [m]
constexpr double kMostDamageOfOne = 0.02;  // [m]
constexpr double kLeastOff = 0.04;         // else it is hidden, or hardly moves: not wrong [m]
constexpr int kLabelsOfAMotion = 6;

class Runs {
 public:
  Runs(const std::string& configuration, int first, int last)
      : settings_(ReadSettings(ReadConverterConfig(
            testing::SourcePath("xml_config/converters/" + configuration + ".xml")))),
        first_(first),
        last_(last) {}

  /// Legs or arms bear each other's labels for a second.
  void SwappedLimbs(bool is_calibrated) const {
    Damages damages(kMostDamage);
    for (int seed = first_; seed <= last_; ++seed) {
      const Session session(seed);
      const KinematicModel model = is_calibrated ? session.Calibrate() : session.model;
      for (const NamedMotion& named :
           SessionMotionsWithRecordedOnes(session.model, kFrames, seed)) {
        const MarkerSequence seen = HideBlocks(session.Record(named.motion), seed);
        const PoseTrajectory clean = Convert(model, session.joints, seen);
        for (const Limb limb : {Limb::kLeg, Limb::kArm}) {
          for (const int begin : {40, 140}) {
            const MarkerSequence swapped = SwapSides(seen, limb, begin, begin + kSecond);
            CentreErrors errors;
            errors.Add(model, clean, model, Convert(model, session.joints, swapped),
                       session.joints);
            damages.Add(named.name + (limb == Limb::kLeg ? ", legs" : ", arms"), seed,
                        fmt::format("from frame {}", begin), errors.largest());
          }
        }
      }
    }
    damages.Print();
  }

  /// Most markers are missing in the first half second; what is left of that a second later.
  void LateMarkers() const {
    Damages damages(kMostDamage);
    for (int seed = first_; seed <= last_; ++seed) {
      const Session session(seed);
      for (const NamedMotion& named :
           SessionMotionsWithRecordedOnes(session.model, kFrames, seed)) {
        const MarkerSequence all = HideBlocks(session.Record(named.motion), seed);
        const MarkerSequence hidden =
            testing::OccludeShare(all, kMissingShare, 10 * kMissingFrames, seed);
        MarkerSequence seen = all;
        for (int k = 0; k < kMissingFrames; ++k) seen.frame(k) = hidden.frame(k);
        CentreErrors errors;
        errors.Add(session.model, Convert(session.model, session.joints, all), session.model,
                   Convert(session.model, session.joints, seen), session.joints,
                   kMissingFrames + kSecond);
        damages.Add(named.name, seed, "the start", errors.largest());
      }
    }
    damages.Print();
  }

  /// Single markers that wander away, stand still or jump for a second.
  void WrongMarkers(bool is_calibrated) const {
    Damages damages(kMostDamageOfOne);
    for (int seed = first_; seed <= last_; ++seed) {
      const Session session(seed);
      const KinematicModel model = is_calibrated ? session.Calibrate() : session.model;
      SeededRandom random(seed);
      for (const NamedMotion& named :
           SessionMotionsWithRecordedOnes(session.model, kFrames, seed)) {
        const MarkerSequence seen = HideBlocks(session.Record(named.motion), seed);
        const ConversionResult clean = Result(model, session.joints, seen);
        for (int i = 0; i < kLabelsOfAMotion; ++i) {
          const int label = random.UniformIndex(seen.num_labels());
          const Eigen::Vector3d way =
              kWay *
              Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal()).normalized();
          for (const char* kind : {"wanders", "frozen", "shifted"}) {
            const MarkerSequence wrong = MakeWrong(seen, kind, label, way);
            if (FarthestOff(seen, wrong, label) < kLeastOff) continue;
            const ConversionResult result = Result(model, session.joints, wrong);
            CentreErrors errors;
            errors.Add(model, clean.trajectory, model, result.trajectory, session.joints);
            damages.Add(kind, seed, named.name + ", " + seen.labels()[label], errors.largest());
            damages.Named(kind, IsNamed(result, AssignAll(model, seen), label));
          }
        }
      }
    }
    damages.Print();
  }

  /// Rates of joint angles over those of the truth.
  void Rates() const {
    std::map<std::string, RateRatios> ratios;
    for (int seed = first_; seed <= last_; ++seed) {
      const Session session(seed);
      const KinematicModel calibrated = session.Calibrate();
      for (NamedMotion& named : SessionMotionsWithRecordedOnes(session.model, kFrames, seed)) {
        const MarkerSequence all = session.Record(named.motion);
        Differentiate(&named.motion);
        const auto add = [&](const std::string& what, const KinematicModel& model,
                             const MarkerSequence& seen) {
          PoseTrajectory found = Convert(model, session.joints, seen);
          if (found.velocities.size() == 0) Differentiate(&found);
          ratios[named.name + what].Add(named.motion, found);
        };
        add("", session.model, all);
        add(", gaps", session.model, HideBlocks(all, seed));
        add(", calibrated, gaps", calibrated, HideBlocks(all, seed));
      }
    }
    for (const auto& [what, ratio] : ratios) ratio.Print(what);
  }

  /// Joint centres over all motions, by what the person was calibrated on.
  void Calibrations() const {
    std::map<std::string, CentreErrors> errors;
    std::map<std::string, std::vector<double>> worse;
    for (int seed = first_; seed <= last_; ++seed) {
      const Session session(seed);
      const std::map<std::string, double> uncalibrated =
          OverAllMotions(session, session.model).Means();
      for (const auto& [what, model] : CalibratedModels(session)) {
        const CentreErrors own = OverAllMotions(session, model);
        errors[what].Add(own);
        for (const auto& [group, mean] : own.Means()) {
          const double more = mean - uncalibrated.at(group);
          if (more > kWorse) worse[fmt::format("{}: {}", what, group)].push_back(more);
        }
      }
    }
    for (const auto& [what, error] : errors) {
      std::printf("%-28s", what.c_str());
      for (const auto& [group, mean] : error.Means()) {
        std::printf(" %s %.1f", group.c_str(), kMillimetres * mean);
      }
      std::printf(" mm\n");
    }
    for (const auto& [what, more] : worse) {
      std::printf("%s, worse than uncalibrated in %d persons, by up to %.0f mm\n", what.c_str(),
                  static_cast<int>(more.size()),
                  kMillimetres * *std::max_element(more.begin(), more.end()));
    }
  }

 private:
  ConversionResult Result(const KinematicModel& model, const std::vector<int>& joints,
                          const MarkerSequence& seen) const {
    return S2kfConverter(SetupOf(model, joints, AssignAll(model, seen)), settings_)
        .Convert(seen, {});
  }

  PoseTrajectory Convert(const KinematicModel& model, const std::vector<int>& joints,
                         const MarkerSequence& seen) const {
    return Result(model, joints, seen).trajectory;
  }

  static MarkerSequence MakeWrong(MarkerSequence seen, const std::string& kind, int label,
                                  const Eigen::Vector3d& way) {
    const Eigen::Vector3d frozen = seen.frame(kFirstWrong).col(label);
    for (int k = kFirstWrong; k < kFirstWrong + kSecond && k < seen.num_frames(); ++k) {
      auto p = seen.frame(k).col(label);
      if (!p.allFinite()) continue;
      if (kind == "frozen" && frozen.allFinite()) p = frozen;
      if (kind == "shifted") p += way;
      if (kind == "wanders") p += way * (k - kFirstWrong) / kSecond;
    }
    return seen;
  }

  /// Seen, from where it is right [m].
  static double FarthestOff(const MarkerSequence& right, const MarkerSequence& wrong, int label) {
    double farthest = 0;
    for (int k = 0; k < right.num_frames(); ++k) {
      const double off = (right.frame(k).col(label) - wrong.frame(k).col(label)).norm();
      if (off > farthest) farthest = off;
    }
    return farthest;
  }

  /// While it is wrong.
  static bool IsNamed(const ConversionResult& result,
                      const std::vector<MarkerAssignment>& assignments, int label) {
    return std::any_of(result.incidents.begin(), result.incidents.end(), [&](const auto& found) {
      return assignments[found.assignment].label == label &&
             found.first_frame < kFirstWrong + kSecond && found.last_frame >= kFirstWrong;
    });
  }

  CentreErrors OverAllMotions(const Session& session, const KinematicModel& model) const {
    CentreErrors errors;
    for (const NamedMotion& named :
         SessionMotionsWithRecordedOnes(session.model, kFrames, session.seed)) {
      errors.Add(session.person, named.motion, model,
                 Convert(model, session.joints, session.Record(named.motion)), session.joints);
    }
    return errors;
  }

  static std::map<std::string, KinematicModel> CalibratedModels(const Session& session) {
    std::map<std::string, KinematicModel> models = {
        {"uncalibrated", session.model},
        {"the true person", session.person},
        {"on 40 s range of motion", session.Calibrate()}};
    for (const NamedMotion& named :
         SessionMotionsWithRecordedOnes(session.model, 10 * kSecond, session.seed)) {
      if (named.name != "walking" && named.name != "waving") continue;
      const MarkerSequence trial = session.Record(named.motion);
      const CalibrationRecording recording = {"trial", &trial, AssignAll(session.model, trial)};
      const Subject subject =
          CalibrateSubject(session.model, session.joints, {recording}, {}).subject;
      models.emplace("on at most 10 s " + named.name, FitToSubject(session.model, subject));
    }
    return models;
  }

  S2kfSettings settings_;
  int first_;
  int last_;
};

}  // namespace
}  // namespace mmm_converter::s2kf

int main(int argc, char** argv) try {
  using mmm_converter::s2kf::Runs;
  const std::span<char*> args(argv, static_cast<std::size_t>(argc));
  if (argc != 5) throw mmm_converter::Error("WHAT CONFIGURATION FIRST_SEED LAST_SEED");
  const Runs runs(args[2], std::stoi(args[3]), std::stoi(args[4]));
  const std::map<std::string, std::function<void()>> table = {
      {"swapped-limbs", [&] { runs.SwappedLimbs(false); }},
      {"swapped-limbs-calibrated", [&] { runs.SwappedLimbs(true); }},
      {"wrong-markers", [&] { runs.WrongMarkers(false); }},
      {"wrong-markers-calibrated", [&] { runs.WrongMarkers(true); }},
      {"late-markers", [&] { runs.LateMarkers(); }},
      {"rates", [&] { runs.Rates(); }},
      {"calibrations", [&] { runs.Calibrations(); }}};
  const auto found = table.find(args[1]);
  if (found == table.end()) {
    std::string names;
    for (const auto& [name, run] : table) names += " " + name;
    throw mmm_converter::Error(std::string(args[1]) + " is none of" + names);
  }
  found->second();
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "truth_benchmark: %s\n", e.what());
  return 1;
}
