// SPDX-License-Identifier: MIT
#include "common/motion/body_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "common/math/statistics.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/ground_rules.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

/// Body index of each segment, -1 for those of none; `names` gets the bodies' names.
std::vector<int> EndsOfReferenceModel(const KinematicModel& model,
                                      std::vector<std::string>* names) {
  constexpr std::array<std::pair<const char*, const char*>, 4> kEnds = {
      {{"left foot", "LAx_joint"},
       {"right foot", "RAx_joint"},
       {"left hand", "LWx_joint"},
       {"right hand", "RWx_joint"}}};
  std::vector<int> owner(model.segments().size(), -1);
  for (const auto& [name, node] : kEnds) {
    const int first = model.FindSegment(node);
    if (first < 0) continue;
    owner[first] = static_cast<int>(names->size());
    for (std::size_t i = first + 1; i < owner.size(); ++i) {
      if (owner[model.segments()[i].parent] == owner[first]) owner[i] = owner[first];
    }
    names->emplace_back(name);
  }
  return owner;
}

/// The same for the segments that move with a joint after which there is no other.
std::vector<int> EndsOfLimbs(const KinematicModel& model, std::vector<std::string>* names) {
  const std::vector<Segment>& segments = model.segments();
  std::vector<int> moved_by(segments.size(), 0);  // the segment whose joint, or the root, moves it
  std::vector<bool> is_end(segments.size(), true);
  for (std::size_t i = 1; i < segments.size(); ++i) {
    moved_by[i] = segments[i].joint < 0 ? moved_by[segments[i].parent] : static_cast<int>(i);
    if (segments[i].joint >= 0) is_end[moved_by[segments[i].parent]] = false;
  }
  std::vector<int> owner(segments.size(), -1);
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const int first = moved_by[i];
    if (first == 0 || !is_end[first]) continue;
    if (first == static_cast<int>(i)) {
      owner[i] = static_cast<int>(names->size());
      names->push_back(segments[i].name);
    } else {
      owner[i] = owner[first];
    }
  }
  return owner;
}

/// Origins of all segments, then all markers, 3 x points.
Eigen::Matrix3Xd Points(const KinematicModel& model, const Posture& posture) {
  const std::vector<Eigen::Isometry3d> X_WS = SegmentPoses(model, posture);
  const std::size_t segments = X_WS.size();
  Eigen::Matrix3Xd points(3, static_cast<Index>(segments + model.markers().size()));
  for (std::size_t i = 0; i < segments; ++i) {
    points.col(static_cast<Index>(i)) = X_WS[i].translation();
  }
  for (std::size_t i = 0; i < model.markers().size(); ++i) {
    const ModelMarker& marker = model.markers()[i];
    points.col(static_cast<Index>(segments + i)) = X_WS[marker.segment] * marker.p_SM;
  }
  return points;
}

/// Columns of Points.
std::vector<Index> PointsOf(const ContactBody& body, const KinematicModel& model) {
  std::vector<Index> points(body.segments.begin(), body.segments.end());
  const auto segments = static_cast<Index>(model.segments().size());
  points.reserve(body.segments.size() + body.markers.size());
  for (const int marker : body.markers) points.push_back(segments + marker);
  return points;
}

Index Lowest(const std::vector<Index>& candidates, const Eigen::Matrix3Xd& points) {
  return *std::min_element(candidates.begin(), candidates.end(),
                           [&](Index a, Index b) { return points(2, a) < points(2, b); });
}

/// Heights of the lowest points, one entry a body, and how fast these points are.
struct LowestPoints {
  Eigen::MatrixXd heights;
  Eigen::MatrixXd speeds;
};

LowestPoints FindLowestPoints(const KinematicModel& model, const std::vector<ContactBody>& bodies,
                              const PoseTrajectory& measured, const PoseTrajectory& smooth) {
  const auto num_bodies = static_cast<Index>(bodies.size());
  const int frames = measured.num_frames();
  LowestPoints lowest{Eigen::MatrixXd(num_bodies, frames), Eigen::MatrixXd(num_bodies, frames)};
  std::vector<std::vector<Index>> candidates;
  candidates.reserve(bodies.size());
  for (const ContactBody& body : bodies) candidates.push_back(PointsOf(body, model));

  Eigen::Matrix3Xd before = Points(model, smooth.postures[0]);
  Eigen::Matrix3Xd now = before;
  for (int k = 0; k < frames; ++k) {
    const int next = std::min(k + 1, frames - 1);
    const Eigen::Matrix3Xd after = Points(model, smooth.postures[next]);
    const Eigen::Matrix3Xd points = Points(model, measured.postures[k]);
    const double seconds = (next - std::max(k - 1, 0)) / measured.rate;
    for (Index b = 0; b < num_bodies; ++b) {
      const Index point = Lowest(candidates[b], points);
      lowest.heights(b, k) = points(2, point);
      lowest.speeds(b, k) = (after.col(point) - before.col(point)).norm() / seconds;
    }
    before = std::exchange(now, after);
  }
  return lowest;
}

