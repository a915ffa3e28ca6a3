// SPDX-License-Identifier: MIT
#include "common/pipeline/comparison/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <set>

#include "common/math/statistics.h"
#include "common/model/marker_kinematics.h"
#include "common/motion/marker_residuals.h"
#include "common/study/optimal_fit.h"
#include "common/support/error.h"
#include "common/support/parallel.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A trial's contenders that take part, and what one of them uses.
struct Field {
  std::vector<ComparisonRow*> rows;
  std::vector<LabelIx> used_labels;
  std::vector<int> used_joints;
};

void ResolveRow(const Trial& trial, const Contender& contender, ComparisonRow* row) {
  row->failure = trial.failure.empty() ? contender.failure : trial.failure;
  if (!row->failure.empty()) return;
  try {
    row->setup =
        MatchMarkers(LabelsOf(trial.markers), trial.model, contender.config, &row->warnings);
  } catch (const Error& error) {
    row->failure = error.what();
    row->remedy = error.remedy();
  }
}

std::vector<int> JointsOf(const Trial& trial, const PoseTrajectory& trajectory) {
  std::vector<int> joints;
  for (const std::string& name : trajectory.joint_names) {
    const int joint = trial.model->FindJoint(name);
    if (joint >= 0) joints.push_back(joint);
  }
  return joints;
}

std::vector<int> Intersection(const std::vector<int>& ordered, const std::vector<int>& other) {
  std::vector<int> both;
  std::copy_if(ordered.begin(), ordered.end(), std::back_inserter(both),
               [&](int i) { return std::find(other.begin(), other.end(), i) != other.end(); });
  return both;
}

void FindCommonGround(const Field& field, CommonGround* ground) {
  if (field.rows.empty()) return;
  for (const MarkerAssignment& assignment : field.rows.front()->setup.assignments()) {
    const bool is_common =
        std::all_of(field.rows.begin(), field.rows.end(), [&](const ComparisonRow* row) {
          const auto& others = row->setup.assignments();
          return std::any_of(others.begin(), others.end(), [&](const MarkerAssignment& other) {
            return other.label == assignment.label && other.marker == assignment.marker;
          });
        });
    if (!is_common) continue;
    ground->labels.push_back(assignment.label);
    ground->markers.push_back(assignment.marker);
  }
  ground->joints = field.rows.front()->setup.joints;
  for (const ComparisonRow* row : field.rows) {
    ground->joints = Intersection(ground->joints, row->setup.joints);
  }
}

void FindUsed(Field* field) {
  std::set<LabelIx> labels;
  std::set<int> joints;
  for (const ComparisonRow* row : field->rows) {
    joints.insert(row->setup.joints.begin(), row->setup.joints.end());
    for (const MarkerAssignment& assignment : row->setup.assignments()) {
      labels.insert(assignment.label);
    }
  }
  field->used_labels.assign(labels.begin(), labels.end());
  field->used_joints.assign(joints.begin(), joints.end());
}

// Rows of `hidden`, which are for the used labels, that belong to the common ones.
HiddenMarkers OfCommonLabels(const Field& field, const CommonGround& ground,
                             const HiddenMarkers& hidden) {
  std::vector<int> places;
  places.reserve(ground.labels.size());
  for (const LabelIx label : ground.labels) {
    const auto at = std::find(field.used_labels.begin(), field.used_labels.end(), label);
    places.push_back(static_cast<int>(at - field.used_labels.begin()));
  }
  return hidden(places, Eigen::all);
}

HiddenMarkers HiddenInRun(const Field& field, const Trial& trial, const ComparisonOptions& options,
                          int run) {
  return DrawHidden(options.hiding, static_cast<int>(field.used_labels.size()),
                    trial.markers.num_frames(), options.seed + static_cast<std::uint64_t>(run));
}

void CountHidden(const Field& field, const Trial& trial, const ComparisonOptions& options,
                 CommonGround* ground) {
  const int frames = trial.markers.num_frames();
  ground->mean_hidden.setZero(frames);
  ground->most_hidden.setZero(frames);
  for (int run = 0; run < options.runs; ++run) {
    const HiddenMarkers hidden = HiddenInRun(field, trial, options, run);
    const VectorXd counts = hidden.cast<double>().colwise().sum();
    ground->mean_hidden += counts / options.runs;
    ground->most_hidden = ground->most_hidden.cwiseMax(counts);
    if (run == 0) ground->hidden = OfCommonLabels(field, *ground, hidden);
  }
}

// Distances of the common markers, hidden ones too, labels x frames [m].
MatrixXd MeasureDistances(const Trial& trial, const CommonGround& ground,
                          const PoseTrajectory& trajectory) {
  const MarkerKinematics kinematics(*trial.model, JointsOf(trial, trajectory), ground.markers,
                                    std::vector<int>());
  MarkerJacobian at = kinematics.MakeJacobian();
  MatrixXd distances(ground.labels.size(), trajectory.num_frames());
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const Posture& posture = trajectory.postures[k];
    kinematics.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                              posture.joint_angles, &at);
    const Eigen::Matrix3Xd z = trial.markers.frame(k)(Eigen::all, ground.labels);
    distances.col(k) = (z - at.p_WM).colwise().norm();
  }
  return distances;
}

