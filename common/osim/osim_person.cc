// SPDX-License-Identifier: MIT
#include "common/osim/osim_person.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/convert/coordinate_tasks.h"
#include "common/fit/posture_search.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_scaling.h"
#include "common/io/osim/osim_subject.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

namespace {

constexpr int kFewestMarkers = 3;

OsimDocument Parse(const NamedText& text) {
  Diagnostics diagnostics(text.file);
  return ParseOsim(text.content, {}, &diagnostics);
}

KinematicModel MakeModel(const OsimDocument& document, const std::string& file) {
  Diagnostics diagnostics(file);
  return MakeOsimModel(document, &diagnostics);
}

struct FrameRange {
  int begin = 0, end = 0;
};

/// From the last frame at or before the start to the first at or after the end.
FrameRange FramesOf(const MarkerSequence& recording, const ScaleSetup::TimeRange& times) {
  FrameRange range{0, recording.num_frames()};
  if (!times) return range;
  constexpr double kSameTime = 1e-6;  // [s], of times with few digits
  while (range.begin + 1 < range.end &&
         recording.time(range.begin + 1) <= (*times)[0] + kSameTime) {
    ++range.begin;
  }
  while (range.end - 2 >= range.begin && recording.time(range.end - 2) >= (*times)[1] - kSameTime) {
    --range.end;
  }
  return range;
}

/// How far two labels are from each other on average where both are seen [m]; NaN: nowhere.
double MeanDistance(const MarkerSequence& recording, const FrameRange& range, int a, int b) {
  double sum = 0;
  int count = 0;
  for (int k = range.begin; k < range.end; ++k) {
    const auto p = recording.frame(k);
    if (!IsSeen(p.col(a)) || !IsSeen(p.col(b))) continue;
    sum += (p.col(a) - p.col(b)).norm();
    ++count;
  }
  return sum / count;
}

constexpr std::size_t kMostPlacedJoints = 500;  // the work grows with their cube

/// Those that move one of the markers, or that a task draws to a value, in ascending order.
std::vector<int> JointsThatCount(const KinematicModel& model, const std::vector<MarkerIx>& markers,
                                 const std::vector<JointTask>& tasks) {
  std::set<int> joints;
  for (const JointTask& task : tasks) joints.insert(task.joint);
  for (const MarkerIx marker : markers) {
    for (int s = model.markers()[marker].segment; s >= 0; s = model.segments()[s].parent) {
      if (model.segments()[s].joint >= 0) joints.insert(model.segments()[s].joint);
    }
  }
  return {joints.begin(), joints.end()};
}

/// Set-ups name bodies of other models too.
void LeaveOutUnknown(const OsimDocument& document, std::map<std::string, Vector3d>* factors,
                     Warnings* warnings) {
  std::vector<std::string> unknown;
  std::erase_if(*factors, [&](const auto& factor) {
    const bool is_known =
        std::any_of(document.bodies.begin(), document.bodies.end(),
                    [&](const OsimBody& body) { return body.name == factor.first; });
    if (!is_known) unknown.push_back(factor.first);
    return !is_known;
  });
  if (unknown.empty()) return;
  Warn(warnings, fmt::format("the set-up scales bodies that the model does not have: {}",
                             FirstNames(unknown)));
}

class PersonScaler {
 public:
  PersonScaler(const ScaleSetup& setup, std::string setup_file, const MarkerSequence& recording,
               Warnings* warnings)
      : setup_(setup),
        setup_file_(std::move(setup_file)),
        recording_(recording),
        warnings_(warnings) {}

  std::map<std::string, Vector3d> Factors(const KinematicModel& model) const;
  /// The markers where the person has them; those that do not move are left out.
  std::vector<OsimMarker> PlaceMarkers(const OsimDocument& document, const KinematicModel& model,
                                       double* distance) const;

 private:
  struct Target {
    std::vector<MarkerIx> markers;  // with tasks
    Matrix3Xd places;               // [m]
    Eigen::VectorXd noise_scale;
  };

  double Measure(const ScaleSetup::Measurement& measurement, const KinematicModel& model,
                 const Matrix3Xd& p_WM) const;
  Matrix3Xd MeanFrame() const;
  Target FindTarget(const KinematicModel& model, const Matrix3Xd& mean) const;

