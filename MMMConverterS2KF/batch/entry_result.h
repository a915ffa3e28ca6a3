// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/dynamics/retarget_run.h"
#include "common/support/units.h"

namespace mmm_converter {

/// Of an entry that was brought to a robot. NaN: there is none, as of feet without contact.
struct RobotFigures {
  std::string name;
  double slide = kNaN, toe_slide = kNaN;  ///< shares
  double penetration_mm = kNaN, floating_mm = kNaN;
  double direction_deg = kNaN, direction_p95_deg = kNaN;
  int position_breaks = 0, velocity_breaks = 0;
  double acceleration = kNaN;  ///< rms [rad/s^2]
};

/// Figures of a converted entry. NaN or an empty text: there is none, as of the height of an
/// object. A figure is a member here and a row of the table in entry_result.cc; journal, results
/// and the page of the batch follow from these.
struct EntryFigures {
  Verdict verdict;
  int frames = 0;
  double rate = 0;       ///< [Hz]
  double height = kNaN;  ///< [m]
  std::string height_source;
  double mass = kNaN;  ///< [kg]
  std::string mass_source;
  std::string subject;  ///< its name
  std::string converter, configuration;
  int markers_used = 0, markers_absent = 0, markers_ignored = 0;
  double mean_mm = kNaN, p95_mm = kNaN, max_mm = kNaN;  ///< distance over all markers and frames
  std::string worst_marker;                             ///< label with the largest mean distance
  double worst_marker_mm = kNaN;
  int frames_with_missing_markers = 0, frames_not_converged = 0, frames_reassembled = 0;
  int wrong_markers = 0;
  double process_noise_scale = kNaN;
  double nis = kNaN;  ///< over its degrees of freedom
  double median_ms = kNaN, p99_ms = kNaN;
  std::optional<RobotFigures> robot;  ///< the verdict is then of its motion, too
  std::vector<std::string> warnings;
};

/// What became of an entry.
struct EntryResult {
  std::optional<EntryFigures> figures;  ///< of a converted entry
  std::string reason;                   ///< why it failed
  double seconds = 0;                   ///< all work on it

  bool converted() const { return figures.has_value(); }
};

/// robot: null: it was brought to none.
EntryResult Converted(const ConversionReport& report, const RetargetReport* robot, double seconds);
EntryResult Failed(const std::string& reason, double seconds);

/// As journals and results have it; batch/README.md says what is in it.
Json ToJson(const EntryResult& result);

/// The same from a journal. @throws nlohmann::json::exception or Error where it is something else.
EntryResult ParseEntryResult(const Json& json);

}  // namespace mmm_converter
