// SPDX-License-Identifier: MIT
#include "common/model/model_points.h"

#include <utility>

#include "common/model/kit_joints.h"

namespace mmm_converter {
namespace {

// Points and the joints that turn there. Those of several axes turn about one place.
constexpr std::pair<const char*, const char*> kKitPoints[] = {
    {"BP", "BPx_joint"}, {"BT", "BTx_joint"},      {"BLN", "BLNx_joint"},    {"BUN", "BUNx_joint"},
    {"LS", "LSx_joint"}, {"LE", "LEx_joint"},      {"LW", "LWx_joint"},      {"RS", "RSx_joint"},
    {"RE", "REx_joint"}, {"RW", "RWx_joint"},      {"LH", "LHx_joint"},      {"LK", "LKx_joint"},
    {"LA", "LAx_joint"}, {"LMrot", "LMrot_joint"}, {"LF", "LFx_joint"},      {"RH", "RHx_joint"},
    {"RK", "RKx_joint"}, {"RA", "RAx_joint"},      {"RMrot", "RMrot_joint"}, {"RF", "RFx_joint"}};

}  // namespace

std::vector<ModelPoint> KitPoints(const KinematicModel& model) {
  std::vector<ModelPoint> points = {{"root", 0}};
  for (const auto& [name, joint] : kKitPoints) {
    const int segment = model.FindSegment(joint);
    if (segment < 0) return {};
    points.push_back({name, segment});
  }
  return points;
}

std::vector<ModelPoint> KitJointPoints(const KinematicModel& model) {
  std::vector<ModelPoint> points;
  for (const std::string& joint : KitJointNames()) {
    const int segment = model.FindSegment(joint);
    if (segment < 0) return {};
    points.push_back({joint, segment});
  }
  return points;
}

std::vector<ModelPoint> JointPoints(const KinematicModel& model) {
  std::vector<ModelPoint> points = {{model.segments().front().name, 0}};
  for (int j = 0; j < model.num_joints(); ++j) {
    points.push_back({model.joint(j).name, model.joint_segment(j)});
  }
  return points;
}

}  // namespace mmm_converter
