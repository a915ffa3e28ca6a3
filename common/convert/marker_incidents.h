// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmm_converter {

/// What a converter may say of an assignment in a frame: the label is right; its own index: the
/// marker is not where its label is, left out; another assignment's index: that one bears its
/// label.
inline constexpr int kAsLabelled = -1;

/// Labels that were wrong for a while.
struct MarkerIncident {
  enum class Kind {
    kSwapped,    ///< two markers bear each other's label
    kMisplaced,  ///< a jump, a ghost, or another marker's place without the other taking its own
  };
  Kind kind = Kind::kMisplaced;
  int assignment = -1;
  int other = -1;  ///< kSwapped: the second assignment, greater than the first
  int first_frame = 0;
  int last_frame = 0;

  bool operator==(const MarkerIncident&) const = default;
};

/// "swapped" or "misplaced".
const char* Name(MarkerIncident::Kind kind);

/// An incident goes on where it stops for no more frames than this. rate [Hz].
int BridgedFrames(double rate);

/// The incidents of a recording by first frame, then assignment. verdicts: assignments x frames.
/// One that stops for up to `bridged` frames goes on.
std::vector<MarkerIncident> FindIncidents(const Eigen::MatrixXi& verdicts, int bridged);

}  // namespace mmm_converter
