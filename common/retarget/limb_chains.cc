// SPDX-License-Identifier: MIT
#include "common/retarget/limb_chains.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <set>
#include <string_view>
#include <utility>

#include "common/model/forward_kinematics.h"
#include "common/model/robot.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kFewestJoints = 3;
constexpr double kMirrorTolerance = 0.006;  // [m] of axes that files round
constexpr double kMirrorShare = 0.02;       // of a chain's length, of bodies measured on people
constexpr double kLeastApart = 0.02;        // [m] of places that tell where the plane is
constexpr double kSkewNormal = 0.5;         // |cos| to a root's axis that may be the normal
constexpr double kParallel = 0.9;           // |cos| of axes that meet nowhere in particular
constexpr double kFingersReach = 0.35;      // of the chain before them
constexpr int kSweepSteps = 48;

/// Longest way from a segment's origin to one below it, for each segment.
std::vector<double> ReachesOf(const ZeroPose& zero) {
  const auto& segments = zero.model->segments();
  std::vector<double> reach(segments.size(), 0);
  for (int s = static_cast<int>(segments.size()) - 1; s > 0; --s) {
    const int parent = segments[s].parent;
    const double step = (zero.origin(s) - zero.origin(parent)).norm();
    reach[parent] = std::max(reach[parent], reach[s] + step);
  }
  return reach;
}

std::vector<std::vector<int>> PathsToLeaves(const ZeroPose& zero) {
  const int count = static_cast<int>(zero.model->segments().size());
  std::vector<bool> is_leaf(count, false);
  for (int s = 0; s < count; ++s) is_leaf[s] = zero.Moves(s);
  for (int s = 0; s < count; ++s) {
    if (zero.Moves(s) && zero.moving_parent[s] >= 0) is_leaf[zero.moving_parent[s]] = false;
  }
  std::vector<std::vector<int>> paths;
  for (int s = 0; s < count; ++s) {
    if (!is_leaf[s]) continue;
    std::vector<int> path;
    for (int at = s; at >= 0; at = zero.moving_parent[at]) path.push_back(at);
    std::reverse(path.begin(), path.end());
    paths.push_back(std::move(path));
  }
  return paths;
}

/// Longest way from a child's origin to one below it: of a finger without the palm.
double ReachBeyond(const ZeroPose& zero, const std::vector<double>& reach, int segment) {
  double most = 0;
  for (std::size_t s = 0; s < reach.size(); ++s) {
    if (zero.Moves(static_cast<int>(s)) && zero.moving_parent[s] == segment) {
      most = std::max(most, reach[s]);
    }
  }
  return most;
}

/// Ends a chain where several short ones begin: a hand.
void CutFingers(const ZeroPose& zero, const std::vector<double>& reach,
                const std::vector<int>& num_children, std::vector<int>* chain) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < chain->size(); ++i) {
    const int at = (*chain)[i];
    if (i > 0) length += (zero.origin(at) - zero.origin((*chain)[i - 1])).norm();
    if (i + 1 >= kFewestJoints && num_children[at] > 1 &&
        ReachBeyond(zero, reach, at) < kFingersReach * length) {
      chain->resize(i + 1);
    }
  }
}

struct Plane {
  Eigen::Vector3d normal;
  double offset;
};

double LengthOf(const ZeroPose& zero, const std::vector<int>& chain) {
  double length = 0;
  for (std::size_t i = 1; i < chain.size(); ++i) {
    length += (zero.origin(chain[i]) - zero.origin(chain[i - 1])).norm();
  }
  return length;
}

/// Where the plane with that normal lies: origins may be anywhere along their axes.
Plane PlaneAcross(const ZeroPose& zero, const Eigen::Vector3d& normal, const std::vector<int>& a,
                  const std::vector<int>& b) {
  std::vector<double> offsets;
  for (const double most : {kParallel, 2.0}) {
    for (std::size_t i = 0; i < a.size() && (most < 1 || offsets.empty()); ++i) {
      if (std::abs(zero.axis(a[i]).dot(normal)) > most) continue;
      offsets.push_back(0.5 * normal.dot(zero.origin(a[i]) + zero.origin(b[i])));
    }
  }
  std::nth_element(offsets.begin(), offsets.begin() + offsets.size() / 2, offsets.end());
  return {normal, offsets[offsets.size() / 2]};
}

