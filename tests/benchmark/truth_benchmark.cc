// SPDX-License-Identifier: MIT
// Figures on persons, motions and errors that were made, so that the truth is known (Session):
//   truth_benchmark swapped-limbs|swapped-limbs-calibrated|late-markers|calibrations
//       CONFIGURATION FIRST_SEED LAST_SEED
// Every seed is another person, who wears every marker elsewhere.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/calibrate/calibration.h"
#include "common/convert/converter_config.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/occlusion.h"
#include "common/support/error.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/coverage.h"
#include "tests/plugins/s2kf/session.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::s2kf {
namespace {

constexpr int kFrames = 300;
constexpr int kSecond = 100;        // frames
constexpr int kMissingFrames = 50;  // of the start
constexpr double kMissingShare = 0.6;
constexpr double kMostDamage = 0.01;  // what an event may cost a joint's centre [m]
constexpr double kWorse = 0.001;      // a group's centres are worse [m]
constexpr double kMillimetres = 1000;

/// How far joint centres are from where they should be [m], by joint group; "all" is all.
class CentreErrors {
 public:
  /// Every third frame from `begin` on.
  void Add(const KinematicModel& person, const PoseTrajectory& truth, const KinematicModel& model,
           const PoseTrajectory& estimate, const std::vector<int>& joints, int begin = 0) {
    for (int k = begin; k < std::min(truth.num_frames(), estimate.num_frames()); k += 3) {
      const auto X_true = SegmentPoses(person, ModelPosture(person, truth, k));
      const auto X = SegmentPoses(model, ModelPosture(model, estimate, k));
      for (const int joint : joints) {
        const int s = model.joint_segment(joint);
        const double error = (X[s].translation() - X_true[s].translation()).norm();
        for (const std::string& group : {GroupOf(model.joint(joint).name), std::string("all")}) {
          groups_[group].first += error;
          groups_[group].second += 1;
        }
        largest_ = std::max(largest_, error);
      }
    }
  }

  void Add(const CentreErrors& other) {
    for (const auto& [group, sum] : other.groups_) {
      groups_[group].first += sum.first;
      groups_[group].second += sum.second;
    }
  }

  std::map<std::string, double> Means() const {
    std::map<std::string, double> means;
    for (const auto& [group, sum] : groups_) means[group] = sum.first / sum.second;
    return means;
  }
  double largest() const { return largest_; }

 private:
  std::map<std::string, std::pair<double, double>> groups_;  // sum, samples
  double largest_ = 0;
};

/// What events of a kind cost: the largest change of a joint's centre against the clean run.
class Damages {
 public:
  void Add(const std::string& kind, int person, int begin, double damage) {
    damages_[kind].push_back(damage);
    if (damage <= kMostDamage) return;
    std::printf("  person %d, %s, from frame %d: %.0f mm\n", person, kind.c_str(), begin,
                kMillimetres * damage);
    std::fflush(stdout);
  }

  ~Damages() {
    for (const auto& [kind, damages] : damages_) {
      const auto bad =
          std::count_if(damages.begin(), damages.end(), [](double d) { return d > kMostDamage; });
      std::printf("%-24s beyond 10 mm in %d of %d, worst %.0f mm\n", kind.c_str(),
                  static_cast<int>(bad), static_cast<int>(damages.size()),
                  kMillimetres * *std::max_element(damages.begin(), damages.end()));
    }
  }

 private:
  std::map<std::string, std::vector<double>> damages_;
};

class Runs {
 public:
  Runs(const std::string& configuration, int first, int last)
      : settings_(ReadSettings(ReadConverterConfig(
            testing::SourcePath("xml_config/converters/" + configuration + ".xml")))),
        first_(first),
        last_(last) {}

  /// Legs or arms bear each other's labels for a second.
  void SwappedLimbs(bool is_calibrated) const {
    Damages damages;
    for (int seed = first_; seed <= last_; ++seed) {
      const Session session(seed);
      const KinematicModel model = is_calibrated ? session.Calibrate() : session.model;
      for (const NamedMotion& named : SessionMotions(session.model, kFrames, seed)) {
        const MarkerSequence seen = HideBlocks(session.Record(named.motion), seed);
        const PoseTrajectory clean = Convert(model, session.joints, seen);
        for (const Limb limb : {Limb::kLeg, Limb::kArm}) {
          for (const int begin : {40, 140}) {
            const MarkerSequence swapped = SwapSides(seen, limb, begin, begin + kSecond);
            CentreErrors errors;
            errors.Add(model, clean, model, Convert(model, session.joints, swapped),
                       session.joints);
            damages.Add(named.name + (limb == Limb::kLeg ? ", legs" : ", arms"), seed, begin,
                        errors.largest());
          }
        }
      }
    }
  }

  /// Most markers are missing in the first half second; what is left of that a second later.
  void LateMarkers() const {
    Damages damages;
    for (int seed = first_; seed <= last_; ++seed) {
      const Session session(seed);
      for (const NamedMotion& named : SessionMotions(session.model, kFrames, seed)) {
        const MarkerSequence all = HideBlocks(session.Record(named.motion), seed);
        const MarkerSequence hidden = OccludeShare(all, kMissingShare, 10 * kMissingFrames, seed);
        MarkerSequence seen = all;
        for (int k = 0; k < kMissingFrames; ++k) seen.frame(k) = hidden.frame(k);
        CentreErrors errors;
        errors.Add(session.model, Convert(session.model, session.joints, all), session.model,
                   Convert(session.model, session.joints, seen), session.joints,
                   kMissingFrames + kSecond);
        damages.Add(named.name, seed, 0, errors.largest());
      }
    }
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
  PoseTrajectory Convert(const KinematicModel& model, const std::vector<int>& joints,
                         const MarkerSequence& seen) const {
    return S2kfConverter(SetupOf(model, joints, AssignAll(model, seen)), settings_)
        .Convert(seen, {})
        .trajectory;
  }

  CentreErrors OverAllMotions(const Session& session, const KinematicModel& model) const {
    CentreErrors errors;
    for (const NamedMotion& named : SessionMotions(session.model, kFrames, session.seed)) {
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
    for (const NamedMotion& named : SessionMotions(session.model, 10 * kSecond, session.seed)) {
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
  const std::string what = args[1];
  const Runs runs(args[2], std::stoi(args[3]), std::stoi(args[4]));
  if (what == "swapped-limbs") {
    runs.SwappedLimbs(false);
  } else if (what == "swapped-limbs-calibrated") {
    runs.SwappedLimbs(true);
  } else if (what == "late-markers") {
    runs.LateMarkers();
  } else if (what == "calibrations") {
    runs.Calibrations();
  } else {
    throw mmm_converter::Error(
        what + " is none of swapped-limbs, swapped-limbs-calibrated, late-markers, calibrations");
  }
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "truth_benchmark: %s\n", e.what());
  return 1;
}
