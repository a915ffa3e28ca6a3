// SPDX-License-Identifier: MIT
#include "common/retarget/body_posture.h"

namespace mmm_converter {
namespace {

Eigen::Vector3d Place(const BodyPoint& point, const std::vector<Eigen::Isometry3d>& X_WS) {
  return X_WS[point.segment] * point.p_S;
}

LimbPosture PostureOfLimb(const LimbMap& limb, const std::vector<Eigen::Isometry3d>& X_WS) {
  return {Place(limb.proximal, X_WS),
          Place(limb.middle, X_WS),
          Place(limb.distal, X_WS),
          X_WS[limb.upper.segment].linear() * limb.upper.R_SL,
          X_WS[limb.lower.segment].linear() * limb.lower.R_SL,
          X_WS[limb.end].linear() * limb.R_ED};
}

}  // namespace

BodyPosture PostureOfBody(const BodyMap& map, const std::vector<Eigen::Isometry3d>& X_WS) {
  BodyPosture body;
  body.R_pelvis = X_WS[map.pelvis].linear() * map.R_PA;
  body.R_chest = X_WS[map.chest].linear() * map.R_CA;
  body.mid_hip = X_WS[map.pelvis].translation();
  for (std::size_t i = 0; i < 2; ++i) {
    if (map.legs[i]) body.legs[i] = PostureOfLimb(*map.legs[i], X_WS);
    if (map.arms[i]) body.arms[i] = PostureOfLimb(*map.arms[i], X_WS);
  }
  if (map.has_legs()) body.mid_hip = 0.5 * (body.legs[0].proximal + body.legs[1].proximal);
  return body;
}

}  // namespace mmm_converter
