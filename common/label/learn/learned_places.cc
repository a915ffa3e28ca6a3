// SPDX-License-Identifier: MIT
#include "common/label/learn/learned_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "common/fit/posture_search.h"
#include "common/label/tuning.h"
#include "common/math/statistics.h"
#include "common/support/units.h"

namespace mmm_converter {

using Eigen::Isometry3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// The middle of some places (3 x n, each finite), and their scatter about it, each coordinate.
std::pair<Vector3d, double> MiddleAndScatter(const Matrix3Xd& p) {
  Vector3d middle;
  std::vector<double> values(static_cast<std::size_t>(p.cols()));
  for (int i = 0; i < 3; ++i) {
    std::copy(p.row(i).begin(), p.row(i).end(), values.begin());
    middle[i] = Median(values);
  }
  for (Eigen::Index k = 0; k < p.cols(); ++k) {
    values[static_cast<std::size_t>(k)] = (p.col(k) - middle).squaredNorm();
  }
  std::sort(values.begin(), values.end());
  const auto kept = std::max<std::size_t>(
      1, static_cast<std::size_t>(LearnPlaceTuning::kTrimmed * static_cast<double>(values.size())));
  const double sum =
      std::accumulate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(kept), 0.0);
  return {middle, std::sqrt(sum / (3 * static_cast<double>(kept)))};
}

}  // namespace

LearnedPlaces::LearnedPlaces(const BodySites& sites, std::vector<LearnFrame> frames,
                             Eigen::MatrixXd deviations, std::vector<NamedPlace> named)
    : sites_(sites),
      frames_(std::move(frames)),
      places_(static_cast<std::size_t>(deviations.rows())),
      held_(places_.size(), -1),
      deviations_(std::move(deviations)),
      named_(std::move(named)),
      skin_(VectorXd::Constant(static_cast<Eigen::Index>(places_.size()), LearnPlaceTuning::kSkin)),
      radii_(static_cast<Eigen::Index>(sites.sites().size())) {
  for (int s = 0; s < radii_.size(); ++s) {
    double farthest = LearnPlaceTuning::kLeastRadius;
    for (const Vector3d& place : sites.sites()[s].places) {
      farthest = std::max(farthest, sites.DistanceFromBones(s, place));
    }
    radii_[s] = farthest + LearnPlaceTuning::kMargin;
  }
}

std::vector<int> LearnedPlaces::SitesOfLabels() const {
  std::vector<int> sites;
  sites.reserve(places_.size());
  for (const WornPlace& worn : places_) sites.push_back(worn.site);
  return sites;
}

void LearnedPlaces::Start(int frame, const Posture& posture) {
  for (LearnFrame& one : frames_) one.posture = Posture();
  start_ = frame;
  frames_[frame].posture = posture;
  ChoosePlaces();
}

void LearnedPlaces::Start(const std::vector<WornPlace>& places) {
  for (LearnFrame& one : frames_) one.posture = Posture();
  places_ = places;
  Eigen::Index most = -1;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    Eigen::Index seen = 0;
    for (std::size_t l = 0; l < places_.size(); ++l) {
      seen += places_[l].site >= 0 && frames_[k].z.col(static_cast<Eigen::Index>(l)).allFinite();
    }
    if (seen > most) start_ = static_cast<int>(k);
    most = std::max(most, seen);
  }
  FitPostures();
  ChoosePlaces();
}

void LearnedPlaces::Iterate(int times, double independent) {
  independent_ = independent;
  for (int i = 0; i < times; ++i) {
    FitPostures();
    ChoosePlaces();
  }
}

void LearnedPlaces::AllowForSkinAtJoints() {
  for (std::size_t l = 0; l < places_.size(); ++l) {
    if (places_[l].site < 0) continue;
    const double d = sites_.DistanceFromJoints(places_[l].site, places_[l].p_SM) /
                     LearnPlaceTuning::kReachOfJoints;
    skin_[static_cast<Eigen::Index>(l)] =
        LearnPlaceTuning::kSkin + LearnPlaceTuning::kSkinAtJoints * std::exp(-d * d / 2);
  }
  ChoosePlaces();
}

