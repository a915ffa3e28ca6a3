// SPDX-License-Identifier: MIT
// Figures on persons, motions and errors that were made, so that the truth is known:
//   truth_benchmark WHAT PRESET FIRST_SEED LAST_SEED
// Every seed is another person, who wears every marker elsewhere.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/calibrate/calibration.h"
#include "common/calibrate/person_height.h"
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
constexpr int kSecond = 100;  // frames
constexpr double kMillimetres = 1000;

const std::vector<std::string> kArm = {"UPA", "AEL", "AOL", "FRA", "WTS",
                                       "WPS", "HTS", "HPS", "IFD"};
const std::vector<std::string> kLeg = {"THI", "KNE", "TIP", "ANK", "HEE", "TOE", "MT1", "MT5"};

/// How far joint centres are from where they should be, by joint group ("all" is all) [m].
class CentreErrors {
 public:
  void Add(const KinematicModel& person, const PoseTrajectory& truth, const KinematicModel& model,
           const PoseTrajectory& estimate, const std::vector<int>& joints) {
    for (int k = 0; k < std::min(truth.num_frames(), estimate.num_frames()); k += kStep) {
      const auto X_true = SegmentPoses(person, ModelPosture(person, truth, k));
      const auto X = SegmentPoses(model, ModelPosture(model, estimate, k));
      for (const int joint : joints) {
        const int s = model.joint_segment(joint);
        const double error = (X[s].translation() - X_true[s].translation()).norm();
        for (const std::string& group : {GroupOf(model.joint(joint).name), std::string("all")}) {
          sums_[group].first += error;
          sums_[group].second += 1;
        }
        largest_ = std::max(largest_, error);
      }
    }
  }

  void Print(const std::string& title) const {
    std::printf("%-34s", title.c_str());
    for (const auto& [group, sum] : sums_) {
      std::printf(" %s %.1f", group.c_str(), kMillimetres * sum.first / sum.second);
    }
    std::printf(" mm\n");
    std::fflush(stdout);
  }

  double Mean(const std::string& group) const {
    return sums_.at(group).first / sums_.at(group).second;
  }
  void Add(const CentreErrors& other) {
    for (const auto& [group, sum] : other.sums_) {
      sums_[group].first += sum.first;
      sums_[group].second += sum.second;
    }
    largest_ = std::max(largest_, other.largest_);
  }
  std::vector<std::string> Groups() const {
    std::vector<std::string> groups;
    for (const auto& [group, sum] : sums_) groups.push_back(group);
    return groups;
  }
  double largest() const { return largest_; }

 private:
  static constexpr int kStep = 3;
  std::map<std::string, std::pair<double, long>> sums_;
  double largest_ = 0;
};

class Runs {
 public:
  Runs(const std::string& preset, std::uint64_t first, std::uint64_t last)
      : settings_(ReadSettings(
            ReadConverterConfig(testing::SourcePath("xml_config/converters/" + preset + ".xml")))),
        first_(first),
        last_(last) {}

  ConversionResult Convert(const KinematicModel& model, const std::vector<int>& joints,
                           const MarkerSequence& seen) const {
    return S2kfConverter(SetupOf(model, joints, AssignAll(model, seen)), settings_)
        .Convert(seen, {});
  }

  /// Legs or arms that bear each other's labels for a second, against the same without.
  void SwappedLimbs(bool is_calibrated) const {
    std::map<std::string, std::vector<double>> worst;
    for (std::uint64_t seed = first_; seed <= last_; ++seed) {
      const Session session(seed);
      const KinematicModel model = is_calibrated ? session.Calibrate() : session.model;
      for (const NamedMotion& named : SessionMotions(session.model, kFrames, seed)) {
        const MarkerSequence seen = HideBlocks(session.Record(named.motion), seed);
        const PoseTrajectory clean = Convert(model, session.joints, seen).trajectory;
        for (const auto* limb : {&kLeg, &kArm}) {
          for (const int begin : {40, 140}) {
            MarkerSequence swapped = seen;
            for (const std::string& name : *limb) {
              swapped =
                  SwapMarkers(std::move(swapped), "L" + name, "R" + name, begin, begin + kSecond);
            }
            CentreErrors errors;
            errors.Add(model, clean, model, Convert(model, session.joints, swapped).trajectory,
                       session.joints);
            const std::string what = named.name + (limb == &kLeg ? ", legs" : ", arms");
            worst[what].push_back(errors.largest());
            if (errors.largest() <= kMostDamage / 2) continue;
            std::printf("  person %d, %s from frame %d: %.0f mm\n", static_cast<int>(seed),
                        what.c_str(), begin, kMillimetres * errors.largest());
            std::fflush(stdout);
          }
        }
      }
    }
    for (const auto& [what, values] : worst) {
      const auto bad = std::count_if(values.begin(), values.end(),
                                     [](double value) { return value > kMostDamage / 2; });
      std::printf("%-28s beyond 10 mm in %d of %d, worst %.0f mm\n", what.c_str(),
                  static_cast<int>(bad), static_cast<int>(values.size()),
                  kMillimetres * *std::max_element(values.begin(), values.end()));
    }
  }

