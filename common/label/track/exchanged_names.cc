// SPDX-License-Identifier: MIT
#include "common/label/track/exchanged_names.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/label/search/body_match.h"
#include "common/label/search/posture_step.h"
#include "common/label/tuning.h"
#include "common/math/square.h"
#include "common/motion/marker_sequence.h"
#include "common/support/units.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

ExchangedNames::ExchangedNames(const LabelBody& body, const PointTracks& tracks, int first_marker)
    : body_(body),
      tracks_(tracks),
      first_marker_(first_marker),
      equations_(body.kinematics),
      at_(body.kinematics.MakeJacobian()),
      scatter_((body.skin.array().square() + Square(ExchangeTuning::kModelScatter)).sqrt()),
      offset_(Matrix3Xd::Zero(3, body.num_markers())),
      offset_W_(offset_) {}

void ExchangedNames::AddFrame(int frame, const Posture& posture) {
  const Matrix3Xd unseen = Matrix3Xd::Constant(3, body_.num_markers(), kNaN);
  frames_.push_back({frame, posture, unseen, unseen, unseen});
}

void ExchangedNames::Read(const TrackNames& names) {
  for (Frame& frame : frames_) {
    const FramePoints& points = tracks_.frames[frame.k];
    for (std::size_t p = 0; p < points.tracks.size(); ++p) {
      const int m = names.markers[points.tracks[p]] - first_marker_;
      if (m < 0 || m >= body_.num_markers()) continue;
      frame.z.col(m) = points.p_WP.col(static_cast<Eigen::Index>(p));
    }
  }
}

void ExchangedNames::Look(Frame* frame) {
  const Posture& posture = frame->posture;
  body_.kinematics.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                                  posture.joint_angles, &at_);
  frame->places = at_.p_WM;
  for (int m = 0; m < body_.num_markers(); ++m) {
    const Eigen::Matrix3d& R_WL = at_.R_WL[body_.kinematics.link_of_marker(m)];
    offset_W_.col(m) = R_WL * offset_.col(m);
    frame->residual.col(m) = R_WL.transpose() * (frame->z.col(m) - at_.p_WM.col(m));
  }
}

void ExchangedNames::Fit(Frame* frame) {
  for (int i = 0; i < ExchangeTuning::kSteps; ++i) {
    Look(frame);
    equations_.Place(frame->posture);
    targets_ = frame->z - offset_W_;
    StepTowards(targets_, scatter_, ExchangeTuning::kRobustDistance, body_, &equations_,
                &frame->posture);
  }
  Look(frame);
}

void ExchangedNames::PlaceMarkers(const Frames& frames) {
  for (int m = 0; m < body_.num_markers(); ++m) {
    const double variance = Square(scatter_[m]);
    Vector3d sum = Vector3d::Zero();
    double information = variance / Square(body_.place[m]);
    for (const Frame* frame : frames) {
      const Vector3d r = frame->residual.col(m);
      if (!IsSeen(r)) continue;
      // Those far from most count less.
      const double weight =
          std::min(1.0, ExchangeTuning::kFarthest * variance / (r - offset_.col(m)).squaredNorm());
      sum += weight * r;
      information += weight;
    }
    offset_.col(m) = sum / information;
  }
}

double ExchangedNames::Cost(const Frames& frames) const {
  double cost =
      (offset_.colwise().squaredNorm().transpose().array() / body_.place.array().square()).sum();
  for (const Frame* frame : frames) {
    for (int m = 0; m < body_.num_markers(); ++m) {
      const Vector3d r = frame->residual.col(m);
      if (!IsSeen(r)) continue;
      cost += std::min(ExchangeTuning::kFarthest,
                       (r - offset_.col(m)).squaredNorm() / Square(scatter_[m]));
    }
    cost += MatchCosts::kNaturalWeight *
            (frame->posture.joint_angles - body_.natural_angles).squaredNorm();
  }
  return cost;
}

bool ExchangedNames::AreNear(int a, int b) const {
  double sum = 0;
  for (const Frame& frame : frames_) sum += (frame.places.col(a) - frame.places.col(b)).norm();
  return sum < ExchangeTuning::kNearEachOther * static_cast<double>(frames_.size());
}

