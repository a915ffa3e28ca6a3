// SPDX-License-Identifier: MIT
#include "common/judge/body_rules.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr Limit kBodyAtLimit = {kStandsAtLimit, kNever};
// A straight knee is at its limit, and at rest. Markers of uncalibrated persons in the walks of 24
// laboratories show it at most 3 degrees beyond; those of a shank that was turned back by 15, 7.
constexpr double kKneeBeyond = 5 / kDegrees;
// Who walks on hands is not upright; who kicks is not so for long.
constexpr Limit kAnkleAboveHip = {0.2, kNever};
// Of a foot that lies flat [degrees]: shoes and places of markers differ.
constexpr Limit kSlopeOfSole = {15, kNever};
// Share of the frames in which a leg is beside the trunk.
constexpr double kMostOfThem = 0.5;
// Of the labels that a knee or elbow moves, on average: right at most 0.05.
constexpr double kFarBelow = 0.08;  // [m]
// Of what changes by skin, right recordings at most 0.009, made ones 0.012.
constexpr Limit kSlip = {0.013, kNever};

void JudgeJoints(const std::vector<JointAtLimit>& joints, bool is_calibrated,
                 VerdictReasons* reasons) {
  std::vector<std::string> standing;
  double most = 0;
  for (const JointAtLimit& joint : joints) {
    double share = joint.share;
    std::string beyond;
    if (kBodyAtLimit.IsBeyond(joint.straight) && joint.bent_back > kKneeBeyond) {
      share = joint.straight;
      beyond = fmt::format(", bent backwards by {:.0f} degrees", kDegrees * joint.bent_back);
    }
    if (!kBodyAtLimit.IsBeyond(share)) continue;
    standing.push_back(fmt::format("{} ({:.0f} %{})", joint.joint, kPercent * share, beyond));
    most = std::max(most, share);
  }
  const char* advice = is_calibrated ? "" : " Calibrating the person finds where they are worn.";
  reasons->AddBeyond(kBodyAtLimit, most,
                     fmt::format("joints stand at their limits, in more than {:.0f} % of the "
                                 "frames: {}; does the person bend further than the model, or "
                                 "are markers not where their names say?{}",
                                 kPercent * kBodyAtLimit.check, FirstNames(standing, 6), advice));
}

void JudgeLegs(const std::vector<FoldedLeg>& legs, VerdictReasons* reasons) {
  for (const FoldedLeg& leg : legs) {
    reasons->AddBeyond(kAnkleAboveHip, leg.share,
                       fmt::format("the {} ankle is above its hip in {:.0f} % of the frames in "
                                   "which the pelvis is upright: is it a leg's marker?",
                                   leg.side, kPercent * leg.share));
  }
}

void JudgeSoles(const std::vector<FlatSole>& soles, VerdictReasons* reasons) {
  for (const FlatSole& sole : soles) {
    const double slope = kDegrees * std::abs(sole.slope);
    reasons->AddBeyond(
        kSlopeOfSole, slope,
        sole.slope < 0
            ? fmt::format("the {} foot's heel is up by {:.0f} degrees where its markers are "
                          "lowest: does the person walk on toes, or are they not where their "
                          "names say?",
                          sole.side, slope)
            : fmt::format("the {} foot's sole slopes by {:.0f} degrees where its markers lie flat: "
                          "are they where their names say?",
                          sole.side, slope));
  }
}

}  // namespace

void JudgeBodyLimits(const BodyLimits& limits, bool is_calibrated, VerdictReasons* reasons) {
  JudgeJoints(limits.joints, is_calibrated, reasons);
  JudgeLegs(limits.legs, reasons);
  JudgeSoles(limits.soles, reasons);
}

void JudgeSlips(const std::optional<SlippedMarkers>& slipped, VerdictReasons* reasons) {
  if (!slipped) return;
  reasons->AddBeyond(
      kSlip, slipped->distance,
      fmt::format(
          "one of {} seems to slip by {:.0f} mm or more at about {:.1f} s: angles before and "
          "after do not belong together",
          fmt::join(slipped->labels, ", "), kMillimetres * slipped->distance, slipped->time));
}

void JudgeLimbPlaces(const std::vector<LimbPlace>& places, VerdictReasons* reasons) {
  for (const LimbPlace& place : places) {
    if (place.beside_trunk > kMostOfThem) {
      reasons->Add(
          Verdict::Level::kCheck,
          fmt::format("the {} lies beside the trunk, where a leg can't be for long, in "
                      "{:.0f} % of the frames: are its labels another limb's ({})?",
                      place.limb, kPercent * place.beside_trunk, FirstNames(place.labels, 6)));
    }
    if (place.bent_back > kFarBelow) {
      reasons->Add(Verdict::Level::kCheck,
                   fmt::format("the {} would bend backwards at the {}: straight, its labels are "
                               "{:.0f} mm from the model ({})",
                               place.limb, place.is_leg ? "knee" : "elbow",
                               kMillimetres * place.bent_back, FirstNames(place.labels, 6)));
    }
  }
}

}  // namespace mmm_converter
