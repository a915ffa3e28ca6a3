// SPDX-License-Identifier: MIT
#include "common/model/kinematic_model.h"

#include <fmt/core.h>

#include <cmath>
#include <set>
#include <utility>

#include "common/model/body_bounds.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr double kUnitTolerance = 1e-6;  // of axes and rotations; a double's rounding is far below

bool IsJoint(const Segment& segment) {
  const bool moves = segment.type == JointType::kRevolute || segment.type == JointType::kSliding;
  return moves && segment.lower < segment.upper;
}

bool IsFinite(const Segment& s) {
  return s.X_PF.matrix().allFinite() && s.axis.allFinite() && s.p_SB.allFinite() &&
         s.inertia.allFinite() && std::isfinite(s.mass) && std::isfinite(s.rest) &&
         std::isfinite(s.reach) &&
         ((std::isfinite(s.lower) && std::isfinite(s.upper)) || IsEndless(s) ||
          (HasNoLimits(s) && s.reach > 0)) &&
         (s.function == nullptr || s.function->IsFinite());
}

/// Whether a joint that follows another, or moves by a function of its coordinate, is within bounds
/// where its range ends, and at rest.
bool IsFunctionWithin(const Segment& s) {
  if (s.function == nullptr) return true;
  const double reach = s.reach > 0 ? s.reach : EIGEN_PI;
  const double lower = std::isfinite(s.lower) ? s.lower : s.rest - reach;
  const double upper = std::isfinite(s.upper) ? s.upper : s.rest + reach;
  for (const double q : {lower, s.rest, 0.5 * (lower + upper), upper}) {
    double slope = 0;
    if (!IsWithin(s.function->Value(q, &slope), kFarthestTurn)) return false;
    if (!IsWithin(slope, kLargestMultiplier)) return false;
  }
  return true;
}

void CheckBounds(const Segment& s) {
  const auto fail = [&s](const char* what, double most, const char* unit) {
    throw Error(
        fmt::format("model node '{}': {} more than {:g}{}, which no body has; look for a "
                    "slip or another unit",
                    s.name, what, most, unit));
  };
  if (!IsWithin(s.X_PF.translation().norm(), kLongestLength)) {
    fail("it is away from its parent by", kLongestLength, " m");
  }
  if (!IsWithin(s.p_SB.norm(), kLongestLength)) {
    fail("its centre of mass is away by", kLongestLength, " m");
  }
  if (!IsWithin(s.mass, kHeaviestBody)) fail("its mass is", kHeaviestBody, " kg");
  if (!IsWithin(s.inertia.cwiseAbs().maxCoeff(), kLargestInertia)) {
    fail("its inertia is", kLargestInertia, " kg m^2");
  }
  if (!IsWithin(s.rest, kFarthestTurn)) fail("at rest its joint is at", kFarthestTurn, "");
  if (!IsFunctionWithin(s)) {
    fail("it follows its coordinate by numbers beyond what a body can do, multiplied by",
         kLargestMultiplier, "");
  }
}

void CheckSegment(const Segment& s, int num_segments) {
  if (s.name.empty()) throw Error("a node of the model has no name");
  const auto fail = [&s](const std::string& what) {
    throw Error(fmt::format("model node '{}': {}", s.name, what));
  };
  if (!IsFinite(s)) fail("one of its numbers is not finite");
  CheckBounds(s);
  if (s.parent < -1 || s.parent >= num_segments) fail("its parent does not exist");
  if (s.leader < -1 || s.leader >= num_segments) fail("its leader does not exist");
  if (s.lower > s.upper) {
    fail(fmt::format("its joint limits are crossed: lower {} is above upper {}", s.lower, s.upper));
  }
  if (s.mass < 0) fail(fmt::format("its mass is {} kg; it can't be negative", s.mass));
  if (std::abs(s.axis.norm() - 1) > kUnitTolerance) fail("its joint axis is not a unit vector");
  if (!s.X_PF.linear().isUnitary(kUnitTolerance) || s.X_PF.linear().determinant() < 0) {
    fail("its transform is not a rotation and a translation");
  }
}

int FindRoot(const std::vector<Segment>& segments) {
  int root = -1;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments[i].parent != -1) continue;
    if (root != -1) {
      throw Error(fmt::format("the model has two roots, '{}' and '{}'", segments[root].name,
                              segments[i].name));
    }
    root = static_cast<int>(i);
  }
  if (root == -1) throw Error("the model has no root: each of its nodes has a parent");
  if (IsJoint(segments[root])) {
    throw Error(
        fmt::format("model node '{}' is the floating root and can't be a joint as well; "
                    "give it the limits 0 and 0",
                    segments[root].name));
  }
  return root;
}

