// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <complex>

#include "common/math/rotation.h"
#include "common/math/statistics.h"
#include "common/retarget/foot_turns.h"
#include "common/retarget/retarget_targets.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr double kPitchSmoothing = 0.025;  // [s]
constexpr double kLongestDraw = 0.5;       // [s] in which a swing leaves or reaches a place
constexpr double kSoftness = 0.04;         // [rad] of feet in the first pass
constexpr double kLift = 0.06;             // [s] from a stance to the person's full clearance

/// Below the ankle, W.
Vector3d HumanSole(const HumanMotion& human, double ankle_height, std::size_t foot, int k) {
  return human.bodies[k].legs[foot].distal - ankle_height * human.R_feet[foot][k].col(2);
}

double SoleLevel(const Retargeted& retargeted, double ankle_height, std::size_t foot) {
  std::vector<double> standing, all;
  for (int k = 0; k < retargeted.human.num_frames(); ++k) {
    all.push_back(HumanSole(retargeted.human, ankle_height, foot, k).z() -
                  retargeted.states.support(foot, k));
    if (retargeted.rests[foot].heel[k]) standing.push_back(all.back());
  }
  return standing.empty() ? Percentile(all, 5) : Median(standing);
}

/// Of the lower end of the person's foot above where that stands on the floor, by frame [m]; 0 in
/// stances, from which it grows.
std::vector<double> ClearancesOf(const Retargeted& retargeted, std::size_t foot) {
  const HumanMotion& human = retargeted.human;
  const FootStates& states = retargeted.states;
  std::vector<double> away(human.num_frames(), INFINITY), clearances;  // from a stance [frames]
  for (const FrameInterval& stance : retargeted.rests[foot].stances) {
    for (int k = 0; k < human.num_frames(); ++k) {
      const int from = std::max({0, stance.begin - k, k - stance.end + 1});
      away[k] = std::min(away[k], static_cast<double>(from));
    }
  }
  for (int k = 0; k < human.num_frames(); ++k) {
    if (away[k] == 0) {
      clearances.push_back(0);
      continue;
    }
    const double heel = human.heels[foot](2, k) - states.heels[foot].level;
    const double toe = human.toes[foot](2, k) - states.toes[foot].level;
    const double share = std::min(1.0, away[k] / (kLift * human.rate));
    clearances.push_back(share * std::max(0.0, std::min(heel, toe)));
  }
  return clearances;
}

/// What of an angle is more than a fit's softness: the robot's joints do not allow a flat foot.
double Unavoidable(double angle) {
  return std::copysign(std::max(0.0, std::abs(angle) - kSoftness), angle);
}

std::vector<double> Smoothed(const std::vector<double>& values, double sigma) {
  const int reach = static_cast<int>(std::ceil(3 * sigma));
  const int count = static_cast<int>(values.size());
  std::vector<double> smooth(values.size());
  for (int k = 0; k < count; ++k) {
    double sum = 0, weights = 0;
    for (int i = std::max(0, k - reach); i <= std::min(count - 1, k + reach); ++i) {
      const double weight = std::exp(-0.5 * (i - k) * (i - k) / (sigma * sigma));
      sum += weight * values[i];
      weights += weight;
    }
    smooth[k] = sum / weights;
  }
  return smooth;
}

/// Adds to frames from an end of a stance on, away from it, what is missing there, fading.
/// step: +1 behind the stance, -1 before it; others: where the next stance ends that way.
void DrawSwing(const FootTrack& pass, const FootTrack& anchored, int edge, int step, int limit,
               double rate, std::vector<FootDifference>* draws) {
  const int length = std::min(std::abs(limit - edge), static_cast<int>(kLongestDraw * rate));
  if (length < 2) return;
  const auto missing = [&](int k) { return Difference(pass.X_WF[k], anchored.X_WF[k]); };
  const FootDifference value = missing(edge);
  FootDifference slope = FootDifference::Zero();
  const int inside = edge - step;
  if (inside >= 0 && inside < static_cast<int>(pass.stands.size()) && anchored.stands[inside]) {
    slope = (value - missing(inside)) * length;
  }
  for (int i = 1; i < length; ++i) {
    const double t = static_cast<double>(i) / length;
    for (int j = 0; j < 6; ++j) (*draws)[edge + step * i][j] += Fading(value[j], slope[j], t);
  }
}

/// Places of a stance's frames, on what is `support` above the floor [m]; the flat foot's place and
/// direction are averages.
void Anchor(const RobotFoot& foot, const FootTrack& pass, const std::vector<double>& pitch,
            const std::vector<double>& roll, const FrameInterval& stance, double support,
            FootTrack* track) {
  const Eigen::Matrix3d R_AF = foot.R_FA.transpose();
  std::complex<double> direction = 0;
  for (int k = stance.begin; k < stance.end; ++k) {
    const Vector3d left = pass.X_WF[k].linear() * foot.R_FA.col(1);
    direction += std::polar(1.0, std::atan2(-left.x(), left.y()));
  }
  const double yaw = std::arg(direction);
  const Eigen::AngleAxisd R_WY(yaw, Vector3d::UnitZ());
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  for (int k = stance.begin; k < stance.end; ++k) {
    const Vector3d pivot = pitch[k] > 0 ? foot.toe : foot.heel;
    const Vector3d flat = pass.X_WF[k] * pivot - R_WY * (R_AF * (pivot - foot.sole));
    place += flat.head<2>() / (stance.end - stance.begin);
  }
  for (int k = stance.begin; k < stance.end; ++k) {
    track->X_WF[k] = StandingFoot(foot, place, yaw, pitch[k], roll[k]);
    track->X_WF[k].translation().z() += support;
  }
}

}  // namespace

