// SPDX-License-Identifier: MIT
#include "common/study/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "common/model/forward_kinematics.h"
#include "common/model/kit_joints.h"
#include "common/model/marker_kinematics.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

// [s]. A prediction bridges the first while other limbs hold the body, the second alone.
constexpr double kLongGapOfLimb = 1;
constexpr double kLongGapOfBody = 0.5;
constexpr double kLongGapOfEnd = 0.5;  // pelvis and feet: no other limb holds these
constexpr double kBridged = 0.1;       // what gait laboratories fill without a look

constexpr int kFewestOfPelvis = 2, kMostThatTell = 3;  // markers of an end part

struct EndSegments {
  const char* name;
  std::array<const char*, 3> segments;  // of MMM, of OpenSim; the first that the model has
};
constexpr EndSegments kEndSegments[] = {{"pelvis", {"root_joint", "pelvis", ""}},
                                        {"left foot", {"LAy_joint", "calcn_l", "foot_l"}},
                                        {"right foot", {"RAy_joint", "calcn_r", "foot_r"}},
                                        {"left hand", {"LWy_joint", "hand_l", ""}},
                                        {"right hand", {"RWy_joint", "hand_r", ""}}};

/// The limb that a foot or a hand is the end of; else empty.
std::string LimbOfEnd(std::string name) {
  const auto end = [&](const char* part, const char* limb) {
    if (!name.ends_with(part)) return false;
    name.replace(name.size() - std::string_view(part).size(), std::string::npos, limb);
    return true;
  };
  return end("foot", "leg") || end("hand", "arm") ? name : "";
}

/// The limbs and end parts by which an angle is known.
std::vector<std::string> PartsBeside(const AnatomicalAngle& angle) {
  struct Beside {
    std::string_view joint;
    std::vector<std::string_view> parts;  // those with a blank in front have the angle's side
  };
  static const Beside kBeside[] = {{"pelvis", {"pelvis"}},
                                   {"trunk", {"pelvis", "spine"}},
                                   {"neck", {"spine", "head"}},
                                   {"hip", {"pelvis", " leg"}},
                                   {"knee", {" leg"}},
                                   {"ankle", {" leg", " foot"}},
                                   {"shoulder", {"spine", " arm"}},
                                   {"elbow", {" arm"}},
                                   {"wrist", {" arm", " hand"}}};
  std::vector<std::string> parts;
  for (const Beside& one : kBeside) {
    if (one.joint != angle.joint) continue;
    for (const std::string_view part : one.parts) {
      parts.push_back((part.front() == ' ' ? angle.side : "") + std::string(part));
    }
  }
  return parts;
}

int SeenOf(const std::vector<LabelIx>& labels, const MarkerSequence& recording, int k) {
  const auto frame = recording.frame(k);
  return static_cast<int>(std::count_if(labels.begin(), labels.end(),
                                        [&](LabelIx label) { return IsSeen(frame.col(label)); }));
}

/// Whether a segment is a part of that one, or hangs on it by joints; of the root only if by none.
bool IsOn(const KinematicModel& model, int segment, int part) {
  while (segment > part) {
    const Segment& one = model.segments()[static_cast<std::size_t>(segment)];
    if (part == 0 && one.type == JointType::kRevolute) return false;
    segment = one.parent;
  }
  return segment == part;
}

/// Limbs, and the pelvis, that no marker shows.
std::vector<std::string> NeverKnown(const TrackingSetup& setup) {
  std::vector<std::string> never;
  for (const EndPart& part : EndPartsOf(setup)) {
    if (part.name == kEndSegments[0].name && part.labels.empty()) never.push_back(part.name);
  }
  for (const Limb& limb : LimbsOf(setup)) {
    if (limb.labels.empty()) never.push_back(limb.name);
  }
  return never;
}

Limb* FindLimb(const std::string& name, std::vector<Limb>* limbs) {
  const auto found = std::find_if(limbs->begin(), limbs->end(),
                                  [&](const Limb& limb) { return limb.name == name; });
  if (found != limbs->end()) return &*found;
  limbs->push_back({name, 0, 0, {}});
  return &limbs->back();
}

