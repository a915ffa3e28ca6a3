// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/tracks.h"

#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "MMMConverterS2KF/report/drawn_frames.h"
#include "MMMConverterS2KF/report/model_json.h"
#include "MMMConverterS2KF/report/packed_array.h"
#include "MMMConverterS2KF/report/subject_json.h"
#include "common/math/statistics.h"
#include "common/motion/anatomical_angles.h"
#include "common/motion/marker_residuals.h"
#include "common/study/coverage.h"
#include "common/support/advice.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::MatrixXd;

Json Floats(const MatrixXd& numbers) { return ToJson(PackFloats(numbers)); }
Json Quantised(const MatrixXd& numbers) { return ToJson(PackQuantised(numbers)); }

/// Angles by the names that people have for them: a column each.
Json AnatomyJson(const AnatomicalAngles& angles) {
  const DrawnFrames drawn(angles.num_frames());
  Json names = Json::array();
  for (const AnatomicalAngle& one : angles.angles) {
    names.push_back({{"joint", one.joint}, {"side", one.side}, {"motion", one.motion}});
  }
  Json out = {{"names", names}, {"values", Quantised(drawn.Of(angles.values.transpose()))}};
  if (angles.deviations.size() > 0) {
    out["deviations"] = Quantised(drawn.Of(angles.deviations.transpose()));
  }
  return out;
}

Json TrialJson(const Trial& trial, const CommonGround& ground) {
  Json out = {{"name", trial.name}, {"failure", trial.failure}};
  if (!trial.model || ground.labels.empty()) return out;
  const int frames = trial.markers.num_frames();
  const auto num_labels = static_cast<Eigen::Index>(ground.labels.size());
  Json labels = Json::array();
  for (const int label : ground.labels) labels.push_back(trial.markers.labels()[label]);
  const DrawnFrames drawn(frames);
  MatrixXd positions(3 * num_labels, drawn.count());
  for (int i = 0; i < drawn.count(); ++i) {
    const Eigen::Matrix3Xd markers = trial.markers.frame(drawn.frame(i))(Eigen::all, ground.labels);
    positions.col(i) = markers.reshaped();
  }
  const HiddenMarkers hidden =
      ground.hidden(Eigen::all, Eigen::seqN(0, drawn.count(), drawn.every()));
  out.update({{"frames", drawn.count()},
              {"every", drawn.every()},
              {"optimum_every", ground.optimum_every},
              {"rate", trial.markers.rate()},
              {"first_time", trial.markers.first_time()},
              {"labels", labels},
              {"markers", std::vector<int>(ground.markers.begin(), ground.markers.end())},
              {"model", ToJson(*trial.model)},
              {"positions", Quantised(positions)},  // a frame's markers beside each other
              {"hidden", ToJson(PackBits(hidden.transpose()))},
              {"optimum", Floats(drawn.Of(ground.optimum))},
              {"mean_hidden", Floats(drawn.Of(ground.mean_hidden))},
              {"most_hidden", Floats(drawn.MostOf(ground.most_hidden))}});
  if (trial.subject) out["subject"] = ToJson(*trial.subject);
  if (trial.truth && trial.truth->num_frames() == frames) {
    out["truth"] = MotionJson(*trial.model, *trial.truth);
    if (HasAnatomy(*trial.model)) {
      out["truth"]["anatomy"] = AnatomyJson(ComputeAnatomicalAngles(*trial.model, *trial.truth));
    }
  }
  return out;
}

/// NIS over its degrees of freedom, and what 95 of 100 frames of a consistent filter stay within;
/// NaN where no marker was seen or the converter states none.
void AddNis(const ConversionResult& result, int frames, Json* out) {
  MatrixXd nis = MatrixXd::Constant(frames, 3, kNaN);
  std::map<int, std::pair<double, double>> bands;
  for (std::size_t k = 0; k < result.frames.size(); ++k) {
    const FrameDiagnostic& frame = result.frames[k];
    const int degrees = 3 * frame.markers_seen;
    if (degrees == 0 || frame.nis <= 0) continue;
    auto& [low, high] = bands[degrees];
    if (high == 0) {
      low = ChiSquareQuantile(0.025, degrees) / degrees;
      high = ChiSquareQuantile(0.975, degrees) / degrees;
    }
    nis.row(static_cast<Eigen::Index>(k)) << frame.nis, low, high;
  }
  const DrawnFrames drawn(frames);
  const MatrixXd shown = drawn.Of(nis);
  (*out)["nis"] = Floats(shown.col(0));
  (*out)["nis_low"] = Floats(shown.col(1));
  (*out)["nis_high"] = Floats(shown.col(2));
  if (drawn.are_all()) return;
  (*out)["nis_least"] = Floats(drawn.LeastOf(nis.col(0)));
  (*out)["nis_most"] = Floats(drawn.MostOf(nis.col(0)));
}

