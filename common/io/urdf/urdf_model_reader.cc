// SPDX-License-Identifier: MIT
#include "common/io/urdf/urdf_model_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "common/io/bytes/file_content.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/urdf/urdf_document.h"
#include "common/support/diagnostics.h"

namespace mmm_converter {
namespace {

constexpr std::string_view kMarkerSuffix = "_marker";
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kWidestRange = 4 * EIGEN_PI;  // [rad]; beyond it a limit limits nothing

class UrdfModelBuilder {
 public:
  UrdfModelBuilder(const UrdfDocument& document, Diagnostics* diagnostics)
      : document_(document), diagnostics_(*diagnostics) {}

  UrdfModel Build();

 private:
  void FindMarkers();
  bool IsMarker(const UrdfLink& link) const;
  void AddSegment(int link);
  void AddMarkers();
  const UrdfJoint* FindMimic(int link) const;
  void SetJoint(const UrdfJoint& joint, Segment* segment);
  void SetRange(const UrdfJoint& joint, Segment* segment);
  void HoldAt(const UrdfJoint& joint, double value, Segment* segment);
  std::string RootName() const;
  void WarnOf(const std::vector<std::string>& joints, const char* what);

  const UrdfDocument& document_;
  Diagnostics& diagnostics_;
  std::vector<bool> is_marker_;  ///< of links; not in the model as segments
  std::vector<int> segment_;     ///< of links; -1: none
  ModelDescription description_;
  std::map<std::string, std::string> segment_of_link_;
  std::map<std::string, std::vector<std::string>> lost_;  ///< markers below each mimic joint
  std::vector<std::string> mimics_, slides_, stiff_;      ///< joints
};

bool UrdfModelBuilder::IsMarker(const UrdfLink& link) const {
  return link.parent_joint >= 0 && link.name.size() > kMarkerSuffix.size() &&
         link.name.ends_with(kMarkerSuffix) &&
         document_.joints[link.parent_joint].type == UrdfJointType::kFixed;
}

/// Markers without mass and children.
void UrdfModelBuilder::FindMarkers() {
  std::vector<bool> has_children(document_.links.size(), false);
  for (const UrdfJoint& joint : document_.joints) has_children[joint.parent] = true;
  is_marker_.resize(document_.links.size());
  for (std::size_t i = 0; i < is_marker_.size(); ++i) {
    const UrdfLink& link = document_.links[i];
    is_marker_[i] = IsMarker(link) && !has_children[i] && link.mass == 0;
  }
}

/// The root's link may be called as one of the joints.
std::string UrdfModelBuilder::RootName() const {
  std::set<std::string> taken;
  for (const UrdfJoint& joint : document_.joints) taken.insert(joint.name);
  std::string name = document_.links[document_.root].name;
  while (taken.contains(name)) name += "_link";
  return name;
}

void UrdfModelBuilder::HoldAt(const UrdfJoint& joint, double value, Segment* segment) {
  segment->type = JointType::kFixed;
  segment->lower = segment->upper = 0;
  if (joint.type == UrdfJointType::kPrismatic) {
    segment->X_PF.translate(value * joint.axis);
  } else {
    segment->X_PF.rotate(Eigen::AngleAxisd(value, joint.axis));
  }
}

void UrdfModelBuilder::SetRange(const UrdfJoint& joint, Segment* segment) {
  segment->type = JointType::kRevolute;
  segment->lower = joint.lower;
  segment->upper = joint.upper;
  if (joint.type == UrdfJointType::kContinuous ||
      (joint.lower < -kWidestRange && joint.upper > kWidestRange)) {
    segment->lower = -kInfinity;
    segment->upper = kInfinity;
  } else if (joint.lower < -kWidestRange || joint.upper > kWidestRange) {
    diagnostics_.AddError(joint.line, fmt::format("joint '{}': its limits {:.6g} to {:.6g} are not "
                                                  "in radian",
                                                  joint.name, joint.lower, joint.upper));
  } else if (joint.lower == joint.upper) {
    HoldAt(joint, joint.lower, segment);
    stiff_.push_back(joint.name);
  }
}

void UrdfModelBuilder::SetJoint(const UrdfJoint& joint, Segment* segment) {
  segment->name = joint.name;
  segment->X_PF = joint.X_PF;
  segment->axis = joint.axis;
  if (joint.type == UrdfJointType::kFixed) return;
  if (joint.type == UrdfJointType::kFloating || joint.type == UrdfJointType::kPlanar) {
    diagnostics_.AddError(
        joint.line,
        fmt::format("joint '{}': {} joints are not supported; only the root link floats, by itself",
                    joint.name, joint.type == UrdfJointType::kPlanar ? "planar" : "floating"));
  } else if (!joint.mimicked.empty()) {
    mimics_.push_back(joint.name);
    HoldAt(joint, joint.mimic_offset, segment);
  } else if (joint.type == UrdfJointType::kPrismatic) {
    slides_.push_back(joint.name);
    HoldAt(joint, std::clamp(0.0, joint.lower, joint.upper), segment);
  } else {
    SetRange(joint, segment);
  }
}

void UrdfModelBuilder::AddSegment(int link) {
  const UrdfLink& source = document_.links[link];
  Segment& segment = description_.segments.emplace_back();
  segment.mass = source.mass;
  segment.p_SB = source.p_LB;
  segment.inertia = source.inertia;
  if (source.parent_joint >= 0) {
    const UrdfJoint& joint = document_.joints[source.parent_joint];
    segment.parent = segment_[joint.parent];
    SetJoint(joint, &segment);
  } else {
    segment.name = RootName();
  }
  segment_of_link_[source.name] = segment.name;
}

/// The mimic joint nearest above a link; nullptr: there is none.
const UrdfJoint* UrdfModelBuilder::FindMimic(int link) const {
  for (int joint = document_.links[link].parent_joint; joint >= 0;
       joint = document_.links[document_.joints[joint].parent].parent_joint) {
    if (!document_.joints[joint].mimicked.empty()) return &document_.joints[joint];
  }
  return nullptr;
}

void UrdfModelBuilder::AddMarkers() {
  for (std::size_t i = 0; i < document_.links.size(); ++i) {
    const UrdfLink& link = document_.links[i];
    if (!IsMarker(link)) continue;
    std::string label = link.name.substr(0, link.name.size() - kMarkerSuffix.size());
    if (const UrdfJoint* mimic = FindMimic(static_cast<int>(i))) {
      lost_[mimic->name].push_back(std::move(label));
      continue;
    }
    ModelMarker& marker = description_.markers.emplace_back();
    marker.name = std::move(label);
    marker.segment = segment_[i];
    if (!is_marker_[i]) continue;
    const UrdfJoint& joint = document_.joints[link.parent_joint];
    marker.segment = segment_[joint.parent];
    marker.p_SM = joint.X_PF.translation();
  }
}

void UrdfModelBuilder::WarnOf(const std::vector<std::string>& joints, const char* what) {
  if (joints.empty()) return;
  diagnostics_.AddWarning(0, fmt::format("{} {} {}", joints.size() == 1 ? "joint" : "joints",
                                         fmt::join(joints, ", "), what));
}

UrdfModel UrdfModelBuilder::Build() {
  FindMarkers();
  description_.name = document_.name;
  int num_segments = 0;
  for (const bool is_marker : is_marker_) segment_.push_back(is_marker ? -1 : num_segments++);
  for (std::size_t i = 0; i < segment_.size(); ++i) {
    if (!is_marker_[i]) AddSegment(static_cast<int>(i));
  }
  AddMarkers();
  diagnostics_.ThrowIfErrors();
  WarnOf(mimics_, "(mimic): held at the offset, the coupling is not tracked");
  for (const auto& [joint, markers] : lost_) {
    diagnostics_.AddWarning(0, fmt::format("below joint {} (mimic) {} not used: {}", joint,
                                           markers.size() == 1 ? "a marker is" : "markers are",
                                           fmt::join(markers, ", ")));
  }
  WarnOf(slides_, "(prismatic): held, sliding is not tracked");
  WarnOf(stiff_, "(revolute with equal limits): does not turn");
  return {KinematicModel(std::move(description_)), std::move(segment_of_link_)};
}

}  // namespace

UrdfModel ParseUrdfModel(std::string_view content, const std::string& file, Warnings* warnings) {
  Diagnostics diagnostics(file, warnings);
  const UrdfDocument document = ParseUrdf(content, &diagnostics);
  return UrdfModelBuilder(document, &diagnostics).Build();
}

UrdfModel ReadUrdfModel(const std::string& path, Warnings* warnings) {
  return ParseUrdfModel(ReadFileContent(path, kMaxModelBytes), path, warnings);
}

}  // namespace mmm_converter
