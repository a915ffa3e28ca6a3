// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/live/motion_journal.h"

#include <fmt/format.h>

#include <chrono>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "MMMConverterS2KF/live/journal_lines.h"
#include "common/convert/tracking_start.h"
#include "common/model/posture.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr std::chrono::milliseconds kFlushEvery(400);

void AppendNumber(double value, std::string* line) {
  fmt::format_to(std::back_inserter(*line), " {}", value);
}

template <typename Vector>
void AppendNumbers(const Vector& values, std::string* line) {
  for (Eigen::Index i = 0; i < values.size(); ++i) AppendNumber(values[i], line);
}

}  // namespace

std::string JournalOf(const std::string& output) { return output + ".live"; }

MotionJournal::MotionJournal(const JournalHeader& header, bool keeps_all)
    : header_(header),
      file_(JournalOf(header.output)),
      flushed_(std::chrono::steady_clock::now()),
      keeps_all_(keeps_all) {
  file_.Append(FormatJournalHeader(header));
}

void MotionJournal::Write(const std::shared_ptr<const LiveBody>& body, const PoseFrame& frame) {
  has_begun_ = has_begun_ || keeps_all_ || frame.is_tracking;
  if (!has_begun_ && CountSeen(frame.points, body->setup) < kFewestMarkers) return;
  const FrameEstimate& estimate = frame.estimate;
  const std::vector<int>& joints = body->setup.joints;
  const auto assignments = static_cast<Eigen::Index>(body->setup.assignments().size());
  if (!lines_.empty()) lines_ += '\n';
  if (body->is_calibrated && !is_calibrated_) {
    is_calibrated_ = true;
    header_.motion.comment = fmt::format(
        "From frame {} of the stream on, root poses and joint angles are those of the subject {}, "
        "whose segment lengths and marker places differ from this model scaled by height and mass",
        frame.number, body->name);
    lines_ += FormatJournalHeader(header_) + "\n";
  }
  fmt::format_to(std::back_inserter(lines_), "{} {} {}", frame.number, frame.time,
                 frame.is_tracking ? 1 : 0);
  if (frame.is_tracking) {
    const std::chrono::duration<double> seconds = frame.tracked - frame.received;
    fmt::format_to(std::back_inserter(lines_), " {} {} {} {} {} {} {:.3g}", estimate.markers_seen,
                   estimate.markers_downweighted, estimate.markers_wrong, estimate.nis,
                   estimate.reassembled ? 1 : 0, estimate.converged ? 1 : 0, seconds.count());
    AppendNumbers(estimate.posture.position, &lines_);
    AppendNumbers(estimate.posture.orientation.coeffs(), &lines_);
    for (const int joint : joints) AppendNumber(estimate.posture.joint_angles[joint], &lines_);
    const bool has_deviations = estimate.standard_deviations.size() > 0;
    for (int i = 0; i < 6 + static_cast<int>(joints.size()); ++i) {
      const int dof = i < 6 ? i : 6 + joints[static_cast<std::size_t>(i - 6)];
      AppendNumber(has_deviations ? estimate.standard_deviations[dof] : kNaN, &lines_);
    }
    AppendNumbers(estimate.residuals, &lines_);
    for (Eigen::Index i = 0; i < assignments; ++i) {
      AppendNumber(estimate.verdicts.size() > 0 ? estimate.verdicts[i] : kAsLabelled, &lines_);
    }
  }
  AppendNumbers(frame.points.reshaped(), &lines_);
  if (frame.tracked - flushed_ > kFlushEvery) Flush();
}

void MotionJournal::End() { Flush(); }

void MotionJournal::Flush() {
  flushed_ = std::chrono::steady_clock::now();
  if (lines_.empty()) return;
  file_.Append(lines_);
  lines_.clear();
}

}  // namespace mmm_converter