/// Across the farthest origins; as these may lie askew along their axes, the root's axis near it,
/// too.
std::vector<Plane> PlanesBetween(const ZeroPose& zero, const std::vector<int>& a,
                                 const std::vector<int>& b) {
  double farthest = kLeastApart;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector3d way = zero.origin(a[i]) - zero.origin(b[i]);
    if (way.norm() <= farthest) continue;
    farthest = way.norm();
    normal = way.normalized();
  }
  if (normal.isZero()) return {};
  std::vector<Plane> planes = {PlaneAcross(zero, normal, a, b)};
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d of_root = zero.X_WS[0].linear().col(axis);
    const double cosine = of_root.dot(normal);
    if (std::abs(cosine) < kSkewNormal) continue;
    planes.push_back(PlaneAcross(zero, cosine > 0 ? of_root : Eigen::Vector3d(-of_root), a, b));
  }
  return planes;
}

bool AreMirrored(const ZeroPose& zero, const Plane& plane, const std::vector<int>& a,
                 const std::vector<int>& b) {
  const Eigen::Vector3d& n = plane.normal;
  if (std::abs(n.z()) > 0.2) return false;
  const double tolerance =
      std::max(kMirrorTolerance, kMirrorShare * std::min(LengthOf(zero, a), LengthOf(zero, b)));
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Segment& one = zero.model->segments()[a[i]];
    const Segment& other = zero.model->segments()[b[i]];
    if (one.type != other.type) return false;
    const Eigen::Vector3d axis = zero.axis(a[i]), its_axis = zero.axis(b[i]);
    const Eigen::Vector3d reflected = axis - 2 * n.dot(axis) * n;
    if (std::abs(reflected.dot(its_axis)) < 0.99) return false;
    const Eigen::Vector3d p = zero.origin(a[i]);
    const Eigen::Vector3d image = p - 2 * (n.dot(p) - plane.offset) * n;
    // Both turn about lines: where on them the origins lie tells nothing.
    const Eigen::Vector3d between = image - zero.origin(b[i]);
    const bool turns = other.type == JointType::kRevolute;
    if ((turns ? between.cross(its_axis) : between).norm() > tolerance) return false;
  }
  return true;
}

double DistanceToEnd(const ZeroPose& zero, const std::vector<int>& chain, int joint, double angle) {
  const Eigen::Vector3d end = zero.mass_centre[chain.back()];
  const int segment = chain[joint];
  const Eigen::Vector3d pivot = zero.origin(segment);
  const Eigen::Vector3d turned = Eigen::AngleAxisd(angle, zero.axis(segment)) * (end - pivot);
  return (pivot + turned - CentreBefore(zero, chain, joint)).norm();
}

}  // namespace

ZeroPose::ZeroPose(const KinematicModel& of) : model(&of) {
  X_WS = SegmentPoses(of, ZeroPosture(of));
  const int count = static_cast<int>(of.segments().size());
  moving_parent.assign(count, -1);
  std::vector<double> mass(count, 0);
  mass_centre.assign(count, Eigen::Vector3d::Zero());
  Eigen::AlignedBox3d box;
  for (int s = 0; s < count; ++s) {
    const Segment& segment = of.segments()[s];
    if (s > 0)
      moving_parent[s] = Moves(segment.parent) ? segment.parent : moving_parent[segment.parent];
    const int body = RigidRoot(of, s);
    mass[body] += segment.mass;
    mass_centre[body] += segment.mass * (X_WS[s] * segment.p_SB);
    box.extend(origin(s));
  }
  size = box.diagonal().norm();
  for (int s = 0; s < count; ++s) {
    const int body = RigidRoot(of, s);
    if (s == body)
      mass_centre[s] = mass[s] > 0 ? Eigen::Vector3d(mass_centre[s] / mass[s]) : origin(s);
    if (s != body) mass_centre[s] = mass_centre[body];
  }
}

Eigen::Vector3d ZeroPose::axis(int segment) const {
  return X_WS[segment].linear() * model->segments()[segment].axis;
}

Eigen::Vector3d NearestPoint(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                             const Eigen::Vector3d& q, const Eigen::Vector3d& b, double share) {
  const double cosine = a.dot(b), sine2 = 1 - cosine * cosine;
  const Eigen::Vector3d between = q - p;
  const double s = (between.dot(a) - cosine * between.dot(b)) / sine2;
  const double t = (cosine * between.dot(a) - between.dot(b)) / sine2;
  return (1 - share) * (p + s * a) + share * (q + t * b);
}

