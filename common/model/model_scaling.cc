// SPDX-License-Identifier: MIT
#include "common/model/model_scaling.h"

#include <fmt/core.h>

#include <string>
#include <vector>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

void CheckRange(const char* what, double value, const char* unit, double low, double high,
                const char* advice, Remedy remedy = Remedy::kNone) {
  if (value >= low && value <= high) return;  // false for NaN
  throw Error(fmt::format("{} {} {} is outside {} to {} {}; {}", what, value, unit, low, high, unit,
                          advice),
              remedy);
}

void CheckPerson(const WinterScaling& person) {
  CheckRange("height", person.height, "m", kLeastHeight, kLargestHeight, "give metres",
             Remedy::kHeight);
  CheckRange("mass", person.mass, "kg", kLeastMass, kLargestMass, "give kilograms", Remedy::kMass);
  if (person.hand_length) {
    CheckRange("hand length", *person.hand_length, "m", kLeastHandLength, kLargestHandLength,
               "give metres, e.g. 0.18 (<HandLength> in an MMM file is in cm)");
  }
}

/// For each segment, whether it hangs below a wrist joint.
std::vector<bool> FindHands(const KinematicModel& model) {
  const int left = model.FindSegment("LWy_joint");
  const int right = model.FindSegment("RWy_joint");
  if (left < 0 || right < 0) {
    throw Error(
        "a hand length needs a model with the wrist joints LWy_joint and RWy_joint; leave "
        "the hand length out");
  }
  std::vector<bool> in_hand(model.segments().size(), false);
  for (std::size_t i = 1; i < in_hand.size(); ++i) {
    const int parent = model.segments()[i].parent;
    in_hand[i] = parent == left || parent == right || in_hand[parent];
  }
  return in_hand;
}

void ScaleSegment(Segment& segment, double length, double mass) {
  segment.X_PF.translation() *= length;
  segment.p_SB *= length;
  segment.mass *= mass;
  segment.inertia *= mass * length * length;
  if (segment.type == JointType::kPrismatic) {
    segment.lower *= length;
    segment.upper *= length;
  }
}

}  // namespace

std::vector<double> WinterLengths(const KinematicModel& reference, const WinterScaling& person) {
  CheckPerson(person);
  std::vector<double> lengths(reference.segments().size(), person.height);
  if (person.hand_length) {
    const std::vector<bool> in_hand = FindHands(reference);
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      if (in_hand[i]) lengths[i] = *person.hand_length / kWinterHandLength;
    }
  }
  return lengths;
}

KinematicModel ScaleWinter(const KinematicModel& reference, const WinterScaling& person) {
  const std::vector<double> lengths = WinterLengths(reference, person);
  ModelDescription scaled = DescriptionOf(reference);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    ScaleSegment(scaled.segments[i], lengths[i], person.mass);
  }
  for (ModelMarker& marker : scaled.markers) marker.p_SM *= lengths[marker.segment];
  return KinematicModel(std::move(scaled));
}

}  // namespace mmm_converter
