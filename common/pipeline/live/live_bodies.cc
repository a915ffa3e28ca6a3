// SPDX-License-Identifier: MIT
#include "common/pipeline/live/live_bodies.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <set>
#include <utility>

#include "common/io/model_file.h"
#include "common/live/shared_labels.h"
#include "common/pipeline/object.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

LabelSelection RestOf(const std::vector<std::string>& labels,
                      const std::vector<LabelSelection>& taken,
                      const std::optional<std::string>& subject, const std::string& source,
                      Warnings* warnings) {
  std::vector<bool> is_taken(labels.size());
  for (const LabelSelection& one : taken) {
    for (const int i : one.indices) is_taken[static_cast<std::size_t>(i)] = true;
  }
  std::vector<std::string> rest;
  std::vector<int> places;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (is_taken[i]) continue;
    rest.push_back(labels[i]);
    places.push_back(static_cast<int>(i));
  }
  LabelSelection selection = SelectLabels(rest, {}, {}, subject, source, warnings);
  for (int& i : selection.indices) i = places[static_cast<std::size_t>(i)];
  return selection;
}

LabelledObject ObjectOf(const std::string& file, const KinematicModel& model) {
  LabelledObject object;
  object.name = std::filesystem::path(file).stem().string();
  for (const ModelMarker& marker : model.markers()) {
    object.labels.push_back(marker.name);
    const std::string label = LabelOfMarker(marker.name);
    if (label != marker.name) object.labels.push_back(label);
  }
  return object;
}

// Without what is of the person beside it.
LiveRequest RequestOf(const LiveRequest& request, const std::string& file,
                      const std::string& name) {
  LiveRequest own = request;
  own.input.model_file = file;
  own.input.person = {};
  own.input.marker_set.clear();
  own.input.marker_file.clear();
  own.other_objects.clear();
  own.motion_name = name;
  if (!own.output.empty()) own.output = OutputOfObject(own.output, name);
  own.self_calibrate = false;
  own.calibration_time = 0;
  own.subject_output.clear();
  own.robot = {};
  return own;
}

void CheckNames(const std::vector<LabelledObject>& objects) {
  std::set<std::string> names;
  for (const LabelledObject& one : objects) {
    // The second motion of the first body is OUTPUT_2.
    if (ParseLong(one.name)) {
      throw Error(
          fmt::format("the object of {}.xml has a number as its name; rename the file", one.name));
    }
    if (names.insert(ToLower(one.name)).second) continue;
    throw Error(
        fmt::format("two objects are called {}; objects are called as the files of their "
                    "models: rename one",
                    one.name));
  }
}

// The second motion of box is OUTPUT_box_2.
void CheckOutputsOf(const std::vector<LiveBodyRequest>& bodies) {
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    for (std::size_t j = 1; j < bodies.size(); ++j) {
      const std::string& name = bodies[j].request.motion_name;
      const std::string before = bodies[i].request.motion_name + "_";
      if (!EqualIgnoringCase(name.substr(0, before.size()), before)) continue;
      if (ParseLong(name.substr(before.size())).value_or(0) < 2) continue;
      throw Error(fmt::format(
          "the objects {}.xml and {}.xml would have motions of one name, {}; rename one of them",
          bodies[i].request.motion_name, name, bodies[j].request.output));
    }
  }
}

}  // namespace

std::string OutputOfObject(const std::string& output, const std::string& name) {
  const std::filesystem::path path = output;
  return (path.parent_path() / (path.stem().string() + "_" + name + ".xml")).string();
}

std::vector<LiveBodyRequest> BodiesOf(const LiveRequest& request, bool selects_labels) {
  if (request.other_objects.empty()) {
    if (!selects_labels || request.label) return {{request, {}}};
    const std::optional<std::string> subject = request.input.reading.subject;
    return {{request, [subject](const std::vector<std::string>& labels, const std::string& source,
                                Warnings* warnings) {
               return SelectLabels(labels, {}, {}, subject, source, warnings);
             }}};
  }
  std::vector<LabelledObject> objects;
  std::vector<LiveBodyRequest> bodies;
  const std::string& first = request.input.model_file;
  bool is_first_object = false;
  if (!first.empty()) {
    Warnings unused;  // told where it is planned
    const LoadedModel model = ReadModelFile(first, &unused);
    is_first_object = model.model.num_joints() == 0;
    if (is_first_object) objects.push_back(ObjectOf(first, model.model));
  }
  bodies.push_back({request, {}});
  bodies.front().request.other_objects.clear();
  if (is_first_object && request.motion_name.empty()) {
    bodies.front().request.motion_name = objects.front().name;
  }
  for (const std::string& file : request.other_objects) {
    Warnings unused;
    const LoadedModel model = ReadModelFile(file, &unused);
    if (model.model.num_joints() > 0) {
      throw Error(fmt::format("{}: has {} joints; {} is of rigid objects, which have none", file,
                              model.model.num_joints(), OptionText("and-model")));
    }
    objects.push_back(ObjectOf(file, model.model));
    bodies.push_back({RequestOf(request, file, objects.back().name), {}});
  }
  CheckNames(objects);
  if (!request.output.empty()) CheckOutputsOf(bodies);
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    bodies.front().other_names.push_back(bodies[i].request.motion_name);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::optional<std::string> subject = request.input.reading.subject;
    const std::size_t offset = is_first_object ? 0 : 1;
    bodies[i].choose = [objects, i, offset, subject](const std::vector<std::string>& labels,
                                                     const std::string& source,
                                                     Warnings* warnings) {
      std::vector<LabelSelection> shares = ShareLabels(labels, objects, source);
      return i < offset ? RestOf(labels, shares, subject, source, warnings) : shares[i - offset];
    };
  }
  return bodies;
}

}  // namespace mmm_converter
