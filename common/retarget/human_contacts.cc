// SPDX-License-Identifier: MIT
#include "common/retarget/human_contacts.h"

#include <algorithm>
#include <cmath>

#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

constexpr double kOnHeight = 0.04, kOffHeight = 0.06;  // [m]
constexpr double kOnSpeed = 0.3, kOffSpeed = 0.5;      // [m/s]
constexpr double kShortest = 0.08;                     // [s]
constexpr double kHalfSpan = 0.02;                     // [s] about a frame, of its speed
constexpr double kStands = 0.1;                        // [m/s]
constexpr double kAboveLowest = 0.06;  // [m] of heights that tell the level; more is another one
// Of a foot that stands on what is not the floor: its ends rest, one not far above the other.
constexpr double kRests = 0.2;     // [m/s]
constexpr double kRestsFor = 0.1;  // [s]
constexpr double kFlat = 0.08;     // [m]
constexpr double kUpright = 0.7;   // of its up axis along the world's
// [s], and frames at least, on what is below all else.
constexpr double kLandsFor = 0.03, kLandsFrames = 3;

Eigen::Vector3d At(const Eigen::Matrix3Xd& path, double frame) {
  const auto last = static_cast<double>(path.cols() - 1);
  frame = std::clamp(frame, 0.0, last);
  const auto k = static_cast<Eigen::Index>(frame);
  const Eigen::Index next = std::min(k + 1, path.cols() - 1);
  const double part = frame - static_cast<double>(k);
  return (1 - part) * path.col(k) + part * path.col(next);
}

double LevelOf(const Eigen::Matrix3Xd& path, const Eigen::VectorXd& speed) {
  std::vector<double> heights;
  for (Eigen::Index k = 0; k < speed.size(); ++k) {
    if (speed[k] < kStands) heights.push_back(path(2, k));
  }
  if (heights.empty()) return path.cols() > 0 ? path.row(2).minCoeff() : 0;
  std::sort(heights.begin(), heights.end());
  const double low = heights[heights.size() / 10];
  std::erase_if(heights, [&](double height) { return std::abs(height - low) > kAboveLowest; });
  return Median(heights);
}

std::vector<bool> FindOn(const PointState& point, double rate) {
  const auto frames = static_cast<int>(point.height.size());
  std::vector<bool> on(frames, false);
  for (int k = 0; k < frames; ++k) {
    const bool was = k > 0 && on[k - 1];
    const double height = was ? kOffHeight : kOnHeight, speed = was ? kOffSpeed : kOnSpeed;
    on[k] = point.height[k] < height && point.speed[k] < speed;
  }
  const auto each_run = [&](bool value, const auto& change) {
    for (int begin = 0; begin < frames;) {
      int end = begin + 1;
      while (end < frames && on[end] == on[begin]) ++end;
      if (on[begin] == value && end - begin < kShortest * rate) change(begin, end);
      begin = end;
    }
  };
  each_run(false, [&](int begin, int end) {
    const bool is_low = (point.height.segment(begin, end - begin).array() < kOffHeight).all();
    if (begin > 0 && end < frames && is_low) std::fill(on.begin() + begin, on.begin() + end, true);
  });
  // How long those are that the recording cuts off is not known.
  each_run(true, [&](int begin, int end) {
    if (begin > 0 && end < frames) std::fill(on.begin() + begin, on.begin() + end, false);
  });
  return on;
}

void MoveLevel(double level, PointState* point) {
  point->height.array() += point->level - level;
  point->level = level;
}

/// One floor for both feet: each point's level is its own where they differ by little.
void ShareFloor(std::array<PointState, 2>* points) {
  const double floor = std::min((*points)[0].level, (*points)[1].level);
  for (PointState& point : *points) {
    if (point.level > floor + kAboveLowest) MoveLevel(floor, &point);
  }
}