QualityReference MakeReference(const Trial& trial, const CommonGround& ground,
                               HiddenMarkers hidden) {
  return {trial.model.get(), ground.joints, std::move(hidden), ground.optimum,
          trial.truth ? &*trial.truth : nullptr};
}

// One run of one contender on one trial: a task.
struct Run {
  int trial, contender, number;
};

struct RunOutcome {
  TrackingQuality quality;
  VectorXd frame_means;
  std::string failure;
  Remedy remedy = Remedy::kNone;
};

void FillBand(const std::vector<RunOutcome>& outcomes, ComparisonRow* row) {
  const auto frames = outcomes.front().frame_means.size();
  row->mean_distance.resize(frames);
  row->p05_distance.resize(frames);
  row->p95_distance.resize(frames);
  row->max_distance.resize(frames);
  std::vector<double> values(outcomes.size());
  for (Eigen::Index k = 0; k < frames; ++k) {
    for (std::size_t r = 0; r < outcomes.size(); ++r) values[r] = outcomes[r].frame_means[k];
    row->mean_distance[k] = Mean(values);
    row->p05_distance[k] = Percentile(values, 5);
    row->p95_distance[k] = Percentile(values, 95);
    row->max_distance[k] = Max(values);
  }
}

void FinishRow(const std::vector<RunOutcome>& outcomes, ComparisonRow* row) {
  for (const RunOutcome& outcome : outcomes) {
    if (!outcome.failure.empty()) {
      row->failure = outcome.failure;
      row->remedy = outcome.remedy;
      return;
    }
  }
  for (const RunOutcome& outcome : outcomes) row->runs.push_back(outcome.quality);
  row->quality = Summarize(row->runs);
  FillBand(outcomes, row);
}

RunOutcome Perform(const Run& run, const Comparison& comparison, const Field& field,
                   ComparisonRow* row) {
  const Trial& trial = comparison.trials[run.trial];
  const CommonGround& ground = comparison.grounds[run.trial];
  const Contender& contender = comparison.contenders[run.contender];
  RunOutcome outcome;
  try {
    const HiddenMarkers hidden = HiddenInRun(field, trial, comparison.options, run.number);
    const MarkerSequence seen = WithoutHidden(trial.markers, field.used_labels, hidden);
    const auto converter = contender.plugin->factory().Create(row->setup, contender.config);
    ConversionResult result = converter->Convert(seen, nullptr);
    MatrixXd distances = MeasureDistances(trial, ground, result.trajectory);
    outcome.frame_means = MeanOfEachFrame(distances);
    outcome.quality =
        MeasureQuality(MakeReference(trial, ground, OfCommonLabels(field, ground, hidden)),
                       distances, result.trajectory, result.frames);
    if (run.number == 0) {
      row->result = std::move(result);
      row->distances = std::move(distances);
    }
  } catch (const Error& error) {
    outcome.failure = error.what();
    outcome.remedy = error.remedy();
  } catch (const std::exception& error) {
    outcome.failure = error.what();
  }
  return outcome;
}

std::vector<ComparisonRow> MakeRows(std::size_t trials, std::size_t contenders) {
  std::vector<ComparisonRow> rows(trials * contenders);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].trial = static_cast<int>(i / contenders);
    rows[i].contender = static_cast<int>(i % contenders);
  }
  return rows;
}

// Resolves what every contender needs of a trial, and what they share.
Field PrepareTrial(int index, Comparison* comparison) {
  const Trial& trial = comparison->trials[index];
  CommonGround& ground = comparison->grounds[index];
  Field field;
  for (std::size_t c = 0; c < comparison->contenders.size(); ++c) {
    ComparisonRow& row = comparison->rows[index * comparison->contenders.size() + c];
    ResolveRow(trial, comparison->contenders[c], &row);
    if (row.failure.empty()) field.rows.push_back(&row);
  }
  FindUsed(&field);
  FindCommonGround(field, &ground);
  if (!field.rows.empty() && ground.labels.empty()) {
    for (ComparisonRow* row : field.rows) row->failure = "no marker is used by all configurations";
    field.rows.clear();
  }
  if (field.rows.empty()) return field;
  CountHidden(field, trial, comparison->options, &ground);
  return field;
}

// The floor of every contender: with all joints that one of them has.
void FindOptimum(const Trial& trial, const Field& field, CommonGround* ground) {
  ground->optimum = OptimalDistances(*trial.model, field.used_joints, ground->markers,
                                     ground->labels, trial.markers);
}

