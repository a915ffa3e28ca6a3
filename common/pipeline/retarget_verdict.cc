// SPDX-License-Identifier: MIT
#include "common/pipeline/retarget_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/judge/evidence.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Level = Verdict::Level;

// Right is what motions that a robot can do have, wrong what framewise fits without contacts have
// (README.md of common/retarget).
constexpr Limit kSlide = {0.02, 0.3};          // share of what is in contact
constexpr Limit kPenetration = {0.002, 0.03};  // [m]
constexpr Limit kFloating = {0.003, 0.03};     // [m]
constexpr Limit kDirection = {6, 25};          // [deg] on average
constexpr Limit kLimb = {12, 45};              // [deg] of one half of a limb, on average
constexpr double kLeastContact = 0.1;          // share of the frames of both feet
constexpr Limit kPath = {0.05, 0.3};           // from 1
constexpr Limit kTouch = {0.01, kNever};       // [m]: capsules are no closer to the bodies
constexpr Limit kAtLimit = {0.1, kNever};      // share of the frames
constexpr Limit kJump = {0.5, 1.5};            // [rad] from frame to frame
constexpr double kMostHeld = 0.3;              // of the time that a robot follows
constexpr double kMostJumps = 0.2;             // a second
constexpr Limit kAcceleration = {60, 150};     // [rad/s^2] rms: karate has 25
constexpr Limit kRootSpeed = {6.01, kNever};   // [m/s]: a sprinter's, scaled
// [m]: a quarter of a palm's width of 80 mm; robots that reach what the person holds are within 10.
constexpr Limit kOffHold = {0.02, kNever};
constexpr std::size_t kMostJointsNamed = 4, kMostTouchesNamed = 3;

void JudgeJoints(const RetargetFigures& figures, VerdictReasons* reasons) {
  std::size_t named = 0;
  for (const JointFigures& joint : figures.joints) {
    if (named == kMostJointsNamed) break;
    const double most = std::max(joint.share_at_limit, joint.share_at_speed);
    named += reasons->AddBeyond(
                 kAtLimit, most,
                 fmt::format("{} stands at its limit of {} in {:.0f} % of the frames", joint.name,
                             joint.share_at_limit >= joint.share_at_speed ? "position" : "velocity",
                             kPercent * most))
                 ? 1
                 : 0;
  }
}

void JudgeTouches(const RetargetFigures& figures, VerdictReasons* reasons) {
  const std::size_t count = std::min(figures.touches.size(), kMostTouchesNamed);
  for (std::size_t i = 0; i < count; ++i) {
    const TouchFigures& touch = figures.touches[i];
    reasons->AddBeyond(
        kTouch, touch.depth,
        fmt::format("{} goes {:.0f} mm into {} at {:.2f} s, {:.0f} % of the frames", touch.first,
                    kMillimetres * touch.depth, touch.second, touch.time, kPercent * touch.share));
  }
}

void JudgeHolds(const RetargetFigures& figures, VerdictReasons* reasons) {
  const auto worst = std::max_element(figures.holds.begin(), figures.holds.end(),
                                      [](const auto& a, const auto& b) { return a.most < b.most; });
  if (worst == figures.holds.end()) return;
  reasons->AddBeyond(
      kOffHold, worst->most,
      fmt::format("the {} hand is {:.0f} mm off {}, which the person holds, at {:.2f} s, {:.0f} on "
                  "average",
                  worst->hand, kMillimetres * worst->most, worst->object, worst->most_time,
                  kMillimetres * worst->mean));
}

void JudgeFollowing(const FollowedFigures& followed, VerdictReasons* reasons) {
  const auto times = [](int count) {
    return fmt::format("{} time{}", count, count == 1 ? "" : "s");
  };
  const double seconds = std::max(followed.seconds, 1e-3);
  if (followed.holds > 0) {
    const bool is_much = followed.held > kMostHeld * seconds;
    reasons->Add(is_much ? Level::kFailed : Level::kCheck,
                 fmt::format("the person was lost {}: the robot held for {:.1f} s",
                             times(followed.holds), followed.held));
  }
  if (followed.jumps > 0) {
    const bool is_much = followed.jumps > std::max(1.0, kMostJumps * seconds);
    reasons->Add(is_much ? Level::kFailed : Level::kCheck,
                 fmt::format("the person jumped, or was far from the robot for long, {}",
                             times(followed.jumps)));
  }
}

