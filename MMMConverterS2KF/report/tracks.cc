// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/tracks.h"

#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "MMMConverterS2KF/report/packed_array.h"
#include "MMMConverterS2KF/report/subject_json.h"
#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

using Eigen::MatrixXd;

Json Floats(const MatrixXd& numbers) { return ToJson(PackFloats(numbers)); }
Json Quantised(const MatrixXd& numbers) { return ToJson(PackQuantised(numbers)); }

Json VectorJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json ModelJson(const KinematicModel& model) {
  Json segments = Json::array();
  for (const Segment& segment : model.segments()) {
    const Eigen::Quaterniond q(segment.X_PF.linear());
    segments.push_back({{"name", segment.name},
                        {"parent", segment.parent},
                        {"position", VectorJson(segment.X_PF.translation())},
                        {"orientation", {q.x(), q.y(), q.z(), q.w()}},
                        {"axis", VectorJson(segment.axis)},
                        {"joint", segment.joint}});
  }
  Json markers = Json::array();
  for (const ModelMarker& marker : model.markers()) {
    markers.push_back({{"name", marker.name},
                       {"segment", marker.segment},
                       {"position", VectorJson(marker.p_SM)}});
  }
  Json joints = Json::array();
  for (int i = 0; i < model.num_joints(); ++i) {
    const Segment& joint = model.joint(i);
    joints.push_back({{"name", joint.name}, {"lower", joint.lower}, {"upper", joint.upper}});
  }
  return {{"segments", segments}, {"markers", markers}, {"joints", joints}};
}

Json MotionJson(const KinematicModel& model, const PoseTrajectory& trajectory) {
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
  Json joints = Json::array();
  for (const std::string& name : trajectory.joint_names) joints.push_back(model.FindJoint(name));
  // Position and orientation: a frame's components beside each other.
  Json motion = {{"joints", joints},
                 {"position", Quantised(position)},
                 {"orientation", Quantised(orientation)},
                 {"angles", Quantised(angles)}};
  const MatrixXd& deviations = trajectory.standard_deviations;
  if (deviations.cols() == frames && deviations.rows() == 6 + num_joints) {
    motion["deviations"] = Quantised(deviations.bottomRows(num_joints).transpose());
  }
  return motion;
}

Json TrialJson(const Trial& trial, const CommonGround& ground) {
  Json out = {{"name", trial.name}, {"failure", trial.failure}};
  if (!trial.model || ground.labels.empty()) return out;
  const int frames = trial.markers.num_frames();
  const auto num_labels = static_cast<Eigen::Index>(ground.labels.size());
  Json labels = Json::array();
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
              {"hidden", ToJson(PackBits(ground.hidden.transpose()))},
              {"optimum", Floats(ground.optimum)},
              {"mean_hidden", Floats(ground.mean_hidden)},
              {"most_hidden", Floats(ground.most_hidden)}});
  if (trial.subject) out["subject"] = ToJson(*trial.subject);
  if (trial.truth && trial.truth->num_frames() == frames) {
    out["truth"] = MotionJson(*trial.model, *trial.truth);
  }
  return out;
}

/// NIS over its degrees of freedom, and what 95 of 100 frames of a consistent filter stay within;
/// NaN where no marker was seen or the converter states none.
void AddNis(const ConversionResult& result, Json* out) {
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

Json IncidentsJson(const Trial& trial, const ComparisonRow& row) {
  Json incidents = Json::array();
  const auto label = [&](int assignment) {
    return trial.markers.labels()[row.mapping.assignments[assignment].label];
  };
  for (const MarkerIncident& incident : row.result.incidents) {
    Json labels = {label(incident.assignment)};
    if (incident.other >= 0) labels.push_back(label(incident.other));
    incidents.push_back({{"kind", Name(incident.kind)},
                         {"labels", labels},
                         {"first", incident.first_frame},
                         {"last", incident.last_frame}});
  }
  return incidents;
}

Json RowJson(const Trial& trial, const ComparisonRow& row) {
  Json out = {{"trial", row.trial},
              {"contender", row.contender},
              {"failure", row.failure},
              {"warnings", row.mapping.warnings},
              {"ignored", row.mapping.ignored_labels},
              {"absent", row.mapping.absent_markers}};
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

Json TracksJson(const Comparison& comparison) {
  Json trials = Json::array();
  for (std::size_t i = 0; i < comparison.trials.size(); ++i) {
    trials.push_back(TrialJson(comparison.trials[i], comparison.grounds[i]));
  }
  Json contenders = Json::array();
  for (const Contender& contender : comparison.contenders) {
    contenders.push_back({{"name", contender.name},
                          {"configuration", contender.configuration},
                          {"failure", contender.failure}});
  }
  Json rows = Json::array();
  for (const ComparisonRow& row : comparison.rows) {
    rows.push_back(RowJson(comparison.trials[row.trial], row));
  }
  return {{"trials", trials}, {"contenders", contenders}, {"rows", rows}};
}

}  // namespace mmm_converter
