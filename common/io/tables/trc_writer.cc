// SPDX-License-Identifier: MIT
#include "common/io/tables/trc_writer.h"

#include <fmt/format.h>

#include <cassert>
#include <optional>

#include "common/io/tables/column_names.h"
#include "common/io/tables/table_rows.h"
#include "common/io/xml/xml_text.h"
#include "common/math/up_axis.h"
#include "common/model/marker_kinematics.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

/// Where the model has its markers, frame by frame.
class ModelMarkers {
 public:
  explicit ModelMarkers(const TrcOutput& output)
      : trajectory_(*output.trajectory), kinematics_(MakeKinematics(output)) {
    at_ = kinematics_.MakeJacobian();
  }

  const Eigen::Matrix3Xd& At(int k) {
    const Posture& q = trajectory_.postures[k];
    kinematics_.ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles, &at_);
    return at_.p_WM;
  }

 private:
  static MarkerKinematics MakeKinematics(const TrcOutput& output) {
    std::vector<int> joints;
    joints.reserve(output.trajectory->joint_names.size());
    for (const std::string& name : output.trajectory->joint_names) {
      joints.push_back(output.model->FindJoint(name));
      if (joints.back() < 0) {
        throw Error(fmt::format("model {} has no joint {}", output.model->name(), name));
      }
    }
    std::vector<MarkerIx> markers;
    markers.reserve(output.model_markers.size());
    for (const TrcModelMarker& one : output.model_markers) markers.push_back(one.marker);
    return MarkerKinematics(*output.model, joints, markers, std::vector<int>());
  }

  const PoseTrajectory& trajectory_;
  MarkerKinematics kinematics_;
  MarkerJacobian at_;
};

std::vector<std::string> Labels(const TrcOutput& output) {
  std::vector<std::string> labels = output.measured->labels();
  labels.reserve(labels.size() + output.model_markers.size());
  for (const TrcModelMarker& one : output.model_markers) {
    labels.push_back(output.measured->labels()[one.label] + "_model");
  }
  return ColumnNames(labels);
}

std::string FormatTrcHeader(const TrcOutput& output) {
  const std::vector<std::string> labels = Labels(output);
  const int frames = output.measured->num_frames();
  std::string rate;
  AppendDecimal(output.measured->rate(), kSecondDecimals, &rate);
  std::string header = fmt::format(
      "PathFileType\t4\t(X/Y/Z)\t{}\n"
      "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
      "OrigNumFrames\n"
      "{}\t{}\t{}\t{}\tmm\t{}\t{}\t{}\n"
      "Frame#\tTime\t",
      OneWord(output.file_name), rate, rate, frames, labels.size(), rate, output.first_frame,
      frames);
  for (const std::string& label : labels) header += label + "\t\t\t";
  header += "\n\t\t";
  for (std::size_t i = 1; i <= labels.size(); ++i) header += fmt::format("X{0}\tY{0}\tZ{0}\t", i);
  return header + "\n\n";
}

void AppendPoints(const Eigen::Ref<const Eigen::Matrix3Xd>& p_WM, std::string* out) {
  static const Eigen::Matrix3d rotation = RotationToZUp(UpAxis::kY).transpose();
  for (Eigen::Index i = 0; i < p_WM.cols(); ++i) {
    if (!IsSeen(p_WM.col(i))) {
      *out += "\t\t\t";
      continue;
    }
    const Eigen::Vector3d p = kMillimetres * (rotation * p_WM.col(i));
    for (const double coordinate : p) {
      AppendDecimal(coordinate, kMillimetreDecimals, out);
      *out += '\t';
    }
  }
}

}  // namespace

TextPieces FormatTrc(const TrcOutput& output) {
  std::optional<ModelMarkers> model;
  if (!output.model_markers.empty()) {
    assert(output.trajectory->num_frames() == output.measured->num_frames());
    model.emplace(output);
  }
  const auto row = [output, model](int k, std::string* out) mutable {
    *out += fmt::format("{}\t", output.first_frame + k);
    AppendDecimal(output.measured->time(k), kSecondDecimals, out);
    *out += '\t';
    AppendPoints(output.measured->frame(k), out);
    if (model) AppendPoints(model->At(k), out);
  };
  return TableText(FormatTrcHeader(output), {0, output.measured->num_frames()}, row);
}

}  // namespace mmm_converter
