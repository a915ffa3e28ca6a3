// SPDX-License-Identifier: MIT
#include "common/live/natnet/natnet_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "common/live/natnet/natnet_layout.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr const char* kSetOfAll = "all";  // repeats the markers of the others
constexpr std::int32_t kLowWord = 0xFFFF;

const NatNetMarkerSet* FindSet(const NatNetModel& model, const std::string& name) {
  const auto set = std::find_if(model.marker_sets.begin(), model.marker_sets.end(),
                                [&](const NatNetMarkerSet& s) { return s.name == name; });
  return set == model.marker_sets.end() || name == kSetOfAll ? nullptr : &*set;
}

std::vector<std::string> NamesOf(const NatNetBody& body) {
  std::vector<std::string> names;
  for (const NatNetBodyMarker& marker : body.markers) {
    names.push_back(marker.name.empty() ? fmt::format("{}_{}", body.name, names.size() + 1)
                                        : marker.name);
  }
  return names;
}

/// By their numbers, where these are 1 to n; else in their order.
std::vector<std::string> NamesOf(const NatNetAsset& asset) {
  std::vector<std::string> names(asset.markers.size());
  std::vector<std::string> listed;
  for (const NatNetAssetMarker& marker : asset.markers) {
    listed.push_back(marker.name);
    const std::size_t member = static_cast<std::size_t>(marker.id & kLowWord);
    if (member >= 1 && member <= names.size()) names[member - 1] = marker.name;
  }
  const bool is_numbered =
      std::none_of(names.begin(), names.end(), [](const std::string& n) { return n.empty(); });
  return is_numbered ? names : listed;
}

bool IsMissing(const NatNetMarker& marker) {
  return (marker.parameters & kNatNetOccluded) != 0 ||
         ((marker.parameters & kNatNetModelFilled) != 0 &&
          (marker.parameters & kNatNetSolved) == 0);
}

Eigen::Vector3d ToVector(const std::array<float, 3>& position) {
  const Eigen::Vector3d p(position[0], position[1], position[2]);
  return p.allFinite() ? p : Eigen::Vector3d::Constant(kNaN);
}

}  // namespace

NatNetColumns::NatNetColumns(const NatNetModel& model, const NatNetVersion& version)
    : has_member_ids_(version >= kNatNetWithMemberIds) {
  if (has_member_ids_) AddAssets(model);
  for (const NatNetMarkerSet& set : model.marker_sets) {
    const bool is_known = std::any_of(groups_.begin(), groups_.end(),
                                      [&](const Group& g) { return g.name == set.name; });
    if (set.name != kSetOfAll && !is_known) groups_.push_back({set.name, -1, set.markers, 0});
  }
  NameColumns();
}

void NatNetColumns::AddAssets(const NatNetModel& model) {
  for (const NatNetBody& body : model.bodies) AddAsset(model, body.name, body.id, NamesOf(body));
  for (const NatNetSkeleton& skeleton : model.skeletons) {
    AddAsset(model, skeleton.name, skeleton.id, {});
  }
  for (const NatNetAsset& asset : model.assets) {
    AddAsset(model, asset.name, asset.id, NamesOf(asset));
  }
}

void NatNetColumns::AddAsset(const NatNetModel& model, const std::string& name, std::int32_t id,
                             const std::vector<std::string>& own_names) {
  const NatNetMarkerSet* set = FindSet(model, name);
  groups_.push_back({name, id & kLowWord, set == nullptr ? own_names : set->markers, 0});
}

void NatNetColumns::NameColumns() {
  std::map<std::string, int> groups_with;
  for (const Group& group : groups_) {
    for (const auto& name : std::set<std::string>(group.names.begin(), group.names.end())) {
      ++groups_with[name];
    }
  }
  std::set<std::string> taken;
  for (Group& group : groups_) {
    group.first_column = static_cast<int>(labels_.size());
    for (const std::string& name : group.names) {
      std::string label = groups_with[name] > 1 ? group.name + ":" + name : name;
      for (int i = 2; !taken.insert(label).second; ++i) label = fmt::format("{}_{}", name, i);
      labels_.push_back(label);
    }
  }
}

const NatNetColumns::Group* NatNetColumns::FindAsset(std::int32_t id) const {
  const auto group = std::find_if(groups_.begin(), groups_.end(),
                                  [&](const Group& g) { return g.id == (id & kLowWord); });
  return group == groups_.end() ? nullptr : &*group;
}

void NatNetColumns::FillSets(const NatNetFrame& frame, Eigen::Matrix3Xd* points) const {
  for (const Group& group : groups_) {
    if (group.id >= 0) continue;
    const auto set =
        std::find_if(frame.marker_sets.begin(), frame.marker_sets.end(),
                     [&](const NatNetFrameMarkerSet& s) { return s.name == group.name; });
    if (set == frame.marker_sets.end()) continue;
    for (std::size_t i = 0; i < std::min(set->positions.size(), group.names.size()); ++i) {
      const Eigen::Vector3d p = ToVector(set->positions[i]);
      // What is not seen stands at the origin there.
      if (!p.isZero(0)) points->col(group.first_column + static_cast<int>(i)) = p;
    }
  }
}

NatNetColumns::Rest NatNetColumns::Fill(const NatNetFrame& frame, Eigen::Matrix3Xd* points,
                                        std::vector<Eigen::Vector3d>* unnamed) const {
  Rest rest;
  if (unnamed != nullptr) unnamed->clear();
  const auto leave = [&](const std::array<float, 3>& position, bool is_missing) {
    ++rest.unnamed;
    if (unnamed != nullptr && !is_missing) unnamed->push_back(ToVector(position));
  };
  points->resize(3, static_cast<Eigen::Index>(labels_.size()));
  points->setConstant(kNaN);
  FillSets(frame, points);
  if (!has_member_ids_) {
    for (const auto& position : frame.other_markers) leave(position, false);
    return rest;
  }
  const auto fill = [&](std::int32_t asset, const NatNetMarker& marker) {
    const Group* group = FindAsset(asset);
    const auto member = static_cast<std::size_t>(marker.id & kLowWord);
    if (group == nullptr || member < 1 || member > group->names.size()) return group != nullptr;
    points->col(group->first_column + static_cast<int>(member) - 1) =
        IsMissing(marker) ? Eigen::Vector3d::Constant(kNaN) : ToVector(marker.position);
    return true;
  };
  for (const NatNetFrameAsset& asset : frame.assets) {
    for (const NatNetMarker& marker : asset.markers) fill(asset.id, marker);
  }
  for (const NatNetMarker& marker : frame.markers) {
    const std::int32_t asset = (marker.id >> 16) & kLowWord;
    if (asset == 0 || (marker.parameters & kNatNetUnlabelled) != 0) {
      leave(marker.position, IsMissing(marker));
    } else if (!fill(asset, marker)) {
      leave(marker.position, IsMissing(marker));
      rest.has_new_asset = true;
    }
  }
  return rest;
}

}  // namespace mmm_converter
