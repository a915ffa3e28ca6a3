// SPDX-License-Identifier: MIT
#include "common/convert/tracking_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/convert/coordinate_tasks.h"
#include "common/convert/marker_set.h"
#include "common/model/marker_kinematics.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

bool IsScaled(const ConverterConfig& config) { return config.model_processor != "None"; }

}  // namespace

void WarnOfFreeJoints(const TrackingSetup& setup, const ConverterConfig& config,
                      Warnings* warnings) {
  constexpr std::size_t kShown = 5;
  if (IsScaled(config)) return;
  const MarkerKinematics kinematics(*setup.model, setup.joints, MarkerIndices(setup.assignments()));
  std::vector<std::string> names;
  for (int j = 0; j < kinematics.num_joints(); ++j) {
    bool is_moving = false;
    for (int m = 0; m < kinematics.num_markers(); ++m) is_moving |= kinematics.Moves(j, m);
    if (!is_moving) names.push_back(setup.model->joint(kinematics.joints()[j]).name);
  }
  if (names.empty()) return;
  Warn(warnings, fmt::format("no marker of the recording is moved by {} of the {} tracked joints, "
                             "whose angles are not "
                             "known: {}",
                             names.size(), kinematics.num_joints(), FirstNames(names, kShown)));
}

std::vector<JointPull> PullsOf(const TrackingSetup& setup) {
  std::vector<JointPull> pulls;
  for (const JointTask& task : setup.joint_tasks) {
    const auto tracked = std::find(setup.joints.begin(), setup.joints.end(), task.joint);
    if (tracked == setup.joints.end()) continue;
    pulls.push_back({static_cast<int>(tracked - setup.joints.begin()), task.value, task.weight});
  }
  return pulls;
}

TrackingSetup MatchMarkers(const MarkerLabels& labels,
                           std::shared_ptr<const KinematicModel> reference,
                           const ConverterConfig& config, Warnings* warnings) {
  TrackingSetup setup;
  setup.model = std::move(reference);
  const std::vector<MarkerPair> pairs =
      ResolveMarkerPairs(config, labels, *setup.model, &setup.marker_set);
  setup.mapping = ResolveMarkerMapping(pairs, labels, *setup.model, warnings);
  setup.joints = ResolveJoints(config, *setup.model);
  if (const auto set = ReadOwnMarkerSet(config)) {
    setup.joint_tasks = ResolveCoordinateTasks(set->coordinate_tasks, *setup.model, warnings);
  }
  return setup;
}

HeightEstimate EstimateHeight(const TrackingSetup& setup, const KinematicModel& reference,
                              const MarkerSequence& recording, const std::vector<Posture>* track) {
  return EstimateHeight(reference, setup.joints, MarkerIndices(setup.assignments()),
                        LabelIndices(setup.assignments()), recording, {track});
}

KinematicModel ScaleModel(const KinematicModel& reference, const PersonScaling& person) {
  if (!person.size) return reference;
  KinematicModel scaled = ScaleWinter(reference, *person.size);
  if (person.subject) return FitToSubject(scaled, *person.subject);
  return person.landmarks ? WithLandmarkBody(scaled, *person.landmarks) : scaled;
}

void ScaleToPerson(const PersonScaling& person, TrackingSetup* setup) {
  if (!person.size) return;
  setup->model = std::make_shared<const KinematicModel>(ScaleModel(*setup->model, person));
}

TrackingSetup MakeTrackingSetup(const MarkerLabels& labels,
                                std::shared_ptr<const KinematicModel> reference,
                                const ConverterConfig& config, const PersonScaling& person,
                                Warnings* warnings) {
  TrackingSetup setup = MatchMarkers(labels, std::move(reference), config, warnings);
  WarnOfFreeJoints(setup, config, warnings);
  if (IsScaled(config)) ScaleToPerson(person, &setup);
  return setup;
}

}  // namespace mmm_converter