Json IncidentsJson(const Trial& trial, const ComparisonRow& row) {
  Json incidents = Json::array();
  const auto label = [&](int assignment) {
    return trial.markers.labels()[row.setup.assignments()[assignment].label];
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

Json TrackedJson(const Trial& trial, const ComparisonRow& row) {
  Json motion = MotionJson(*trial.model, row.result.trajectory);
  if (HasAnatomy(*trial.model)) {
    AnatomicalAngles angles = ShownAngles(row.setup, row.result.trajectory);
    HideUnknown(row.setup, trial.markers, &angles);
    motion["anatomy"] = AnatomyJson(angles);
  }
  return motion;
}

Json RowJson(const Trial& trial, const ComparisonRow& row) {
  Json out = {{"trial", row.trial},
              {"contender", row.contender},
              {"failure", WithAdvice(row.failure, row.remedy)},
              {"warnings", row.warnings.texts()},
              {"ignored", row.setup.mapping.ignored_labels},
              {"absent", row.setup.mapping.absent_markers}};
  if (!row.failure.empty()) return out;
  const DrawnFrames drawn(trial.markers.num_frames());
  Eigen::VectorXd seconds = Eigen::VectorXd::Zero(trial.markers.num_frames());
  for (std::size_t k = 0; k < row.result.frames.size(); ++k) {
    seconds[static_cast<Eigen::Index>(k)] = row.result.frames[k].seconds;
  }
  out.update({{"incidents", IncidentsJson(trial, row)},
              {"motion", TrackedJson(trial, row)},
              {"distances", Quantised(drawn.Of(row.distances.transpose()))},
              {"mean", Floats(drawn.Of(row.mean_distance))},
              {"p05", Floats(drawn.LeastOf(row.p05_distance))},
              {"p95", Floats(drawn.MostOf(row.p95_distance))},
              {"max", Floats(drawn.MostOf(row.max_distance))},
              {"seconds", Floats(drawn.Of(seconds))}});
  if (!drawn.are_all()) {
    out["seconds_least"] = Floats(drawn.LeastOf(seconds));
    out["seconds_most"] = Floats(drawn.MostOf(seconds));
    Json means = Json::array();
    for (const ResidualSummary& label : SummarizeEachMarker(row.distances)) {
      means.push_back(label.mean);
    }
    out["label_means"] = means;
  }
  AddNis(row.result, trial.markers.num_frames(), &out);
  return out;
}

}  // namespace

Json MotionJson(const KinematicModel& model, const PoseTrajectory& trajectory) {
  const int frames = trajectory.num_frames();
  const DrawnFrames drawn(frames);
  const auto num_joints = static_cast<Eigen::Index>(trajectory.joint_names.size());
  MatrixXd position(3, drawn.count());
  MatrixXd orientation(4, drawn.count());
  for (int i = 0; i < drawn.count(); ++i) {
    const Posture& posture = trajectory.postures[drawn.frame(i)];
    position.col(i) = posture.position;
    orientation.col(i) = posture.orientation.coeffs();
  }
  MatrixXd angles(frames, num_joints);
  for (int k = 0; k < frames; ++k) {
    angles.row(k) = trajectory.postures[k].joint_angles.transpose();
  }
  Json joints = Json::array();
  for (const std::string& name : trajectory.joint_names) joints.push_back(model.FindJoint(name));
  // Position and orientation: a frame's components beside each other.
  Json motion = {{"joints", joints},
                 {"position", Quantised(position)},
                 {"orientation", Quantised(orientation)},
                 {"angles", Quantised(drawn.Of(angles))}};
  if (!drawn.are_all()) {
    motion["angles_least"] = Quantised(drawn.LeastOf(angles));
    motion["angles_most"] = Quantised(drawn.MostOf(angles));
  }
  const MatrixXd& deviations = trajectory.standard_deviations;
  if (deviations.cols() == frames && deviations.rows() == 6 + num_joints) {
    motion["deviations"] = Quantised(drawn.Of(deviations.bottomRows(num_joints).transpose()));
  }
  return motion;
}

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