// The longest runs of frames, at most `most` of those that last `least` [s], in which `is_known`
// says no to the number of labels that are seen; in the order of time.
template <typename IsKnown>
std::vector<Gap> LongestGaps(const std::string& what, double least, std::size_t most,
                             const std::vector<LabelIx>& labels, const MarkerSequence& recording,
                             const IsKnown& is_known) {
  std::vector<Gap> gaps;
  int begin = 0;
  for (int k = 0; k <= recording.num_frames(); ++k) {
    if (k < recording.num_frames() && !is_known(SeenOf(labels, recording, k))) continue;
    const Gap gap{what, begin, k - 1, (k - begin) / recording.rate()};
    if (gap.seconds >= least) gaps.push_back(gap);
    begin = k + 1;
  }
  std::stable_sort(gaps.begin(), gaps.end(),
                   [](const Gap& a, const Gap& b) { return a.seconds > b.seconds; });
  gaps.resize(std::min(gaps.size(), most));
  std::stable_sort(gaps.begin(), gaps.end(),
                   [](const Gap& a, const Gap& b) { return a.first_frame < b.first_frame; });
  return gaps;
}

// How long `gap` goes on beyond another one [s]; all of it, where they do not meet.
double SecondsBeyond(const Gap& gap, const Gap& other, double rate) {
  const int common =
      std::min(gap.last_frame, other.last_frame) - std::max(gap.first_frame, other.first_frame) + 1;
  return gap.seconds - std::max(0, common) / rate;
}

/// Sides whose foot shows too little of itself to tell how it is bent: of a heel and a malleolus
/// 70 mm apart each place is off by 10.
std::vector<std::string> ShortFeet(const TrackingSetup& setup) {
  constexpr double kLeastLength = 0.2;  // share of the shank's
  const KinematicModel& model = *setup.model;
  const auto X_WS = SegmentPoses(model, ZeroPosture(model));
  std::vector<std::string> sides;
  for (const char* side : {"L", "R"}) {
    const int foot = model.FindSegment(std::string(side).append("Ay_joint"));
    const int ankle = model.FindSegment(std::string(side).append("Asegment_joint"));
    if (foot < 0 || ankle < 0) continue;
    std::vector<Eigen::Vector3d> places;
    for (const MarkerAssignment& one : setup.assignments()) {
      const ModelMarker& marker = model.markers()[one.marker];
      if (!model.IsBelow(marker.segment, foot)) continue;
      places.emplace_back(X_WS[static_cast<std::size_t>(marker.segment)] * marker.p_SM);
    }
    double apart = 0;
    for (const Eigen::Vector3d& a : places) {
      for (const Eigen::Vector3d& b : places) apart = std::max(apart, (a - b).norm());
    }
    const double shank =
        model.segments()[static_cast<std::size_t>(ankle)].X_PF.translation().norm();
    if (!places.empty() && apart < kLeastLength * shank) sides.emplace_back(side);
  }
  return sides;
}

// Of the model: those that no assigned marker moves, UntoldJoints, and ankles of ShortFeet.
std::vector<int> UnshownJoints(const TrackingSetup& setup) {
  const MarkerKinematics kinematics(*setup.model, setup.joints, MarkerIndices(setup.assignments()));
  std::vector<int> unshown;
  for (int joint = 0; joint < setup.model->num_joints(); ++joint) {
    const auto& tracked = kinematics.joints();
    const auto found = std::find(tracked.begin(), tracked.end(), joint);
    bool is_shown = false;
    for (int m = 0; m < kinematics.num_markers() && found != tracked.end(); ++m) {
      is_shown = is_shown || kinematics.Moves(static_cast<int>(found - tracked.begin()), m);
    }
    if (!is_shown) unshown.push_back(joint);
  }
  for (const std::string& side : ShortFeet(setup)) {
    for (const char* ankle : {"Ax_joint", "Ay_joint", "Az_joint"}) {
      const int joint = setup.model->FindJoint(side + ankle);
      if (joint >= 0) unshown.push_back(joint);
    }
  }
  return unshown;
}

}  // namespace

