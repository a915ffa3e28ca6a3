// SPDX-License-Identifier: MIT
#include "common/osim/osim_sizes.h"

#include <algorithm>

#include "common/model/kit_joints.h"

namespace mmm_converter {
namespace {

bool Moves(const OsimDocument& document, const OsimJoint& joint) {
  const auto is_moved = [&](const OsimAxis& axis) {
    return std::any_of(axis.value.terms.begin(), axis.value.terms.end(), [&](const auto& term) {
      const auto found = std::find_if(
          document.coordinates.begin(), document.coordinates.end(),
          [&](const OsimCoordinate& coordinate) { return coordinate.name == term.coordinate; });
      return found != document.coordinates.end() && !found->IsHeld();
    });
  };
  return std::any_of(joint.rotations.begin(), joint.rotations.end(), is_moved) ||
         std::any_of(joint.translations.begin(), joint.translations.end(), is_moved);
}

class Groups {
 public:
  explicit Groups(const std::vector<bool>& has_marker) : has_marker_(has_marker) {
    for (std::size_t i = 0; i < has_marker.size(); ++i) group_.push_back(static_cast<int>(i));
  }

  int Of(int body) const { return group_[body]; }
  bool HasMarker(int body) const { return has_marker_[group_[body]]; }
  void Join(int a, int b) {
    const int from = std::max(group_[a], group_[b]);
    const int to = std::min(group_[a], group_[b]);
    if (has_marker_[from]) has_marker_[to] = true;
    std::replace(group_.begin(), group_.end(), from, to);
  }

 private:
  std::vector<bool> has_marker_;  // by group
  std::vector<int> group_;        // by body
};

/// Joins those without markers over the joints that `joins` names, until there are none.
template <typename Condition>
void JoinAll(const OsimDocument& document, Condition joins, Groups* groups) {
  for (bool changes = true; changes;) {
    changes = false;
    for (const OsimJoint& joint : document.joints) {
      if (joint.parent == 0 || groups->Of(joint.parent) == groups->Of(joint.child)) continue;
      if (!joins(joint)) continue;
      groups->Join(joint.parent, joint.child);
      changes = true;
    }
  }
}

}  // namespace

OsimSizes FindOsimSizes(const OsimDocument& document, const std::vector<bool>& has_marker) {
  Groups groups(has_marker);
  JoinAll(
      document, [&](const OsimJoint& joint) { return !Moves(document, joint); }, &groups);
  JoinAll(
      document,
      [&](const OsimJoint& joint) {
        return !groups.HasMarker(joint.parent) && groups.HasMarker(joint.child);
      },
      &groups);
  JoinAll(
      document,
      [&](const OsimJoint& joint) {
        return groups.HasMarker(joint.parent) && !groups.HasMarker(joint.child);
      },
      &groups);
  OsimSizes sizes;
  const auto num_bodies = static_cast<int>(document.bodies.size());
  sizes.size_of.assign(document.bodies.size(), -1);
  std::vector<int> size_of_group(document.bodies.size(), -1);
  for (int body = 1; body < num_bodies; ++body) {
    if (!has_marker[body] || size_of_group[groups.Of(body)] >= 0) continue;
    size_of_group[groups.Of(body)] = static_cast<int>(sizes.bodies.size());
    sizes.bodies.push_back(body);
  }
  for (int body = 1; body < num_bodies; ++body) {
    sizes.size_of[body] = size_of_group[groups.Of(body)];
  }
  for (int body = 1; body < num_bodies; ++body) {
    const std::string mirrored = MirroredOsimName(document.bodies[body].name);
    const auto other = std::find_if(document.bodies.begin() + body, document.bodies.end(),
                                    [&](const OsimBody& one) { return one.name == mirrored; });
    if (mirrored.empty() || other == document.bodies.end()) continue;
    const std::pair<int, int> pair(sizes.size_of[body],
                                   sizes.size_of[other - document.bodies.begin()]);
    const auto has_one = [&](const std::pair<int, int>& one) {
      return one.first == pair.first || one.second == pair.second || one.first == pair.second ||
             one.second == pair.first;
    };
    if (pair.first < 0 || pair.second < 0 || pair.first == pair.second) continue;
    if (std::any_of(sizes.mirror.begin(), sizes.mirror.end(), has_one)) continue;
    sizes.mirror.push_back(pair);
  }
  return sizes;
}

}  // namespace mmm_converter
