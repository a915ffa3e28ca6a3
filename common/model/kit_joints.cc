// SPDX-License-Identifier: MIT
#include "common/model/kit_joints.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace mmm_converter {

const std::vector<std::string>& KitJointNames() {
  static const std::vector<std::string> kNames = {
      "BLNx_joint", "BLNy_joint", "BLNz_joint", "BPx_joint",   "BPy_joint",  "BPz_joint",
      "BTx_joint",  "BTy_joint",  "BTz_joint",  "BUNx_joint",  "BUNy_joint", "BUNz_joint",
      "LAx_joint",  "LAy_joint",  "LAz_joint",  "LEx_joint",   "LEz_joint",  "LHx_joint",
      "LHy_joint",  "LHz_joint",  "LKx_joint",  "LSx_joint",   "LSy_joint",  "LSz_joint",
      "LWx_joint",  "LWy_joint",  "LFx_joint",  "LMrot_joint", "RAx_joint",  "RAy_joint",
      "RAz_joint",  "REx_joint",  "REz_joint",  "RHx_joint",   "RHy_joint",  "RHz_joint",
      "RKx_joint",  "RSx_joint",  "RSy_joint",  "RSz_joint",   "RWx_joint",  "RWy_joint",
      "RFx_joint",  "RMrot_joint"};
  return kNames;
}

std::string LimbOfJoint(std::string_view joint) {
  constexpr std::string_view kSpine[] = {"BP", "BT"};
  constexpr std::string_view kHead[] = {"BLN", "BUN"};
  constexpr std::string_view kArm[] = {"S", "E", "W"};
  constexpr std::string_view kLeg[] = {"H", "K", "A", "F", "M"};
  const auto starts_with = [&joint](std::string_view start) { return joint.starts_with(start); };
  if (!joint.ends_with("_joint")) return "";
  if (std::any_of(std::begin(kSpine), std::end(kSpine), starts_with)) return "spine";
  if (std::any_of(std::begin(kHead), std::end(kHead), starts_with)) return "head";
  const std::string side = joint.starts_with('L')   ? "left "
                           : joint.starts_with('R') ? "right "
                                                    : "";
  if (side.empty()) return "";
  joint.remove_prefix(1);
  if (std::any_of(std::begin(kArm), std::end(kArm), starts_with)) return side + "arm";
  if (std::any_of(std::begin(kLeg), std::end(kLeg), starts_with)) return side + "leg";
  return "";
}

std::string MirroredName(const std::string& name) {
  constexpr std::pair<std::string_view, std::string_view> kSides[] = {{"Left", "Right"},
                                                                      {"L", "R"}};
  for (const auto& [left, right] : kSides) {
    if (name.starts_with(left)) return std::string(right) + name.substr(left.size());
    if (name.starts_with(right)) return std::string(left) + name.substr(right.size());
  }
  return "";
}

std::string MirroredOsimName(const std::string& name) {
  const auto exchanged = [](char side) {
    return side == 'r' ? 'l' : side == 'l' ? 'r' : side == 'R' ? 'L' : side == 'L' ? 'R' : '\0';
  };
  const std::size_t n = name.size();
  std::string other = name;
  if (n > 2 && name[n - 2] == '_' && exchanged(name[n - 1]) != '\0') {
    other[n - 1] = exchanged(name[n - 1]);
    return other;
  }
  if (n > 2 && name[1] == '_' && exchanged(name[0]) != '\0') {
    other[0] = exchanged(name[0]);
    return other;
  }
  return MirroredName(name);
}

std::vector<int> MirroredMarkers(const KinematicModel& model,
                                 const std::vector<MarkerIx>& markers) {
  const auto name = [&](MarkerIx marker) {
    constexpr std::string_view kPrefix = "MARKER_";
    const std::string& full = model.markers()[marker].name;
    return full.starts_with(kPrefix) ? full.substr(kPrefix.size()) : full;
  };
  std::vector<int> mirrored(markers.size(), -1);
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const std::string other = MirroredName(name(markers[i]));
    const auto found = std::find_if(markers.begin(), markers.end(),
                                    [&](MarkerIx marker) { return name(marker) == other; });
    if (found != markers.end()) mirrored[i] = static_cast<int>(found - markers.begin());
  }
  return mirrored;
}

}  // namespace mmm_converter
