// SPDX-License-Identifier: MIT
// Figures on models of OpenSim, with persons, motions and markers that were made:
//   osim_benchmark WHAT MODEL.osim FIRST_SEED LAST_SEED
// WHAT: deviations, hidden or time. A model without markers gets three on each body. Every seed is
// another person, whose bodies are up to some 10 % larger or smaller than the model's, who wears
// every marker some 10 mm elsewhere, with soft tissue of 4 mm.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/io/bytes/file_content.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_scaling.h"
#include "common/math/seeded_random.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/occlusion.h"
#include "plugins/jacobian/jacobian_converter.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

constexpr int kFrames = 300;
constexpr int kSettled = 25;
constexpr double kRate = 100;  // [Hz]
constexpr MarkerErrors kErrors{0.01, 0.004, 0.3, 0.0005};
constexpr double kDegrees = 180 / EIGEN_PI;

using ModelPtr = std::shared_ptr<const KinematicModel>;

struct Case {
  ModelPtr generic;  ///< lengths of the model
  ModelPtr person;   ///< lengths of the person, markers where the model has them
  ModelPtr known;    ///< the person with the markers where they are worn
  PoseTrajectory truth;
  MarkerSequence markers;
};

ModelPtr Parse(const std::string& text) {
  return std::make_shared<const KinematicModel>(ParseOsimModel(text, "model"));
}

/// The file, with markers.
std::string ReadModelText(const std::string& file) {
  const std::string text = ReadFileContent(file, kMaxOsimBytes);
  Diagnostics diagnostics(file);
  const OsimDocument document = ParseOsim(text, {}, &diagnostics);
  if (!document.markers.empty()) return text;
  SeededRandom random(1);
  std::vector<OsimMarker> markers;
  for (int body = 1; body < static_cast<int>(document.bodies.size()); ++body) {
    for (int i = 0; i < 3; ++i) {
      OsimMarker& marker = markers.emplace_back();
      marker.name = fmt::format("{}_{}", document.bodies[body].name, i);
      marker.body = body;
      marker.p_BM = document.bodies[body].p_BC;
      for (int axis = 0; axis < 3; ++axis) marker.p_BM[axis] += 0.06 * random.Normal();
    }
  }
  return WriteOsimMarkers(text, file, document, markers);
}

/// "knee_angle_r" and "knee_angle_l" are one group.
std::string GroupOf(std::string name) {
  if (name.ends_with("_r") || name.ends_with("_l")) name.resize(name.size() - 2);
  return name;
}

std::string MakePerson(const std::string& text, int seed) {
  Diagnostics diagnostics("model");
  SeededRandom random(1000 + seed);
  OsimScaling scaling;
  std::map<std::string, double> sizes;  // of both sides
  for (const OsimBody& body : ParseOsim(text, {}, &diagnostics).bodies) {
    const auto [size, is_new] = sizes.try_emplace(GroupOf(body.name), 1);
    if (is_new) size->second += 0.05 * std::clamp(random.Normal(), -2.0, 2.0);
    if (body.mass > 0) scaling.factors[body.name] = Eigen::Vector3d::Constant(size->second);
  }
  return ScaleOsim(text, "model", scaling, nullptr);
}

/// Every joint swings within its range, twice as fast as slow walking at most.
PoseTrajectory MakeMotion(const KinematicModel& model, int seed) {
  SeededRandom random(2000 + seed);
  PoseTrajectory motion;
  motion.rate = kRate;
  std::vector<std::array<double, 4>> swings;
  for (int j = 0; j < model.num_joints(); ++j) {
    const Segment& joint = model.joint(j);
    motion.joint_names.push_back(joint.name);
    const double half = HasNoLimits(joint) ? 0.5 * joint.reach : 0.5 * (joint.upper - joint.lower);
    const double most = joint.type == JointType::kSliding ? 0.05 : 0.4;
    const double mean = HasNoLimits(joint) ? joint.rest : 0.5 * (joint.upper + joint.lower);
    swings.push_back({std::clamp(mean, joint.rest - 0.3, joint.rest + 0.3),
                      std::min(most, 0.6 * half), 2 + 4 * random.Uniform(), 6 * random.Uniform()});
  }
  for (int k = 0; k < kFrames; ++k) {
    const double t = k / kRate;
    Posture& q = motion.postures.emplace_back(ZeroPosture(model));
    if (!model.is_root_fixed()) {
      q.position = {1.2 * t, 0.02 * std::sin(6 * t), 0.95 + 0.02 * std::sin(12 * t)};
      q.orientation = Eigen::Quaterniond(model.coordinates()->R_WG()) *
                      Eigen::AngleAxisd(0.1 * std::sin(6 * t), Eigen::Vector3d::UnitY());
    }
    for (int j = 0; j < model.num_joints(); ++j) {
      const auto& [mean, reach, speed, phase] = swings[static_cast<std::size_t>(j)];
      double angle = mean + reach * std::sin(speed * t + phase);
      const Segment& joint = model.joint(j);
      if (!HasNoLimits(joint)) angle = std::clamp(angle, joint.lower, joint.upper);
      q.joint_angles[j] = angle;
    }
  }
  return motion;
}