std::vector<Limb> LimbsOf(const TrackingSetup& setup) {
  const MarkerKinematics kinematics(*setup.model, setup.joints, MarkerIndices(setup.assignments()));
  std::vector<Limb> limbs;
  for (int j = 0; j < kinematics.num_joints(); ++j) {
    const std::string name = LimbOfJoint(setup.model->joint(kinematics.joints()[j]).name);
    if (name.empty()) continue;
    Limb* limb = FindLimb(name, &limbs);
    ++limb->num_joints;
    bool is_free = true;
    for (int m = 0; m < kinematics.num_markers(); ++m) {
      if (!kinematics.Moves(j, m)) continue;
      is_free = false;
      const LabelIx label = setup.assignments()[static_cast<std::size_t>(m)].label;
      if (std::count(limb->labels.begin(), limb->labels.end(), label) > 0) continue;
      limb->labels.push_back(label);
    }
    if (is_free) ++limb->free_joints;
  }
  return limbs;
}

std::vector<EndPart> EndPartsOf(const TrackingSetup& setup) {
  const KinematicModel& model = *setup.model;
  std::vector<EndPart> parts;
  if (!HasAnatomy(model)) return parts;
  for (const EndSegments& one : kEndSegments) {
    int segment = -1;
    for (const char* name : one.segments) {
      if (segment < 0 && *name != '\0') segment = model.FindSegment(name);
    }
    if (segment < 0) continue;
    EndPart part{one.name, 1, {}};
    for (const MarkerAssignment& assignment : setup.assignments()) {
      if (IsOn(model, model.markers()[assignment.marker].segment, segment)) {
        part.labels.push_back(assignment.label);
      }
    }
    const int half = (static_cast<int>(part.labels.size()) + 1) / 2;
    const bool is_pelvis = one.name == kEndSegments[0].name;
    part.fewest = std::clamp(half, is_pelvis ? kFewestOfPelvis : 1, kMostThatTell);
    parts.push_back(std::move(part));
  }
  return parts;
}

std::vector<bool> KnownFrames(const TrackingSetup& setup, const std::vector<std::string>& parts,
                              const MarkerSequence& recording) {
  std::vector<bool> known(static_cast<std::size_t>(recording.num_frames()), true);
  const auto is_asked = [&](const std::string& name) {
    return std::find(parts.begin(), parts.end(), name) != parts.end();
  };
  const auto take = [&](const std::vector<LabelIx>& labels, const auto& is_known) {
    const auto bridged = static_cast<int>(kBridged * recording.rate());
    int begin = 0;
    for (int k = 0; k <= recording.num_frames(); ++k) {
      if (k < recording.num_frames() && !is_known(SeenOf(labels, recording, k))) continue;
      if (k - begin > bridged) std::fill(known.begin() + begin, known.begin() + k, false);
      begin = k + 1;
    }
  };
  for (const Limb& limb : LimbsOf(setup)) {
    const int all = static_cast<int>(limb.labels.size());
    const auto is_known = [&](int seen) {
      return seen > 0 && (seen == all || limb.IsKnownBy(seen));
    };
    if (is_asked(limb.name)) take(limb.labels, is_known);
  }
  for (const EndPart& part : EndPartsOf(setup)) {
    const int all = static_cast<int>(part.labels.size());
    if (!is_asked(part.name) || (all > 0 && !part.IsKnownBy(all))) continue;
    take(part.labels, [&](int seen) { return part.IsKnownBy(seen); });
  }
  return known;
}

std::string DescribeUnshown(const TrackingSetup& setup) {
  std::vector<std::string> unshown;
  for (const std::string& part : NeverKnown(setup)) unshown.push_back("the " + part);
  for (const Limb& limb : LimbsOf(setup)) {
    const int told = 3 * static_cast<int>(limb.labels.size());
    const int missing = std::max(limb.free_joints, limb.num_joints - told);
    if (limb.labels.empty() || missing <= 0) continue;
    unshown.push_back(
        fmt::format("{} of {} joints of the {}", missing, limb.num_joints, limb.name));
  }
  for (const std::string& side : ShortFeet(setup)) {
    unshown.emplace_back(side == "L" ? "how the left foot is bent" : "how the right foot is bent");
  }
  return unshown.empty() ? "" : JoinNames(unshown, " and ");
}

