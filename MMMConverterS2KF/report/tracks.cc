// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/tracks.h"

#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "MMMConverterS2KF/report/packed_array.h"
#include "MMMConverterS2KF/report/subject_json.h"
#include "MMMConverterS2KF/terminal/advice.h"
#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

using Eigen::MatrixXd;
using nlohmann::json;

json Floats(const MatrixXd& numbers) { return ToJson<json>(PackFloats(numbers)); }
json Quantised(const MatrixXd& numbers) { return ToJson<json>(PackQuantised(numbers)); }

json VectorJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

json ModelJson(const KinematicModel& model) {
  json segments = json::array();
  for (const Segment& segment : model.segments()) {
    const Eigen::Quaterniond q(segment.X_PF.linear());
    segments.push_back({{"name", segment.name},
                        {"parent", segment.parent},
                        {"position", VectorJson(segment.X_PF.translation())},
                        {"orientation", {q.x(), q.y(), q.z(), q.w()}},
                        {"axis", VectorJson(segment.axis)},
                        {"joint", segment.joint}});
  }
  json markers = json::array();
  for (const ModelMarker& marker : model.markers()) {
    markers.push_back({{"name", marker.name},
                       {"segment", marker.segment},
                       {"position", VectorJson(marker.p_SM)}});
  }
  json joints = json::array();
  for (int i = 0; i < model.num_joints(); ++i) {
    const Segment& joint = model.joint(i);
    joints.push_back({{"name", joint.name}, {"lower", joint.lower}, {"upper", joint.upper}});
  }
  return {{"segments", segments}, {"markers", markers}, {"joints", joints}};
}

json MotionJson(const KinematicModel& model, const PoseTrajectory& trajectory) {
  const int frames = trajectory.num_frames();
  const auto num_joints = static_cast<Eigen::Index>(trajectory.joint_names.size());
  MatrixXd position(3, frames);
  MatrixXd orientation(4, frames);
  MatrixXd angles(frames, num_joints);
  for (int k = 0; k < frames; ++k) {
    const Posture& posture = trajectory.postures[k];
    position.col(k) = posture.position;
    orientation.col(k) = posture.orientation.coeffs();
    angles.row(k) = posture.joint_angles.transpose();
  }
  json joints = json::array();
  for (const std::string& name : trajectory.joint_names) joints.push_back(model.FindJoint(name));
  // Position and orientation: a frame's components beside each other.
  json motion = {{"joints", joints},
                 {"position", Quantised(position)},
                 {"orientation", Quantised(orientation)},
                 {"angles", Quantised(angles)}};
  const MatrixXd& deviations = trajectory.standard_deviations;
  if (deviations.cols() == frames && deviations.rows() == 6 + num_joints) {
    motion["deviations"] = Quantised(deviations.bottomRows(num_joints).transpose());
  }
  return motion;
}

json TrialJson(const Trial& trial, const CommonGround& ground) {
  json out = {{"name", trial.name}, {"failure", trial.failure}};
  if (!trial.model || ground.labels.empty()) return out;
  const int frames = trial.markers.num_frames();
  const auto num_labels = static_cast<Eigen::Index>(ground.labels.size());
  json labels = json::array();
  for (const int label : ground.labels) labels.push_back(trial.markers.labels()[label]);
  MatrixXd positions(3 * num_labels, frames);
  for (int k = 0; k < frames; ++k) {
    const Eigen::Matrix3Xd markers = trial.markers.frame(k)(Eigen::all, ground.labels);
    positions.col(k) = markers.reshaped();
  }
  out.update({{"frames", frames},
              {"rate", trial.markers.rate()},
              {"first_time", trial.markers.first_time()},
              {"labels", labels},
              {"markers", ground.markers},
              {"model", ModelJson(*trial.model)},
              {"positions", Quantised(positions)},  // a frame's markers beside each other
              {"hidden", ToJson<json>(PackBits(ground.hidden.transpose()))},
              {"optimum", Floats(ground.optimum)},
              {"mean_hidden", Floats(ground.mean_hidden)},
              {"most_hidden", Floats(ground.most_hidden)}});
  if (trial.subject) out["subject"] = json::parse(FormatSubjectJson(*trial.subject));
  if (trial.truth && trial.truth->num_frames() == frames) {
    out["truth"] = MotionJson(*trial.model, *trial.truth);
  }
  return out;
}

