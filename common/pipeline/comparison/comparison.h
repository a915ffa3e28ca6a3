// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/convert/motion_converter.h"
#include "common/convert/plugin_loader.h"
#include "common/model/kinematic_model.h"
#include "common/model/subject.h"
#include "common/motion/hiding.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"
#include "common/study/tracking_quality.h"
#include "common/support/error.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A recording with the model of its person: what contenders are compared on.
struct Trial {
  std::string name;                             ///< for tables
  MarkerSequence markers;                       ///< as measured
  std::shared_ptr<const KinematicModel> model;  ///< scaled to the person
  std::shared_ptr<const Subject> subject;       ///< of the model; null: height and mass only
  std::optional<PoseTrajectory> truth;          ///< of that model
  std::string failure;                          ///< why it can't be used; empty: it can
};

/// A converter with its configuration.
struct Contender {
  std::string name;           ///< for tables
  std::string configuration;  ///< its text, for reports
  ConverterConfig config;
  std::shared_ptr<const LoadedPlugin> plugin;
  std::string failure;  ///< why it can't take part; empty: it can
};

struct ComparisonOptions {
  Hiding hiding;
  int runs = 1;            ///< run r hides with seed + r
  std::uint64_t seed = 1;  ///< every contender gets the same markers
  int jobs = 0;            ///< runs at a time; 0: as many as there are cores
};

/// What all contenders share on one trial. Only markers and joints that every contender uses count,
/// so that no one is measured on other things than the others.
struct CommonGround {
  std::vector<LabelIx> labels;    ///< that are compared, indices of the recording
  std::vector<MarkerIx> markers;  ///< of the model, one for each label
  std::vector<int> joints;        ///< that are compared, indices of the model
  Eigen::VectorXd optimum;        ///< per frame: mean distance at the least-squares posture [m]
  int optimum_every = 1;          ///< of every n-th frame, linear between; see CompareFinished
  HiddenMarkers hidden;           ///< labels x frames, in the first run
  /// Per frame, number of labels that are hidden from some contender, over the runs.
  Eigen::VectorXd mean_hidden, most_hidden;
};

/// One contender on one trial.
struct ComparisonRow {
  int trial = 0;
  int contender = 0;
  std::string failure;                ///< why there is no result; empty: there is one
  Remedy remedy = Remedy::kNone;      ///< of the failure
  TrackingSetup setup;                ///< on the trial's model
  Warnings warnings;                  ///< of the mapping
  TrackingQuality quality;            ///< of all runs
  std::vector<TrackingQuality> runs;  ///< one for each
  ConversionResult result;            ///< of the first run
  Eigen::MatrixXd distances;          ///< of the first run, common labels x frames [m]; hidden too
  /// Mean distance of each frame over the runs: the mean, the 5th and 95th percentile, the largest
  /// [m].
  Eigen::VectorXd mean_distance, p05_distance, p95_distance, max_distance;
};

/// Every contender on every trial.
struct Comparison {
  ComparisonOptions options;
  std::vector<Trial> trials;
  std::vector<Contender> contenders;
  std::vector<CommonGround> grounds;  ///< one for each trial
  std::vector<ComparisonRow> rows;    ///< by trial, then contender

  const ComparisonRow& row(int trial, int contender) const {
    return rows[trial * contenders.size() + contender];
  }
  int num_failures() const;
};

/// Runs every contender on every trial. What fails becomes a row with its reason. Apart from times
/// the result is the same whatever options.jobs. progress(done, all): runs; called by one thread at
/// a time.
/// @throws Error where nothing can be compared: no trials or no contenders.
Comparison Compare(std::vector<Trial> trials, std::vector<Contender> contenders,
                   const ComparisonOptions& options, const std::function<void(int, int)>& progress);

/// A finished result: a motion of the trial's model, a posture for each of its frames.
struct Finished {
  MarkerMapping mapping;
  Warnings warnings;  ///< of the mapping
  ConversionResult result;
};

/// One trial, and a finished result for each contender; contenders need no plugin. Of a recording
/// of more than 4000 frames the optimum is fitted at some 2000, evenly spread, and where a frame's
/// verdict (good, lost) depends on it.
Comparison CompareFinished(Trial trial, std::vector<Contender> contenders,
                           std::vector<Finished> results);

}  // namespace mmm_converter
