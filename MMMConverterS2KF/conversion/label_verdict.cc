// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "MMMConverterS2KF/conversion/judgement.h"
#include "MMMConverterS2KF/conversion/recording_labels.h"
#include "MMMConverterS2KF/conversion/verdict.h"
#include "MMMConverterS2KF/terminal/advice.h"
#include "common/fit/posture_search.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Level = Verdict::Level;

// Share of the names that no point has: right 0, fewer markers than the set has up to 0.4.
constexpr Limit kNamesNotFound = {0.4, 0.6};
// Mean of one minus the probability of a name: right at most 0.005; by another person's subject
// file 0.02 to 0.15.
constexpr Limit kUnsure = {0.08, 0.4};

/// The named points of a frame, by assignment of the setup.
class NamedPoints {
 public:
  NamedPoints(const FoundLabels& found, const MarkerSequence& markers)
      : markers_(markers), pieces_(found.setup.assignments().size()) {
    std::vector<int> assignment(found.labelling.names.size(), -1);
    for (std::size_t m = 0; m < pieces_.size(); ++m) {
      assignment[found.setup.assignments()[m].label] = static_cast<int>(m);
    }
    for (const NamedPiece& piece : found.labelling.pieces) {
      if (piece.name >= 0 && assignment[piece.name] >= 0) {
        pieces_[assignment[piece.name]].push_back(piece);
      }
    }
  }

  Eigen::Matrix3Xd At(int frame) const {
    Eigen::Matrix3Xd z =
        Eigen::Matrix3Xd::Constant(3, static_cast<Eigen::Index>(pieces_.size()), kNaN);
    for (std::size_t m = 0; m < pieces_.size(); ++m) {
      for (const NamedPiece& piece : pieces_[m]) {
        if (piece.begin > frame || piece.end <= frame) continue;
        z.col(static_cast<Eigen::Index>(m)) = markers_.frame(frame).col(piece.point);
      }
    }
    return z;
  }

 private:
  const MarkerSequence& markers_;
  std::vector<std::vector<NamedPiece>> pieces_;
};

}  // namespace

double LabelDistance(const FoundLabels& found, const MarkerSequence& markers) {
  constexpr int kFrames = 24, kFewest = 10, kAttempts = 4;
  const TrackingSetup& setup = found.setup;
  const MarkerKinematics kinematics(*setup.model, setup.joints, MarkerIndices(setup.assignments()));
  const Eigen::VectorXd scales = NoiseScales(setup.assignments());
  PostureFitOptions options;
  options.robust_distance = 0.1;
  PostureSearch search(kinematics);
  const NamedPoints points(found, markers);
  double sum = 0;
  int count = 0;
  for (int i = 0; i < kFrames; ++i) {
    const int k = (2 * i + 1) * markers.num_frames() / (2 * kFrames);
    const Eigen::Matrix3Xd z = points.At(k);
    if (z.row(0).array().isFinite().count() < kFewest) continue;
    Posture posture;
    sum += search.Assemble(z, scales, options, kAttempts, &posture).mean_distance;
    ++count;
  }
  return count > 0 ? sum / count : kNaN;
}

Verdict JudgeLabels(const LabelReport& report) {
  const FoundLabels& found = report.found;
  const MarkerSequence& markers = report.input.recording.markers;
  VerdictReasons judgement;
  JudgeReading(report.input.recording, &judgement);
  std::vector<int> frames(found.labelling.names.size(), 0);
  std::vector<int> unnamed(static_cast<std::size_t>(markers.num_labels()), 0);
  double unsure = 0, named = 0;
  for (const NamedPiece& piece : found.labelling.pieces) {
    const int length = piece.end - piece.begin;
    if (piece.name < 0) {
      unnamed[piece.point] += length;
      continue;
    }
    frames[piece.name] += length;
    named += length;
    unsure += (1 - piece.probability) * length;
  }
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i] == 0) missing.push_back(found.labelling.names[i]);
  }
  const auto spare = std::count_if(unnamed.begin(), unnamed.end(),
                                   [&](int n) { return 2 * n > markers.num_frames(); });
  const auto names = static_cast<double>(frames.size());
  const std::string not_found =
      fmt::format("{} of {} names {} not found ({})", missing.size(), frames.size(),
                  missing.size() == 1 ? "was" : "were", FirstNames(missing));
  const bool is_few =
      judgement.AddBeyond(kNamesNotFound, static_cast<double>(missing.size()) / names, not_found);
  if (!is_few && !missing.empty() && spare > 0) {
    judgement.Add(
        Level::kCheck,
        fmt::format("{}, though {} without a name nearly all along: markers may be worn "
                    "elsewhere",
                    not_found, spare == 1 ? "one point is" : fmt::format("{} points are", spare)));
  }
  const bool is_calibrated = found.person.subject != nullptr;
  judgement.AddBeyond(
      is_calibrated ? kCalibratedMeanDistance : kMeanDistance, report.mean_distance,
      fmt::format("the named points are {:.0f} mm from the markers of {}",
                  1000 * report.mean_distance,
                  is_calibrated ? "the subject: another person's, or put on anew since"
                                : "the model of that height"));
  if (named > 0) {
    judgement.AddBeyond(kUnsure, unsure / named,
                        fmt::format("names are sure to {:.0f} % only", 100 * (1 - unsure / named)));
  }
  return judgement.Take();
}

}  // namespace mmm_converter
