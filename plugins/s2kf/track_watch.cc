// SPDX-License-Identifier: MIT
#include "plugins/s2kf/track_watch.h"

#include <algorithm>
#include <cmath>

#include "common/model/posture.h"

namespace mmm_converter::s2kf {

namespace {

// A track is in doubt for this many frames after its start or after a cause of doubt.
constexpr int kDoubtFrames = 20;
// So many markers that come back together after having been hidden for longer than this [s] may
// stand where the filter does not expect them.
constexpr int kManyReturned = 3;
constexpr double kLongGap = 0.1;
// Where more than two thirds of those seen were hidden for longer than this [s], the person was,
// not some markers; and where no frame came for so long [s] and so many of the last step.
constexpr double kPersonHidden = 0.05;
constexpr double kHalted = 0.25, kHaltedSteps = 3;
// Distances this much above their usual level are a cause of doubt.
constexpr double kDoubtFactor = 1.15;
constexpr double kDoubtDistance = 0.001;
// The usual level follows with this time constant [s].
constexpr double kLevelTime = 1.0;
// A found posture must lower the cost by this share to replace the filter's: the filter smooths, so
// its posture never has the least cost. It must lower it as much as if every marker came this many
// times its noise nearer, from its place: where little is left of the distances, what the filter
// lags is a large share of it. Markers that are not seen leave a fit free, and a track that is
// smoothed is cut where it is taken up anew: there the mean distance must fall, too, by up to the
// noise of a marker.
constexpr double kClearlyBetter = 0.1;
constexpr double kClearFall = 3;

// Markers left out may be right where there are so many, and are where a posture exists at which
// their mean squared distance is no more than this many times the others'.
constexpr int kManyLeftOut = 2;
constexpr double kAsWell = 4;

}  // namespace

TrackWatch::TrackWatch(double marker_deviation, bool is_smoothed)
    : marker_deviation_(marker_deviation), is_smoothed_(is_smoothed) {}

void TrackWatch::Start(int num_markers, double distance, State* state) const {
  state->hidden_for.assign(num_markers, 0.0);
  state->step = 0;
  state->usual_distance = distance;
  state->is_far = false;
  state->doubt = kDoubtFrames;
}

int TrackWatch::TakeHidden(const Eigen::Matrix3Xd& z, double dt, State* state) const {
  int returned = 0;
  state->step = dt;
  for (std::size_t i = 0; i < state->hidden_for.size(); ++i) {
    double& hidden_for = state->hidden_for[i];
    if (z.col(static_cast<Eigen::Index>(i)).allFinite()) {
      returned += hidden_for > kLongGap;
      hidden_for = 0;
    } else {
      hidden_for += dt;
    }
  }
  return returned;
}

bool TrackWatch::IsInDoubt(const Eigen::Matrix3Xd& z, double distance, double dt,
                           State* state) const {
  const int returned = TakeHidden(z, dt, state);
  const double level = kDoubtFactor * state->usual_distance;
  const bool rises = distance > level + kDoubtDistance;
  state->is_far = distance > level + std::max(kDoubtDistance, marker_deviation_);
  state->doubt = rises || returned >= kManyReturned ? kDoubtFrames : std::max(state->doubt - 1, 0);
  const double step = 1 - std::exp(-dt / kLevelTime);
  state->usual_distance += step * (distance - state->usual_distance);
  return state->doubt > 0;
}

bool TrackWatch::IsBack(const Eigen::Matrix3Xd& z, double dt, const State& state) const {
  const bool halted = dt > kHalted && dt > kHaltedSteps * state.step && state.step > 0;
  int seen = 0, returned = 0;
  for (std::size_t i = 0; i < state.hidden_for.size(); ++i) {
    if (!z.col(static_cast<Eigen::Index>(i)).allFinite()) continue;
    ++seen;
    returned += state.hidden_for[i] > kPersonHidden || halted;
  }
  const int enough = std::max(kFewestMarkers, static_cast<int>(z.cols()) / 3);
  return seen >= enough && 3 * returned > 2 * seen;
}

void TrackWatch::Recovered(double distance, State* state) const {
  state->is_far = false;
  state->usual_distance = std::min(state->usual_distance, distance);
}

bool TrackWatch::IsClearlyBetter(const PostureFit::Result& before, const PostureFit::Result& after,
                                 int seen, int all) const {
  const double fall = kClearFall * marker_deviation_;
  const double least_fall = fall * fall * seen;
  if (before.cost - after.cost < std::max(kClearlyBetter * before.cost, least_fall)) return false;
  const double unseen = 1 - static_cast<double>(seen) / all;
  const double least_gain = (is_smoothed_ ? 1 : std::min(1.0, 2 * unseen)) * marker_deviation_;
  return after.mean_distance <= before.mean_distance - least_gain;
}

bool TrackWatch::MayBeRight(int left_out) const { return left_out >= kManyLeftOut; }

bool TrackWatch::ExplainsLeftOut(double used_cost, int used, double left_out_cost,
                                 int left_out) const {
  return left_out_cost * used <= kAsWell * used_cost * left_out;
}

}  // namespace mmm_converter::s2kf
