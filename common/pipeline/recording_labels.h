// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/judge/verdict.h"
#include "common/label/track/labelling.h"
#include "common/label/track/relabelled.h"
#include "common/motion/pose_trajectory.h"
#include "common/pipeline/input/input.h"
#include "common/pipeline/input/person.h"
#include "common/study/label_figures.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// What is known of the names, beside the input's model and person.
struct LabelHints {
  std::string like;  ///< a labelled recording of the person; empty: none
  /// The recording's own labels are right unless the body says otherwise; so they are without
  /// other hints where all of them are known (AreAllNamed).
  bool repair = false;
  std::vector<std::string> other_persons;  ///< their subject files
  std::string object_models;               ///< folder with models of rigid objects; empty: none
  std::set<std::string> taken;             ///< names that can't be given
  bool has_others() const { return !other_persons.empty() || !object_models.empty(); }
};

/// Files that are read for these.
std::vector<std::string> FilesOf(const LabelHints& hints);

/// A person beside the first, or a rigid object.
struct OtherBody {
  std::string name;
  std::string file;  ///< subject, or model
  bool is_object = false;
  int first_name = 0, end_name = 0;  ///< its names of the labelling
};

/// Whose markers the points of a recording are.
struct FoundLabels {
  bool is_repair = false;            ///< of the recording's own labels
  bool has_exchanged_sides = false;  ///< these were left for right, and were exchanged first
  std::shared_ptr<const KinematicModel> reference;  ///< of the setup, not scaled
  Person person;
  TrackingSetup setup;            ///< of the labelling's names; its model is the person's
  std::string prefix;             ///< of the person's names, as in `anna:`
  std::vector<OtherBody> others;  ///< whose names come after those of the setup
  Labelling labelling;
  std::vector<RelabelledPoint> points;
  std::vector<LabelChange> changes;
};

/// Names the points of an input that was read with its unlabelled points, and whose model is
/// matched (MatchModel). The names: of a repair those of the recording's labels that the marker set
/// knows; else those of `like`; and those of the markers that the subject has offsets for, by the
/// marker set's labels. Where there is none of these, all of the marker set, which is KIT's where
/// nothing says otherwise. The person is the subject, or else calibrated on `like`, or of the
/// height that is known. Where there are several persons, the names of each begin with the person's
/// name, those of an object always with that of its model's file, as in `anna:LASI`, `box:3`.
/// request: how the input was asked for; `like` has its person and model.
/// progress(done, all): frames; may be empty.
/// @throws Error
FoundLabels FindLabels(const InputRequest& request, const LabelHints& hints, const Input& input,
                       const ConverterConfig& config, const std::function<bool(int, int)>& progress,
                       Warnings* warnings);

/// The person's own points, under names without prefix; those of others and those without a name
/// are left out.
std::vector<RelabelledPoint> PointsOfPerson(const FoundLabels& found);

/// The points are those of the markers.
NamingFigures MeasureNaming(const Labelling& labelling, const MarkerSequence& markers);

/// How far named points are from the person's markers in the best postures of some frames.
struct FittedLabels {
  LabelFit figures;
  TrackingSetup setup;  ///< its labels are columns of the frames; no assignments: too few are named
  MarkerSequence frames;
  PoseTrajectory trajectory;  ///< these postures
};

/// reference: the model of 1 m; null: the height that they tell is not asked for.
FittedLabels FitLabels(const FoundLabels& found, const MarkerSequence& markers,
                       const KinematicModel* reference);

/// Of the recording's own labels those whose points are at most so far from their markers on
/// average [m].
std::set<std::string> NamesThatFit(const FoundLabels& found, const MarkerSequence& markers,
                                   double most);

/// As FindLabels without hints, of points that are still to come: person, setup and the names
/// (Labelling::names) alone.
/// @throws Error
FoundLabels FindNames(const InputRequest& request, const Input& input,
                      const ConverterConfig& config, Warnings* warnings);

/// A recording under the names that were found; points without one are left out.
struct NamedRecording {
  Input input;
  FoundLabels labels;
};

/// What was asked for.
struct LabelRequest {
  InputRequest input;
  ConverterRequest converter;  ///< its configuration names markers and joints
  LabelHints hints;
  bool ignores_subject = false;           ///< of the configuration
  std::string output;                     ///< empty: nothing is written
  std::vector<std::string> more_outputs;  ///< that the caller writes
};

/// Everything that a summary tells.
struct LabelReport {
  Input input;
  ConverterConfig config;  ///< matched with the model
  FoundLabels found;
  std::string output;
  LabelFit fit;
  Verdict verdict;
  Warnings warnings;
};

/// Reads, and names the points: minutes of a long recording. The report has no verdict yet.
/// progress: as of FindLabels; returning false ends it with an Error.
/// @throws Error
LabelReport LabelPoints(const LabelRequest& request, const ReadBefore& read_before,
                        const std::function<bool(int, int)>& progress);

/// Checks the outputs, names the points and judges; writes nothing.
/// @throws Error
LabelReport RunLabelling(const LabelRequest& request,
                         const std::function<bool(int, int)>& progress);

}  // namespace mmm_converter