Eigen::MatrixXd LearnedPlaces::Strangeness() const {
  const int labels = static_cast<int>(places_.size());
  Eigen::MatrixXd strangeness(labels, static_cast<Eigen::Index>(sites_.sites().size()));
  const std::vector<int> sites = SitesOfLabels();
  std::vector<int> counts(static_cast<std::size_t>(strangeness.cols()), 0);
  for (const int site : sites) {
    if (site >= 0) ++counts[site];
  }
  for (int l = 0; l < labels; ++l) {
    for (int s = 0; s < strangeness.cols(); ++s) {
      const double deviation =
          DeviationFrom(s, l, sites, deviations_).value_or(LearnPlaceTuning::kRigidUsual);
      strangeness(l, s) = LearnPlaceTuning::kRigidWeight *
                          std::log1p(std::pow(std::min(deviation, LearnPlaceTuning::kRigidMost) /
                                                  LearnPlaceTuning::kRigidUsual,
                                              2));
      const int mirror = sites_.sites()[s].mirror;
      if (mirror < 0) {
        strangeness(l, s) += LearnPlaceTuning::kUnlikeOtherSide / 2;
      } else if (counts[s] - (sites[l] == s) >= counts[mirror] - (sites[l] == mirror)) {
        strangeness(l, s) += LearnPlaceTuning::kUnlikeOtherSide;
      }
    }
  }
  return strangeness;
}

double LearnedPlaces::DistanceBeyond(int site, const Vector3d& p_SM) const {
  return std::max(0.0, sites_.DistanceFromBones(site, p_SM) - radii_[site]);
}

double LearnedPlaces::PriorCost(int label, int site, const Vector3d& p_SM) const {
  const double beyond = DistanceBeyond(site, p_SM) / LearnPlaceTuning::kBeyond;
  const NamedPlace& named = named_[static_cast<std::size_t>(label)];
  const double near =
      named.is_at_place && named.site == site
          ? (p_SM - named.p_SM).norm() / std::max(named.deviation, LearnPlaceTuning::kNear)
          : sites_.DistanceFromMarkers(site, p_SM) / LearnPlaceTuning::kNear;
  return std::min(beyond * beyond / 2, LearnPlaceTuning::kMostOfBeyond) +
         std::min(near * near / 2, LearnPlaceTuning::kMostOfNear);
}

double LearnedPlaces::CostOfOtherThanNamed(int label, int site) const {
  const NamedPlace& named = named_[static_cast<std::size_t>(label)];
  if (named.site < 0 || named.site == site) return 0;
  const bool is_next = named.is_at_place && sites_.IsAtJointBetween(named.site, site, named.p_SM,
                                                                    NamedTuning::kReachOfJoints);
  return is_next ? NamedTuning::kNextToNamed : NamedTuning::kElsewhere;
}

std::unique_ptr<LearnedPlaces> LearnedPlaces::Moved(const std::vector<int>& labels, int site,
                                                    int turns) const {
  auto moved = std::make_unique<LearnedPlaces>(*this);
  moved->is_searching_ = false;
  for (std::size_t l = 0; l < places_.size(); ++l) moved->held_[l] = places_[l].site;
  for (const int l : labels) moved->held_[l] = site;
  moved->ChoosePlaces();
  for (const int l : labels) moved->places_[l].scatter = 0;  // to be taken seriously at first
  moved->Iterate(1, independent_);
  for (const int l : labels) moved->places_[l].scatter = 0;
  moved->Iterate(turns - 1, independent_);
  moved->held_.assign(places_.size(), -1);
  moved->is_searching_ = true;
  return moved;
}

void LearnedPlaces::ChoosePlaces() {
  const int labels = static_cast<int>(places_.size());
  const int count = static_cast<int>(sites_.sites().size());
  std::vector<std::vector<Isometry3d>> X_SW(frames_.size());
  int fitted = 0;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    if (frames_[k].posture.joint_angles.size() == 0) continue;
    ++fitted;
    X_SW[k] = sites_.Poses(frames_[k].posture);
    for (Isometry3d& X : X_SW[k]) X = X.inverse();
  }
  costs_.setConstant(labels, count, LearnPlaceTuning::kImpossible);
  prior_costs_ = costs_;
  const Eigen::MatrixXd strangeness = fitted > LearnPlaceTuning::kFewestSeen
                                          ? Strangeness()
                                          : Eigen::MatrixXd::Zero(labels, count).eval();
  cost_ = 0;
  for (int l = 0; l < labels; ++l) {
    WornPlace& worn = places_[l];
    const int before = worn.site;
    worn = WornPlace();
    std::vector<int> seen;
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (!X_SW[k].empty() && frames_[k].z.col(l).allFinite()) seen.push_back(static_cast<int>(k));
    }
    if (seen.empty() || (fitted > LearnPlaceTuning::kFewestSeen &&
                         static_cast<int>(seen.size()) < LearnPlaceTuning::kFewestSeen)) {
      continue;
    }
    const double weight = LearnPlaceTuning::kWeight *
                          std::min<double>(static_cast<double>(seen.size()), independent_);
    Matrix3Xd p(3, static_cast<Eigen::Index>(seen.size()));
    double second = LearnPlaceTuning::kImpossible;
    for (int s = 0; s < count; ++s) {
      if (held_[l] >= 0 && s != held_[l]) continue;
      for (std::size_t i = 0; i < seen.size(); ++i) {
        p.col(static_cast<Eigen::Index>(i)) = X_SW[seen[i]][s] * frames_[seen[i]].z.col(l);
      }
      const auto [middle, scatter] = MiddleAndScatter(p);
      double cost = weight * std::log1p(std::pow(scatter / skin_[l], 2)) + PriorCost(l, s, middle) +
                    strangeness(l, s) + CostOfOtherThanNamed(l, s);
      prior_costs_(l, s) = PriorCost(l, s, middle);
      if (s == before) cost -= LearnPlaceTuning::kStays;
      costs_(l, s) = cost;
      if (worn.site < 0 || cost < costs_(l, worn.site)) {
        if (worn.site >= 0) second = costs_(l, worn.site);
        worn.site = s;
        worn.p_SM = middle;
        worn.scatter = scatter;
      } else {
        second = std::min(second, cost);
      }
    }
    worn.lead = second - costs_(l, worn.site);
    cost_ += costs_(l, worn.site);
  }
}