Eigen::Isometry3d PlaceFoot(const ScaledFoot& of, const RobotBody& body, std::size_t i) {
  const RobotFoot& foot = (*body.feet)[i];
  const BodyPosture& person = *of.person;
  Vector3d place = person.legs[i].distal - of.ankle_height * of.R_foot.col(2);
  place.z() -= of.level;
  Vector3d left = person.R_pelvis.col(1);
  left.z() = 0;
  const double hip_width = (person.legs[0].proximal - person.legs[1].proximal).norm();
  const double wider = 0.5 * (body.hip_width - of.scale * hip_width);
  place = of.scale * place + (i == 0 ? wider : -wider) * left.normalized();
  Eigen::Matrix3d R_WA = of.R_foot;
  if (of.pitch) {
    R_WA = Eigen::AngleAxisd(YawOf(R_WA.col(0)), Vector3d::UnitZ()) *
           Eigen::AngleAxisd(*of.pitch, Vector3d::UnitY());
  }
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = R_WA * foot.R_FA.transpose();
  X.translation() = place - X.linear() * foot.sole;
  const double lowest = LowestOf(foot, X);
  if (of.pitch) X.translation().z() += of.scale * of.support - lowest;
  if (!of.pitch) X.translation().z() += std::max(0.0, of.scale * of.clearance - lowest);
  return X;
}

FootTracks ScaledFeet(const Retargeted& retargeted, const RobotBody& body) {
  FootTracks tracks;
  if (!body.feet) return tracks;
  const HumanMotion& human = retargeted.human;
  for (std::size_t i = 0; i < 2; ++i) {
    const double level = SoleLevel(retargeted, retargeted.ankle_height, i);
    const std::vector<double> clearances = ClearancesOf(retargeted, i);
    tracks[i].stands.assign(human.num_frames(), false);
    for (const FrameInterval& stance : retargeted.rests[i].stances) {
      std::fill(tracks[i].stands.begin() + stance.begin, tracks[i].stands.begin() + stance.end,
                true);
    }
    for (int k = 0; k < human.num_frames(); ++k) {
      ScaledFoot of = {&human.bodies[k],
                       human.R_feet[i][k],
                       retargeted.ankle_height,
                       level,
                       retargeted.scale,
                       {},
                       retargeted.states.support(i, k),
                       clearances[k]};
      if (tracks[i].stands[k]) {
        const FootRests& rests = retargeted.rests[i];
        of.pitch = GatedPitch(rests.heel[k], rests.toe[k], PitchOf(of.R_foot.col(0)));
      }
      tracks[i].X_WF.push_back(PlaceFoot(of, body, i));
    }
  }
  return tracks;
}

FootTracks AnchoredFeet(const Retargeted& retargeted, const RobotBody& body,
                        const FootTracks& first_pass) {
  FootTracks tracks = first_pass;
  const double rate = retargeted.human.rate;
  const int frames = retargeted.human.num_frames();
  for (std::size_t i = 0; i < 2; ++i) {
    const RobotFoot& foot = (*body.feet)[i];
    const FootTrack& pass = first_pass[i];
    FootTrack& track = tracks[i];
    std::vector<double> pitch, roll;
    for (int k = 0; k < frames; ++k) {
      const Vector3d forward = pass.X_WF[k].linear() * foot.R_FA.col(0);
      const double gated =
          GatedPitch(retargeted.rests[i].heel[k], retargeted.rests[i].toe[k], PitchOf(forward));
      pitch.push_back(gated + Unavoidable(PitchOf(forward) - gated));
      // A robot without such a joint rolls its feet as its legs lean.
      const Vector3d left = pass.X_WF[k].linear() * foot.R_FA.col(1);
      const double leaning = std::asin(std::clamp(left.z(), -1.0, 1.0));
      roll.push_back(foot.rolls ? Unavoidable(leaning) : leaning);
    }
    roll = Smoothed(roll, kPitchSmoothing * rate);
    pitch = Smoothed(pitch, kPitchSmoothing * rate);
    const std::vector<FrameInterval>& stances = retargeted.rests[i].stances;
    for (const FrameInterval& stance : stances) {
      const double support = retargeted.scale * retargeted.states.support(i, stance.begin);
      Anchor(foot, pass, pitch, roll, stance, support, &track);
    }
    std::vector<FootDifference> draws(frames, FootDifference::Zero());
    for (std::size_t n = 0; n < stances.size(); ++n) {
      const int next = n + 1 < stances.size() ? stances[n + 1].begin : frames;
      const int last = n > 0 ? stances[n - 1].end - 1 : -1;
      DrawSwing(pass, track, stances[n].end - 1, 1, next, rate, &draws);
      DrawSwing(pass, track, stances[n].begin, -1, last, rate, &draws);
    }
    const std::vector<double> clearances = ClearancesOf(retargeted, i);
    for (int k = 0; k < frames; ++k) {
      if (track.stands[k]) continue;
      Eigen::Isometry3d& X = track.X_WF[k];
      X.translation() += draws[k].head<3>();
      X.linear() = Exp(draws[k].tail<3>()).toRotationMatrix() * X.linear();
      X.translation().z() += std::max(0.0, retargeted.scale * clearances[k] - LowestOf(foot, X));
    }
  }
  return tracks;
}

}  // namespace mmm_converter