AnatomicalAngles ShownAngles(const TrackingSetup& setup, const PoseTrajectory& motion) {
  const AnatomicalAngles angles = ComputeAnatomicalAngles(*setup.model, motion);
  const std::vector<int> unshown = UnshownJoints(setup);
  const std::vector<std::string> unknown = NeverKnown(setup);
  const auto is_in = [](const auto& list, const auto& one) {
    return std::find(list.begin(), list.end(), one) != list.end();
  };
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < angles.angles.size(); ++i) {
    const std::vector<int>& joints = angles.joints[i];
    const std::vector<std::string> parts = PartsBeside(angles.angles[i]);
    const bool moves = joints.empty() || std::any_of(joints.begin(), joints.end(), [&](int joint) {
                         return !is_in(unshown, joint);
                       });
    const bool is_known = std::none_of(
        parts.begin(), parts.end(), [&](const std::string& part) { return is_in(unknown, part); });
    if (moves && is_known) rows.push_back(static_cast<Eigen::Index>(i));
  }
  return SomeOf(angles, rows);
}

void HideUnknown(const TrackingSetup& setup, const MarkerSequence& recording,
                 AnatomicalAngles* angles) {
  const auto first = static_cast<std::size_t>(recording.num_frames() - angles->num_frames());
  std::map<std::vector<std::string>, std::vector<bool>> known;
  for (std::size_t i = 0; i < angles->angles.size(); ++i) {
    const std::vector<std::string> parts = PartsBeside(angles->angles[i]);
    const auto [found, is_new] = known.try_emplace(parts);
    if (is_new) found->second = KnownFrames(setup, parts, recording);
    for (int k = 0; k < angles->num_frames(); ++k) {
      if (found->second[first + static_cast<std::size_t>(k)]) continue;
      angles->values(static_cast<Eigen::Index>(i), k) = kNaN;
      if (angles->deviations.size() > 0) {
        angles->deviations(static_cast<Eigen::Index>(i), k) = kNaN;
      }
    }
  }
}

Coverage MeasureCoverage(const TrackingSetup& setup) {
  return {static_cast<int>(setup.assignments().size()), LimbsOf(setup), EndPartsOf(setup)};
}

std::vector<Gap> LongGaps(const TrackingSetup& setup, const MarkerSequence& recording) {
  constexpr std::size_t kMost = 3;
  std::vector<Gap> gaps =
      LongestGaps("the body", kLongGapOfBody, kMost, LabelIndices(setup.assignments()), recording,
                  [](int seen) { return seen > 0; });
  const std::vector<std::string> never = NeverKnown(setup);
  const auto add = [&](const std::string& name, double least, const auto& part) {
    const auto is_unknown = [&](const std::string& one) {
      return std::find(never.begin(), never.end(), one) != never.end();
    };
    if (!part.IsKnownBy(static_cast<int>(part.labels.size()))) return;
    if (is_unknown(name) || is_unknown(LimbOfEnd(name))) return;
    const std::vector<Gap> wider = gaps;
    for (const Gap& gap : LongestGaps("the " + name, least, 1, part.labels, recording,
                                      [&](int seen) { return part.IsKnownBy(seen); })) {
      const bool is_within = std::any_of(wider.begin(), wider.end(), [&](const Gap& other) {
        return (other.what == "the body" || other.what == "the " + LimbOfEnd(name)) &&
               SecondsBeyond(gap, other, recording.rate()) < least;
      });
      if (!is_within) gaps.push_back(gap);
    }
  };
  for (const Limb& limb : LimbsOf(setup)) add(limb.name, kLongGapOfLimb, limb);
  for (const EndPart& part : EndPartsOf(setup)) {
    add(part.name, part.name.ends_with("hand") ? kLongGapOfLimb : kLongGapOfEnd, part);
  }
  return gaps;
}

}  // namespace mmm_converter
