// SPDX-License-Identifier: MIT
#include "common/retarget/foot_figures.h"

#include <algorithm>
#include <cmath>

namespace mmm_converter {
namespace {

constexpr double kBears = 0.002;       // [m] above the foot's lowest point
constexpr double kEnds = 0.05;         // [s] of a contact that floating leaves out
constexpr double kOthersRate = 30;     // [Hz]
constexpr double kOthersSlide = 0.01;  // [m] a frame

std::vector<bool> ContactsOf(const Retargeted& retargeted, std::size_t foot) {
  const PoseTrajectory& motion = retargeted.motion;
  std::vector<bool> contact = retargeted.contacts.StandingFrames(
      kSides[foot], motion.first_time, motion.rate, retargeted.human.num_frames());
  for (int k = 0; k < retargeted.human.num_frames(); ++k) {
    contact[k] = contact[k] && (IsAtRest(retargeted.states.heels[foot], k) ||
                                IsAtRest(retargeted.states.toes[foot], k));
  }
  return contact;
}

struct Counts {
  int pairs = 0, slides = 0, labels = 0, toe_slides = 0, contacts = 0, heights = 0;
  double height = 0;
};

void CountFloating(const std::vector<bool>& contact, const Eigen::VectorXd& lowest, double rate,
                   Counts* counts) {
  const int ends = static_cast<int>(std::lround(kEnds * rate));
  const int frames = static_cast<int>(contact.size());
  for (int begin = 0; begin < frames;) {
    int end = begin + 1;
    while (end < frames && contact[end] == contact[begin]) ++end;
    for (int k = begin + ends; contact[begin] && k < end - ends; ++k) {
      counts->height += lowest[k];
      ++counts->heights;
    }
    begin = end;
  }
}

Eigen::Vector3d Between(const Eigen::Matrix3Xd& path, double frame) {
  const auto k = static_cast<Eigen::Index>(frame);
  const double part = frame - static_cast<double>(k);
  return (1 - part) * path.col(k) + part * path.col(std::min(k + 1, path.cols() - 1));
}

void CountOthersRule(const Eigen::Matrix3Xd& human, const Eigen::Matrix3Xd& robot, double rate,
                     Counts* counts) {
  const double step = rate / kOthersRate;
  const auto last = static_cast<double>(human.cols() - 1);
  for (double at = 0; at + step <= last; at += step) {
    if ((Between(human, at + step) - Between(human, at)).norm() > kOthersSlide) continue;
    ++counts->labels;
    if ((Between(robot, at + step) - Between(robot, at)).norm() > kOthersSlide) {
      ++counts->toe_slides;
    }
  }
}

}  // namespace

double WayOf(const RobotFoot& foot, const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  const double low_from = LowestOf(foot, from) + kBears, low_to = LowestOf(foot, to) + kBears;
  double largest = -1, smallest = INFINITY;
  for (const FloorBall& ball : foot.bearing) {
    const Eigen::Vector3d p_S = ball.p_S - ball.radius * foot.R_FA.col(2);
    const Eigen::Vector3d before = from * p_S, after = to * p_S;
    const double way = (after - before).head<2>().norm();
    const bool first = before.z() < low_from, second = after.z() < low_to;
    if (first && second) largest = std::max(largest, way);
    if (first || second) smallest = std::min(smallest, way);
  }
  if (largest >= 0) return largest;
  return std::isinf(smallest) ? 0 : smallest;
}

void MeasureFeet(const Retargeted& retargeted, const RobotBody& body, const PosesOverTime& X_WS,
                 RetargetFigures* figures) {
  Counts counts;
  const double rate = retargeted.human.rate;
  const int frames = static_cast<int>(X_WS.size());
  for (std::size_t i = 0; i < 2; ++i) {
    const RobotFoot& foot = (*body.feet)[i];
    const std::vector<bool> contact = ContactsOf(retargeted, i);
    Eigen::VectorXd& lowest = figures->feet[i].height;
    Eigen::VectorXd& speed = figures->feet[i].speed;
    lowest.resize(frames);
    speed.setConstant(frames, NAN);
    Eigen::Matrix3Xd toe(3, frames);
    for (int k = 0; k < frames; ++k) {
      const Eigen::Isometry3d& X = X_WS[k][foot.segment];
      lowest[k] = LowestOf(foot, X);
      toe.col(k) = X * foot.toe;
      if (contact[k]) ++counts.contacts;
      // Into the floor, or what it stands on.
      const double support = retargeted.scale * retargeted.states.support(i, k);
      const double depth = (contact[k] ? support : 0) - lowest[k];
      if (depth > figures->penetration) {
        figures->penetration = depth;
        figures->penetration_time = retargeted.motion.time(k);
      }
      if (k == 0 || !contact[k] || !contact[k - 1]) continue;
      ++counts.pairs;
      speed[k] = WayOf(foot, X_WS[k - 1][foot.segment], X) * rate;
      if (speed[k] > kSlideSpeed) ++counts.slides;
    }
    for (int k = 0; k < frames; ++k) {
      const double support = retargeted.scale * retargeted.states.support(i, k);
      lowest[k] -= support;
      if (contact[k]) figures->highest_stance = std::max(figures->highest_stance, support);
    }
    CountFloating(contact, lowest, rate, &counts);
    CountOthersRule(retargeted.human.toes[i], toe, rate, &counts);
  }
  const auto share = [](double part, double whole) { return whole > 0 ? part / whole : NAN; };
  figures->contact_share = share(counts.contacts, 2.0 * frames);
  figures->slide = share(counts.slides, counts.pairs);
  figures->toe_slide = share(counts.toe_slides, counts.labels);
  figures->floating = share(counts.height, counts.heights);
}

}  // namespace mmm_converter