constexpr double kOtherLevel = 0.1;  // [m] lower than the ground is no noise

/// Runs of frames [begin, end) in which is_resting(k) holds long enough.
template <typename Predicate>
std::vector<std::pair<Index, Index>> LongRuns(Index frames, double rate, Predicate is_resting) {
  const auto least = std::max<Index>(2, static_cast<Index>(std::ceil(kBodyRestTime * rate)));
  std::vector<std::pair<Index, Index>> runs;
  Index begin = 0;
  for (Index k = 0; k <= frames; ++k) {
    if (k < frames && is_resting(k)) continue;
    if (k - begin >= least) runs.emplace_back(begin, k);
    begin = k + 1;
  }
  return runs;
}

/// The median of the whole body's lowest point over the frames in which that is slow; of all frames
/// where there is none. Where the body rests clearly lower, as below stairs, that is the ground.
double GroundHeight(const LowestPoints& lowest, double rate) {
  std::vector<double> slow;
  std::vector<double> all;
  std::vector<double> speeds;
  for (Index k = 0; k < lowest.heights.cols(); ++k) {
    Index body = 0;
    all.push_back(lowest.heights.col(k).minCoeff(&body));
    speeds.push_back(lowest.speeds(body, k));
    if (speeds.back() <= kComesBelow) slow.push_back(all.back());
  }
  const double usual = Median(slow.empty() ? all : slow);
  double ground = usual;
  const auto is_lower = [&](Index k) {
    return all[k] < usual - kOtherLevel && speeds[k] <= kBodyRestSpeed;
  };
  for (const auto& [begin, end] : LongRuns(lowest.heights.cols(), rate, is_lower)) {
    const Eigen::Map<const Eigen::VectorXd> heights(all.data() + begin, end - begin);
    ground = std::min(ground, heights.mean());
  }
  return ground;
}

/// Frames [begin, end) in which a body rests where none is near the ground, so high above it [m].
struct Rest {
  Index body = 0, begin = 0, end = 0;
  double height = 0;
};

/// Not of hands that hang still: what bears the body is sometimes its lowest part.
std::vector<Rest> FindBodyRests(const GroundContact& contact, const Eigen::MatrixXd& speeds,
                                double rate) {
  std::vector<Rest> rests;
  for (Index body = 0; body < speeds.rows(); ++body) {
    const auto is_resting = [&](Index k) {
      return contact.heights.col(k).minCoeff() > kRestHeight && speeds(body, k) <= kBodyRestSpeed;
    };
    for (const auto& [begin, end] : LongRuns(speeds.cols(), rate, is_resting)) {
      const auto all = contact.heights.middleCols(begin, end - begin);
      const Eigen::RowVectorXd own = all.row(body);
      if ((own.array() > all.colwise().minCoeff().array()).all()) continue;
      rests.push_back({body, begin, end, own.mean()});
    }
  }
  return rests;
}

/// What rests touches, as long as it is low above that, and slow.
void AddRests(const std::vector<Rest>& rests, const Eigen::MatrixXd& speeds,
              GroundContact* contact) {
  const Eigen::MatrixXd heights = contact->heights;  // above the ground
  const auto stays = [&](const Rest& rest, Index k) {
    return std::abs(heights(rest.body, k) - rest.height) <= kRestHeight &&
           speeds(rest.body, k) <= kComesBelow;
  };
  for (Rest rest : rests) {
    while (rest.begin > 0 && stays(rest, rest.begin - 1)) --rest.begin;
    while (rest.end < heights.cols() && stays(rest, rest.end)) ++rest.end;
    for (Index k = rest.begin; k < rest.end; ++k) {
      contact->heights(rest.body, k) = heights(rest.body, k) - rest.height;
      contact->touches(rest.body, k) = 1;
      if (heights.col(k).minCoeff() > kRestHeight) {
        contact->raised[k] = std::max(contact->raised[k], rest.height);
      }
    }
  }
}

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Appends to a hull, counterclockwise, the points in their order (Andrew's monotone chain).
void AppendChain(const std::vector<Vector2d>& points, std::vector<Vector2d>* hull) {
  const std::size_t first = hull->size();
  for (const Vector2d& p : points) {
    while (hull->size() >= first + 2 &&
           Cross(hull->back() - hull->end()[-2], p - hull->back()) <= 0) {
      hull->pop_back();
    }
    hull->push_back(p);
  }
  hull->pop_back();  // starts the other chain
}

double DistanceFromEdge(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  const double length2 = (b - a).squaredNorm();
  const double share = length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0;
  return (a + share * (b - a) - p).norm();
}

}  // namespace

