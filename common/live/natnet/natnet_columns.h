// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "common/live/natnet/natnet_frame.h"
#include "common/live/natnet/natnet_model.h"

namespace mmm_converter {

/// Which point of a frame is which named marker. Labelled points tell their asset (rigid body,
/// skeleton, trained marker set) and their number in it; the names are those of the marker set that
/// is called like the asset. Before 2.8 they do not, and of marker sets that are no asset either:
/// their points are found in the frame's own marker sets.
class NatNetColumns {
 public:
  NatNetColumns() = default;
  NatNetColumns(const NatNetModel& model, const NatNetVersion& version);

  /// A name that several assets have stands behind that of its asset: "Anna:LFHD".
  const std::vector<std::string>& labels() const { return labels_; }

  struct Rest {
    int unnamed = 0;             ///< points without a column
    bool has_new_asset = false;  ///< some are of an asset that the model does not have
  };
  /// *points: 3 x labels [m], in the axes of the stream; NaN where a marker is not seen, also where
  /// the server has filled it from its model of the asset. *unnamed: the points without a column
  /// that are measured; may be null.
  Rest Fill(const NatNetFrame& frame, Eigen::Matrix3Xd* points,
            std::vector<Eigen::Vector3d>* unnamed = nullptr) const;

 private:
  struct Group {
    std::string name;
    std::int32_t id = -1;  // of the asset, its low word; -1: a marker set only
    std::vector<std::string> names;
    int first_column = 0;
  };

  void AddAssets(const NatNetModel& model);
  void AddAsset(const NatNetModel& model, const std::string& name, std::int32_t id,
                const std::vector<std::string>& own_names);
  void NameColumns();
  const Group* FindAsset(std::int32_t id) const;
  void FillSets(const NatNetFrame& frame, Eigen::Matrix3Xd* points) const;

  std::vector<Group> groups_;
  std::vector<std::string> labels_;
  bool has_member_ids_ = true;
};

}  // namespace mmm_converter