// The same for finished results of a long recording, in about the time of kMostOptima fits.
void SampleOptimum(const Trial& trial, const Field& field, CommonGround* ground) {
  constexpr int kMostOptima = 2000;
  const int frames = trial.markers.num_frames();
  if (frames <= 2 * kMostOptima) return FindOptimum(trial, field, ground);
  ground->optimum_every = (frames + kMostOptima - 1) / kMostOptima;
  OptimumSampling sampling;
  sampling.every = ground->optimum_every;
  std::vector<VectorXd> means;
  for (const ComparisonRow* row : field.rows) {
    sampling.tracked.push_back(&row->result.trajectory);
    means.push_back(MeanOfEachFrame(row->distances));
  }
  std::vector<bool> has_good(means.size());
  sampling.is_doubtful = [&](int k, double least, double most) {
    bool is_doubtful = false;
    for (std::size_t r = 0; r < means.size(); ++r) {
      const double distance = means[r][k];
      is_doubtful |= IsLostFrame(distance, least) != IsLostFrame(distance, most);
      if (has_good[r]) continue;  // only the first is told
      has_good[r] = IsGoodFrame(distance, least);
      is_doubtful |= !has_good[r] && IsGoodFrame(distance, most);
    }
    return is_doubtful;
  };
  ground->optimum = SampledOptimalDistances(*trial.model, field.used_joints, ground->markers,
                                            ground->labels, trial.markers, sampling);
}

}  // namespace

int Comparison::num_failures() const {
  return static_cast<int>(std::count_if(
      rows.begin(), rows.end(), [](const ComparisonRow& row) { return !row.failure.empty(); }));
}

Comparison Compare(std::vector<Trial> trials, std::vector<Contender> contenders,
                   const ComparisonOptions& options,
                   const std::function<void(int, int)>& progress) {
  Comparison comparison{options, std::move(trials), std::move(contenders), {}, {}};
  const int num_trials = static_cast<int>(comparison.trials.size());
  comparison.grounds.resize(num_trials);
  comparison.rows = MakeRows(comparison.trials.size(), comparison.contenders.size());
  std::vector<Field> fields;
  std::vector<Run> runs;
  for (int t = 0; t < num_trials; ++t) {
    fields.push_back(PrepareTrial(t, &comparison));
    for (const ComparisonRow* row : fields.back().rows) {
      for (int r = 0; r < options.runs; ++r) runs.push_back({t, row->contender, r});
    }
  }
  ParallelFor(num_trials, options.jobs, [&](int t) {
    if (!fields[t].rows.empty())
      FindOptimum(comparison.trials[t], fields[t], &comparison.grounds[t]);
  });

  std::vector<RunOutcome> outcomes(runs.size());
  std::mutex mutex;
  int done = 0;
  const int num_runs = static_cast<int>(runs.size());
  ParallelFor(num_runs, options.jobs, [&](int i) {
    const std::size_t row = runs[i].trial * comparison.contenders.size() + runs[i].contender;
    outcomes[i] = Perform(runs[i], comparison, fields[runs[i].trial], &comparison.rows[row]);
    const std::lock_guard lock(mutex);
    ++done;
    if (progress) progress(done, num_runs);
  });
  for (std::size_t i = 0; i < outcomes.size(); i += options.runs) {
    const std::size_t row = runs[i].trial * comparison.contenders.size() + runs[i].contender;
    FinishRow({outcomes.begin() + static_cast<std::ptrdiff_t>(i),
               outcomes.begin() + static_cast<std::ptrdiff_t>(i) + options.runs},
              &comparison.rows[row]);
  }
  return comparison;
}

Comparison CompareFinished(Trial trial, std::vector<Contender> contenders,
                           std::vector<Finished> results) {
  Comparison comparison{{}, {std::move(trial)}, std::move(contenders), {}, {}};
  const Trial& only = comparison.trials.front();
  comparison.grounds.resize(1);
  comparison.rows = MakeRows(1, comparison.contenders.size());
  CommonGround& ground = comparison.grounds.front();
  Field field;
  for (std::size_t i = 0; i < results.size(); ++i) {
    ComparisonRow& row = comparison.rows[i];
    row.warnings = std::move(results[i].warnings);
    row.result = std::move(results[i].result);
    row.setup = {only.model, JointsOf(only, row.result.trajectory), std::move(results[i].mapping)};
    field.rows.push_back(&row);
  }
  FindUsed(&field);
  FindCommonGround(field, &ground);
  CountHidden(field, only, comparison.options, &ground);
  for (ComparisonRow* row : field.rows) {
    row->distances = MeasureDistances(only, ground, row->result.trajectory);
    row->distances.leftCols(FramesBeforeFirstSeen(row->result.residuals)).setConstant(kNaN);
  }
  SampleOptimum(only, field, &ground);
  for (ComparisonRow* row : field.rows) {
    RunOutcome outcome;
    outcome.frame_means = MeanOfEachFrame(row->distances);
    outcome.quality = MeasureQuality(MakeReference(only, ground, ground.hidden), row->distances,
                                     row->result.trajectory, row->result.frames);
    FinishRow({outcome}, row);
  }
  return comparison;
}

}  // namespace mmm_converter
