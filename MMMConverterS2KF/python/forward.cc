// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/python/forward.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"

namespace mmm_converter::python {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The segments of one posture. What is the identity is left out, which changes no bit of a product.
class SegmentChain {
 public:
  explicit SegmentChain(const KinematicModel& model)
      : model_(model), p_(model.segments().size()), R_(model.segments().size()) {
    is_turned_.reserve(p_.size());
    for (const Segment& segment : model.segments()) {
      is_turned_.push_back(segment.X_PF.linear() != Matrix3d::Identity());
    }
  }

  void Compute(const Posture& posture) {
    p_[0] = posture.position;
    R_[0] = posture.orientation.toRotationMatrix();
    for (std::size_t i = 1; i < p_.size(); ++i) {
      const Segment& segment = model_.segments()[i];
      const Matrix3d& R_WP = R_[segment.parent];
      p_[i] = R_WP * segment.X_PF.translation() + p_[segment.parent];
      R_[i] = is_turned_[i] ? Matrix3d(R_WP * segment.X_PF.linear()) : R_WP;
      if (segment.joint < 0) continue;
      const double value = JointValue(segment, posture.joint_angles[segment.joint]);
      if (value == 0) continue;
      if (segment.type == JointType::kSliding) {
        p_[i] += R_[i] * (value * segment.axis);
        continue;
      }
      const Eigen::AngleAxisd turn(value, segment.axis);
      R_[i] = R_[i] * turn.toRotationMatrix();
    }
  }

  void Store(double* p_WS, double* R_WS) const {
    for (std::size_t i = 0; i < p_.size(); ++i) {
      Eigen::Map<Vector3d>(p_WS + 3 * i) = p_[i];
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R_WS + 9 * i) = R_[i];
    }
  }

  Vector3d PlaceOf(const ModelMarker& marker) const {
    return R_[marker.segment] * marker.p_SM + p_[marker.segment];
  }

 private:
  const KinematicModel& model_;
  std::vector<Vector3d> p_;
  std::vector<Matrix3d> R_;
  std::vector<bool> is_turned_;
};

// Fills a batch with the postures [begin, begin + samples).
void FillBatch(const KinematicModel& model, const std::vector<int>& joints,
               const ForwardArrays& arrays, std::ptrdiff_t begin, int samples, MarkerBatch* batch) {
  const Posture rest = ZeroPosture(model);
  const auto count = static_cast<std::ptrdiff_t>(joints.size());
  for (int j = 0; j < model.num_joints(); ++j) {
    std::fill_n(batch->angles.col(j), samples, rest.joint_angles[j]);
  }
  for (int i = 0; i < samples; ++i) {
    const std::ptrdiff_t k = begin + i;
    const double* q = arrays.quaternions + 4 * k;
    const Eigen::Matrix3d R = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    for (int e = 0; e < 9; ++e) batch->rotation.col(e)[i] = R(e / 3, e % 3);
    for (int e = 0; e < 3; ++e) batch->position.col(e)[i] = arrays.positions[3 * k + e];
    for (std::ptrdiff_t j = 0; j < count; ++j) {
      batch->angles.col(joints[j])[i] = arrays.angles[count * k + j];
    }
  }
}

}  // namespace

void ComputeForward(const KinematicModel& model, const std::vector<int>& joints,
                    std::ptrdiff_t frames, const ForwardArrays& arrays) {
  const std::size_t segments = model.segments().size();
  const double* angles = arrays.angles;
  double* p_WM = arrays.p_WM;
  Posture posture = ZeroPosture(model);
  SegmentChain chain(model);
  for (std::ptrdiff_t k = 0; k < frames; ++k) {
    posture.position = Eigen::Map<const Vector3d>(arrays.positions + 3 * k);
    const double* q = arrays.quaternions + 4 * k;
    posture.orientation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    for (const int joint : joints) posture.joint_angles[joint] = *angles++;
    chain.Compute(posture);
    chain.Store(arrays.p_WS + 3 * segments * k, arrays.R_WS + 9 * segments * k);
    for (const ModelMarker& marker : model.markers()) {
      Eigen::Map<Vector3d>{p_WM} = chain.PlaceOf(marker);
      p_WM += 3;
    }
  }
}

void ComputeMarkerPlaces(const KinematicModel& model, const std::vector<int>& joints,
                         std::ptrdiff_t frames, const ForwardArrays& arrays) {
  constexpr std::ptrdiff_t kSamples = 256;  // what stays in the cache
  std::vector<int> all(model.num_joints());
  std::iota(all.begin(), all.end(), 0);
  std::vector<MarkerIx> markers;
  markers.reserve(model.markers().size());
  for (std::size_t i = 0; i < model.markers().size(); ++i) {
    markers.emplace_back(static_cast<int>(i));
  }
  const MarkerKinematics kinematics(model, all, markers, std::vector<int>());
  MarkerBatch batch = kinematics.MakeBatch(kSamples);
  const int columns = 3 * kinematics.num_markers();
  for (std::ptrdiff_t begin = 0; begin < frames; begin += kSamples) {
    const int samples = static_cast<int>(std::min(kSamples, frames - begin));
    FillBatch(model, joints, arrays, begin, samples, &batch);
    kinematics.ComputeBatch(&batch);
    Eigen::Map<Eigen::MatrixXd>(arrays.p_WM + columns * begin, columns, samples) =
        batch.markers.view().topLeftCorner(samples, columns).transpose();
  }
}

}  // namespace mmm_converter::python
