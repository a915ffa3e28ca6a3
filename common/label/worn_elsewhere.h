// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <map>
#include <utility>
#include <vector>

namespace mmm_converter {

/// Points that no marker has, seen from links of which a marker has no point. One that stays at a
/// place of the link while this moves is worn there: the marker, farther from the model's place
/// than a point that is named by its place alone.
class WornElsewhere {
 public:
  static constexpr int kLeastFrames = 10;  ///< of a track; of shorter ones nothing is known

  /// A frame in which neither has another. track: the point's. offset: of the point from the
  /// marker's place, axes of its link [m]; p_WP: of the point [m].
  void Add(int marker, int track, const Eigen::Vector3d& offset, const Eigen::Vector3d& p_WP);

  /// Markers and their tracks, each track at most once, those of a marker at the same place.
  /// dt [s]: of a frame.
  std::vector<std::pair<int, int>> Find(double dt) const;

 private:
  struct Sums {
    double count = 0;
    Eigen::Vector3d offset = Eigen::Vector3d::Zero(), p_WP = Eigen::Vector3d::Zero();
    double offset_squares = 0, p_WP_squares = 0;

    Sums& operator+=(const Sums& more);
    double ScatterOfOffset() const;  ///< each coordinate [m]
    double Path() const;             ///< deviation of the points, each coordinate [m]
    Eigen::Vector3d MeanOffset() const { return offset / count; }
  };
  using Track = std::pair<const std::pair<int, int>, Sums>;
  struct Place {
    int marker = 0;
    double distance = 0;  ///< from the model's place [m]
    Sums all;
    std::vector<int> tracks;
  };
  /// Where the marker's tracks are for longest.
  Place FindPlace(int marker) const;

  std::map<std::pair<int, int>, Sums> tracks_;  ///< by marker and track
};

}  // namespace mmm_converter
