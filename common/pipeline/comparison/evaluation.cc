// SPDX-License-Identifier: MIT
#include "common/pipeline/comparison/evaluation.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/io/mmm/mmm_model.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/synthetic_motion.h"
#include "common/pipeline/comparison/comparison_setup.h"
#include "common/support/data_directory.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

// The person and the seed of the sample recording, examples/handstand.c3d.
constexpr double kReferenceHeight = 1.8;  // [m]
constexpr double kMass = 75;              // [kg]
constexpr int kSeed = 1;

constexpr const char* kComplete = "complete";
constexpr const char* kOcclusion = "occlusion";
constexpr const char* kRates = "rates";
constexpr const char* kRecordings = "recordings";

constexpr const char* kCompleteText =
    "A synthetic handstand, tracked by every converter with the paper's 50 markers and 40 joints. "
    "Markers sit 28 mm (rms per axis) beside the model's, as real ones do: no posture has less "
    "than the optimum, whoever finds it.\n\n"
    "With complete data a framewise fit that runs to convergence is that optimum: in marker "
    "distance a filter has nothing to add. The gradient takes two steps of at most 0.02 rad in "
    "each frame and lags where joints are faster; with more or larger steps it comes near the "
    "optimum too.";

constexpr const char* kOcclusionText =
    "In every frame a visible marker hides with a probability of 0.5 % for a Poisson(100) number "
    "of frames. Distances are taken over all markers, hidden ones too. Lines are means over the "
    "runs, bands reach from 5 to 95 %.\n\n"
    "jacobian_pull is a framewise fit at its best: least squares with a pull to the previous "
    "posture, which is the estimate of a filter whose covariance never changes.";

constexpr const char* kRatesText =
    "The three filters with the same models, without the fit that helps where a track is in doubt. "
    "The lower the frame rate, the farther a person moves within a frame, and the wider the region "
    "over which the measurement is linearised: a Jacobian takes one point of it, samples take all "
    "of it.";

// The synthetic handstand with every step-th frame.
Trial MakeHandstandTrial(const std::shared_ptr<const KinematicModel>& model, int step) {
  PoseTrajectory truth = MakeHandstand(*model);
  std::vector<Posture> postures;
  for (int k = 0; k < truth.num_frames(); k += step) postures.push_back(truth.postures[k]);
  truth.postures = std::move(postures);
  truth.rate /= step;
  Trial trial;
  trial.name = fmt::format("handstand, {:g} Hz", truth.rate);
  trial.model = model;
  trial.markers = SynthesizeMarkers(*model, truth, MarkerErrors{}, kSeed);
  trial.truth = std::move(truth);
  return trial;
}

std::vector<Contender> ShippedContenders(const std::vector<std::string>& names) {
  std::vector<Contender> contenders;
  contenders.reserve(names.size());
  for (const std::string& name : names) contenders.push_back(MakeContender(name));
  return contenders;
}

// The paper's 50 markers and 40 joints for everyone: all are given and measured on the same.
std::vector<Contender> InPaperSetting(std::vector<Contender> contenders) {
  const Contender paper = MakeContender("s2kf_paper");
  for (Contender& contender : contenders) {
    contender.config.marker_pairs = paper.config.marker_pairs;
    contender.config.joint_set = paper.config.joint_set;
  }
  return contenders;
}

// A filter that is not helped by a fit where its track is in doubt.
Contender FilterAlone(const std::string& type) {
  Contender contender = MakeContender("s2kf_default");
  contender.name = type;
  contender.configuration = fmt::format(
      "<ConverterConfig type=\"S2KFConverter\">\n  <Filter type=\"{}\"/>\n"
      "  <Start recovery=\"false\"/>\n</ConverterConfig>\n",
      type);
  if (contender.failure.empty()) {
    contender.config = ParseConverterConfig(contender.configuration, type + " alone");
  }
  return contender;
}

std::vector<Contender> FiltersAlone() {
  return InPaperSetting({FilterAlone("s2kf"), FilterAlone("ukf"), FilterAlone("ekf")});
}

// Stages of the evaluation, run one after the other.
class Stages {
 public:
  explicit Stages(const std::function<void(const std::string&, int, int)>& progress)
      : progress_(progress) {}

  void Add(const std::string& name, const std::string& title, const std::string& text,
           std::vector<Trial> trials, std::vector<Contender> contenders,
           const ComparisonOptions& options) {
    const auto progress = [&](int done, int all) {
      if (progress_) progress_(title, done, all);
    };
    experiments_.push_back(
        {name, title, text, Compare(std::move(trials), std::move(contenders), options, progress)});
  }

  std::vector<Experiment> Results() { return std::move(experiments_); }

 private:
  const std::function<void(const std::string&, int, int)>& progress_;
  std::vector<Experiment> experiments_;
};

