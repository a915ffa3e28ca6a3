// SPDX-License-Identifier: MIT
#include "common/pipeline/c3d_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/angles/normal_bands.h"
#include "common/io/c3d/c3d_file.h"
#include "common/math/statistics.h"
#include "common/motion/anatomical_angles.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/gait_forces.h"
#include "common/study/coverage.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

/// Which of a point's three values: in the sagittal, frontal or transverse plane.
struct Plane {
  const char* motion;
  Eigen::Index index;
};
constexpr Plane kPlanes[] = {{"tilt", 0},
                             {"flexion", 0},
                             {"dorsiflexion", 0},
                             {"obliquity", 1},
                             {"lateral bending", 1},
                             {"adduction", 1},
                             {"inversion", 1},
                             {"radial deviation", 1},
                             {"rotation", 2},
                             {"internal rotation", 2},
                             {"pronation", 2},
                             {"extension moment", 0},
                             {"plantar flexion moment", 0},
                             {"abduction moment", 1},
                             {"eversion moment", 1},
                             {"external rotation moment", 2},
                             {"power", 2}};

std::optional<Eigen::Index> PlaneOf(std::string_view motion) {
  for (const Plane& one : kPlanes) {
    if (motion == one.motion) return one.index;
  }
  return {};
}

C3dResultKind KindOf(std::string_view motion) {
  if (motion == "power") return C3dResultKind::kPower;
  return motion.ends_with("moment") ? C3dResultKind::kMoment : C3dResultKind::kAngle;
}

/// "LKneeAngles": the joint as gait laboratories write it.
std::string LabelOf(std::string_view joint, Side side, C3dResultKind kind) {
  std::string name(joint == "trunk" ? "spine" : joint);
  name[0] = static_cast<char>(name[0] - 'a' + 'A');
  const char* what = kind == C3dResultKind::kAngle    ? "Angles"
                     : kind == C3dResultKind::kMoment ? "Moment"
                                                      : "Power";
  return fmt::format("{}{}{}", side == Side::kLeft ? 'L' : 'R', name, what);
}

/// The quarters of a turn nearest to most of these [rad]: by Plug-in Gait the pelvis turns against
/// the axis of the laboratory along which the person walks.
double NearestQuarter(const Eigen::RowVectorXd& turns) {
  std::vector<double> known;
  std::copy_if(turns.begin(), turns.end(), std::back_inserter(known),
               [](double one) { return std::isfinite(one); });
  constexpr double kQuarter = std::numbers::pi / 2;
  return known.empty() ? 0 : kQuarter * std::round(Median(known) / kQuarter);
}

class ResultPoints {
 public:
  ResultPoints(std::string prefix, int first_frame, const KnownLegs& known)
      : prefix_(std::move(prefix)), first_frame_(first_frame), known_(known) {}

  /// Rows of angles [rad], moments and powers, for each side that has them.
  void Add(const AnatomicalAngles& rows) {
    for (std::size_t i = 0; i < rows.angles.size(); ++i) {
      const AnatomicalAngle& row = rows.angles[i];
      const std::optional<Eigen::Index> plane = PlaneOf(row.motion);
      if (!plane) continue;
      Eigen::RowVectorXd values = rows.values.row(static_cast<Eigen::Index>(i));
      if (std::string_view(row.joint) == "pelvis" && *plane == 2) {
        values.array() -= NearestQuarter(values);
      }
      for (const Side side : kSides) {
        if (*row.side != '\0' && std::string_view(row.side) != Name(side)) continue;
        const C3dResultKind kind = KindOf(row.motion);
        const double unit = kind == C3dResultKind::kAngle ? kDegrees : 1;
        C3dResult& result = ResultOf(row.joint, side, kind, rows.num_frames());
        result.values.row(*plane) += unit * OwnSideSign(row.joint, row.motion, side) * values;
        if (kind != C3dResultKind::kAngle && IsOfLeg(row.joint)) Hide(side, &result);
      }
    }
  }

  std::vector<C3dResult> Take() { return std::move(results_); }

 private:
  C3dResult& ResultOf(std::string_view joint, Side side, C3dResultKind kind, int frames) {
    const std::string label = prefix_ + LabelOf(joint, side, kind);
    const auto [found, is_new] = places_.try_emplace(label, results_.size());
    if (is_new) {
      results_.push_back({label, kind, first_frame_, Eigen::Matrix3Xd::Zero(3, frames)});
    }
    return results_[found->second];
  }

  void Hide(Side side, C3dResult* result) const {
    const std::vector<bool>& leg = known_[static_cast<std::size_t>(side)];
    for (Eigen::Index k = 0; k < result->values.cols(); ++k) {
      if (!leg[static_cast<std::size_t>(k)]) result->values.col(k).setConstant(kNaN);
    }
  }

  std::string prefix_;
  int first_frame_;
  const KnownLegs& known_;
  std::map<std::string, std::size_t> places_;
  std::vector<C3dResult> results_;
};

/// "Anna:" where the file's labels begin so; else empty.
std::string PrefixOf(const C3dFile& file, const std::string& subject) {
  const std::vector<std::string> names = C3dPointNames(file, nullptr);
  const std::string prefix = subject + ":";
  const bool has_prefix =
      !subject.empty() && std::any_of(names.begin(), names.end(),
                                      [&](const auto& one) { return one.starts_with(prefix); });
  return has_prefix ? prefix : "";
}

int FirstFrame(const C3dFile& file, const PoseTrajectory& motion) {
  // Rates of files are floats.
  constexpr double kSameRate = 1e-3;
  const double rate = file.layout().rate > 0 ? file.layout().rate : motion.rate;
  if (std::abs(rate - motion.rate) > kSameRate * rate) {
    throw Error(fmt::format(
        "{}: has {:g} frames a second, and the motion {:g}: its angles are no points of "
        "that file",
        file.path(), rate, motion.rate));
  }
  return static_cast<int>(std::lround((motion.first_time - file.layout().first_time(rate)) * rate));
}

}  // namespace

std::vector<C3dResult> C3dResultsOf(const ConversionReport& report, const GroundStudy& ground,
                                    Warnings* warnings) {
  const Recording& recording = report.plan.input.recording;
  const C3dFile file(recording.file);
  const PoseTrajectory motion = TrackedMotion(report.result);
  const KnownLegs known = FindKnownLegs(report);
  ResultPoints points(PrefixOf(file, recording.subject), FirstFrame(file, motion), known);
  AnatomicalAngles angles = ShownAngles(report.plan.setup, motion);
  HideUnknown(report.plan.setup, recording.markers, &angles);
  points.Add(angles);
  if (const auto moments = LegMomentsOf(report, ground)) points.Add(*moments);
  std::vector<C3dResult> results = points.Take();
  const std::vector<std::string> hidden = HideUnstorable(file, &results);
  if (!hidden.empty()) {
    Warn(warnings,
         fmt::format("{} stores 16 bit integers, which can't hold all values of {}: these "
                     "are not written into its copy",
                     recording.file, fmt::join(hidden, ", ")));
  }
  return results;
}

}  // namespace mmm_converter