/// Of few contacts a share says nothing.
void JudgeContacts(const RetargetFigures& figures, VerdictReasons* reasons) {
  if (std::isnan(figures.slide)) return;
  if (figures.contact_share < kLeastContact) {
    reasons->Add(Level::kCheck,
                 fmt::format("the person's feet stand still in {:.0f} % of the frames only, as in "
                             "flight or on a treadmill: the robot's are not held",
                             kPercent * figures.contact_share));
    return;
  }
  reasons->AddBeyond(
      kSlide, figures.slide,
      fmt::format("feet slide in {:.1f} % of the frames in contact", kPercent * figures.slide));
  reasons->AddBeyond(kFloating, figures.floating,
                     fmt::format("feet in contact are {:.1f} mm above the floor on average",
                                 kMillimetres * figures.floating));
}

}  // namespace

Verdict JudgeRetargeting(const RetargetFigures& figures, const Verdict* of_conversion) {
  VerdictReasons reasons;
  if (of_conversion != nullptr && of_conversion->level != Level::kGood) {
    reasons.Add(of_conversion->level,
                "the recording's conversion: " +
                    (of_conversion->reasons.empty() ? "" : of_conversion->reasons.front()));
  }
  if (figures.is_mirrored) {
    reasons.Add(Level::kFailed,
                "the robot moves as the person in a mirror, or with sides exchanged");
  }
  if (figures.is_backwards) reasons.Add(Level::kFailed, "the robot faces backwards");
  if (figures.position_breaks > 0 || figures.velocity_breaks > 0) {
    reasons.Add(Level::kCheck,
                fmt::format("limits are broken: of position {} times, of velocity {} times",
                            figures.position_breaks, figures.velocity_breaks));
  }
  if (!figures.keeps_limits) {
    reasons.Add(Level::kCheck,
                "the robot's limits were met only by holding joints back or lifting the robot");
  }
  JudgeContacts(figures, &reasons);
  reasons.AddBeyond(kPenetration, figures.penetration,
                    fmt::format("a foot is {:.1f} mm below the floor at {:.2f} s",
                                kMillimetres * figures.penetration, figures.penetration_time));
  reasons.AddBeyond(kPenetration, figures.body_depth,
                    fmt::format("{} is {:.1f} mm below the floor at {:.2f} s", figures.deepest_body,
                                kMillimetres * figures.body_depth, figures.body_depth_time));
  reasons.AddBeyond(kDirection, figures.direction * kDegrees,
                    fmt::format("limbs point {:.1f} degrees elsewhere than the person's on average",
                                figures.direction * kDegrees));
  if (std::isnan(figures.direction)) {
    reasons.Add(Level::kCheck, "limbs can't be compared: no frame shows which way the body faces");
  }
  for (const LimbFigures& limb : figures.limbs) {
    reasons.AddBeyond(
        kLimb, limb.mean * kDegrees,
        fmt::format("the {} points {:.0f} degrees elsewhere on average, at {:.2f} s "
                    "{:.0f}",
                    limb.name, limb.mean * kDegrees, limb.most_time, limb.most * kDegrees));
  }
  JudgeHolds(figures, &reasons);
  JudgeTouches(figures, &reasons);
  JudgeJoints(figures, &reasons);
  reasons.AddBeyond(kJump, figures.largest_jump,
                    fmt::format("a joint jumps by {:.0f} degrees from a frame to the next",
                                figures.largest_jump * kDegrees));
  reasons.AddBeyond(kAcceleration, figures.acceleration,
                    fmt::format("joints shake: {:.0f} rad/s^2 rms", figures.acceleration));
  reasons.AddBeyond(kRootSpeed, figures.root_speed,
                    fmt::format("the root moves at {:.1f} m/s", figures.root_speed));
  JudgeFollowing(figures.followed, &reasons);
  reasons.AddBeyond(
      kPath, std::abs(figures.path - 1),
      fmt::format("the path is {:.2f} times as long as the legs allow", figures.path));
  return reasons.Conclude();
}

}  // namespace mmm_converter