  const ScaleSetup& setup_;
  std::string setup_file_;
  const MarkerSequence& recording_;
  Warnings* warnings_;
};

double PersonScaler::Measure(const ScaleSetup::Measurement& measurement,
                             const KinematicModel& model, const Matrix3Xd& p_WM) const {
  const auto fail = [&](const std::string& what) {
    throw Error(fmt::format("{}:{}: measurement '{}': {}", setup_file_, measurement.line,
                            measurement.name, what));
  };
  double sum = 0;
  for (const auto& pair : measurement.pairs) {
    std::array<int, 2> markers{}, labels{};
    for (int i = 0; i < 2; ++i) {
      markers[i] = model.FindMarker(pair[i]);
      labels[i] = recording_.FindLabel(pair[i]);
      if (markers[i] < 0) fail(fmt::format("the model has no marker '{}'", pair[i]));
      if (labels[i] < 0) fail(fmt::format("the recording has no marker '{}'", pair[i]));
    }
    const double measured =
        MeanDistance(recording_, FramesOf(recording_, setup_.scaling_time), labels[0], labels[1]);
    const double of_model = (p_WM.col(markers[0]) - p_WM.col(markers[1])).norm();
    if (!(measured > 0 && of_model > 0)) {
      fail(
          fmt::format("'{}' and '{}' are never seen together, or are one place", pair[0], pair[1]));
    }
    sum += measured / of_model;
  }
  return sum / static_cast<double>(measurement.pairs.size());
}

std::map<std::string, Vector3d> PersonScaler::Factors(const KinematicModel& model) const {
  std::map<std::string, Vector3d> factors;
  if (!setup_.scales) return factors;
  const auto by_hand = [&] {
    for (const ScaleSetup::Factors& one : setup_.factors) factors[one.body] = one.factors;
  };
  if (!setup_.measures_first) by_hand();
  const Matrix3Xd p_WM = MarkerPositions(model, RestPosture(model));
  for (const ScaleSetup::Measurement& measurement : setup_.measurements) {
    const double factor = Measure(measurement, model, p_WM);
    for (const auto& [body, axes] : measurement.bodies) {
      Vector3d& all = factors.try_emplace(body, Vector3d::Ones()).first->second;
      all = (axes.array() > 0).select(factor, all);
    }
  }
  if (setup_.measures_first) by_hand();
  return factors;
}

/// Of each label [m]; NaN where it is not seen.
Matrix3Xd PersonScaler::MeanFrame() const {
  const FrameRange range = FramesOf(recording_, setup_.placing_time);
  Matrix3Xd mean = Matrix3Xd::Zero(3, recording_.num_labels());
  for (int label = 0; label < recording_.num_labels(); ++label) {
    int count = 0;
    for (int k = range.begin; k < range.end; ++k) {
      const Vector3d p = recording_.frame(k).col(label);
      if (!IsSeen(p)) continue;
      mean.col(label) += p;
      ++count;
    }
    mean.col(label) /= count;
  }
  return mean;
}

/// The markers that tasks draw to where they are seen; without tasks, all.
PersonScaler::Target PersonScaler::FindTarget(const KinematicModel& model,
                                              const Matrix3Xd& mean) const {
  Target target;
  std::vector<double> scales;
  const auto add = [&](const std::string& name, double weight) {
    const int marker = model.FindMarker(name);
    const int label = recording_.FindLabel(name);
    if (marker < 0 || label < 0 || !mean.col(label).allFinite()) return;
    target.markers.emplace_back(marker);
    target.places.conservativeResize(3, static_cast<Eigen::Index>(target.markers.size()));
    target.places.rightCols<1>() = mean.col(label);
    scales.push_back(1 / std::sqrt(weight));
  };
  for (const IkTasks::OfMarker& task : setup_.tasks.markers) add(task.name, task.weight);
  if (setup_.tasks.markers.empty()) {
    for (const ModelMarker& marker : model.markers()) add(marker.name, 1);
  }
  if (target.markers.size() < kFewestMarkers) {
    throw Error(
        fmt::format("{}: markers can't be placed: the recording shows {} of those that have "
                    "tasks, and at least {} are needed",
                    setup_file_, target.markers.size(), kFewestMarkers));
  }
  target.noise_scale = Eigen::Map<Eigen::VectorXd>(scales.data(), static_cast<int>(scales.size()));
  return target;
}

std::vector<OsimMarker> PersonScaler::PlaceMarkers(const OsimDocument& document,
                                                   const KinematicModel& model,
                                                   double* distance) const {
  const Matrix3Xd mean = MeanFrame();
  const Target target = FindTarget(model, mean);
  const std::vector<JointTask> tasks =
      ResolveCoordinateTasks(setup_.tasks.coordinates, model, warnings_);
  const std::vector<int> joints = JointsThatCount(model, target.markers, tasks);
  if (joints.size() > kMostPlacedJoints) {
    throw Error(
        fmt::format("{}: {} joints move the markers that are to be placed, more than the "
                    "{} that are fitted",
                    setup_file_, joints.size(), kMostPlacedJoints));
  }
  const MarkerKinematics kinematics(model, joints, target.markers);
  // As near to the minimum as numbers let it come, wherever the markers determine it.
  PostureFitOptions options;
  options.max_iterations = 2000;
  options.tolerance = 1e-13;
  options.natural_weight = 0;
  for (const JointTask& task : tasks) {
    const auto at = std::lower_bound(joints.begin(), joints.end(), task.joint);
    options.pulls.push_back({static_cast<int>(at - joints.begin()), task.value, task.weight});
  }
  const Posture rest = RestPosture(model);
  Posture posture = rest;
  posture.joint_angles = rest.joint_angles(joints);
  PostureSearch search(kinematics);
  search.Assemble(target.places, target.noise_scale, options, 0, &posture);
  search.fit().Solve(target.places, target.noise_scale, options, &posture);
  Posture placed = posture;
  placed.joint_angles = rest.joint_angles;
  placed.joint_angles(joints) = posture.joint_angles;
  const std::vector<Eigen::Isometry3d> poses = SegmentPoses(model, placed);
  double squares = 0;
  for (std::size_t i = 0; i < target.markers.size(); ++i) {
    const ModelMarker& marker = model.markers()[target.markers[i]];
    squares +=
        (poses[marker.segment] * marker.p_SM - target.places.col(static_cast<Eigen::Index>(i)))
            .squaredNorm();
  }
  *distance = std::sqrt(squares / static_cast<double>(target.markers.size()));
  std::vector<OsimMarker> moved;
  for (const OsimMarker& marker : document.markers) {
    const int label = recording_.FindLabel(marker.name);
    const int known = model.FindMarker(marker.name);
    if (marker.is_fixed || label < 0 || known < 0 || !mean.col(label).allFinite()) continue;
    moved.push_back(marker);
    moved.back().p_BM = poses[model.markers()[known].segment].inverse() * mean.col(label);
  }
  return moved;
}

}  // namespace

