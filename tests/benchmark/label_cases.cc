// SPDX-License-Identifier: MIT
#include "tests/benchmark/label_cases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "common/calibrate/calibration.h"
#include "common/convert/converter_config.h"
#include "common/io/recording/recording.h"
#include "common/label/search/label_body.h"
#include "common/math/seeded_random.h"
#include "common/support/error.h"
#include "common/support/parallel.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {

namespace {

struct RealRecording {
  const char* name;
  const char* file;
  std::optional<double> height;  // [m]; nothing: estimated
};

constexpr RealRecording kReal[] = {{"close", "kit_bimanual_c3d/Close_1723.c3d", 1.68},
                                   {"cut", "kit_bimanual_c3d/Cut_1723.c3d", 1.68},
                                   {"peel", "kit_bimanual_c3d/Peel_1723.c3d", 1.68},
                                   {"pour", "kit_bimanual_c3d/Pour_1480.c3d", 1.79},
                                   {"stir", "kit_bimanual_c3d/Stir_1723.c3d", 1.68},
                                   {"02_05", "whole_body/cmu_02_05.c3d", {}},
                                   {"85_02", "whole_body/85_02.c3d", {}},
                                   {"tennis", "whole_body/kinematics_tennis_serve.c3d", {}},
                                   {"pycgm", "whole_body/pycgm_movement_trial.c3d", {}}};

constexpr double kMadeHeight = 1.78;
constexpr double kMadeSeconds = 3;

LabelCase Read(const RealRecording& real) {
  LabelCase one;
  one.name = real.name;
  const Recording recording =
      ReadRecording(testing::SharedData(std::string("recordings/") + real.file), {});
  one.recording = recording.markers;
  const KinematicModel unit = testing::ScaledReferenceModel(1);
  const TrackingSetup matched =
      MatchMarkers(LabelsOf(one.recording), std::make_shared<const KinematicModel>(unit), {});
  const double height =
      real.height ? *real.height : EstimateHeight(matched, unit, one.recording).height;
  one.by_height = matched;
  one.by_height.model =
      std::make_shared<const KinematicModel>(testing::ScaledReferenceModel(height));
  const CalibrationResult result = CalibrateSubject(
      *one.by_height.model, matched.joints, {{"", &one.recording, matched.assignments()}}, {});
  one.calibrated = matched;
  one.calibrated.model =
      std::make_shared<const KinematicModel>(FitToSubject(*one.by_height.model, result.subject));
  return one;
}

/// Labels whose marker a joint moves.
std::vector<int> LabelsMovedBy(const LabelCase& one, const std::string& joint) {
  const LabelBody body(one.calibrated);
  const auto& joints = body.kinematics.joints();
  const auto found =
      std::find(joints.begin(), joints.end(), one.calibrated.model->FindJoint(joint + "_joint"));
  std::vector<int> labels;
  for (int m = 0; found != joints.end() && m < body.num_markers(); ++m) {
    if (body.kinematics.Moves(static_cast<int>(found - joints.begin()), m)) {
      labels.push_back(one.calibrated.assignments()[m].label);
    }
  }
  return labels;
}

/// The left labels of a limb and the right ones of the same names.
std::vector<std::pair<int, int>> SidesOf(const LabelCase& one, const std::string& joint) {
  std::vector<std::pair<int, int>> sides;
  for (const int left : LabelsMovedBy(one, "L" + joint)) {
    std::string name = one.recording.labels()[left];
    name[0] = name[0] == 'L' ? 'R' : name[0];
    const int right = one.recording.FindLabel(name);
    if (right >= 0 && right != left) sides.emplace_back(left, right);
  }
  return sides;
}

int Nearest(const MarkerSequence& recording, const std::vector<int>& labels, int to, int k) {
  int nearest = labels[0] == to ? labels[1] : labels[0];
  double shortest = std::numeric_limits<double>::infinity();
  for (const int label : labels) {
    const double d = (recording.frame(k).col(label) - recording.frame(k).col(to)).norm();
    if (label == to || !(d < shortest)) continue;
    shortest = d;
    nearest = label;
  }
  return nearest;
}

}  // namespace

std::vector<LabelCase> RealCases(const std::vector<std::string>& only) {
  std::vector<const RealRecording*> real;
  for (const RealRecording& one : kReal) {
    if (only.empty() || std::find(only.begin(), only.end(), one.name) != only.end()) {
      real.push_back(&one);
    }
  }
  std::vector<LabelCase> cases(real.size());
  ParallelFor(static_cast<int>(real.size()), 0, [&](int i) { cases[i] = Read(*real[i]); });
  return cases;
}