/// One floor for heels and toes: where the ones stood on a lower step than the others did for long,
/// it is that one, at the height that heels have above toes of feet that rest.
void ShareStep(FootStates* states) {
  std::vector<double> apart;
  for (std::size_t i = 0; i < 2; ++i) {
    const PointState &heel = states->heels[i], &toe = states->toes[i];
    for (Eigen::Index k = 0; k < heel.height.size(); ++k) {
      if (std::max(heel.speed[k], toe.speed[k]) > kRests) continue;
      apart.push_back(heel.height[k] + heel.level - toe.height[k] - toe.level);
    }
  }
  if (apart.empty()) return;
  const double above = Median(apart);
  const double heels = std::min(states->heels[0].level, states->heels[1].level);
  const double toes = std::min(states->toes[0].level, states->toes[1].level);
  if (std::abs(above) > kFlat || std::abs(heels - toes - above) < 2 * kAboveLowest) return;
  const double floor = std::min(heels - above, toes);
  for (PointState& point : states->heels) MoveLevel(floor + above, &point);
  for (PointState& point : states->toes) MoveLevel(floor, &point);
}

/// How far below the floor on which they stand feet rest for a moment.
double StepsBelow(const FootStates& states, double rate) {
  const double least_frames = std::max(kLandsFrames, kLandsFor * rate);
  double below = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const PointState &heel = states.heels[i], &toe = states.toes[i];
    double least = INFINITY, most = 0;  // of the frames that it has rested
    int rested = 0;
    for (Eigen::Index k = 0; k < heel.height.size(); ++k) {
      const double depth = -std::max(heel.height[k], toe.height[k]);
      const bool rests = depth > kAboveLowest && std::max(heel.speed[k], toe.speed[k]) < kRests;
      rested = rests ? rested + 1 : 0;
      least = rests ? std::min(least, depth) : INFINITY;
      most = rests ? std::max(most, depth) : 0;
      if (rested >= least_frames && most - least < kOnHeight) below = std::max(below, least);
    }
  }
  return below;
}

/// Heights of a foot's ends on what it stands on [m]; 0: it stands on the floor, or nowhere.
struct Support {
  Eigen::VectorXd heel, toe;
};

/// Of a foot that is level and rests above the floor: it stands where the other one swings
/// meanwhile, or rests as high. Whoever stands on one leg holds the other foot up.
Support FindSupport(const FootStates& states, const HumanMotion& motion, std::size_t foot) {
  const Eigen::VectorXd &heel = states.heels[foot].height, &toe = states.toes[foot].height;
  const std::size_t other = 1 - foot;
  const auto speed = [&](std::size_t i, Eigen::Index k) {
    return std::max(states.heels[i].speed[k], states.toes[i].speed[k]);
  };
  const auto height = [&](std::size_t i, Eigen::Index k) {
    return 0.5 * (states.heels[i].height[k] + states.toes[i].height[k]);
  };
  const auto rests = [&](Eigen::Index k) {
    const bool is_upright = motion.R_feet[foot].empty() || motion.R_feet[foot][k](2, 2) > kUpright;
    return std::min(heel[k], toe[k]) > kAboveLowest && speed(foot, k) < kRests &&
           std::abs(heel[k] - toe[k]) < kFlat && is_upright;
  };
  const auto bears = [&](Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index k = begin; k < end; ++k) {
      if (speed(other, k) > kOnSpeed) return true;
      if (std::abs(height(other, k) - height(foot, k)) < kOffHeight) return true;
    }
    return false;
  };
  const Eigen::Index frames = heel.size();
  Support support = {Eigen::VectorXd::Zero(frames), Eigen::VectorXd::Zero(frames)};
  for (Eigen::Index begin = 0; begin < frames;) {
    Eigen::Index end = begin;
    while (end < frames && rests(end)) ++end;
    const auto count = static_cast<std::size_t>(end - begin);
    const bool lasts = count > 0 && static_cast<double>(count) >= kRestsFor * motion.rate;
    if (lasts && bears(begin, end)) {
      const double of_heel = Median({heel.data() + begin, count});
      const double of_toe = Median({toe.data() + begin, count});
      const auto take = [&](Eigen::Index k) {
        const double off = std::min(std::abs(heel[k] - of_heel), std::abs(toe[k] - of_toe));
        const double middle = 0.5 * (of_heel + of_toe), z = height(foot, k);
        if (off > kOffHeight || std::abs(z - middle) > std::abs(z)) return false;
        if (support.heel[k] != 0) return false;
        support.heel[k] = of_heel;
        support.toe[k] = of_toe;
        return true;
      };
      for (Eigen::Index k = begin - 1; k >= 0 && take(k);) --k;
      for (Eigen::Index k = begin; k < frames && take(k);) ++k;
    }
    begin = end + 1;
  }
  return support;
}

