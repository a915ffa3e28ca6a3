// SPDX-License-Identifier: MIT
#include "common/motion/foot_states.h"

#include <algorithm>
#include <cmath>

#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

constexpr double kLandingFrames = 3;    // at least
constexpr double kTimeRounding = 1e-6;  // of a frame: times are rounded

/// Where an end of a foot is while the foot stands.
double FindLevel(const FootPath& foot, const Eigen::Matrix3Xd& path, const Eigen::VectorXd& speed) {
  for (const double slow : {kStillSpeed, kComesBelow}) {  // a runner's foot is hardly still
    std::vector<double> heights;
    for (Eigen::Index k = 0; k < speed.size(); ++k) {
      if (speed[k] < slow && foot.IsUpright(k)) heights.push_back(path(2, k));
    }
    if (heights.empty()) continue;
    std::sort(heights.begin(), heights.end());
    const double low = heights[heights.size() / 10];
    std::erase_if(heights, [&](double height) { return std::abs(height - low) > kLowHeight; });
    return Median(heights);
  }
  return path.cols() > 0 ? path.row(2).minCoeff() : 0;
}

/// is_on: the frames of the foot's contacts.
std::vector<bool> FindRest(const PointState& point, const std::vector<bool>& is_on, double rate) {
  const auto frames = static_cast<int>(point.height.size());
  std::vector<bool> rest(frames, false);
  for (int k = 0; k < frames; ++k) {
    const bool was = k > 0 && rest[k - 1];
    const double height = was ? kLowHeight : kRestHeight;
    const double speed = was ? kEndOfRestSpeed : kRestSpeed;
    rest[k] = is_on[k] && point.height[k] < height && point.speed[k] < speed;
  }
  for (int begin = 0; begin < frames;) {
    int end = begin + 1;
    while (end < frames && rest[end] == rest[begin]) ++end;
    bool stays = rest[begin] || begin == 0 || end == frames || end - begin >= kRestGap * rate;
    for (int k = begin; k < end && !stays; ++k) {
      stays = !is_on[k] || !(point.height[k] < kLowHeight);
    }
    if (!stays) std::fill(rest.begin() + begin, rest.begin() + end, true);
    begin = end;
  }
  return rest;
}

void MoveLevel(double level, PointState* point) {
  point->height.array() += point->level - level;
  point->level = level;
}

/// One floor for both feet: where both ends of a foot only stood on a higher step than the other
/// foot's did. One end alone is as high as the person's model has it.
void ShareFloor(FootStates* states) {
  for (std::size_t i = 0; i < 2; ++i) {
    const double heel = states->heels[1 - i].level, toe = states->toes[1 - i].level;
    if (states->heels[i].level <= heel + kLowHeight) continue;
    if (states->toes[i].level <= toe + kLowHeight) continue;
    MoveLevel(heel, &states->heels[i]);
    MoveLevel(toe, &states->toes[i]);
  }
}

/// One floor for heels and toes: where the ones stood on a lower step than the others did for long,
/// it is that one, at the height that heels have above toes of feet that rest.
void ShareStep(FootStates* states) {
  std::vector<double> apart;
  for (std::size_t i = 0; i < 2; ++i) {
    const PointState &heel = states->heels[i], &toe = states->toes[i];
    for (Eigen::Index k = 0; k < heel.height.size(); ++k) {
      if (std::max(heel.speed[k], toe.speed[k]) > kStepSpeed) continue;
      apart.push_back(heel.height[k] + heel.level - toe.height[k] - toe.level);
    }
  }
  if (apart.empty()) return;
  const double above = Median(apart);
  const double heels = std::min(states->heels[0].level, states->heels[1].level);
  const double toes = std::min(states->toes[0].level, states->toes[1].level);
  if (std::abs(above) > kLevelFoot || std::abs(heels - toes - above) < 2 * kLowHeight) return;
  const double floor = std::min(heels - above, toes);
  for (PointState& point : states->heels) MoveLevel(floor + above, &point);
  for (PointState& point : states->toes) MoveLevel(floor, &point);
}

