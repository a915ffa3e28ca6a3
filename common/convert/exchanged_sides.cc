// SPDX-License-Identifier: MIT
#include "common/convert/exchanged_sides.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/fit/posture_search.h"
#include "common/model/kit_joints.h"

namespace mmm_converter {
namespace {

constexpr int kSideFrames = 8;
constexpr int kSideAttempts = 4;
constexpr double kClearlyNearer = 0.75;  // of the distance with the labels as they are

// Two assignments whose markers are called alike but for the side.
struct Pair {
  int one = -1, other = -1;
  std::string limb;  // "arm", "leg" or neither
};

// The arm or leg that moves the marker; empty: none.
std::string LimbOfMarker(const KinematicModel& model, const MarkerKinematics& kinematics,
                         int marker) {
  for (int j = 0; j < kinematics.num_joints(); ++j) {
    if (!kinematics.Moves(j, marker)) continue;
    const std::string limb = LimbOfJoint(model.joint(kinematics.joints()[j]).name);
    if (limb.ends_with("arm")) return "arm";
    if (limb.ends_with("leg")) return "leg";
  }
  return "";
}

std::vector<Pair> FindPairs(const KinematicModel& model, const MarkerKinematics& kinematics) {
  const std::vector<int> mirrored = MirroredMarkers(model, kinematics.markers());
  std::vector<Pair> pairs;
  for (int m = 0; m < kinematics.num_markers(); ++m) {
    if (mirrored[m] > m) pairs.push_back({m, mirrored[m], LimbOfMarker(model, kinematics, m)});
  }
  return pairs;
}

// Evenly spread ones that show at least half of the markers.
std::vector<Eigen::Matrix3Xd> ChooseFrames(const std::vector<LabelIx>& labels,
                                           const MarkerSequence& recording) {
  std::vector<Eigen::Matrix3Xd> frames;
  for (int part = 0; part < kSideFrames; ++part) {
    const long n = recording.num_frames();
    const int end = static_cast<int>(n * (part + 1) / kSideFrames);
    for (int k = static_cast<int>(n * part / kSideFrames); k < end; ++k) {
      Eigen::Matrix3Xd z = recording.frame(k)(Eigen::all, labels);
      if (2 * (z.row(0).array().isFinite().count()) < z.cols()) continue;
      frames.push_back(std::move(z));
      break;
    }
  }
  return frames;
}

double MeanDistance(const MarkerKinematics& kinematics, const std::vector<Eigen::Matrix3Xd>& frames,
                    const std::vector<int>& order) {
  const Eigen::VectorXd scale = Eigen::VectorXd::Ones(kinematics.num_markers());
  PostureFitOptions options;
  options.robust_distance = 0.1;
  PostureSearch search(kinematics);
  double sum = 0;
  for (const Eigen::Matrix3Xd& frame : frames) {
    Posture posture;
    const Eigen::Matrix3Xd z = frame(Eigen::all, order);
    sum += search.Assemble(z, scale, options, kSideAttempts, &posture).mean_distance;
  }
  return sum / static_cast<double>(frames.size());
}

}  // namespace

std::optional<ExchangedSides> FindExchangedSides(const TrackingSetup& setup,
                                                 const MarkerSequence& recording) {
  const MarkerKinematics kinematics(*setup.model, setup.joints, MarkerIndices(setup.assignments()));
  const std::vector<Pair> pairs = FindPairs(*setup.model, kinematics);
  const std::vector<Eigen::Matrix3Xd> frames =
      ChooseFrames(LabelIndices(setup.assignments()), recording);
  if (pairs.empty() || frames.empty()) return std::nullopt;
  const auto distance_exchanging = [&](const std::string& limb) {
    std::vector<int> order(static_cast<std::size_t>(kinematics.num_markers()));
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    for (const Pair& pair : pairs) {
      if (limb != "all" && pair.limb != limb) continue;
      std::swap(order[static_cast<std::size_t>(pair.one)],
                order[static_cast<std::size_t>(pair.other)]);
    }
    return MeanDistance(kinematics, frames, order);
  };
  constexpr std::pair<const char*, const char*> kParts[] = {
      {"all", "all markers"}, {"arm", "the arms"}, {"leg", "the legs"}};
  const double distance = distance_exchanging("none");
  std::optional<ExchangedSides> found;
  for (const auto& [limb, part] : kParts) {
    const double exchanged = distance_exchanging(limb);
    if (exchanged > kClearlyNearer * distance) continue;
    if (found && found->exchanged_distance <= exchanged) continue;
    found = ExchangedSides{part, distance, exchanged, {}};
    for (const Pair& pair : pairs) {
      if (limb != std::string("all") && pair.limb != limb) continue;
      found->labels.emplace_back(setup.assignments()[pair.one].label,
                                 setup.assignments()[pair.other].label);
    }
  }
  return found;
}

MarkerSequence WithLabelsExchanged(const ExchangedSides& sides, const MarkerSequence& recording) {
  std::vector<std::string> labels = recording.labels();
  for (const auto& [one, other] : sides.labels) std::swap(labels[one], labels[other]);
  MarkerSequence exchanged(labels, recording.num_frames(), recording.rate(),
                           recording.first_time());
  for (int k = 0; k < recording.num_frames(); ++k) exchanged.frame(k) = recording.frame(k);
  return exchanged;
}

}  // namespace mmm_converter
