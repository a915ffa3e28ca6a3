// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "common/contacts/contacts.h"
#include "common/motion/anatomical_angles.h"
#include "common/motion/foot_motion.h"

namespace mmm_converter {

/// From a foot's contact with the ground to its next one. Lengths are horizontal, along and across
/// the way from one contact to the next; NaN: the other foot's contacts do not tell.
struct Stride {
  Side side = Side::kLeft;
  double begin = 0, end = 0;  ///< [s]
  double time_deviation = 0;  ///< standard deviation of end - begin [s]
  double foot_off = 0;        ///< of the stride [0, 1]: the share that it stood
  double length = 0;          ///< [m]
  double heading = 0;         ///< of the way, from W's x to its y [rad]
  double step_length = 0;     ///< [m] from where the other foot stood to where it stands next
  double step_width = 0;      ///< [m] between both heels then; negative: the feet cross
  double step_time = 0;       ///< [s] since the other foot's contact
  double double_support = 0;  ///< of the stride [0, 1]: the share that both feet stood
  double rise = 0;            ///< from where the foot stood to where it stands next, upwards [m]
  /// Standard deviations of foot_off and double_support.
  double foot_off_deviation = 0, double_support_deviation = 0;
  bool is_backwards = false;  ///< the toes point against the way

  double time() const { return end - begin; }
  double speed() const { return length / time(); }  ///< [m/s]
  double cadence() const { return 120 / time(); }   ///< [steps/min]
};

/// An angle over the strides of one foot, from contact (0 %) to contact (100 %).
struct GaitCycle {
  static constexpr int kSamples = 101;

  AnatomicalAngle angle;
  Side side = Side::kLeft;  ///< whose strides they are
  int strides = 0;
  std::array<double, kSamples> mean = {};       ///< [rad]
  std::array<double, kSamples> deviation = {};  ///< among the strides [rad]; NaN: it is one
  /// Standard deviation of the angle itself, root mean square of the strides [rad]; NaN: not known.
  std::array<double, kSamples> uncertainty = {};
};

/// Each row of `rows` over the strides of its side, or of both feet where it has none. A stride
/// counts where the row is known in half of it; the mean is of those that are known there.
std::vector<GaitCycle> CyclesOf(const AnatomicalAngles& rows, const std::vector<Stride>& strides);

/// What most of the strides are.
enum class GaitKind { kWalking, kRunning, kBackwards, kStairs, kRamp };
const char* Name(GaitKind kind);  ///< "walking", "running", "walking backwards", "stairs"

/// What a joint's muscles give and take in a stride, means of strides [J/kg].
struct JointWork {
  const char* joint = "";
  const char* side = "";
  double generated = 0, absorbed = 0;
  int strides = 0;
};

struct Gait {
  GaitKind kind = GaitKind::kWalking;
  std::vector<Stride> strides;    ///< the left foot's, then the right foot's, over time
  std::vector<GaitCycle> cycles;  ///< of angles of a side over its strides, of others over both
  std::vector<GaitCycle> forces;  ///< of forces, moments and powers; empty: not known
  std::vector<JointWork> work;
  int left_out = 0;  ///< strides in which a leg was hidden
  int turns = 0;     ///< strides over a turn, which are left out, too
};

inline constexpr double kLongestStride = 6;  ///< [s] of persons who walk slowly

/// Strides last at most kLongestStride, and in those of more than 2.5 s the feet swing: else the
/// person stands. Both legs are known all along. Lengths are between the places where feet stood,
/// in mid-stance, on a treadmill on its belt. What does not apply is NaN: double support of who
/// runs. The pelvis turns against the way from contact to contact. angles: of the same motion.
Gait AnalyzeGait(const FootMotion& feet, const Contacts& contacts, const AnatomicalAngles& angles,
                 const KnownLegs& known);

}  // namespace mmm_converter