LabelCase MadeCase(std::uint64_t seed) {
  const KinematicModel model = testing::ScaledReferenceModel(kMadeHeight);
  Subject subject = testing::DrawPerson(model, seed);
  for (MarkerOffset& offset : subject.offsets) {
    offset.standard_deviations.setConstant(0.005);
    offset.skin_deviation = 0.004;
  }
  const KinematicModel person = FitToSubject(model, subject);
  LabelCase one;
  one.name = kMadeCase;
  one.recording =
      testing::RecordPerson(person, testing::RangeOfMotion(model, kMadeSeconds, 0.6, seed), seed);
  const std::vector<int> joints = testing::TrackedJoints(model);
  const auto assignments = testing::AssignAll(model, one.recording);
  one.calibrated = testing::SetupOf(person, joints, assignments);
  one.by_height = testing::SetupOf(model, joints, assignments);
  return one;
}

TogetherCase MakeTogether(std::uint64_t seed) {
  constexpr std::uint64_t kOther = 1000;   // seeds of the second persons
  constexpr double kFar = 1, kNear = 0.4;  // [m] from the middle
  TogetherCase together;
  const std::array<LabelCase, 2> persons = {MadeCase(seed), MadeCase(seed + kOther)};
  SeededRandom random(seed);
  LabelObject box;
  box.p_OM.resize(3, 5);
  for (double& x : box.p_OM.reshaped()) x = 0.3 * random.Uniform();
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < persons.size(); ++i) {
    TrackingSetup setup = persons[i].calibrated;
    for (MarkerAssignment& one : setup.mapping.assignments) {
      one.label = LabelIx(one.label + static_cast<int>(labels.size()));
    }
    together.scene.persons.push_back(std::move(setup));
    for (const std::string& label : persons[i].recording.labels()) {
      labels.push_back(std::to_string(i) + ":" + label);
    }
  }
  for (int m = 0; m < box.p_OM.cols(); ++m) {
    box.names.push_back(static_cast<int>(labels.size()));
    labels.push_back("box:" + std::to_string(m));
  }
  const MarkerSequence& first = persons[0].recording;
  const MarkerSequence& second = persons[1].recording;
  together.recording = MarkerSequence(labels, first.num_frames(), first.rate(), 0);
  for (int k = 0; k < first.num_frames(); ++k) {
    const double x = kFar + (kNear - kFar) * k / first.num_frames();
    const Eigen::Matrix3d R(Eigen::AngleAxisd(0.02 * k, Eigen::Vector3d(1, 2, 2) / 3));
    const Eigen::Vector3d p(std::sin(0.03 * k), std::cos(0.03 * k), 1);
    together.recording.frame(k) << first.frame(k).colwise() - Eigen::Vector3d(x, 0, 0),
        second.frame(k).colwise() + Eigen::Vector3d(x, 0, 0), (R * box.p_OM).colwise() + p;
  }
  together.scene.objects.push_back(std::move(box));
  return together;
}

std::vector<int> MarkerOfLabel(const LabelCase& one) {
  std::vector<int> markers(one.recording.num_labels(), -1);
  for (std::size_t m = 0; m < one.calibrated.assignments().size(); ++m) {
    markers[one.calibrated.assignments()[m].label] = static_cast<int>(m);
  }
  return markers;
}

BrokenLabels Break(const LabelCase& one, LabelEvent event, int begin, std::uint64_t seed) {
  const int labels = one.recording.num_labels();
  const int frames = one.recording.num_frames();
  const int second = static_cast<int>(std::lround(one.recording.rate()));
  SeededRandom random(seed);
  std::vector<int> named;
  for (const MarkerAssignment& a : one.calibrated.assignments()) named.push_back(a.label);
  const int first = named[random.UniformIndex(static_cast<int>(named.size()))];
  std::vector<std::pair<int, int>> exchanged;  // columns
  if (event == LabelEvent::kPair) {
    const int other = named[random.UniformIndex(static_cast<int>(named.size()))];
    exchanged = {{first, other == first ? Nearest(one.recording, named, first, begin) : other}};
  } else if (event == LabelEvent::kNearestPair) {
    exchanged = {{first, Nearest(one.recording, named, first, begin)}};
  } else if (event == LabelEvent::kLimb) {
    exchanged = SidesOf(one, random.Uniform() < 0.5 ? "Hx" : "Sx");
  }
  std::vector<std::string> names = one.recording.labels();
  names.insert(names.end(), {"*1", "*2"});
  BrokenLabels broken = {
      MarkerSequence(names, frames, one.recording.rate(), one.recording.first_time()), {}};
  for (int k = 0; k < frames; ++k) {
    std::vector<int> from(labels + 2, -1);  // label of each column
    for (int c = 0; c < labels; ++c) from[c] = c;
    if (k >= begin && k < begin + second) {
      for (const auto& [a, b] : exchanged) std::swap(from[a], from[b]);
      const bool is_later = event == LabelEvent::kSplit && k >= begin + second / 2;
      if (exchanged.empty()) std::swap(from[first], from[labels + (is_later ? 1 : 0)]);
    }
    for (int c = 0; c < labels + 2; ++c) {
      if (from[c] >= 0) broken.recording.frame(k).col(c) = one.recording.frame(k).col(from[c]);
    }
    broken.own.push_back(std::move(from));
  }
  return broken;
}

}  // namespace mmm_converter
