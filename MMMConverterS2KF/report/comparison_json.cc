// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/comparison_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "common/math/statistics.h"
#include "common/support/advice.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

Json ToJson(const DistanceFigures& distance) {
  if (std::isnan(distance.mean)) return nullptr;
  return {{"mean", Number(kMillimetres * distance.mean)},
          {"p95", Number(kMillimetres * distance.p95)},
          {"max", Number(kMillimetres * distance.max)},
          {"worst_frame", Number(kMillimetres * distance.worst_frame)}};
}

// How often the truth is within what the deviations claim.
Json ReliabilityJson(const TrackingQuality& quality) {
  if (quality.reliability.empty()) return nullptr;
  Json points = Json::array();
  for (std::size_t m = 0; m < kReliabilityMultiples.size(); ++m) {
    points.push_back({{"deviations", kReliabilityMultiples[m]},
                      {"claimed", Number(NormalShareWithin(kReliabilityMultiples[m]))},
                      {"observed", Number(quality.reliability[m])}});
  }
  return points;
}

Json ToJson(const TrackingQuality& quality) {
  return {{"distance_mm", ToJson(quality.all)},
          {"hidden_distance_mm", ToJson(quality.hidden)},
          {"frames_to_converge", quality.first_good ? Number(*quality.first_good) : Json(nullptr)},
          {"frames_lost", Number(quality.lost_frames)},
          {"jitter_rad_per_s2", Number(quality.jitter)},
          {"largest_step_rad", Number(quality.largest_step)},
          {"limit_share", Number(quality.limit_share)},
          {"ms_per_frame",
           {{"median", Number(kMilliseconds * quality.median_seconds)},
            {"p99", Number(kMilliseconds * quality.p99_seconds)}}},
          {"joint_center_error_mm", Number(kMillimetres * quality.joint_center_error)},
          {"joint_angle_error_deg", Number(kDegrees * quality.joint_angle_error)},
          {"within_1_sd", Number(quality.ReliabilityAt(1))},
          {"within_2_sd", Number(quality.ReliabilityAt(2))},
          {"reliability", ReliabilityJson(quality)}};
}

Json DescribeOptions(const ComparisonOptions& options) {
  const bool is_paper = options.hiding.model == HidingModel::kPaper;
  return {{"hide", options.hiding.amount},
          {"hiding_model", is_paper ? "paper" : "stationary"},
          {"mean_hidden_frames", options.hiding.mean_frames},
          {"runs", options.runs},
          {"seed", options.seed},
          {"jobs", options.jobs}};
}

Json DescribeTrial(const Trial& trial, const CommonGround& ground) {
  const Eigen::VectorXd& optimum = ground.optimum;
  const std::span values(optimum.data(), static_cast<std::size_t>(optimum.size()));
  Json json = {{"name", trial.name},
               {"frames", trial.markers.num_frames()},
               {"rate_hz", Number(trial.markers.rate())},
               {"compared_markers", ground.labels.size()},
               {"compared_joints", ground.joints.size()},
               {"optimum_mm", Number(kMillimetres * Mean(values))},
               {"has_truth", trial.truth.has_value()},
               {"failure", TextOrNull(trial.failure)}};
  if (ground.optimum_every > 1) json["optimum_every"] = ground.optimum_every;
  return json;
}

Json DescribeContender(const Contender& contender) {
  return {{"name", contender.name},
          {"converter", contender.config.type},
          {"failure", TextOrNull(contender.failure)}};
}

Json DescribeRow(const Comparison& comparison, const ComparisonRow& row) {
  Json json = {{"trial", comparison.trials[row.trial].name},
               {"contender", comparison.contenders[row.contender].name},
               {"failure", TextOrNull(WithAdvice(row.failure, row.remedy))}};
  if (!row.failure.empty()) return json;
  json.update(ToJson(row.quality));
  json["runs"] = Json::array();
  for (const TrackingQuality& run : row.runs) json["runs"].push_back(ToJson(run));
  return json;
}

}  // namespace

Json ToJson(const Comparison& comparison) {
  Json trials = Json::array();
  Json contenders = Json::array();
  Json rows = Json::array();
  for (std::size_t t = 0; t < comparison.trials.size(); ++t) {
    trials.push_back(DescribeTrial(comparison.trials[t], comparison.grounds[t]));
  }
  for (const Contender& contender : comparison.contenders) {
    contenders.push_back(DescribeContender(contender));
  }
  for (const ComparisonRow& row : comparison.rows) rows.push_back(DescribeRow(comparison, row));
  return {{"program", "MMMConverterS2KF " MMM_CONVERTER_VERSION},
          {"options", DescribeOptions(comparison.options)},
          {"trials", trials},
          {"contenders", contenders},
          {"rows", rows}};
}

}  // namespace mmm_converter