/// Old indices depth first, children in their old order.
std::vector<int> TreeOrder(const std::vector<Segment>& segments) {
  std::vector<std::vector<int>> children(segments.size());
  for (std::size_t i = segments.size(); i-- > 0;) {
    if (segments[i].parent >= 0) children[segments[i].parent].push_back(static_cast<int>(i));
  }
  std::vector<int> order;
  std::vector<int> open{FindRoot(segments)};
  while (!open.empty()) {
    order.push_back(open.back());
    open.pop_back();
    open.insert(open.end(), children[order.back()].begin(), children[order.back()].end());
  }
  return order;
}

/// Sorts the segments into a tree and rewrites parents and joint indices.
std::vector<Segment> SortSegments(std::vector<Segment> segments, std::vector<int>& new_index) {
  const std::vector<int> order = TreeOrder(segments);
  new_index.assign(segments.size(), -1);
  for (std::size_t i = 0; i < order.size(); ++i) new_index[order[i]] = static_cast<int>(i);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (new_index[i] < 0) {
      throw Error(fmt::format("model node '{}' hangs in a circle of parents", segments[i].name));
    }
  }
  std::vector<Segment> sorted;
  int num_joints = 0;
  for (const int old_index : order) {
    Segment& segment = sorted.emplace_back(std::move(segments[old_index]));
    if (segment.parent >= 0) segment.parent = new_index[segment.parent];
    if (segment.leader >= 0) segment.leader = new_index[segment.leader];
    segment.joint = segment.leader < 0 && IsJoint(segment) ? num_joints++ : -1;
  }
  for (Segment& segment : sorted) {
    if (segment.leader < 0) continue;
    const Segment& leader = sorted[segment.leader];
    if (leader.leader >= 0 || leader.joint < 0 || !IsJoint(segment)) {
      throw Error(
          fmt::format("model node '{}' follows '{}', but both must be joints, and that one "
                      "its own",
                      segment.name, leader.name));
    }
    segment.joint = leader.joint;
  }
  return sorted;
}

template <typename Named>
int Find(const std::vector<Named>& all, const std::string& name) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

template <typename Named>
void CheckNamesDiffer(const std::vector<Named>& all, const char* what) {
  std::set<std::string> names;
  for (const Named& one : all) {
    if (!names.insert(one.name).second) {
      throw Error(fmt::format("the model has two {}s called '{}'", what, one.name));
    }
  }
}

}  // namespace

KinematicModel::KinematicModel(ModelDescription description)
    : name_(std::move(description.name)),
      markers_(std::move(description.markers)),
      node_sets_(std::move(description.node_sets)),
      is_root_fixed_(description.is_root_fixed),
      coordinates_(std::move(description.coordinates)),
      standing_(description.standing) {
  if (description.segments.empty()) throw Error("the model has no nodes");
  const int num_segments = static_cast<int>(description.segments.size());
  for (const Segment& segment : description.segments) CheckSegment(segment, num_segments);
  CheckNamesDiffer(description.segments, "node");
  CheckNamesDiffer(markers_, "marker");
  std::vector<int> new_index;
  segments_ = SortSegments(std::move(description.segments), new_index);
  for (ModelMarker& marker : markers_) {
    if (marker.segment < 0 || marker.segment >= num_segments || !marker.p_SM.allFinite()) {
      throw Error(fmt::format("marker '{}' has no node or no finite offset", marker.name));
    }
    if (!IsWithin(marker.p_SM.norm(), kLongestLength)) {
      throw Error(
          fmt::format("marker '{}' is more than {:g} m from its body, which is of another "
                      "unit",
                      marker.name, kLongestLength));
    }
    marker.segment = new_index[marker.segment];
  }
  for (int i = 0; i < num_segments; ++i) {
    if (segments_[i].joint >= 0 && segments_[i].leader < 0) joint_segments_.push_back(i);
  }
}

int KinematicModel::FindSegment(const std::string& name) const { return Find(segments_, name); }

int KinematicModel::FindJoint(const std::string& name) const {
  const int segment = FindSegment(name);
  return segment < 0 ? -1 : segments_[segment].joint;
}

int KinematicModel::FindMarker(const std::string& name) const { return Find(markers_, name); }

bool KinematicModel::IsBelow(int segment, int above) const {
  while (segment > above) segment = segments_[segment].parent;
  return segment == above;
}

double KinematicModel::total_mass() const {
  double mass = 0;
  for (const Segment& segment : segments_) mass += segment.mass;
  return mass;
}

ModelDescription DescriptionOf(const KinematicModel& model) {
  return {model.name(),          model.segments(),    model.markers(), model.node_sets(),
          model.is_root_fixed(), model.coordinates(), model.standing()};
}

Eigen::Isometry3d JointTransform(const Segment& segment, double q) {
  const double value = JointValue(segment, q);
  if (segment.type == JointType::kSliding) {
    return Eigen::Isometry3d(Eigen::Translation3d(value * segment.axis));
  }
  return Eigen::Isometry3d(Eigen::AngleAxisd(value, segment.axis));
}

}  // namespace mmm_converter
