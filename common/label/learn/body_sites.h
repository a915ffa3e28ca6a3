// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <utility>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// A rigid part of a body that can wear markers: all nodes that no tracked joint moves against each
/// other. Known from the markers that the model has there.
struct BodySite {
  int segment = 0;   ///< a node of it; all that follows is in its axes
  std::string side;  ///< "left", "right" or empty
  std::vector<MarkerIx> markers;
  std::vector<Eigen::Vector3d> places;  ///< of these [m]
  std::vector<int> nodes;               ///< by marker: the node that the model has it on
  /// From the joint above to those below; of the last to the middle of the markers [m].
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> bones;
  int parent = -1;  ///< the next site above
  int mirror = -1;  ///< the same of the other side
};

/// The sites of a body, and where they are in a posture.
class BodySites {
 public:
  /// model: of the person's size; must outlive it. joints: tracked.
  BodySites(const KinematicModel& model, std::vector<int> joints);

  const std::vector<BodySite>& sites() const { return sites_; }
  const KinematicModel& model() const { return model_; }
  const std::vector<int>& joints() const { return joints_; }

  /// Sites that are one or two joints away.
  std::vector<int> Neighbours(int site) const;

  /// X_WS of each site's segment. posture: tracked joints.
  std::vector<Eigen::Isometry3d> Poses(const Posture& posture) const;

  /// Distance of a place from the nearest bone of a site [m].
  double DistanceFromBones(int site, const Eigen::Vector3d& p_SM) const;
  /// Distance of a place from the nearest of the model's markers of a site [m].
  double DistanceFromMarkers(int site, const Eigen::Vector3d& p_SM) const;
  /// Distance from the nearest joint at the end of a bone [m].
  double DistanceFromJoints(int site, const Eigen::Vector3d& p_SM) const;

  /// The site that carries a node, and a place of the node in its axes; -1: none does.
  std::pair<int, Eigen::Vector3d> OnSite(int node, const Eigen::Vector3d& p_SM) const;
  /// The site of the other side and the place there that mirrors a place, where left is -x in the
  /// model's zero posture.
  std::pair<int, Eigen::Vector3d> Mirrored(int site, const Eigen::Vector3d& p_SM) const;
  /// Whether a place is near the joint between two sites.
  bool IsAtJointBetween(int site, int other, const Eigen::Vector3d& p_SM, double reach) const;

  /// The place in axes of the node that the model has its nearest marker of the site on.
  std::pair<int, Eigen::Vector3d> OnUsualNode(int site, const Eigen::Vector3d& p_SM) const;

 private:
  const KinematicModel& model_;
  std::vector<int> joints_;
  std::vector<Eigen::Isometry3d> X_WS_;  // of all nodes where every angle is zero
  std::vector<BodySite> sites_;
  KinematicModel probed_;  // with an origin and three axes for each site
  MarkerKinematics probes_;
};

}  // namespace mmm_converter
