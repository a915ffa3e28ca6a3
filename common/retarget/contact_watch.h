// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>

namespace mmm_converter {

/// An end of a foot as it moves, from the frames until now alone: how high above its own level, how
/// fast, and whether it rests on the ground, as FindRests has it.
class PointWatch {
 public:
  /// level: of the point where it stands on z = 0 [m].
  explicit PointWatch(double level) : level_(level) {}

  /// time [s] is later than the last one, but for the first after Forget.
  void Take(const Eigen::Vector3d& p_W, double time);
  /// The next point is the first one; the level stays.
  void Forget();

  bool is_on() const { return is_on_; }
  double level() const { return level_; }  ///< [m]
  double height() const { return p_.z() - level_; }
  const Eigen::Vector3d& velocity() const { return velocity_; }  ///< [m/s]
  /// Stands still, but so high that its level may be another one.
  bool is_raised() const { return is_slow_ && height_ > 0; }
  bool is_low() const { return is_slow_ && height_ <= 0; }
  double height_of_level() const { return p_.z(); }
  void SetLevel(double level) { level_ = level; }

 private:
  struct Sample {
    Eigen::Vector3d p;
    double time = 0;
  };
  Eigen::Vector3d VelocityAt(const Eigen::Vector3d& p_W, double time) const;

  static constexpr int kSamples = 64;
  std::array<Sample, kSamples> samples_;
  int count_ = 0, next_ = 0;
  Eigen::Vector3d p_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
  double level_;
  double height_ = 0;    // above what still tells the level [m]
  double told_for_ = 0;  // [s] that frames told the level
  bool is_on_ = false, is_slow_ = false;
  bool has_stood_ = false;  // still; feet of runners hardly do
};

}  // namespace mmm_converter
