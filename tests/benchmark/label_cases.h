// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/label/track/label_recording.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// A recording whose labels are right, and what may be known of the person who wears the markers.
struct LabelCase {
  std::string name;
  MarkerSequence recording;
  TrackingSetup calibrated;  ///< on the recording itself; of made persons the truth
  TrackingSetup by_height;   ///< the model of the height
};

/// Those of /shared: KIT's at 10 Hz, CMU, the tennis serve, pyCGM's trial. only: names to keep;
/// empty: all. Labels without a marker stay, as points that are nobody's.
std::vector<LabelCase> RealCases(const std::vector<std::string>& only);

inline constexpr const char* kMadeCase = "made";
/// Three seconds of another person with each seed.
LabelCase MadeCase(std::uint64_t seed);

/// Two of these persons, who come from 2 m to 0.8 m of each other, and a box with five markers.
struct TogetherCase {
  MarkerSequence recording;
  LabelScene scene;  ///< names are the recording's labels
};
TogetherCase MakeTogether(std::uint64_t seed);

/// The marker of each label of a recording, -1: none.
std::vector<int> MarkerOfLabel(const LabelCase& one);

/// What goes wrong with labels for a second.
enum class LabelEvent { kPair, kNearestPair, kLimb, kRenamed, kSplit };

struct BrokenLabels {
  MarkerSequence recording;           ///< with two more labels, "*1" and "*2"
  std::vector<std::vector<int>> own;  ///< by frame and column: the label that is right, -1: none
};

/// From frame `begin` on; labels are drawn.
BrokenLabels Break(const LabelCase& one, LabelEvent event, int begin, std::uint64_t seed);

}  // namespace mmm_converter
