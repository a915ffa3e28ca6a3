// SPDX-License-Identifier: MIT
#include "common/convert/marker_incidents.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace mmm_converter {
namespace {

constexpr double kBridgedTime = 0.1;  // [s]

}  // namespace

const char* Name(MarkerIncident::Kind kind) {
  return kind == MarkerIncident::Kind::kSwapped ? "swapped" : "misplaced";
}

int BridgedFrames(double rate) { return static_cast<int>(std::lround(kBridgedTime * rate)); }

std::vector<MarkerIncident> FindIncidents(const Eigen::MatrixXi& verdicts, int bridged) {
  std::vector<MarkerIncident> incidents;
  for (int i = 0; i < verdicts.rows(); ++i) {
    // The latest of each verdict, as indices of `incidents`.
    const std::size_t first = incidents.size();
    for (int k = 0; k < verdicts.cols(); ++k) {
      const int other = verdicts(i, k);
      if (other == kAsLabelled) continue;
      const bool is_swap = other != i;
      if (is_swap && other < i) continue;
      const auto same = std::find_if(
          incidents.rbegin(), incidents.rend() - first,
          [&](const MarkerIncident& incident) { return incident.other == (is_swap ? other : -1); });
      if (same != incidents.rend() - first && k - same->last_frame <= bridged + 1) {
        same->last_frame = k;
        continue;
      }
      incidents.push_back(
          {is_swap ? MarkerIncident::Kind::kSwapped : MarkerIncident::Kind::kMisplaced, i,
           is_swap ? other : -1, k, k});
    }
  }
  std::stable_sort(incidents.begin(), incidents.end(),
                   [](const MarkerIncident& a, const MarkerIncident& b) {
                     return a.first_frame < b.first_frame;
                   });
  return incidents;
}

}  // namespace mmm_converter
