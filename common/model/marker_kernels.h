// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "common/math/kernel_variants.h"

namespace mmm_converter {

/// A marker on a link: p_WM = p_WL + R_WL p_LM.
struct MarkerSite {
  int marker = 0;       ///< its place in the results
  double p_LM[3] = {};  ///< [m]
};

/// A rigid body between tracked joints. R_WL = R_WP R_PF Rot(axis, slope angle), p_WL = p_WP + R_WP
/// p_PF; of a joint that slides R_WL = R_WP R_PF, p_WL = p_WP + R_WP (p_PF + slide_P angle). The
/// first link is the root and has no joint.
struct TrackedLink {
  int parent = 0;
  int column = 0;  ///< of the joint's angle
  int axis = 2;    ///< 0 x, 1 y, 2 z
  double slope = 1;
  bool slides = false;
  double slide_P[3] = {};   ///< in axes of P, with the slope
  bool rotated = false;     ///< R_PF is not the identity
  bool translated = false;  ///< p_PF is not zero
  bool kept = false;        ///< a later link than the next one starts from it
  double R_PF[9] = {};      ///< column-major
  double p_PF[3] = {};      ///< [m]
  int first_site = 0;
  int num_sites = 0;
};

/// Columns of MarkerBatch, in its units.
struct MarkerBatchColumns {
  const double* rotation;
  const double* position;
  const double* angles;
  double* markers;
  double* frames;  ///< scratch: kFrameSize * links
  std::ptrdiff_t rows;
};

/// Doubles that a link's frame needs, for one group of samples.
inline constexpr int kFrameSize = 12 * 8;

struct MarkerKernels {
  /// Forward kinematics of all rows; rows is padded. Links stand behind their parents.
  void (*place_markers)(const TrackedLink* links, int num_links, const MarkerSite* sites,
                        const MarkerBatchColumns& batch);
  /// The same where some links slide.
  void (*place_markers_of_slides)(const TrackedLink* links, int num_links, const MarkerSite* sites,
                                  const MarkerBatchColumns& batch);
};

MMM_CONVERTER_DECLARE_KERNELS(MarkerKernels)

}  // namespace mmm_converter
