// SPDX-License-Identifier: MIT
#include "plugins/s2kf/misplaced_markers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/math/statistics.h"
#include "common/support/units.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3Xd;
using Eigen::MatrixXf;
using Eigen::Vector3d;

namespace {

// A marker may be so many times as far from the middle of its residuals as it is in half of the
// frames: lengths that are not the person's move it in some postures. At least and at
// most [m].
constexpr double kTimes = 5;
constexpr double kLeastAllowed = 0.03;
constexpr double kMostAllowed = 0.12;
constexpr int kFewestFrames = 20;
// It is elsewhere from where it leaves this share of that until it is back within it.
constexpr double kLeaving = 0.5;
// Where more markers than this are elsewhere at the same time, the posture is; and one that leaves
// more often moves with the posture.
constexpr int kMostMarkers = 3;
constexpr int kMostStays = 2;
// Nor may any other at that time, or itself at another time, be this share as far off.
constexpr float kAlone = 0.5F;

constexpr float kNotJudged = std::numeric_limits<float>::quiet_NaN();

std::vector<double> Finite(const Eigen::Ref<const Eigen::VectorXf>& values) {
  std::vector<double> finite;
  for (const float value : values) {
    if (std::isfinite(value)) finite.push_back(value);
  }
  return finite;
}

// What is known of a marker whose residuals these are, 3 x frames: distances from their middle over
// what is allowed.
Eigen::VectorXf ExcessesOf(const Eigen::Matrix3Xf& residuals) {
  Eigen::Vector3f middle;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double> samples = Finite(residuals.row(axis).transpose());
    if (samples.size() < kFewestFrames) {
      return Eigen::VectorXf::Constant(residuals.cols(), kNotJudged);
    }
    middle[axis] = static_cast<float>(Median(samples));
  }
  const Eigen::VectorXf apart = (residuals.colwise() - middle).colwise().norm().transpose();
  const double allowed = std::clamp(kTimes * Median(Finite(apart)), kLeastAllowed, kMostAllowed);
  return apart / static_cast<float>(allowed);
}

}  // namespace

MisplacedMarkers::MisplacedMarkers(const MarkerSequence& recording, const TrackedMarkers& markers)
    : recording_(recording), markers_(markers) {
  verdicts_.setConstant(markers.kinematics().num_markers(), recording.num_frames(), kAsLabelled);
}

MatrixXf MisplacedMarkers::Excesses(const ConversionResult& result) const {
  const MarkerKinematics& kinematics = markers_.kinematics();
  const int frames = recording_.num_frames();
  std::vector<Eigen::Matrix3Xf> residuals(kinematics.num_markers(), Eigen::Matrix3Xf(3, frames));
  MarkerJacobian at = kinematics.MakeJacobian();
  Matrix3Xd measured(3, kinematics.num_markers());
  bool is_early = true;  // not tracked yet
  for (int k = 0; k < frames; ++k) {
    is_early = is_early && result.residuals.col(k).array().isNaN().all();
    const Posture& q = result.trajectory.postures[k];
    kinematics.ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles, &at);
    markers_.Gather(recording_.frame(k), &measured);
    for (int m = 0; m < kinematics.num_markers(); ++m) {
      const Vector3d r_W = measured.col(m) - at.p_WM.col(m);
      const Vector3d r = at.R_WL[kinematics.link_of_marker(m)].transpose() * r_W;
      residuals[m].col(k) = r.cast<float>();
      if (is_early || verdicts_(m, k) != kAsLabelled) residuals[m].col(k).setConstant(kNotJudged);
    }
  }
  for (const MarkerIncident& incident : result.incidents) {
    if (incident.kind != MarkerIncident::Kind::kSwapped) continue;
    const int count = incident.last_frame - incident.first_frame + 1;
    for (const int m : {incident.assignment, incident.other}) {
      residuals[m].middleCols(incident.first_frame, count).setConstant(kNotJudged);
    }
  }
  MatrixXf excesses(kinematics.num_markers(), frames);
  for (int m = 0; m < kinematics.num_markers(); ++m) excesses.row(m) = ExcessesOf(residuals[m]);
  for (int k = 0; k < frames; ++k) {
    const auto elsewhere = (excesses.col(k).array() > 1).count();
    if (elsewhere > kMostMarkers) excesses.col(k).setConstant(kNotJudged);
  }
  return excesses;
}

