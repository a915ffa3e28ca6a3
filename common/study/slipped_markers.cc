// SPDX-License-Identifier: MIT
#include "common/study/slipped_markers.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>

#include "common/fit/rigid_shape.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3Xd;

constexpr int kSlipFrames = 2000;  // that are looked at
constexpr std::size_t kSpines = 4;

/// The frames that show all of them, some thousand, and their places on a common shape.
struct Shapes {
  std::vector<int> frames;
  std::vector<Matrix3Xd> places;
};

Shapes ShapesOf(const MarkerSequence& recording, const std::vector<int>& labels) {
  Shapes shapes;
  const int step = 1 + recording.num_frames() / kSlipFrames;
  for (int k = 0; k < recording.num_frames(); k += step) {
    const Matrix3Xd points = recording.frame(k)(Eigen::all, labels);
    if (!points.allFinite()) continue;
    shapes.frames.push_back(k);
    shapes.places.push_back(points);
  }
  if (shapes.places.empty()) return shapes;
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(shapes.places.front().cols());
  Matrix3Xd shape = shapes.places.front();
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    Matrix3Xd sum = Matrix3Xd::Zero(3, shape.cols());
    for (Matrix3Xd& one : shapes.places) {
      one = FitRigidPose(one, shape, weights) * one;
      sum += one;
    }
    shape = sum / static_cast<double>(shapes.places.size());
  }
  return shapes;
}

/// How much of a step out of their plane by one of four markers, the one of which it is most, a
/// rigid fit leaves: it follows by all steps that a plane can make.
double ShareThatFitLeaves(const Matrix3Xd& shape) {
  const Matrix3Xd centred = shape.colwise() - shape.rowwise().mean();
  const Eigen::JacobiSVD<Eigen::MatrixXd> axes(centred, Eigen::ComputeThinU);
  Eigen::MatrixXd planes(3, shape.cols());
  planes << Eigen::RowVectorXd::Ones(shape.cols()),
      axes.matrixU().leftCols<2>().transpose() * centred;
  const Eigen::VectorXd left = planes.fullPivLu().kernel().col(0).normalized();
  return left.cwiseAbs().maxCoeff();
}

std::vector<int> FindIliacSpines(const TrackingSetup& setup) {
  std::vector<int> labels;
  for (const MarkerAssignment& one : setup.assignments()) {
    const std::string& name = setup.model->markers()[one.marker].name;
    if (name.ends_with("ASI") || name.ends_with("PSI")) labels.push_back(one.label);
  }
  return labels;
}

}  // namespace

std::optional<SlippedMarkers> FindSlippedPelvis(const TrackingSetup& setup,
                                                const MarkerSequence& recording) {
  const std::vector<int> labels = FindIliacSpines(setup);
  if (labels.size() != kSpines) return {};
  const Shapes shapes = ShapesOf(recording, labels);
  const auto count = static_cast<int>(shapes.frames.size());
  const auto time = [&](int at) { return recording.time(shapes.frames[at]); };
  std::vector<Matrix3Xd> sums(1, Matrix3Xd::Zero(3, kSpines));
  for (const Matrix3Xd& one : shapes.places) sums.emplace_back(sums.back() + one);
  SlippedMarkers most;
  const double left = count == 0 ? 1 : ShareThatFitLeaves(shapes.places.front());
  for (int at = 1; at < count; ++at) {
    if (time(at - 1) - time(0) < kSlipWindow || time(count - 1) - time(at) < kSlipWindow) continue;
    const Matrix3Xd changes = (sums[count] - sums[at]) / (count - at) - sums[at] / at;
    const double distance = changes.norm() / left;
    if (distance <= most.distance) continue;
    most.distance = distance;
    most.time = time(at);
  }
  if (most.distance == 0) return {};
  for (const int label : labels) most.labels.push_back(recording.labels()[label]);
  return most;
}

}  // namespace mmm_converter
