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
  /// A frame in which neither has another. track: the point's. offset: of the point from the
  /// marker's place, axes of its link [m]; p_WP: of the point [m].
  void Add(int marker, int track, const Eigen::Vector3d& offset, const Eigen::Vector3d& p_WP);

  /// Markers and their tracks, each track at most once, those of a marker at the same place.
  /// dt [s]: of a frame. reach [m]: of a place, from the marker's own.
  std::vector<std::pair<int, int>> Find(double dt, double reach) const;

 private:
  /// Of vectors [m].
  struct Moments {
    double count = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double squares = 0;

    void Add(const Eigen::Vector3d& v);
    void Add(const Moments& more);
    Eigen::Vector3d Mean() const { return sum / count; }
    double Deviation() const;  ///< each coordinate
  };
  struct Seen {
    Moments offset, p_WP;
  };
  using Track = std::pair<const std::pair<int, int>, Seen>;
  struct Place {
    int marker = 0;
    double distance = 0;  ///< from the model's place [m]
    Seen all;
    std::vector<int> tracks;
  };
  /// Where the marker's tracks are for longest.
  Place FindPlace(int marker) const;

  std::map<std::pair<int, int>, Seen> tracks_;  ///< by marker and track
};

}  // namespace mmm_converter