std::vector<MisplacedMarkers::Stay> MisplacedMarkers::FindStays(const MatrixXf& excesses) {
  const int frames = static_cast<int>(excesses.cols());
  const auto is_there = [&](int m, int k) { return excesses(m, k) <= kLeaving; };
  std::vector<Stay> stays;
  for (int m = 0; m < excesses.rows(); ++m) {
    const std::size_t first = stays.size();
    for (int k = 0; k < frames; ++k) {
      if (!(excesses(m, k) > 1)) continue;
      Stay stay = {m, k, k + 1, 0};
      while (stay.begin > 0 && !is_there(m, stay.begin - 1)) --stay.begin;
      while (stay.end < frames && !is_there(m, stay.end)) ++stay.end;
      for (k = stay.begin; k < stay.end; ++k) {
        if (excesses(m, k) > stay.farthest) stay.farthest = excesses(m, k);
      }
      stays.push_back(stay);
    }
    if (stays.size() > first + kMostStays) stays.erase(stays.begin() + first, stays.end());
  }
  return stays;
}

bool MisplacedMarkers::Find(const ConversionResult& result) {
  const MatrixXf excesses = Excesses(result);
  const std::vector<Stay> stays = FindStays(excesses);
  bool is_any = false;
  for (const Stay& stay : stays) {
    const bool is_alone = std::all_of(stays.begin(), stays.end(), [&](const Stay& other) {
      const bool is_meanwhile = other.begin < stay.end && stay.begin < other.end;
      return !is_meanwhile || other.marker == stay.marker ||
             other.farthest <= kAlone * stay.farthest;
    });
    if (!is_alone) continue;
    Eigen::VectorXf own = excesses.row(stay.marker);
    for (const Stay& other : stays) {
      if (other.marker == stay.marker) own.segment(other.begin, other.end - other.begin).setZero();
    }
    if ((own.array() > kAlone * stay.farthest).any()) continue;
    verdicts_.row(stay.marker).segment(stay.begin, stay.end - stay.begin).setConstant(stay.marker);
    is_any = true;
  }
  return is_any;
}

MarkerSequence MisplacedMarkers::Without() const {
  MarkerSequence without = recording_;
  for (int k = 0; k < without.num_frames(); ++k) {
    for (int m = 0; m < verdicts_.rows(); ++m) {
      if (verdicts_(m, k) != kAsLabelled) {
        without.frame(k).col(markers_.label(m)).setConstant(kNaN);
      }
    }
  }
  return without;
}

void MisplacedMarkers::Tell(ConversionResult* result) const {
  const MarkerKinematics& kinematics = markers_.kinematics();
  MarkerJacobian at = kinematics.MakeJacobian();
  Matrix3Xd measured(3, kinematics.num_markers());
  Eigen::MatrixXi verdicts = verdicts_;
  for (int k = 0; k < recording_.num_frames(); ++k) {
    if ((verdicts_.col(k).array() == kAsLabelled).all()) continue;
    const Posture& q = result->trajectory.postures[k];
    kinematics.ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles, &at);
    markers_.Gather(recording_.frame(k), &measured);
    for (int m = 0; m < kinematics.num_markers(); ++m) {
      if (verdicts_(m, k) == kAsLabelled) continue;
      if (!measured.col(m).allFinite()) {
        verdicts(m, k) = kAsLabelled;
        continue;
      }
      result->residuals(m, k) = (measured.col(m) - at.p_WM.col(m)).norm();
      ++result->frames[k].markers_seen;
      ++result->frames[k].markers_wrong;
    }
  }
  for (const MarkerIncident& incident : result->incidents) {
    const int count = incident.last_frame - incident.first_frame + 1;
    const bool is_swap = incident.kind == MarkerIncident::Kind::kSwapped;
    const int other = is_swap ? incident.other : incident.assignment;
    verdicts.row(incident.assignment).segment(incident.first_frame, count).setConstant(other);
    verdicts.row(other).segment(incident.first_frame, count).setConstant(incident.assignment);
  }
  result->incidents = FindIncidents(verdicts, BridgedFrames(recording_.rate()));
}

}  // namespace mmm_converter::s2kf