  /// Joint centres of every motion, by what the person was calibrated on.
  void Calibrations() const {
    std::map<std::string, CentreErrors> errors;
    std::map<std::string, std::pair<int, double>> worse;
    for (std::uint64_t seed = first_; seed <= last_; ++seed) {
      const Session session(seed);
      const std::vector<NamedMotion> motions = SessionMotions(session.model, kFrames, seed);
      std::map<std::string, KinematicModel> models = {{"0 nothing", session.model},
                                                      {"1 (truth)", session.person}};
      CalibrationOptions options;
      if (getenv("SKIN") && *getenv("SKIN")) options.skin_deviation = atof(getenv("SKIN"));
      if (getenv("FR")) options.frames = atoi(getenv("FR"));
      MarkerSequence trial = session.Record(testing::RangeOfMotion(session.model, 40, 0.7, seed));
      const auto calibrate = [&](const std::string& what) {
        const CalibrationRecording recording = {"trial", &trial, AssignAll(session.model, trial)};
        try {
          const Subject subject =
              CalibrateSubject(session.model, session.joints, {recording}, options).subject;
          models.emplace(what, FitToSubject(session.model, subject));
        } catch (const Error& e) {
          std::printf("  person %d, %s: %s\n", static_cast<int>(seed), what.c_str(), e.what());
        }
      };
      calibrate("2 range of motion");
      for (const NamedMotion& named : SessionMotions(session.model, 1000, seed)) {
        if (named.name != "walking" && named.name != "waving") continue;
        trial = session.Record(named.motion);
        calibrate("3 " + named.name);
      }
      CentreErrors uncalibrated;
      for (const auto& [what, model] : models) {
        CentreErrors own;
        for (const NamedMotion& named : motions) {
          const MarkerSequence seen = session.Record(named.motion);
          const PoseTrajectory estimate = Convert(model, session.joints, seen).trajectory;
          own.Add(session.person, named.motion, model, estimate, session.joints);
        }
        errors[what].Add(own);
        if (what[0] == '0') uncalibrated = own;
        for (const std::string& group : own.Groups()) {
          const double more = own.Mean(group) - uncalibrated.Mean(group);
          if (more <= 0.001) continue;
          auto& [count, most] = worse[what + ": " + group];
          ++count;
          most = std::max(most, more);
        }
      }
    }
    for (const auto& [what, error] : errors) error.Print(what);
    for (const auto& [what, bad] : worse) {
      std::printf("%s: over 1 mm worse than uncalibrated in %d persons, by up to %.0f mm\n",
                  what.c_str(), bad.first, kMillimetres * bad.second);
    }
  }

 private:
  static constexpr double kMostDamage = 0.02;

  S2kfSettings settings_;
  std::uint64_t first_;
  std::uint64_t last_;
};

}  // namespace
}  // namespace mmm_converter::s2kf

int main(int argc, char** argv) try {
  using namespace mmm_converter::s2kf;
  const std::span<char*> args(argv, static_cast<std::size_t>(argc));
  const std::string what = argc == 5 ? args[1] : "";
  const auto run = [&] { return Runs(args[2], std::stoul(args[3]), std::stoul(args[4])); };
  if (what == "swapped-limbs") {
    run().SwappedLimbs(false);
  } else if (what == "swapped-limbs-calibrated") {
    run().SwappedLimbs(true);
  } else if (what == "calibrations") {
    run().Calibrations();
  } else {
    std::fprintf(stderr,
                 "truth_benchmark swapped-limbs|swapped-limbs-calibrated|calibrations "
                 "PRESET FIRST_SEED LAST_SEED\n");
    return 2;
  }
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "truth_benchmark: %s\n", e.what());
  return 1;
}