/// Of frames of which either end is on, on one thing.
void FindStances(const FootStates& states, std::size_t i, FootContacts* foot) {
  bool stands = false;
  for (int k = 0; k < static_cast<int>(foot->heel.size()); ++k) {
    const bool on = foot->heel[k] || foot->toe[k];
    const bool is_other = stands && states.support(i, k) != states.support(i, k - 1);
    if (on && (!stands || is_other)) foot->stances.push_back({k, k});
    if (on) foot->stances.back().end = k + 1;
    stands = on;
  }
}

/// Of `count` frames, the one nearest to frame k at another rate.
Eigen::Index NearestFrame(int k, double from, double to, Eigen::Index count) {
  return std::min<Eigen::Index>(std::lround(k * from / to), count - 1);
}

}  // namespace

PointState StateOf(const Eigen::Matrix3Xd& path, double rate) {
  PointState state;
  state.height.resize(path.cols());
  state.speed.resize(path.cols());
  const double half = kHalfSpan * rate;
  const auto last = static_cast<double>(path.cols() - 1);
  for (Eigen::Index k = 0; k < path.cols(); ++k) {
    const double before = std::max(0.0, static_cast<double>(k) - half);
    const double after = std::min(last, static_cast<double>(k) + half);
    const double way = (At(path, after) - At(path, before)).norm();
    state.speed[k] = after > before ? way * rate / (after - before) : 0;
  }
  state.level = LevelOf(path, state.speed);
  state.height = path.row(2).transpose().array() - state.level;
  return state;
}

FootStates StatesOf(const HumanMotion& motion) {
  FootStates states;
  for (std::size_t i = 0; i < 2; ++i) {
    states.heels[i] = StateOf(motion.heels[i], motion.rate);
    states.toes[i] = StateOf(motion.toes[i], motion.rate);
  }
  ShareFloor(&states.heels);
  ShareFloor(&states.toes);
  ShareStep(&states);
  const double below = StepsBelow(states, motion.rate);
  for (std::size_t i = 0; i < 2; ++i) {
    for (PointState* point : {&states.heels[i], &states.toes[i]}) {
      MoveLevel(point->level - below, point);
    }
  }
  const std::array<Support, 2> found = {FindSupport(states, motion, 0),
                                        FindSupport(states, motion, 1)};
  for (std::size_t i = 0; i < 2; ++i) {
    states.heels[i].height -= found[i].heel;
    states.toes[i].height -= found[i].toe;
    states.supports[i] = 0.5 * (found[i].heel + found[i].toe);
  }
  return states;
}

std::array<FootContacts, 2> FindFootContacts(const FootStates& states, double rate) {
  std::array<FootContacts, 2> feet;
  for (std::size_t i = 0; i < 2; ++i) {
    feet[i].heel = FindOn(states.heels[i], rate);
    feet[i].toe = FindOn(states.toes[i], rate);
    FindStances(states, i, &feet[i]);
  }
  return feet;
}

FootStates AtRate(const FootStates& states, double from, double to, int frames) {
  FootStates other = states;
  const auto sample = [&](const Eigen::VectorXd& of, Eigen::VectorXd* values) {
    if (of.size() == 0) return;
    values->resize(frames);
    for (int k = 0; k < frames; ++k) (*values)[k] = of[NearestFrame(k, from, to, of.size())];
  };
  for (std::size_t i = 0; i < 2; ++i) {
    sample(states.heels[i].height, &other.heels[i].height);
    sample(states.heels[i].speed, &other.heels[i].speed);
    sample(states.toes[i].height, &other.toes[i].height);
    sample(states.toes[i].speed, &other.toes[i].speed);
    sample(states.supports[i], &other.supports[i]);
  }
  return other;
}

std::array<FootContacts, 2> AtRate(const std::array<FootContacts, 2>& contacts,
                                   const FootStates& states, double from, double to) {
  std::array<FootContacts, 2> feet;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto count = static_cast<Eigen::Index>(contacts[i].heel.size());
    for (int k = 0; k < static_cast<int>(states.heels[i].height.size()); ++k) {
      const auto at = static_cast<std::size_t>(NearestFrame(k, from, to, count));
      feet[i].heel.push_back(contacts[i].heel[at]);
      feet[i].toe.push_back(contacts[i].toe[at]);
    }
    FindStances(states, i, &feet[i]);
  }
  return feet;
}

}  // namespace mmm_converter