ScaledOsim ScaleOsimPerson(const NamedText& model, const std::vector<NamedText>& markers,
                           const ScaleSetup& setup, const std::string& setup_file,
                           const MarkerSequence& recording, Warnings* warnings) {
  ScaledOsim scaled;
  scaled.content = WithoutOsimSubject(model.content);
  OsimDocument document = Parse(model);
  if (!markers.empty()) {
    for (const NamedText& set : markers) {
      AddOsimMarkers(set.content, set.file, &document, warnings);
    }
    scaled.content = WriteOsimMarkers(scaled.content, model.file, document, document.markers);
  }
  const PersonScaler person(setup, setup_file, recording, warnings);
  OsimScaling scaling;
  scaling.factors = person.Factors(MakeModel(document, model.file));
  LeaveOutUnknown(document, &scaling.factors, warnings);
  scaling.mass = setup.mass;
  scaling.keeps_mass_distribution = setup.keeps_mass_distribution;
  scaled.content = ScaleOsim(scaled.content, model.file, scaling, warnings);
  scaled.factors = std::move(scaling.factors);
  document = Parse({scaled.content, model.file});
  for (const OsimBody& body : document.bodies) scaled.mass += body.mass;
  if (!setup.places_markers) return scaled;
  const std::vector<OsimMarker> moved =
      person.PlaceMarkers(document, MakeModel(document, model.file), &scaled.distance);
  scaled.placed_markers = static_cast<int>(moved.size());
  scaled.content = WriteOsimMarkers(scaled.content, model.file, document, moved);
  return scaled;
}

}  // namespace mmm_converter
