// SPDX-License-Identifier: MIT
#include "common/label/learn/body_sites.h"

#include <algorithm>
#include <limits>
#include <map>

#include "common/math/rotation.h"
#include "common/model/forward_kinematics.h"
#include "common/model/kit_joints.h"

namespace mmm_converter {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

/// The node of the tracked joint that carries a node; 0: the root.
int LinkOf(const KinematicModel& model, const std::vector<int>& joints, int node) {
  while (node > 0) {
    const int joint = model.segments()[node].joint;
    if (joint >= 0 && std::find(joints.begin(), joints.end(), joint) != joints.end()) return node;
    node = model.segments()[node].parent;
  }
  return 0;
}

std::string SideOf(const std::string& name) {
  if (MirroredName(name).empty()) return "";
  return name.front() == 'L' || name.front() == 'l' ? "left" : "right";
}

std::vector<BodySite> FindSites(const KinematicModel& model, const std::vector<int>& joints,
                                const std::vector<Isometry3d>& X_WS) {
  std::map<int, BodySite> by_link;
  for (int m = 0; m < static_cast<int>(model.markers().size()); ++m) {
    const ModelMarker& marker = model.markers()[m];
    const int link = LinkOf(model, joints, marker.segment);
    BodySite& site = by_link[link];
    if (site.markers.empty()) {
      site.segment = marker.segment;
      if (link > 0) site.side = SideOf(model.segments()[link].name);
    }
    site.markers.emplace_back(m);
    site.nodes.push_back(marker.segment);
    site.places.push_back(X_WS[site.segment].inverse() * X_WS[marker.segment] * marker.p_SM);
  }
  std::vector<BodySite> sites;
  std::map<int, int> index;
  for (auto& [link, site] : by_link) {
    index[link] = static_cast<int>(sites.size());
    sites.push_back(std::move(site));
  }
  for (const auto& [link, i] : index) {
    if (link == 0) continue;
    int above = LinkOf(model, joints, model.segments()[link].parent);
    while (above > 0 && !index.contains(above)) {
      above = LinkOf(model, joints, model.segments()[above].parent);
    }
    if (!index.contains(above)) continue;
    sites[i].parent = index[above];
    BodySite& parent = sites[index[above]];
    const Isometry3d X_SW = X_WS[parent.segment].inverse();
    parent.bones.emplace_back(X_SW * X_WS[above].translation(), X_SW * X_WS[link].translation());
  }
  for (const auto& [link, i] : index) {
    const int other = model.FindSegment(MirroredName(model.segments()[link].name));
    if (index.contains(other) && other != link) sites[i].mirror = index[other];
    if (!sites[i].bones.empty()) continue;
    const Vector3d origin = X_WS[sites[i].segment].inverse() * X_WS[link].translation();
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& place : sites[i].places) middle += place;
    sites[i].bones.emplace_back(origin, middle / static_cast<double>(sites[i].places.size()));
  }
  return sites;
}

KinematicModel WithProbes(const KinematicModel& model, const std::vector<BodySite>& sites) {
  ModelDescription description{model.name(), model.segments(), {}, {}};
  for (std::size_t i = 0; i < sites.size(); ++i) {
    for (int axis = -1; axis < 3; ++axis) {
      const Vector3d p = axis < 0 ? Vector3d(Vector3d::Zero()) : Vector3d(Vector3d::Unit(axis));
      description.markers.push_back(
          {std::to_string(4 * i + axis + 1), sites[i].segment, p, {}, {}});
    }
  }
  return KinematicModel(std::move(description));
}

std::vector<MarkerIx> AllProbes(const KinematicModel& model) {
  std::vector<MarkerIx> all;
  all.reserve(model.markers().size());
  for (int m = 0; m < static_cast<int>(model.markers().size()); ++m) all.emplace_back(m);
  return all;
}

}  // namespace

