// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/model_json.h"

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

namespace mmm_converter {
namespace {

Json VectorJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Pieces of polynomials, lowest power first, one stage after the other.
Json FunctionJson(const ScalarFunction& function) {
  Json stages = Json::array();
  for (const ScalarFunction::Stage& stage : function.stages()) {
    stages.push_back({{"breaks", stage.breaks},
                      {"origins", stage.origins},
                      {"order", stage.order},
                      {"coefficients", stage.coefficients}});
  }
  return stages;
}

}  // namespace

Json ToJson(const KinematicModel& model) {
  Json segments = Json::array();
  for (const Segment& segment : model.segments()) {
    const Eigen::Quaterniond q(segment.X_PF.linear());
    segments.push_back({{"name", segment.name},
                        {"parent", segment.parent},
                        {"position", VectorJson(segment.X_PF.translation())},
                        {"orientation", {q.x(), q.y(), q.z(), q.w()}},
                        {"axis", VectorJson(segment.axis)},
                        {"joint", segment.joint}});
    if (segment.type == JointType::kSliding) segments.back()["slides"] = true;
    if (segment.function) segments.back()["function"] = FunctionJson(*segment.function);
    if (segment.rest != 0) segments.back()["rest"] = segment.rest;
  }
  Json markers = Json::array();
  for (const ModelMarker& marker : model.markers()) {
    markers.push_back({{"name", marker.name},
                       {"segment", marker.segment},
                       {"position", VectorJson(marker.p_SM)}});
  }
  Json joints = Json::array();
  for (int i = 0; i < model.num_joints(); ++i) {
    const Segment& joint = model.joint(i);
    joints.push_back({{"name", joint.name}, {"lower", joint.lower}, {"upper", joint.upper}});
  }
  return {{"segments", segments}, {"markers", markers}, {"joints", joints}};
}

}  // namespace mmm_converter
