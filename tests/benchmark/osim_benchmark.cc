// SPDX-License-Identifier: MIT
// Figures on models of OpenSim, with persons, motions and markers that were made:
//   osim_benchmark WHAT MODEL.osim FIRST_SEED LAST_SEED
// WHAT: calibration, deviations, hidden or time. A model without markers gets three on each body.
// Every seed is another person, whose bodies are up to some 10 % larger or smaller than the
// model's, and by some 3 % otherwise along each axis, who wears every marker some 10 mm elsewhere,
// with soft tissue of 4 mm.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/calibrate/joint_doubts.h"
#include "common/io/osim/osim_document.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "tests/benchmark/osim_cases.h"
#include "tests/benchmark/simbody_assembler.h"
#include "tests/support/changed_markers.h"

namespace mmm_converter {
namespace {

constexpr int kSettled = 25;
constexpr double kLeastLength = 0.05;  // [m]
constexpr double kDegrees = 180 / EIGEN_PI;

struct Share {
  long one = 0, two = 0, all = 0;
  void Add(double error, double deviation) {
    if (!(deviation > 0)) return;
    one += std::abs(error) <= deviation ? 1 : 0;
    two += std::abs(error) <= 2 * deviation ? 1 : 0;
    ++all;
  }
};

void AddShares(const Case& made, const ModelPtr& model, const ConversionResult& result,
               std::map<std::string, Share>* shares) {
  const PoseTrajectory& found = result.trajectory;
  for (int k = kSettled; k < kFrames; ++k) {
    const Posture truth = ModelPosture(*model, made.truth, k);
    const Eigen::VectorXd off = Local(ModelPosture(*model, found, k), truth);
    for (std::size_t j = 0; j < found.joint_names.size(); ++j) {
      const int joint = model->FindJoint(found.joint_names[j]);
      const double deviation = found.standard_deviations(6 + static_cast<int>(j), k);
      (*shares)["all joints"].Add(off[6 + joint], deviation);
      (*shares)[GroupOf(found.joint_names[j])].Add(off[6 + joint], deviation);
    }
    for (int i = 0; i < 3 && !model->is_root_fixed(); ++i) {
      (*shares)["root rotation"].Add(off[3 + i], found.standard_deviations(3 + i, k));
    }
  }
}

/// Calibrated persons move otherwise than when they were calibrated.
void Deviations(const std::string& text, int first, int last) {
  for (const char* preset : {"s2kf_default", "s2kf_offline"}) {
    std::map<std::string, std::map<std::string, Share>> shares;
    for (int seed = first; seed <= last; ++seed) {
      const Case made = MakeCase(text, seed);
      const CalibratedPerson person = Calibrate(text, made);
      const Case other = MoveOtherwise(made, seed, seed + 5000);
      const MarkerSequence seen = testing::OccludeShare(other.markers, 0.1, 30, seed);
      AddShares(other, made.generic, Track(made.generic, preset, seen), &shares["uncalibrated"]);
      AddShares(other, made.person, Track(made.person, preset, seen), &shares["as large"]);
      ConversionResult result = Track(person.model, preset, seen);
      WidenDeviations(person.subject, &result);
      AddShares(other, person.model, result, &shares["calibrated"]);
    }
    for (const auto& [what, of_groups] : shares) {
      for (const auto& [group, share] : of_groups) {
        const double all = static_cast<double>(share.all);
        fmt::print("{} {:12} {:28} {:.2f} {:.2f}\n", preset, what, group, share.one / all,
                   share.two / all);
      }
    }
  }
}

/// Turns only, root mean square and largest [deg]; wanted: part of a joint's name.
void PrintErrors(const std::string& what, const Case& made, const ConversionResult& result,
                 const std::string& wanted, int begin, int end) {
  double squares = 0, most = 0;
  int count = 0;
  for (int k = begin; k < end; ++k) {
    const Eigen::VectorXd off = Local(ModelPosture(*made.known, result.trajectory, k),
                                      ModelPosture(*made.known, made.truth, k));
    for (int j = 0; j < made.known->num_joints(); ++j) {
      const Segment& joint = made.known->joint(j);
      if (joint.type == JointType::kSliding || joint.name.find(wanted) == std::string::npos)
        continue;
      const double error = kDegrees * std::abs(off[6 + j]);
      squares += error * error;
      most = std::max(most, error);
      ++count;
    }
  }
  if (count > 0)
    fmt::print("{:44} {:.2f} deg rms, {:.2f} at most\n", what, std::sqrt(squares / count), most);
}

/// What is lost where nothing is seen, whoever looks: the cubic by exact angles and speeds of both
/// ends.
void PrintBridge(const std::string& what, const Case& made, const std::string& joint, int begin,
                 int end) {
  const int j = made.known->FindJoint(joint);
  const auto angle = [&](int k) {
    return kDegrees * ModelPosture(*made.known, made.truth, k).joint_angles[j];
  };
  const double span = end - begin;
  const double first = span * (angle(begin + 1) - angle(begin - 1)) / 2;
  const double last = span * (angle(end + 1) - angle(end - 1)) / 2;
  double squares = 0;
  for (int k = begin; k < end; ++k) {
    const double u = (k - begin) / span;
    const double v = 1 - u;
    const double bridge = (1 + 2 * u) * v * v * angle(begin) + u * v * v * first +
                          (1 + 2 * v) * u * u * angle(end) - u * u * v * last;
    squares += (bridge - angle(k)) * (bridge - angle(k));
  }
  fmt::print("{:44} {:.2f} deg rms\n", what, std::sqrt(squares / span));
}

void Hidden(const std::string& text, int first, int last) {
  for (int seed = first; seed <= last; ++seed) {
    const Case made = MakeCase(text, seed);
    const MarkerSequence quarter = testing::OccludeShare(made.markers, 0.25, 50, seed);
    std::vector<std::string> limb;  // below the right knee
    for (const ModelMarker& marker : made.known->markers()) {
      for (int s = marker.segment; s >= 0; s = made.known->segments()[s].parent) {
        if (!made.known->segments()[s].name.starts_with("tibia_r")) continue;
        limb.push_back(marker.name);
        break;
      }
    }
    for (const int frames : {25, 100}) {
      for (const char* joint : {"knee_angle_r", "ankle_angle_r"}) {
        PrintBridge(fmt::format("{} bridge of {} over {} s", seed, joint, frames / kRate), made,
                    joint, 100, 100 + frames);
      }
    }
    for (const char* preset : {"jacobian_opensim", "s2kf_default", "s2kf_offline"}) {
      const auto line = [&](const char* what) {
        return fmt::format("{} {} {}", seed, preset, what);
      };
      PrintErrors(line("all seen"), made, Track(made.known, preset, made.markers), "", kSettled,
                  kFrames);
      PrintErrors(line("a quarter hidden"), made, Track(made.known, preset, quarter), "", kSettled,
                  kFrames);
      for (const int frames : {25, 100}) {
        const MarkerSequence seen = testing::HideMarkers(made.markers, limb, 100, 100 + frames);
        const ConversionResult result = Track(made.known, preset, seen);
        for (const char* joint : {"knee_angle_r", "ankle_angle_r"}) {
          const std::string what =
              fmt::format("{} with the leg hidden {} s", joint, frames / kRate);
          PrintErrors(line(what.c_str()), made, result, joint, 100, 100 + frames);
        }
      }
    }
  }
}

/// How far apart the origins of bodies are that a joint connects, at rest [m].
std::map<std::string, double> LengthsOf(const std::string& text, const KinematicModel& model) {
  Diagnostics diagnostics("model");
  const OsimDocument document = ParseOsim(text, {}, &diagnostics);
  const auto poses = SegmentPoses(model, RestPosture(model));
  std::map<std::string, double> lengths;
  for (const OsimJoint& joint : document.joints) {
    const std::string& parent = document.bodies[joint.parent].name;
    const std::string& child = document.bodies[joint.child].name;
    const int a = model.FindSegment(parent), b = model.FindSegment(child);
    if (joint.parent == 0 || a < 0 || b < 0) continue;
    const double length = (poses[a].translation() - poses[b].translation()).norm();
    if (length > kLeastLength) lengths[parent + " to " + GroupOf(child)] = length;
  }
  return lengths;
}

/// Lengths of bodies and their factors by those of the person, and where joints are while the
/// person moves otherwise.
void Calibration(const std::string& text, int first, int last) {
  std::map<std::string, std::vector<double>> sizes, places;
  std::map<std::string, Share> covered;
  for (int seed = first; seed <= last; ++seed) {
    const Case made = MakeCase(text, seed);
    const CalibratedPerson person = Calibrate(text, made);
    for (const auto& [body, factor] : made.factors) {
      for (int axis = 0; axis < 3; ++axis) {
        const double off = person.factors.at(body)[axis] / factor[axis] - 1;
        sizes[fmt::format("size of {} {}", GroupOf(body), "xyz"[axis])].push_back(100 * off);
      }
    }
    const auto lengths = LengthsOf(text, *person.model);
    for (const auto& [what, length] : LengthsOf(text, *made.person)) {
      sizes["length of " + GroupOf(what)].push_back(100 * (lengths.at(what) / length - 1));
    }
    for (const SegmentScale& scale : person.subject.scales) {
      const std::string body = scale.segment.substr(0, scale.segment.rfind(' '));
      const int axis = scale.segment.back() - 'x';
      const double true_scale = made.factors.at(body)[axis] / person.size;
      covered[scale.segment.substr(scale.segment.size() - 1)].Add(true_scale - scale.scale,
                                                                  scale.standard_deviation);
    }
    const Case other = MoveOtherwise(made, seed, seed + 5000);
    for (const auto& [name, model] :
         {std::pair("calibrated", person.model), {"generic", made.generic}}) {
      const PoseTrajectory found = Track(model, "s2kf_offline", other.markers).trajectory;
      for (int k = kSettled; k < kFrames; k += 10) {
        const auto truth = SegmentPoses(*made.person, ModelPosture(*made.person, other.truth, k));
        const auto poses = SegmentPoses(*model, ModelPosture(*model, found, k));
        for (const auto& [body, factor] : made.factors) {
          const int s = model->FindSegment(body);
          if (s <= 0) continue;
          places[fmt::format("{} {}", name, GroupOf(body))].push_back(
              1e3 * (poses[s].translation() - truth[s].translation()).norm());
        }
      }
    }
    fmt::print("seed {}: {} steps\n", seed, person.iterations);
  }
  const auto print = [](const std::string& what, std::vector<double> errors, const char* unit) {
    double squares = 0;
    for (double& error : errors) {
      squares += error * error;
      error = std::abs(error);
    }
    fmt::print("{:44} {:.2f} {} rms, {:.2f} at most\n", what,
               std::sqrt(squares / static_cast<double>(errors.size())), unit,
               *std::max_element(errors.begin(), errors.end()));
  };
  for (const auto& [what, errors] : sizes) print(what, errors, "%");
  for (const auto& [axis, share] : covered) {
    fmt::print("deviations of sizes along {} cover {:.2f} {:.2f}\n", axis,
               share.one / static_cast<double>(share.all),
               share.two / static_cast<double>(share.all));
  }
  for (const auto& [body, errors] : places) print("joint above " + body, errors, "mm");
}

double Milliseconds(std::vector<double> seconds) {
  std::sort(seconds.begin(), seconds.end());
  return 1e3 * seconds[seconds.size() / 2];
}

/// A frame by every preset and by Simbody's Assembler. All hold what moves by functions, as the
/// Assembler here does, but for those in the second half.
void Time(const std::string& text, int seed) {
  constexpr int kMostMarkers = 60;
  const Case made = MakeCase(text, seed);
  ModelDescription description = DescriptionOf(*made.known);
  if (description.markers.size() > kMostMarkers) description.markers.resize(kMostMarkers);
  const KinematicModel fewer(std::move(description));
  const auto held = std::make_shared<const KinematicModel>(HoldFollowers(fewer));
  const auto whole = std::make_shared<const KinematicModel>(fewer);
  for (const auto& [name, model] : {std::pair("held", held), {"whole", whole}}) {
    fmt::print("{}: {} joints and the root, {} markers\n", name, model->num_joints(),
               model->markers().size());
    PoseTrajectory truth = MoveOtherwise(made, seed, seed).truth;
    const MarkerSequence seen = RecordMotion(*model, truth, seed);
    for (const char* preset : {"s2kf_default", "ekf", "jacobian_opensim"}) {
      std::vector<double> times;
      for (const FrameDiagnostic& frame : Track(model, preset, seen).frames)
        times.push_back(frame.seconds);
      fmt::print("{:24} {:.3f} ms median\n", preset, Milliseconds(times));
    }
#ifdef MMM_CONVERTER_WITH_SIMBODY
    if (name != std::string("held")) continue;
    std::vector<Eigen::Matrix3Xd> frames;
    frames.reserve(static_cast<std::size_t>(seen.num_frames()));
    for (int k = 0; k < seen.num_frames(); ++k) frames.emplace_back(seen.frame(k));
    const AssembledFrames assembled = FollowWithAssembler(*model, frames);
    fmt::print("{:24} {:.3f} ms median, {:.2f} mm rms\n", "Simbody's Assembler",
               Milliseconds(assembled.seconds), 1e3 * assembled.distance);
#endif
  }
}

}  // namespace
}  // namespace mmm_converter

int main(int argc, char** argv) {
  using namespace mmm_converter;
  const std::string what = argc == 5 ? argv[1] : "";
  try {
    if (what.empty())
      throw std::runtime_error("use: osim_benchmark WHAT MODEL.osim FIRST_SEED LAST_SEED");
    const std::string text = ReadModelText(argv[2]);
    const int first = std::stoi(argv[3]);
    if (what == "calibration") Calibration(text, first, std::stoi(argv[4]));
    if (what == "deviations") Deviations(text, first, std::stoi(argv[4]));
    if (what == "hidden") Hidden(text, first, std::stoi(argv[4]));
    if (what == "time") Time(text, first);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
