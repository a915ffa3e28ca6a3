// SPDX-License-Identifier: MIT
#include "plugins/s2kf/s2kf_settings.h"

#include <string>

#include "common/support/diagnostics.h"

namespace mmm_converter::s2kf {

namespace {

constexpr double kMillimetre = 1e-3;

void BindFilter(S2kfSettings* v, SettingTable* table) {
  table->AddElement("Filter", "The Kalman filter.");
  table->AddChoice(
      "Filter", "type", &v->filter,
      {{"s2kf", FilterType::kS2kf}, {"ukf", FilterType::kUkf}, {"ekf", FilterType::kEkf}},
      "s2kf: optimally placed samples; ukf: 2n+1 randomly rotated sigma points; ekf: analytic "
      "Jacobian");
  table->Add("Filter", "samples", &v->samples, 3, 10001, "samples of the s2kf, odd");
  table->AddChoice(
      "Filter", "update", &v->update,
      {{"regression", UpdateForm::kRegression}, {"exact", UpdateForm::kExact}},
      "regression: what the samples leave unexplained counts as noise of each coordinate (faster); "
      "exact: the full covariance of the measurement");
  table->Add("Filter", "iterations", &v->iterations, 1, 10,
             "passes a frame at most: linearised anew about the last estimate where that is far "
             "from linear, weighted anew where markers count less; more than 1 needs "
             "update=\"regression\"");
  table->AddChoice("Filter", "root", &v->root,
                   {{"so3", RootParameters::kSo3}, {"rpy", RootParameters::kRpy}},
                   "root orientation: rotation vector about the estimate, or roll-pitch-yaw "
                   "(singular at pitch 90 degrees)");
  table->AddChoice("Filter", "limits", &v->limits,
                   {{"sine", LimitFunction::kSine}, {"tanh", LimitFunction::kTanh}},
                   "function that keeps joint angles inside their limits");
}

void BindMotionModel(S2kfSettings* v, SettingTable* table) {
  table->AddElement("MotionModel",
                    "How the state may change between frames; variances grow with time.");
  table->AddChoice(
      "MotionModel", "type", &v->motion_model,
      {{"auto", MotionModelType::kAuto},
       {"randomWalk", MotionModelType::kRandomWalk},
       {"velocity", MotionModelType::kVelocity}},
      "randomWalk: the state stays and spreads; velocity: it carries its rate, which spreads; "
      "auto: "
      "of landmarks, whose places on the body are well known, a velocity with drifts of its own; "
      "else randomWalk");
  table->Add("MotionModel", "rootPosition_mm_per_sqrt_s", &v->noise.position, kMillimetre, 0, 1e6,
             "randomWalk: drift of the root position within one second");
  table->Add("MotionModel", "rootOrientation_rad_per_sqrt_s", &v->noise.orientation, 1, 0, 100,
             "randomWalk: drift of the root orientation within one second");
  table->Add("MotionModel", "jointParameter_rad_per_sqrt_s", &v->noise.parameters, 1, 0, 100,
             "randomWalk: drift of the joint parameters within one second");
  table->Add("MotionModel", "naturalSpread_rad", &v->natural_spread, 1, 0, 100,
             "spread of the joint parameters about the natural posture when nothing is seen for "
             "long; 0: unbounded");
  table->Add("MotionModel", "velocityDecay_s", &v->velocity_decay, 1, 1e-3, 1e3,
             "velocity: time constant with which the root's rates die out");
  table->Add("MotionModel", "rootVelocity_mm_per_s_per_sqrt_s", &v->velocity_noise.position,
             kMillimetre, 0, 1e6, "velocity: drift of the root velocity within one second");
  table->Add("MotionModel", "rootRate_rad_per_s_per_sqrt_s", &v->velocity_noise.orientation, 1, 0,
             1000, "velocity: drift of the root's angular velocity within one second");
  table->Add("MotionModel", "jointRate_rad_per_s_per_sqrt_s", &v->velocity_noise.parameters, 1, 0,
             1000, "velocity: drift of the joint parameter rates within one second");
  table->Add("MotionModel", "noiseScale", &v->process_noise_scale, 1, 1e-6, 1e6,
             "factor on the variances of all of these drifts");
  table->Add(
      "MotionModel", "chooseNoiseScale", &v->choose_process_noise_scale,
      "of whole recordings: multiply noiseScale by the factor under which the filter expects "
      "the recording most (maximum likelihood of its innovations)");
}

void BindDeviations(S2kfSettings* v, SettingTable* table) {
  DeviationSettings* d = &v->deviations;
  table->AddElement("Deviations",
                    "What the written standard deviations are made of, beside the distances of "
                    "markers and model, which tell most. The postures do not depend on it.");
  table->Add("Deviations", "markerOffset_mm", &d->marker_offset, kMillimetre, 0, 1000,
             "of a person who was not calibrated: of each coordinate, between where a marker is "
             "worn and where the model has it; counts where too few markers are seen to tell");
  table->Add("Deviations", "lengthShare", &d->length_share, 1, 0, 10,
             "of a person who was not calibrated, on another body than OpenSim's, whose parts have "
             "sizes: variance by which lengths of segments move markers, as far as the posture "
             "takes it up, over the variance that the markers' distances show");
  table->Add("Deviations", "limbSpeed_m_per_s", &d->limb_speed, 1, 0, 100,
             "of a marker while it is hidden: how fast what is known of its limb is lost");
}

}  // namespace

SettingTable BindSettings(S2kfSettings* v) {
  SettingTable table;
  BindFilter(v, &table);
  BindMotionModel(v, &table);
  table.AddElement("Noise", "Trust in the markers.");
  table.Add("Noise", "markerStandardDeviation_mm", &v->marker_deviation, kMillimetre, 1e-6, 1e4,
            "of each coordinate of each marker; a Mapping's noiseScale multiplies it; a calibrated "
            "subject's skinDeviation_mm comes in its place where that is less, down to a fifth");
  table.Add("Noise", "robustDistance_mm", &v->robust_distance, kMillimetre, 0, 1e6,
            "a marker that is farther from where it is expected counts less, in proportion "
            "(Huber); 0: all count in full");
  table.Add("Noise", "gateProbability", &v->gate_probability, 1, 0, 0.1,
            "a marker is left out, or exchanged with another, where a right one would be as far "
            "from its place with less than this probability in a frame (chi-square); 0: none is");
  BindDeviations(v, &table);
  table.AddElement("Start", "The first posture, and the way back when the track is lost.");
  table.AddChoice("Start", "method", &v->start,
                  {{"fit", StartMethod::kFit}, {"paper", StartMethod::kPaper}},
                  "fit: rigid fit, least squares and random restarts; paper: root at the mean of "
                  "the markers, the rest 0");
  table.Add("Start", "attempts", &v->start_attempts, 0, 1000,
            "fit: random restarts in the first frame");
  table.Add("Start", "recovery", &v->recovery,
            "look for a better posture by least squares in frames where the track is in doubt");
  table.AddElement("Smoothing", "Of whole recordings.");
  table.Add("Smoothing", "active", &v->smoothing,
            "after the filter, go backwards over its track (Rauch-Tung-Striebel): every frame then "
            "knows the whole recording, and nothing lags");
  table.Add("Smoothing", "learnPlaces", &v->learn_places,
            "before it is tracked, go over the recording once and learn where each marker is worn "
            "beside the model's place, as far as the person was not calibrated: a marker that "
            "hides or returns then moves no limb; distances are still those to the model's places. "
            "Afterwards find markers that are elsewhere for a while, and track again without them");
  return table;
}

S2kfSettings ReadSettings(const ConverterConfig& config) {
  S2kfSettings settings;
  Diagnostics diagnostics(config.file);
  BindSettings(&settings).Read(config.plugin_elements, &diagnostics);
  int filter_line = 0;
  for (const XmlElement& element : config.plugin_elements) {
    if (element.name == "Filter") filter_line = element.line;
  }
  if (settings.filter == FilterType::kS2kf && settings.samples % 2 == 0) {
    diagnostics.AddError(filter_line,
                         "<Filter samples=\"" + std::to_string(settings.samples) +
                             "\">: the samples are pairs and a centre; give an odd number");
  }
  if (settings.iterations > 1 && settings.update == UpdateForm::kExact) {
    diagnostics.AddError(
        filter_line,
        "<Filter update=\"exact\">: more than one iteration needs update=\"regression\"");
  }
  diagnostics.ThrowIfErrors();
  return settings;
}

}  // namespace mmm_converter::s2kf