std::vector<ExchangedNames::Trial> ExchangedNames::Trials(const TrackNames& names) const {
  std::vector<std::vector<int>> tracks_of(static_cast<std::size_t>(body_.num_markers()));
  for (std::size_t t = 0; t < names.markers.size(); ++t) {
    const int m = names.markers[t] - first_marker_;
    if (m >= 0 && m < body_.num_markers()) tracks_of[m].push_back(static_cast<int>(t));
  }
  std::vector<Trial> trials;
  for (int a = 0; a < body_.num_markers(); ++a) {
    for (int b = a + 1; b < body_.num_markers(); ++b) {
      if (!AreNear(a, b)) continue;
      std::vector<int> tracks = tracks_of[a];
      tracks.insert(tracks.end(), tracks_of[b].begin(), tracks_of[b].end());
      if (tracks.empty()) continue;
      std::sort(tracks.begin(), tracks.end(),
                [this](int s, int t) { return tracks_.tracks[s].begin < tracks_.tracks[t].begin; });
      std::vector<Trial> parts;
      for (const int t : tracks) {
        const PointTrack& track = tracks_.tracks[t];
        if (parts.empty() || track.begin >= parts.back().end) {
          parts.push_back({a, b, track.begin, track.end});
        }
        parts.back().end = std::max(parts.back().end, track.end);
      }
      trials.push_back({a, b, parts.front().begin, parts.back().end});
      if (parts.size() > 1) trials.insert(trials.end(), parts.begin(), parts.end());
    }
  }
  return trials;
}

void ExchangedNames::FitAll() {
  Frames all;
  for (const Frame& frame : frames_) all.push_back(&frame);
  for (int i = 0; i < ExchangeTuning::kTurns; ++i) {
    for (Frame& frame : frames_) Fit(&frame);
    PlaceMarkers(all);
  }
  cost_ = Cost(all);
}

bool ExchangedNames::Try(const Trial& trial) {
  std::vector<Frame> changed;
  Frames frames;
  for (const Frame& frame : frames_) {
    const bool is_seen = IsSeen(frame.z.col(trial.a)) || IsSeen(frame.z.col(trial.b));
    if (is_seen && frame.k >= trial.begin && frame.k < trial.end) {
      changed.push_back(frame);
      changed.back().z.col(trial.a).swap(changed.back().z.col(trial.b));
    } else {
      frames.push_back(&frame);
    }
  }
  if (changed.size() < ExchangeTuning::kFewestFrames) return false;
  for (const Frame& frame : changed) frames.push_back(&frame);
  const Matrix3Xd before = offset_;
  for (Frame& frame : changed) Look(&frame);
  PlaceMarkers(frames);
  double cost = 0;
  for (int i = 0; i < ExchangeTuning::kTurnsOfATrial; ++i) {
    for (Frame& frame : changed) Fit(&frame);
    PlaceMarkers(frames);
    cost = Cost(frames);
    if (cost > cost_ + ExchangeTuning::kHopeless) break;
  }
  if (cost > cost_ - ExchangeTuning::kLeastGain) {
    offset_ = before;
    return false;
  }
  for (Frame& frame : changed) {
    const auto own = std::find_if(frames_.begin(), frames_.end(),
                                  [&frame](const Frame& other) { return other.k == frame.k; });
    *own = std::move(frame);
  }
  FitAll();
  return true;
}

void ExchangedNames::Improve(TrackNames* names) {
  Read(*names);
  FitAll();
  bool is_better = true;
  for (int pass = 0; pass < ExchangeTuning::kMostPasses && is_better; ++pass) {
    is_better = false;
    for (const Trial& trial : Trials(*names)) {
      if (!Try(trial)) continue;
      is_better = true;
      const int a = first_marker_ + trial.a, b = first_marker_ + trial.b;
      for (std::size_t t = 0; t < names->markers.size(); ++t) {
        const PointTrack& track = tracks_.tracks[t];
        if (track.begin >= trial.end || track.end <= trial.begin) continue;
        int& marker = names->markers[t];
        if (marker == a || marker == b) marker = a + b - marker;
      }
    }
  }
}

}  // namespace mmm_converter
