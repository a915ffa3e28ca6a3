// SPDX-License-Identifier: MIT
#include "plugins/jacobian/jacobian_settings.h"

#include "common/support/diagnostics.h"

namespace mmm_converter::jacobian {
namespace {

constexpr double kMillimetre = 1e-3;

}  // namespace

SettingTable BindSettings(JacobianSettings* v) {
  SettingTable table;
  table.AddElement("Method", "What is done in each frame.");
  table.AddChoice("Method", "type", &v->method,
                  {{"leastSquares", Method::kLeastSquares}, {"gradient", Method::kGradient}},
                  "leastSquares: Levenberg-Marquardt to convergence; gradient: a fixed number of "
                  "damped, limited Jacobian steps");
  table.Add("Method", "robustDistance_mm", &v->robust_distance, kMillimetre, 0, 1e6,
            "a marker that is farther off counts with its distance only (Huber); 0: all count with "
            "their square");
  table.Add("Method", "naturalWeight_mm_per_rad", &v->natural_weight, kMillimetre, 0, 1e6,
            "pull to the natural posture: 1 rad costs as much as one marker this far off");
  table.Add("Method", "startAttempts", &v->start_attempts, 0, 1000,
            "the first posture is a rigid fit, then least squares, then so many random restarts");

  table.AddElement("LeastSquares", "For type=\"leastSquares\".");
  table.Add("LeastSquares", "iterations", &v->max_iterations, 1, 1000, "a frame at most");
  table.Add("LeastSquares", "tolerance", &v->tolerance, 1, 0, 1,
            "converged where a step lowers the cost by less than this share of it");
  table.Add("LeastSquares", "previousWeight_mm_per_rad", &v->previous_weight, kMillimetre, 0, 1e6,
            "pull to the posture of the previous frame: 1 rad costs as much as one marker this far "
            "off");

  table.AddElement("Gradient", "For type=\"gradient\".");
  table.Add("Gradient", "steps", &v->steps, 1, 1000, "in each frame");
  table.Add("Gradient", "damping_mm_per_rad", &v->damping, kMillimetre, 0, 1e6,
            "damped least squares: a step of 1 rad costs as much as one marker this far off");
  table.Add("Gradient", "stepLimit_rad", &v->step_limit, 1, 1e-6, 10,
            "largest change of a joint, and of the root's rotation, in a step");
  return table;
}

JacobianSettings ReadSettings(const ConverterConfig& config) {
  JacobianSettings settings;
  Diagnostics diagnostics(config.file);
  BindSettings(&settings).Read(config.plugin_elements, &diagnostics);
  diagnostics.ThrowIfErrors();
  return settings;
}

}  // namespace mmm_converter::jacobian
