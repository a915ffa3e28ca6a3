// SPDX-License-Identifier: MIT
#include "common/model/size_effects.h"

#include <map>
#include <string>

#include "common/model/kit_joints.h"

namespace mmm_converter {

using Eigen::Vector3d;

SizeEffects::SizeEffects(const KinematicModel& model, const MarkerKinematics& kinematics,
                         const SizeDeviations& deviations)
    : deviations_(deviations) {
  const int num_links = kinematics.num_links();
  std::vector<bool> has_size(num_links, false);
  for (int m = 0; m < kinematics.num_markers(); ++m) {
    link_.push_back(kinematics.link_of_marker(m));
    has_size[link_.back()] = true;
  }
  parent_.push_back(0);
  for (int l = 1; l < num_links; ++l) {
    parent_.push_back(kinematics.link(l).parent);
    if (kinematics.link(l).translated) has_size[parent_.back()] = true;
  }
  if (kinematics.is_root_fixed()) has_size[0] = false;
  std::map<std::string, int> part_of_name;
  for (int l = 0; l < num_links; ++l) {
    part_.push_back(-1);
    if (!has_size[l]) continue;
    const std::string& name = model.segments()[kinematics.segment_of_link(l)].name;
    const std::string mirrored = MirroredOsimName(name);
    const auto other = mirrored.empty() ? part_of_name.end() : part_of_name.find(mirrored);
    part_[l] = other == part_of_name.end() ? num_parts_++ : other->second;
    part_of_name.emplace(name, part_[l]);
  }
}

void SizeEffects::Compute(const MarkerJacobian& at, PaddedMatrix* effects) const {
  effects->SetZero();
  for (std::size_t m = 0; m < link_.size(); ++m) {
    auto rows = effects->view().middleRows<3>(3 * static_cast<Eigen::Index>(m));
    Vector3d end = at.p_WM.col(static_cast<Eigen::Index>(m));
    for (int l = link_[m];; l = parent_[l]) {
      const Vector3d way = end - at.p_WL[l];
      end = at.p_WL[l];
      if (part_[l] >= 0) {
        auto columns = rows.middleCols<kEffects>(kEffects * part_[l]);
        columns.col(0) += deviations_.whole * way;
        for (int axis = 0; axis < 3; ++axis) {
          const Vector3d a = at.R_WL[l].col(axis);
          columns.col(1 + axis) += deviations_.along * a.dot(way) * a;
        }
      }
      if (l == 0) break;
    }
  }
}

}  // namespace mmm_converter