BodySites::BodySites(const KinematicModel& model, std::vector<int> joints)
    : model_(model),
      joints_(std::move(joints)),
      X_WS_(SegmentPoses(model, {.joint_angles = Eigen::VectorXd::Zero(model.num_joints())})),
      sites_(FindSites(model, joints_, X_WS_)),
      probed_(WithProbes(model, sites_)),
      probes_(probed_, joints_, AllProbes(probed_)) {}

std::vector<int> BodySites::Neighbours(int site) const {
  const int parent = sites_[site].parent;
  std::vector<int> neighbours;
  for (int s = 0; s < static_cast<int>(sites_.size()); ++s) {
    const int above = sites_[s].parent;
    const bool is_near = s == parent || above == site ||
                         (parent >= 0 && s == sites_[parent].parent) ||
                         (above >= 0 && sites_[above].parent == site);
    if (is_near && s != site) neighbours.push_back(s);
  }
  return neighbours;
}

std::vector<Isometry3d> BodySites::Poses(const Posture& posture) const {
  MarkerJacobian at = probes_.MakeJacobian();
  probes_.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                         posture.joint_angles, &at);
  std::vector<Isometry3d> poses(sites_.size(), Isometry3d::Identity());
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    const auto probes = at.p_WM.middleCols<4>(static_cast<Eigen::Index>(4 * i));
    poses[i].translation() = probes.col(0);
    poses[i].linear() = probes.rightCols<3>().colwise() - probes.col(0);
  }
  return poses;
}

double BodySites::DistanceFromBones(int site, const Vector3d& p_SM) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : sites_[site].bones) {
    const Vector3d along = to - from;
    const double share =
        std::clamp(along.dot(p_SM - from) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
    nearest = std::min(nearest, (p_SM - from - share * along).norm());
  }
  return nearest;
}

double BodySites::DistanceFromMarkers(int site, const Vector3d& p_SM) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vector3d& place : sites_[site].places) {
    nearest = std::min(nearest, (p_SM - place).norm());
  }
  return nearest;
}

double BodySites::DistanceFromJoints(int site, const Vector3d& p_SM) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : sites_[site].bones) {
    nearest = std::min({nearest, (p_SM - from).norm(), (p_SM - to).norm()});
  }
  return nearest;
}

std::pair<int, Vector3d> BodySites::OnSite(int node, const Vector3d& p_SM) const {
  const Vector3d p_WM = X_WS_[node] * p_SM;
  for (int link = LinkOf(model_, joints_, node);;
       link = LinkOf(model_, joints_, model_.segments()[link].parent)) {
    for (int s = 0; s < static_cast<int>(sites_.size()); ++s) {
      const int segment = sites_[s].segment;
      if (LinkOf(model_, joints_, segment) == link) return {s, X_WS_[segment].inverse() * p_WM};
    }
    if (link == 0) return {-1, p_SM};
  }
}

std::pair<int, Vector3d> BodySites::Mirrored(int site, const Vector3d& p_SM) const {
  const int other = sites_[site].mirror >= 0 ? sites_[site].mirror : site;
  Vector3d p_WM = X_WS_[sites_[site].segment] * p_SM;
  p_WM.x() = -p_WM.x();
  return {other, X_WS_[sites_[other].segment].inverse() * p_WM};
}

bool BodySites::IsAtJointBetween(int site, int other, const Vector3d& p_SM, double reach) const {
  const bool is_below = sites_[other].parent == site;
  if (!is_below && sites_[site].parent != other) return false;
  const int lower = is_below ? other : site;
  const Vector3d joint_W = X_WS_[LinkOf(model_, joints_, sites_[lower].segment)].translation();
  return (X_WS_[sites_[site].segment] * p_SM - joint_W).norm() < reach;
}

std::pair<int, Vector3d> BodySites::OnUsualNode(int site, const Vector3d& p_SM) const {
  const BodySite& at = sites_[site];
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < at.places.size(); ++i) {
    if ((p_SM - at.places[i]).norm() < (p_SM - at.places[nearest]).norm()) nearest = i;
  }
  const int node = at.nodes[nearest];
  return {node, X_WS_[node].inverse() * X_WS_[at.segment] * p_SM};
}

}  // namespace mmm_converter