Eigen::Vector3d CentreBefore(const ZeroPose& zero, const std::vector<int>& chain, int joint) {
  if (joint == 0) return zero.origin(chain[0]);
  const int last = chain[joint - 1], next = chain[joint];
  const Eigen::Vector3d p = zero.origin(last), a = zero.axis(last);
  for (int i = joint - 2; i >= 0; --i) {
    if (std::abs(zero.axis(chain[i]).dot(a)) >= kParallel) continue;
    return NearestPoint(zero.origin(chain[i]), zero.axis(chain[i]), p, a, 0.5);
  }
  if (std::abs(zero.axis(next).dot(a)) < kParallel)
    return NearestPoint(p, a, zero.origin(next), zero.axis(next), 0);
  return p + (zero.origin(next) - p).dot(a) * a;
}

FoldSweep SweepChain(const ZeroPose& zero, const std::vector<int>& chain) {
  const auto count = static_cast<Eigen::Index>(chain.size());
  FoldSweep sweep{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count)};
  for (int i = 0; i < count; ++i) {
    const Segment& segment = zero.model->segments()[chain[i]];
    if (segment.type != JointType::kRevolute) continue;
    const double lower = std::max(segment.lower, -std::numbers::pi);
    const double upper = std::min(segment.upper, std::numbers::pi);
    const double now = std::clamp(segment.rest, segment.lower, segment.upper);
    double shortest = INFINITY, longest = -INFINITY;
    for (int step = 0; step <= kSweepSteps; ++step) {
      const double angle = lower + (upper - lower) * step / kSweepSteps;
      const double distance = DistanceToEnd(zero, chain, i, angle - now);
      shortest = std::min(shortest, distance);
      if (distance > longest) sweep.straight[i] = angle;
      longest = std::max(longest, distance);
    }
    sweep.change[i] = longest - shortest;
  }
  return sweep;
}

std::vector<MirroredPair> FindMirroredPairs(const ZeroPose& zero) {
  const std::vector<double> reach = ReachesOf(zero);
  std::vector<int> num_children(zero.X_WS.size(), 0);
  for (std::size_t s = 0; s < zero.X_WS.size(); ++s) {
    const int parent = zero.moving_parent[s];
    if (zero.Moves(static_cast<int>(s)) && parent >= 0) ++num_children[parent];
  }
  const auto paths = PathsToLeaves(zero);
  std::vector<MirroredPair> pairs;
  std::set<std::pair<int, int>> known;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    for (std::size_t j = i + 1; j < paths.size(); ++j) {
      if (paths[i].size() != paths[j].size()) continue;
      const auto [a, b] = std::mismatch(paths[i].begin(), paths[i].end(), paths[j].begin());
      MirroredPair pair;
      pair.chains = {std::vector<int>(a, paths[i].end()), std::vector<int>(b, paths[j].end())};
      for (auto& chain : pair.chains) CutFingers(zero, reach, num_children, &chain);
      if (pair.chains[0].size() != pair.chains[1].size()) continue;
      if (pair.chains[0].size() < kFewestJoints) continue;
      if (known.contains({pair.chains[0].back(), pair.chains[1].back()})) continue;
      const auto planes = PlanesBetween(zero, pair.chains[0], pair.chains[1]);
      const auto plane = std::find_if(planes.begin(), planes.end(), [&](const Plane& one) {
        return AreMirrored(zero, one, pair.chains[0], pair.chains[1]);
      });
      if (plane == planes.end()) continue;
      known.emplace(pair.chains[0].back(), pair.chains[1].back());
      pair.normal = plane->normal;
      pair.most_folding = SweepChain(zero, pair.chains[0]).change.maxCoeff();
      pair.lowest = std::min(zero.origin(pair.chains[0].back()).z(),
                             zero.mass_centre[pair.chains[0].back()].z());
      pairs.push_back(std::move(pair));
    }
  }
  return pairs;
}

namespace {

/// In small letters; joints of robots are often numbered through.
std::string WithoutNumbers(const std::string& name) {
  std::string text = ToLower(name);
  std::erase_if(text, [](unsigned char c) { return std::isdigit(c) != 0; });
  return text;
}

}  // namespace

int SideByNames(const std::string& first, const std::string& second) {
  const std::string a = WithoutNumbers(first), b = WithoutNumbers(second);
  const auto replaced = [](std::string text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    if (at != std::string::npos) text.replace(at, from.size(), to);
    return at == std::string::npos ? std::string() : text;
  };
  if (replaced(a, "left", "right") == b) return 1;
  if (replaced(a, "right", "left") == b) return -1;
  if (a.size() != b.size()) return 0;
  const auto [at, other] = std::mismatch(a.begin(), a.end(), b.begin());
  if (at == a.end() || !std::equal(at + 1, a.end(), other + 1)) return 0;
  if (*at == 'l' && *other == 'r') return 1;
  if (*at == 'r' && *other == 'l') return -1;
  return 0;
}

}  // namespace mmm_converter