const ComparisonRow* FindRow(const std::vector<Experiment>& experiments, const std::string& name,
                             const std::string& contender) {
  for (const Experiment& experiment : experiments) {
    if (experiment.name != name) continue;
    for (const ComparisonRow& row : experiment.comparison.rows) {
      const Contender& who = experiment.comparison.contenders[row.contender];
      if (row.trial == 0 && row.failure.empty() && who.name == contender) return &row;
    }
  }
  return nullptr;
}

std::string DescribeHidden(const std::vector<Experiment>& experiments) {
  for (const Experiment& experiment : experiments) {
    if (experiment.name != kOcclusion) continue;
    const CommonGround& ground = experiment.comparison.grounds.front();
    if (ground.mean_hidden.size() == 0) return "";
    return fmt::format("{:.0f} of {} at the end of the motion on average, {:.0f} at most",
                       ground.mean_hidden.tail(100).mean(),
                       experiment.comparison.grounds.front().labels.size(),
                       ground.most_hidden.maxCoeff());
  }
  return "";
}

}  // namespace

std::vector<std::string> ExperimentNames() { return {kComplete, kOcclusion, kRates, kRecordings}; }

std::vector<Experiment> Evaluate(
    const EvaluationRequest& request,
    const std::function<void(const std::string&, int, int)>& progress) {
  const auto model = std::make_shared<KinematicModel>(
      ScaleWinter(ReadMmmModel(DataFile("models/mmm.xml")), {kReferenceHeight, kMass, {}}));
  const Trial handstand = MakeHandstandTrial(model, 1);
  Stages stages(progress);

  ComparisonOptions complete;
  complete.jobs = 1;  // undisturbed times
  stages.Add(kComplete, "All markers seen", kCompleteText, {handstand},
             InPaperSetting(
                 ShippedContenders({"s2kf_default", "s2kf_paper", "ukf", "ekf", "jacobian_gradient",
                                    "jacobian_least_squares", "jacobian_pull"})),
             complete);

  ComparisonOptions occlusion;
  occlusion.hiding.amount = 0.005;
  occlusion.runs = request.runs;
  occlusion.jobs = request.jobs;
  stages.Add(kOcclusion, "Markers hidden at random, as in the paper", kOcclusionText, {handstand},
             InPaperSetting(ShippedContenders(
                 {"s2kf_default", "s2kf_paper", "ekf", "jacobian_least_squares", "jacobian_pull"})),
             occlusion);

  stages.Add(kRates, "S2KF, UKF and EKF alone at falling frame rates", kRatesText,
             {handstand, MakeHandstandTrial(model, 10), MakeHandstandTrial(model, 20)},
             FiltersAlone(), complete);

  if (!request.others.empty()) {
    stages.Add(kRecordings, "Recordings", "All markers as they were recorded.", request.others,
               ShippedContenders({"s2kf_default", "ukf", "ekf", "jacobian_gradient",
                                  "jacobian_least_squares", "jacobian_pull"}),
               complete);
  }
  return stages.Results();
}

std::string FormatPaperTable(const std::vector<Experiment>& experiments) {
  const ComparisonRow* paper = FindRow(experiments, kComplete, "s2kf_paper");
  const ComparisonRow* here = FindRow(experiments, kComplete, "s2kf_default");
  const ComparisonRow* paper_hidden = FindRow(experiments, kOcclusion, "s2kf_paper");
  const ComparisonRow* here_hidden = FindRow(experiments, kOcclusion, "s2kf_default");
  const auto cell = [](const ComparisonRow* row, auto value) {
    return row == nullptr ? std::string("failed") : fmt::format("{:.2f}", value(row->quality));
  };
  const auto mean = [](const TrackingQuality& q) { return kMillimetres * q.all.mean; };
  const auto worst = [](const TrackingQuality& q) { return kMillimetres * q.all.worst_frame; };
  const auto median = [](const TrackingQuality& q) { return kMilliseconds * q.median_seconds; };
  const auto p99 = [](const TrackingQuality& q) { return kMilliseconds * q.p99_seconds; };
  return fmt::format(
      "| handstand | paper | here, s2kf_paper | here, s2kf_default |\n|---|---|---|---|\n"
      "| mean marker distance, all markers seen [mm] | 40 to 50 | {} | {} |\n"
      "| time a frame, median / 99 % [ms] | at most 8 | {} / {} | {} / {} |\n"
      "| hidden markers | 16 of 50 on average, over 25 at times | {} | the same |\n"
      "| mean marker distance, markers hidden [mm] | | {} | {} |\n"
      "| worst frame of all runs, markers hidden [mm] | | {} | {} |\n",
      cell(paper, mean), cell(here, mean), cell(paper, median), cell(paper, p99),
      cell(here, median), cell(here, p99), DescribeHidden(experiments), cell(paper_hidden, mean),
      cell(here_hidden, mean), cell(paper_hidden, worst), cell(here_hidden, worst));
}

}  // namespace mmm_converter