/// NIS over its degrees of freedom, and what 95 of 100 frames of a consistent filter stay within;
/// NaN where no marker was seen or the converter states none.
void AddNis(const ConversionResult& result, json* out) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  MatrixXd nis = MatrixXd::Constant(3, static_cast<Eigen::Index>(result.frames.size()), kNaN);
  std::map<int, std::pair<double, double>> bands;
  for (Eigen::Index k = 0; k < nis.cols(); ++k) {
    const FrameDiagnostic& frame = result.frames[k];
    const int degrees = 3 * frame.markers_seen;
    if (degrees == 0 || frame.nis <= 0) continue;
    auto& [low, high] = bands[degrees];
    if (high == 0) {
      low = ChiSquareQuantile(0.025, degrees) / degrees;
      high = ChiSquareQuantile(0.975, degrees) / degrees;
    }
    nis.col(k) << frame.nis, low, high;
  }
  (*out)["nis"] = Floats(nis.row(0));
  (*out)["nis_low"] = Floats(nis.row(1));
  (*out)["nis_high"] = Floats(nis.row(2));
}

json IncidentsJson(const Trial& trial, const ComparisonRow& row) {
  json incidents = json::array();
  const auto label = [&](int assignment) {
    return trial.markers.labels()[row.setup.assignments()[assignment].label];
  };
  for (const MarkerIncident& incident : row.result.incidents) {
    json labels = {label(incident.assignment)};
    if (incident.other >= 0) labels.push_back(label(incident.other));
    incidents.push_back({{"kind", Name(incident.kind)},
                         {"labels", labels},
                         {"first", incident.first_frame},
                         {"last", incident.last_frame}});
  }
  return incidents;
}

json RowJson(const Trial& trial, const ComparisonRow& row) {
  json out = {{"trial", row.trial},
              {"contender", row.contender},
              {"failure", WithAdvice(row.failure, row.remedy)},
              {"warnings", row.warnings.texts()},
              {"ignored", row.setup.mapping.ignored_labels},
              {"absent", row.setup.mapping.absent_markers}};
  if (!row.failure.empty()) return out;
  Eigen::VectorXd seconds(row.result.frames.size());
  for (Eigen::Index k = 0; k < seconds.size(); ++k) seconds[k] = row.result.frames[k].seconds;
  out.update({{"incidents", IncidentsJson(trial, row)},
              {"motion", MotionJson(*trial.model, row.result.trajectory)},
              {"distances", Quantised(row.distances.transpose())},
              {"mean", Floats(row.mean_distance)},
              {"p05", Floats(row.p05_distance)},
              {"p95", Floats(row.p95_distance)},
              {"max", Floats(row.max_distance)},
              {"seconds", Floats(seconds)}});
  AddNis(row.result, &out);
  return out;
}

}  // namespace

std::string FormatTracks(const Comparison& comparison) {
  json trials = json::array();
  for (std::size_t i = 0; i < comparison.trials.size(); ++i) {
    trials.push_back(TrialJson(comparison.trials[i], comparison.grounds[i]));
  }
  json contenders = json::array();
  for (const Contender& contender : comparison.contenders) {
    contenders.push_back({{"name", contender.name},
                          {"configuration", contender.configuration},
                          {"failure", contender.failure}});
  }
  json rows = json::array();
  for (const ComparisonRow& row : comparison.rows) {
    rows.push_back(RowJson(comparison.trials[row.trial], row));
  }
  const json tracks = {{"trials", trials}, {"contenders", contenders}, {"rows", rows}};
  return tracks.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace mmm_converter
