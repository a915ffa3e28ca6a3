// SPDX-License-Identifier: MIT
#include "common/io/urdf/urdf_model_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "common/io/bytes/file_content.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/urdf/urdf_document.h"
#include "common/io/xml/xml_text.h"
#include "common/model/body_bounds.h"
#include "common/support/diagnostics.h"
#include "common/support/error_of_file.h"

namespace mmm_converter {
namespace {

constexpr std::string_view kMarkerSuffix = "_marker";
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kWidestRange = 4 * EIGEN_PI;  // [rad]; beyond it a limit limits nothing
constexpr double kSlideReach = 1;              // [m], of slides without limits

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
  void SetJoint(const UrdfJoint& joint, Segment* segment);
  void SetRange(const UrdfJoint& joint, Segment* segment);
  void HoldAt(const UrdfJoint& joint, double value, Segment* segment);
  void FindLeaders();
  void Follow(const UrdfJoint& joint, Segment* segment);
  std::string RootName() const;
  void WarnOf(const std::vector<std::string>& joints, const char* what);

  const UrdfDocument& document_;
  Diagnostics& diagnostics_;
  std::vector<bool> is_marker_;  ///< of links; not in the model as segments
  std::vector<int> segment_;     ///< of links; -1: none
  ModelDescription description_;
  std::map<std::string, std::string> segment_of_link_;
  std::map<std::string, int> joint_by_name_;
  std::vector<std::string> stiff_;  ///< joints
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
  const bool slides = joint.type == UrdfJointType::kPrismatic;
  segment->type = slides ? JointType::kSliding : JointType::kRevolute;
  segment->lower = joint.lower;
  segment->upper = joint.upper;
  const double widest = slides ? kLongestLength : kWidestRange;
  const bool is_wide = joint.lower < -widest || joint.upper > widest;
  if (joint.type == UrdfJointType::kContinuous || (slides && is_wide) ||
      (joint.lower < -widest && joint.upper > widest)) {
    segment->lower = -kInfinity;
    segment->upper = kInfinity;
    if (slides) segment->reach = kSlideReach;
  } else if (is_wide) {
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
  } else if (joint.mimicked.empty()) {
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

/// Joints that mimic others, after all the others.
void UrdfModelBuilder::FindLeaders() {
  for (std::size_t i = 0; i < document_.joints.size(); ++i) {
    joint_by_name_[document_.joints[i].name] = static_cast<int>(i);
  }
  for (const UrdfJoint& joint : document_.joints) {
    const int segment = segment_[static_cast<std::size_t>(joint.child)];
    if (joint.mimicked.empty() || joint.type == UrdfJointType::kFixed || segment < 0) continue;
    Follow(joint, &description_.segments[static_cast<std::size_t>(segment)]);
  }
}

void UrdfModelBuilder::Follow(const UrdfJoint& joint, Segment* segment) {
  const UrdfJoint* leader = &joint;
  double slope = 1, offset = 0;
  for (std::size_t steps = 0; !leader->mimicked.empty(); ++steps) {
    if (steps > document_.joints.size()) {
      diagnostics_.AddError(joint.line,
                            fmt::format("joint '{}': mimics joints in a circle", joint.name));
      return;
    }
    offset += slope * leader->mimic_offset;
    slope *= leader->mimic_multiplier;
    leader = &document_.joints[static_cast<std::size_t>(joint_by_name_.at(leader->mimicked))];
  }
  if (!IsWithin(slope, kLargestMultiplier) || !IsWithin(offset, kFarthestTurn)) {
    diagnostics_.AddError(
        joint.line,
        fmt::format("joint '{}': its <mimic> multiplies by {:g} and adds {:g}; a multiplier of at "
                    "most {:g} and an offset of at most {:g} are expected",
                    joint.name, slope, offset, kLargestMultiplier, kFarthestTurn));
    return;
  }
  const int index = segment_[static_cast<std::size_t>(leader->child)];
  const Segment* moved =
      index < 0 ? nullptr : &description_.segments[static_cast<std::size_t>(index)];
  if (moved == nullptr || moved->type == JointType::kFixed) {
    const double held =
        leader->type == UrdfJointType::kFixed ? 0 : std::clamp(0.0, leader->lower, leader->upper);
    HoldAt(joint, slope * held + offset, segment);
    return;
  }
  const bool slides = joint.type == UrdfJointType::kPrismatic;
  segment->type = slides ? JointType::kSliding : JointType::kRevolute;
  segment->lower = moved->lower;
  segment->upper = moved->upper;
  segment->reach = slides && HasNoLimits(*moved) ? kSlideReach : moved->reach;
  segment->leader = index;
  if (slope == 1 && offset == 0) return;
  segment->function = std::make_shared<const ScalarFunction>(ScalarFunction::Linear(slope, offset));
}

void UrdfModelBuilder::AddMarkers() {
  for (std::size_t i = 0; i < document_.links.size(); ++i) {
    const UrdfLink& link = document_.links[i];
    if (!IsMarker(link)) continue;
    ModelMarker& marker = description_.markers.emplace_back();
    marker.name = link.name.substr(0, link.name.size() - kMarkerSuffix.size());
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
  FindLeaders();
  AddMarkers();
  diagnostics_.ThrowIfErrors();
  WarnOf(stiff_, "(with equal limits): does not move");
  return {KinematicModel(std::move(description_)), std::move(segment_of_link_)};
}

}  // namespace

bool IsUrdf(std::string_view content) {
  return RootName(content) == "robot" && content.find("<RobotNode") == std::string_view::npos;
}

UrdfModel MakeUrdfModel(const UrdfDocument& document, Diagnostics* diagnostics) {
  return OfFile(diagnostics->file(),
                [&] { return UrdfModelBuilder(document, diagnostics).Build(); });
}

UrdfModel ParseUrdfModel(std::string_view content, const std::string& file, Warnings* warnings) {
  Diagnostics diagnostics(file, warnings);
  return MakeUrdfModel(ParseUrdf(content, &diagnostics), &diagnostics);
}

UrdfModel ReadUrdfModel(const std::string& path, Warnings* warnings) {
  return ParseUrdfModel(ReadFileContent(path, kMaxModelBytes), path, warnings);
}

}  // namespace mmm_converter
