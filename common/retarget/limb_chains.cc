// SPDX-License-Identifier: MIT
#include "common/retarget/limb_chains.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>
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
constexpr double kSteepNormal = 0.2;        // vertical part of what is no normal
constexpr double kSameNormal = 0.99999;     // cosine
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

/// With that normal, from b to a; nothing if they are not apart along it. Where along their axes
/// origins lie tells nothing.
std::optional<Plane> PlaneAcross(const ZeroPose& zero, const Eigen::Vector3d& normal,
                                 const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<double> offsets;
  double apart = 0;  // of the first joints, as the ends may cross
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::abs(zero.axis(a[i]).dot(normal)) > kParallel) continue;
    const double p = normal.dot(zero.origin(a[i])), q = normal.dot(zero.origin(b[i]));
    offsets.push_back(0.5 * (p + q));
    if (std::abs(apart) < kLeastApart) apart = p - q;
  }
  if (std::abs(apart) < kLeastApart) return {};
  const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
  std::nth_element(offsets.begin(), middle, offsets.end());
  return apart > 0 ? Plane{normal, *middle} : Plane{-normal, -*middle};
}

/// Axes that are images of each other tell the normal: it is along them, or between them.
std::vector<Plane> PlanesBetween(const ZeroPose& zero, const std::vector<int>& a,
                                 const std::vector<int>& b) {
  std::vector<Eigen::Vector3d> normals;
  const auto add = [&](const Eigen::Vector3d& way) {
    if (way.norm() < kLeastApart) return;
    const Eigen::Vector3d normal = way.normalized();
    if (std::abs(normal.z()) > kSteepNormal) return;
    const bool is_known = std::any_of(normals.begin(), normals.end(), [&](const auto& other) {
      return std::abs(other.dot(normal)) > kSameNormal;
    });
    if (!is_known) normals.push_back(normal);
  };
  for (int axis = 0; axis < 3; ++axis) add(zero.X_WS[0].linear().col(axis));
  for (std::size_t i = 0; i < a.size(); ++i) {
    add(zero.axis(a[i]));
    add(zero.axis(a[i]) - zero.axis(b[i]));
    add(zero.axis(a[i]) + zero.axis(b[i]));
    add(zero.origin(a[i]) - zero.origin(b[i]));
  }
  std::vector<Plane> planes;
  for (const Eigen::Vector3d& normal : normals) {
    if (const auto plane = PlaneAcross(zero, normal, a, b)) planes.push_back(*plane);
  }
  return planes;
}

bool AreMirrored(const ZeroPose& zero, const Plane& plane, const std::vector<int>& a,
                 const std::vector<int>& b) {
  const Eigen::Vector3d& n = plane.normal;
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

/// By how much a segment turns as its joint does.
double SlopeOf(const ZeroPose& zero, int segment) {
  double slope = 1;
  const Segment& one = zero.model->segments()[segment];
  if (one.function) one.function->Value(zero.angles[one.joint], &slope);
  return slope;
}

bool TurnsWith(const ZeroPose& zero, int a, int b) {
  const Segment &one = zero.model->segments()[a], &other = zero.model->segments()[b];
  if (one.joint != other.joint || other.type != JointType::kRevolute) return false;
  const double way = SlopeOf(zero, a) * SlopeOf(zero, b) < 0 ? -1 : 1;
  return way * zero.axis(a).dot(zero.axis(b)) > kParallel;
}

}  // namespace

ZeroPose::ZeroPose(const KinematicModel& of) : model(&of) {
  const Posture posture = ZeroPosture(of);
  angles = posture.joint_angles;
  X_WS = SegmentPoses(of, posture);
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

double ZeroPose::Turn(int segment, double q) const {
  const Segment& one = model->segments()[segment];
  return JointValue(one, q) - JointValue(one, angles[one.joint]);
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

int LastOfFold(const ZeroPose& zero, const std::vector<int>& chain, int joint) {
  const Eigen::Vector3d first = zero.origin(chain[joint]), end = zero.mass_centre[chain.back()];
  int last = joint;
  for (int i = joint + 1; i < static_cast<int>(chain.size()); ++i) {
    const Eigen::Vector3d here = zero.origin(chain[i]);
    if (!TurnsWith(zero, chain[joint], chain[i])) break;
    if ((here - first).norm() > (end - here).norm()) break;
    last = i;
  }
  return last;
}

Eigen::Vector3d Folded(const ZeroPose& zero, const std::vector<int>& chain, int joint, double q,
                       Eigen::Vector3d p) {
  for (int i = LastOfFold(zero, chain, joint); i >= joint; --i) {
    const Eigen::Vector3d pivot = zero.origin(chain[i]);
    p = pivot + Eigen::AngleAxisd(zero.Turn(chain[i], q), zero.axis(chain[i])) * (p - pivot);
  }
  return p;
}

FoldSweep SweepChain(const ZeroPose& zero, const std::vector<int>& chain) {
  const auto count = static_cast<Eigen::Index>(chain.size());
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(count);
  FoldSweep sweep{none, none, none};
  for (int i = 0; i < count; ++i) {
    const Segment& segment = zero.model->segments()[chain[i]];
    if (segment.type != JointType::kRevolute) continue;
    const double lower = std::max(segment.lower, -std::numbers::pi);
    const double upper = std::min(segment.upper, std::numbers::pi);
    const Eigen::Vector3d before = CentreBefore(zero, chain, i);
    double shortest = INFINITY, longest = -INFINITY;
    for (int step = 0; step <= kSweepSteps; ++step) {
      const double angle = lower + (upper - lower) * step / kSweepSteps;
      const double distance =
          (Folded(zero, chain, i, angle, zero.mass_centre[chain.back()]) - before).norm();
      shortest = std::min(shortest, distance);
      if (distance > longest) sweep.straight[i] = angle;
      longest = std::max(longest, distance);
    }
    sweep.change[i] = longest - shortest;
    sweep.longest[i] = longest;
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
      const FoldSweep sweep = SweepChain(zero, pair.chains[0]);
      Eigen::Index most = 0;
      pair.most_folding = sweep.change.maxCoeff(&most);
      pair.reach = sweep.longest[most];
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