Case MakeCase(const std::string& text, int seed) {
  Case made;
  made.generic = Parse(text);
  made.person = Parse(MakePerson(text, seed));
  made.truth = MakeMotion(*made.person, seed);
  made.markers = SynthesizeMarkers(*made.person, made.truth, kErrors, seed);
  // Where each is worn: the same offsets without anything else, seen from the posture of frame 0.
  MarkerErrors worn = kErrors;
  worn.wobble = worn.noise = 0;
  const MarkerSequence still = SynthesizeMarkers(*made.person, made.truth, worn, seed);
  ModelDescription description = DescriptionOf(*made.person);
  const auto poses = SegmentPoses(*made.person, ModelPosture(*made.person, made.truth, 0));
  for (ModelMarker& marker : description.markers) {
    const int label = still.FindLabel(marker.name);
    marker.p_SM = poses[marker.segment].inverse() * still.frame(0).col(label);
    marker.deviation = 0.001;
    marker.skin_deviation = 0.004;
  }
  made.known = std::make_shared<const KinematicModel>(std::move(description));
  return made;
}

ConversionResult Track(const ModelPtr& model, const std::string& preset,
                       const MarkerSequence& seen) {
  ConverterConfig config =
      ReadConverterConfig(testing::SourcePath("xml_config/converters/" + preset + ".xml"));
  config.marker_set = "auto";
  config.joint_set = "auto";
  config.model_processor = "None";
  TrackingSetup setup = MakeTrackingSetup(LabelsOf(seen), model, config, {});
  if (preset.starts_with("jacobian")) {
    return jacobian::JacobianConverter(std::move(setup), jacobian::ReadSettings(config))
        .Convert(seen, nullptr);
  }
  return s2kf::S2kfConverter(std::move(setup), s2kf::ReadSettings(config)).Convert(seen, nullptr);
}

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

void Deviations(const std::string& text, int first, int last) {
  for (const char* preset : {"s2kf_default", "s2kf_offline"}) {
    std::map<std::string, Share> uncalibrated, known;
    for (int seed = first; seed <= last; ++seed) {
      const Case made = MakeCase(text, seed);
      const MarkerSequence seen = OccludeShare(made.markers, 0.1, 30, seed);
      AddShares(made, made.generic, Track(made.generic, preset, seen), &uncalibrated);
      AddShares(made, made.known, Track(made.known, preset, seen), &known);
    }
    for (const auto& [what, shares] :
         {std::pair("uncalibrated", &uncalibrated), {"known", &known}}) {
      for (const auto& [group, share] : *shares) {
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

void Hidden(const std::string& text, int first, int last) {
  for (int seed = first; seed <= last; ++seed) {
    const Case made = MakeCase(text, seed);
    const MarkerSequence quarter = OccludeShare(made.markers, 0.25, 50, seed);
    std::vector<std::string> limb;  // below the right knee
    for (const ModelMarker& marker : made.known->markers()) {
      for (int s = marker.segment; s >= 0; s = made.known->segments()[s].parent) {
        if (!made.known->segments()[s].name.starts_with("tibia_r")) continue;
        limb.push_back(marker.name);
        break;
      }
    }
    const MarkerSequence without_limb = HideMarkers(made.markers, limb, 100, 200);
    for (const char* preset : {"jacobian_opensim", "s2kf_default", "s2kf_offline"}) {
      const auto line = [&](const char* what) {
        return fmt::format("{} {} {}", seed, preset, what);
      };
      PrintErrors(line("all seen"), made, Track(made.known, preset, made.markers), "", kSettled,
                  kFrames);
      PrintErrors(line("a quarter hidden"), made, Track(made.known, preset, quarter), "", kSettled,
                  kFrames);
      const ConversionResult result = Track(made.known, preset, without_limb);
      PrintErrors(line("leg hidden 1 s: knee"), made, result, "knee_angle_r", 100, 200);
      PrintErrors(line("leg hidden 1 s: ankle"), made, result, "ankle_angle_r", 100, 200);
    }
  }
}

void Time(const std::string& text, int seed) {
  const Case made = MakeCase(text, seed);
  std::vector<std::string> hidden;
  for (std::size_t i = 60; i < made.markers.labels().size(); ++i)
    hidden.push_back(made.markers.labels()[i]);
  const MarkerSequence seen = HideMarkers(made.markers, hidden, 0, kFrames);
  fmt::print("{} joints and the root, {} of {} markers\n", made.known->num_joints(),
             made.markers.num_labels() - static_cast<int>(hidden.size()),
             made.markers.num_labels());
  for (const char* preset : {"s2kf_default", "ekf", "jacobian_opensim"}) {
    std::vector<double> times;
    for (const FrameDiagnostic& frame : Track(made.known, preset, seen).frames)
      times.push_back(frame.seconds);
    std::sort(times.begin(), times.end());
    fmt::print("{:18} {:.3f} ms median, {:.3f} tenth\n", preset, 1e3 * times[times.size() / 2],
               1e3 * times[times.size() / 10]);
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
    if (what == "deviations") Deviations(text, first, std::stoi(argv[4]));
    if (what == "hidden") Hidden(text, first, std::stoi(argv[4]));
    if (what == "time") Time(text, first);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