std::unique_ptr<const MarkerKinematics> LearnedPlaces::MakeKinematics(KinematicModel* model) const {
  const KinematicModel& bare = sites_.model();
  ModelDescription description{bare.name(), bare.segments(), {}, {}};
  std::vector<MarkerIx> markers;
  for (std::size_t l = 0; l < places_.size(); ++l) {
    const WornPlace& worn = places_[l];
    const int segment = worn.site < 0 ? 0 : sites_.sites()[worn.site].segment;
    description.markers.push_back({std::to_string(l), segment, worn.p_SM, {}, {}});
    markers.emplace_back(static_cast<int>(l));
  }
  *model = KinematicModel(std::move(description));
  return std::make_unique<const MarkerKinematics>(*model, sites_.joints(), markers);
}

void LearnedPlaces::FitPostures() {
  KinematicModel model = sites_.model();
  const auto kinematics = MakeKinematics(&model);
  PostureSearch search(*kinematics);
  VectorXd noise(static_cast<Eigen::Index>(places_.size()));
  for (int l = 0; l < noise.size(); ++l) {
    noise[l] = std::hypot(places_[l].scatter, LearnPlaceTuning::kSkin) / LearnFitTuning::kNoiseUnit;
  }
  PostureFitOptions options;
  options.robust_distance = LearnFitTuning::kRobustDistance;
  // Outward from the frame that is known.
  std::vector<int> order(frames_.size());
  std::iota(order.begin(), order.end(), 0);
  const LearnFrame& first = frames_[start_];
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    const auto far = [&](int k) {
      const LearnFrame& frame = frames_[k];
      return std::pair(frame.recording != first.recording, std::abs(k - start_));
    };
    return far(a) < far(b);
  });
  Matrix3Xd z;
  double sum = 0;
  int seen = 0;
  for (const int k : order) {
    LearnFrame& frame = frames_[k];
    z = frame.z;
    for (int l = 0; l < noise.size(); ++l) {
      if (places_[l].site < 0) z.col(l).setConstant(kNaN);
    }
    const auto count = z.row(0).array().isFinite().count();
    if (count < LearnFitTuning::kFewestLabels) continue;
    PostureFit::Result result;
    if (frame.posture.joint_angles.size() == 0) {
      const int step = k < start_ ? 1 : -1;
      const int from = std::clamp(k + step, 0, static_cast<int>(frames_.size()) - 1);
      Posture near = frames_[from].posture;
      if (frames_[from].recording == frame.recording && near.joint_angles.size() > 0) {
        result = search.fit().Solve(z, noise, options, &near);
        if (result.mean_distance > LearnFitTuning::kBadStart) {
          for (int i = 0; i < LearnFitTuning::kTriesAtStart; ++i)
            search.Improve(z, noise, options, &near);
          result = search.fit().Solve(z, noise, options, &near);
        }
      } else {
        near.joint_angles = first.posture.joint_angles;
        result = search.Assemble(z, noise, options, LearnFitTuning::kTriesFromNothing, &near);
      }
      frame.posture = near;
    } else {
      result = search.fit().Solve(z, noise, options, &frame.posture);
      if (is_searching_ && result.mean_distance > LearnFitTuning::kBad) {
        for (int i = 0; i < LearnFitTuning::kTries; ++i)
          search.Improve(z, noise, options, &frame.posture);
        result = search.fit().Solve(z, noise, options, &frame.posture);
      }
    }
    sum += result.mean_distance * static_cast<double>(count);
    seen += static_cast<int>(count);
  }
  mean_distance_ = seen > 0 ? sum / seen : 0;
}

}  // namespace mmm_converter