std::vector<ContactBody> ContactBodies(const KinematicModel& model) {
  std::vector<std::string> names;
  std::vector<int> owner = EndsOfReferenceModel(model, &names);
  const bool is_other = names.empty();
  if (is_other) owner = EndsOfLimbs(model, &names);
  names.emplace_back("body");
  std::vector<ContactBody> bodies(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) bodies[i].name = names[i];
  const auto body_of = [&](int segment) -> ContactBody& {
    return owner[segment] < 0 ? bodies.back() : bodies[owner[segment]];
  };
  for (int i = 0; i < static_cast<int>(owner.size()); ++i) body_of(i).segments.push_back(i);
  for (int i = 0; i < static_cast<int>(model.markers().size()); ++i) {
    body_of(model.markers()[i].segment).markers.push_back(i);
  }
  // A robot's root that is nothing but a name, as "world", touches nothing.
  std::vector<int>& rest = bodies.back().segments;
  if (is_other && model.segments()[0].mass == 0 && rest.size() > 1) rest.erase(rest.begin());
  return bodies;
}

GroundContact FindGroundContact(const KinematicModel& model, const std::vector<ContactBody>& bodies,
                                const PoseTrajectory& measured, const PoseTrajectory& smooth,
                                const FootContacts* feet) {
  const LowestPoints lowest = FindLowestPoints(model, bodies, measured, smooth);
  GroundContact contact;
  contact.ground_height = GroundHeight(lowest, measured.rate);
  contact.heights = lowest.heights.array() - contact.ground_height;
  contact.touches =
      (contact.heights.array() <= kRestHeight && lowest.speeds.array() <= kComesBelow).cast<int>();
  contact.raised = Eigen::VectorXd::Zero(contact.heights.cols());
  AddRests(FindBodyRests(contact, lowest.speeds, measured.rate), lowest.speeds, &contact);
  for (const Side side : kSides) {
    const auto foot = std::find_if(bodies.begin(), bodies.end(), [&](const ContactBody& body) {
      return body.name == std::string(Name(side)) + " foot";
    });
    if (feet == nullptr || foot == bodies.end()) continue;
    const std::vector<bool> stands =
        feet->StandingFrames(side, measured.first_time, measured.rate, measured.num_frames());
    for (std::size_t k = 0; k < stands.size(); ++k) {
      contact.touches(foot - bodies.begin(), static_cast<Index>(k)) = stands[k] ? 1 : 0;
    }
  }
  return contact;
}

Eigen::VectorXd DistanceOutsideSupport(const KinematicModel& model,
                                       const std::vector<ContactBody>& bodies,
                                       const PoseTrajectory& motion, const GroundContact& contact,
                                       const Eigen::Matrix2Xd& centers_of_pressure) {
  Eigen::VectorXd distances = Eigen::VectorXd::Constant(motion.num_frames(), kNaN);
  for (int k = 0; k < motion.num_frames(); ++k) {
    if (!centers_of_pressure.col(k).allFinite()) continue;
    if (contact.touches.col(k).maxCoeff() == 0) continue;
    const Eigen::Matrix3Xd points = Points(model, motion.postures[k]);
    std::vector<Vector2d> support;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (contact.touches(static_cast<Index>(b), k) == 0) continue;
      for (const Index i : PointsOf(bodies[b], model))
        support.emplace_back(points.col(i).head<2>());
    }
    distances[k] = DistanceOutsideHull(std::move(support), centers_of_pressure.col(k));
  }
  return distances;
}

double DistanceOutsideHull(std::vector<Vector2d> points, const Vector2d& p) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Vector2d> hull;
  hull.reserve(2 * points.size());
  AppendChain(points, &hull);
  std::reverse(points.begin(), points.end());
  AppendChain(points, &hull);
  if (hull.empty()) return (points.front() - p).norm();  // one point
  bool inside = hull.size() > 2;
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2d& a = hull[i];
    const Vector2d& b = hull[(i + 1) % hull.size()];
    inside = inside && Cross(b - a, p - a) >= 0;
    distance = std::min(distance, DistanceFromEdge(a, b, p));
  }
  return inside ? 0 : distance;
}

}  // namespace mmm_converter