/// How far below the floor on which they stand feet rest for a moment.
double StepsBelow(const FootStates& states, double rate) {
  const double least_frames = std::max(kLandingFrames, kLandingTime * rate);
  double below = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const PointState &heel = states.heels[i], &toe = states.toes[i];
    double least = INFINITY, most = 0;  // of the frames that it has rested
    int rested = 0;
    for (Eigen::Index k = 0; k < heel.height.size(); ++k) {
      const double depth = -std::max(heel.height[k], toe.height[k]);
      const bool rests = depth > kLowHeight && std::max(heel.speed[k], toe.speed[k]) < kStepSpeed;
      rested = rests ? rested + 1 : 0;
      least = rests ? std::min(least, depth) : INFINITY;
      most = rests ? std::max(most, depth) : 0;
      if (rested >= least_frames && most - least < kRestHeight) below = std::max(below, least);
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
Support FindSupport(const FootStates& states, const FootMotion& motion, std::size_t foot) {
  const Eigen::VectorXd &heel = states.heels[foot].height, &toe = states.toes[foot].height;
  const std::size_t other = 1 - foot;
  const auto speed = [&](std::size_t i, Eigen::Index k) {
    return std::max(states.heels[i].speed[k], states.toes[i].speed[k]);
  };
  const auto height = [&](std::size_t i, Eigen::Index k) {
    return 0.5 * (states.heels[i].height[k] + states.toes[i].height[k]);
  };
  const auto rests = [&](Eigen::Index k) {
    return std::min(heel[k], toe[k]) > kLowHeight && speed(foot, k) < kStepSpeed &&
           std::abs(heel[k] - toe[k]) < kLevelFoot && motion.feet[foot].IsUpright(k);
  };
  const auto bears = [&](Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index k = begin; k < end; ++k) {
      if (speed(other, k) > kRestSpeed) return true;
      if (std::abs(height(other, k) - height(foot, k)) < kLowHeight) return true;
    }
    return false;
  };
  const Eigen::Index frames = heel.size();
  Support support = {Eigen::VectorXd::Zero(frames), Eigen::VectorXd::Zero(frames)};
  for (Eigen::Index begin = 0; begin < frames;) {
    Eigen::Index end = begin;
    while (end < frames && rests(end)) ++end;
    const auto count = static_cast<std::size_t>(end - begin);
    const bool lasts = count > 0 && static_cast<double>(count) >= kStepTime * motion.rate;
    if (lasts && bears(begin, end)) {
      const double of_heel = Median({heel.data() + begin, count});
      const double of_toe = Median({toe.data() + begin, count});
      const auto take = [&](Eigen::Index k) {
        const double off = std::min(std::abs(heel[k] - of_heel), std::abs(toe[k] - of_toe));
        const double middle = 0.5 * (of_heel + of_toe), z = height(foot, k);
        if (off > kLowHeight || std::abs(z - middle) > std::abs(z)) return false;
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
void FindStances(const FootStates& states, std::size_t i, FootRests* foot) {
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

PointState StateOf(const FootPath& foot, const Eigen::Matrix3Xd& path,
                   const Eigen::VectorXd& speed) {
  PointState state;
  state.speed = speed;
  state.level = FindLevel(foot, path, speed);
  state.height = path.row(2).transpose().array() - state.level;
  return state;
}

}  // namespace

std::vector<bool> FootContacts::StandingFrames(Side side, double first_time, double rate,
                                               int frames) const {
  std::vector<bool> stands(static_cast<std::size_t>(frames), false);
  const auto frame = [&](double time) { return (time - first_time) * rate; };
  for (const FootContact& one : contacts) {
    if (one.side != side) continue;
    const double begin = one.begin ? std::ceil(frame(*one.begin) - kTimeRounding) : 0;
    const double end = one.end ? std::floor(frame(*one.end) + kTimeRounding) : frames - 1.0;
    const auto first = static_cast<std::ptrdiff_t>(std::clamp<double>(begin, 0, frames));
    const auto behind = static_cast<std::ptrdiff_t>(std::clamp<double>(end + 1, 0, frames));
    if (first < behind) std::fill(stands.begin() + first, stands.begin() + behind, true);
  }
  return stands;
}

FootStates FindFootStates(const FootMotion& motion) {
  FootStates states;
  for (std::size_t i = 0; i < 2; ++i) {
    const FootPath& foot = motion.feet[i];
    states.heels[i] = StateOf(foot, foot.heel, foot.heel_speed);
    states.toes[i] = StateOf(foot, foot.toe, foot.toe_speed);
  }
  ShareFloor(&states);
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

std::array<FootRests, 2> FindRests(const FootMotion& motion, const FootStates& states,
                                   const FootContacts& contacts) {
  std::array<FootRests, 2> feet;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::vector<bool> on =
        contacts.StandingFrames(kSides[i], motion.first_time, motion.rate, motion.num_frames());
    feet[i].heel = FindRest(states.heels[i], on, motion.rate);
    feet[i].toe = FindRest(states.toes[i], on, motion.rate);
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

std::array<FootRests, 2> AtRate(const std::array<FootRests, 2>& rests, const FootStates& states,
                                double from, double to) {
  std::array<FootRests, 2> feet;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto count = static_cast<Eigen::Index>(rests[i].heel.size());
    for (int k = 0; k < static_cast<int>(states.heels[i].height.size()); ++k) {
      const auto at = static_cast<std::size_t>(NearestFrame(k, from, to, count));
      feet[i].heel.push_back(rests[i].heel[at]);
      feet[i].toe.push_back(rests[i].toe[at]);
    }
    FindStances(states, i, &feet[i]);
  }
  return feet;
}

}  // namespace mmm_converter
