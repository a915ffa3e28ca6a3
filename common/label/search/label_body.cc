// SPDX-License-Identifier: MIT
#include "common/label/search/label_body.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "common/fit/posture_fit.h"
#include "common/label/tuning.h"
#include "common/model/coordinate_map.h"

namespace mmm_converter {

namespace {

using Angles = std::vector<std::pair<std::string, double>>;  // of joints, without "_joint" [rad]

const std::vector<Angles>& ArmTemplates() {
  static const std::vector<Angles> kTemplates = {
      {},
      {{"LSy", 1.5}, {"RSy", -1.5}},
      {{"LSx", 1.5}, {"RSx", 1.5}},
      {{"LSx", 2.9}, {"RSx", 2.9}},
      {{"LSx", 0.5}, {"RSx", 0.5}, {"LEx", 1.6}, {"REx", 1.6}},
      {{"LSy", 1.5}},
      {{"RSy", -1.5}},
      {{"LSx", 1.5}},
      {{"RSx", 1.5}},
      {{"LSx", 2.9}},
      {{"RSx", 2.9}}};
  return kTemplates;
}

const std::vector<Angles>& LegTemplates() {
  static const std::vector<Angles> kTemplates = {
      {},
      {{"LHx", 1.4}, {"RHx", 1.4}, {"LKx", -1.5}, {"RKx", -1.5}},
      {{"LHx", 0.6}, {"LKx", -0.2}, {"RHx", -0.3}, {"RKx", -0.4}},
      {{"RHx", 0.6}, {"RKx", -0.2}, {"LHx", -0.3}, {"LKx", -0.4}},
      {{"LKx", -1.6}, {"RKx", -1.6}}};
  return kTemplates;
}

void SetAngles(const KinematicModel& model, const MarkerKinematics& kinematics,
               const Angles& angles, Posture* posture) {
  for (const auto& [name, angle] : angles) {
    const auto& joints = kinematics.joints();
    const auto found = std::find(joints.begin(), joints.end(), model.FindJoint(name + "_joint"));
    if (found == joints.end()) continue;
    const auto j = found - joints.begin();
    posture->joint_angles[j] = std::clamp(angle, kinematics.lower()[j], kinematics.upper()[j]);
  }
}

}  // namespace

LabelBody::LabelBody(const TrackingSetup& setup)
    : kinematics(*setup.model, setup.joints, MarkerIndices(setup.assignments())),
      place(NoiseScales(setup.assignments())),
      skin(place.size()),
      natural_angles(NaturalAngles(kinematics)),
      joints_of_marker(place.size()) {
  for (int m = 0; m < num_markers(); ++m) {
    const ModelMarker& marker = setup.model->markers()[kinematics.markers()[m]];
    place[m] = marker.deviation
                   ? std::max(PlaceTuning::kOwnShare * *marker.deviation, PlaceTuning::kLeast)
                   : std::min(PlaceTuning::kByHeight * place[m], PlaceTuning::kMost);
    skin[m] = std::max(marker.skin_deviation.value_or(PlaceTuning::kSkin), PlaceTuning::kLeastSkin);
    for (int j = 0; j < kinematics.num_joints(); ++j) {
      if (kinematics.Moves(j, m)) joints_of_marker[m].push_back(j);
    }
  }
  FindLimbs();
  Posture rest;
  if (setup.model->coordinates()) rest.orientation = RestPosture(*setup.model).orientation;
  rest.joint_angles = natural_angles;
  if (setup.model->coordinates()) {
    templates.push_back(std::move(rest));
    return;
  }
  for (const Angles& arms : ArmTemplates()) {
    for (const Angles& legs : LegTemplates()) {
      Posture posture = rest;
      SetAngles(*setup.model, kinematics, arms, &posture);
      SetAngles(*setup.model, kinematics, legs, &posture);
      templates.push_back(std::move(posture));
    }
  }
}

void LabelBody::FindLimbs() {
  limb_of_marker.assign(static_cast<std::size_t>(num_markers()), -1);
  std::vector<std::vector<int>> moved(kinematics.num_joints());
  for (int m = 0; m < num_markers(); ++m) {
    for (const int j : joints_of_marker[m]) moved[j].push_back(m);
  }
  std::vector<int> order(moved.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&moved](int a, int b) { return moved[a].size() > moved[b].size(); });
  for (const int j : order) {
    if (moved[j].empty() || 3 * static_cast<int>(moved[j].size()) > num_markers()) continue;
    int& limb = limb_of_marker[moved[j].front()];
    if (limb < 0) {
      limb = static_cast<int>(limbs.size());
      limbs.push_back({{}, moved[j]});
      for (const int m : moved[j]) limb_of_marker[m] = limb;
    }
    limbs[limb].joints.push_back(j);
  }
  for (Limb& limb : limbs) std::sort(limb.joints.begin(), limb.joints.end());
}

}  // namespace mmm_converter
