// SPDX-License-Identifier: MIT
#include "common/pipeline/input/person.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "common/calibrate/landmark_body.h"
#include "common/calibrate/person_height.h"
#include "common/convert/converter_config.h"
#include "common/convert/skeleton_setup.h"
#include "common/io/mmm/processor_config.h"
#include "common/io/mmm/subject_file.h"
#include "common/support/advice.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr double kAssumedMass = 70;  // [kg]
constexpr const char* kAssumed = "assumed";
constexpr const char* kByPlates = "force plates";
constexpr const char* kSetOfNames = "names";  // what ComposeNamedMarkers calls its sets
// Of persons whose bones are as long: Winter's proportions differ by some percent [m].
constexpr double kSkeletonHeightDeviation = 0.05;

// The first source that has a value.
std::optional<PersonValue> Choose(const std::optional<double>& given,
                                  const std::optional<double>& in_processor_file,
                                  const std::string& processor_file,
                                  const std::optional<double>& in_recording) {
  if (given) return PersonValue{*given, "given"};
  if (in_processor_file) return PersonValue{*in_processor_file, processor_file};
  if (in_recording) return PersonValue{*in_recording, "from the file"};
  return std::nullopt;
}

/// Only by markers whose places were known before the recording.
TrackingSetup WithKnownPlaces(TrackingSetup setup, const NamedMarkers& names) {
  std::erase_if(setup.mapping.assignments, [&](const MarkerAssignment& one) {
    return names.labels[static_cast<std::size_t>(one.label)].is_cluster;
  });
  return setup;
}

/// What the labels of a marker set that was composed of names, and written, mean.
NamedMarkers NamesOfSet(const TrackingSetup& setup, const MarkerSequence& markers) {
  NamedMarkers named;
  const std::vector<ReadLabel> read = ReadLabels(markers.labels(), {}, ShippedLandmarks());
  for (const MarkerAssignment& one : setup.assignments()) {
    NamedLabel& label = named.labels.emplace_back();
    label.label = markers.labels()[one.label];
    label.marker = setup.model->markers()[one.marker].name;
    label.readings = read[static_cast<std::size_t>(one.label)].readings;
  }
  return named;
}

void Estimate(const TrackingSetup& setup, const MarkerSequence& markers, const NamedMarkers* names,
              Person* person) {
  // Hardly less than the heights of persons differ.
  constexpr double kUnknown = 0.9 * kHeightDeviation;
  const PersonHeight estimate =
      names == nullptr ? EstimatePersonHeight(setup, markers)
                       : EstimatePersonHeight(WithKnownPlaces(setup, *names), markers, true);
  person->height = {estimate.height, fmt::format("estimated from {} frames", estimate.frames)};
  person->height_deviation = estimate.deviation;
  if (estimate.deviation > kUnknown) {
    person->height = {kOrdinaryHeight, "an ordinary one; the markers don't tell it"};
    person->height_deviation = kHeightDeviation;
  }
}

// Of one person's heights, one of which may be estimated from markers: relative.
constexpr double kHeightsOfOne = 0.05;

// Files have at least 6 digits of a metre or a kilogram.
bool AreEqual(double a, double b) { return std::abs(a - b) < 1e-6; }

// A number that the user gives must be the subject's.
void CheckLength(const char* what, const std::optional<double>& given, std::optional<double> own,
                 const std::string& file) {
  if (!given || (own && AreEqual(*given, *own))) return;
  throw Error(
      fmt::format("{}: is calibrated for {} {}, not for {:g} m: its segment scales are relative to "
                  "it; leave the {} out, or calibrate again with it",
                  file, what, own ? fmt::format("{:g} m", *own) : "by the height", *given, what));
}

// Another mass changes no length.
void UseSubject(const PersonRequest& request, const BodySize& processor, const Recording& recording,
                Person* person, Warnings* warnings) {
  const Subject& subject = *person->subject;
  const std::string& file = person->subject_file;
  const auto height = request.size.height ? request.size.height : processor.height;
  const auto hand_length =
      request.size.hand_length ? request.size.hand_length : processor.hand_length;
  CheckLength("height", height, subject.height, file);
  CheckLength("hand length", hand_length, subject.hand_length, file);
  person->height = {subject.height, file};
  person->mass = {subject.mass, file};
  person->hand_length = subject.hand_length;
  const auto mass = Choose(request.size.mass, processor.mass, request.processor_file, std::nullopt);
  if (mass && !AreEqual(mass->value, subject.mass)) {
    warnings->Add(fmt::format("{}: has a mass of {:g} kg; {:g} kg ({}) is taken", file,
                              subject.mass, mass->value, mass->source));
    person->mass = *mass;
  }
  const std::optional<double> stated = recording.size().height;
  if (stated && std::abs(*stated / subject.height - 1) > kHeightsOfOne) {
    warnings->Add(
        fmt::format("{}: the recording is of a person of {:g} m, the subject has {:g} m; is it the "
                    "same person?",
                    file, *stated, subject.height));
  }
}

// Height, mass and hand length from where they are known, else estimated and assumed.
void UseNumbers(const PersonRequest& request, const BodySize& processor, const Recording& recording,
                Person* person) {
  const std::string& file = request.processor_file;
  const auto height = Choose(request.size.height, processor.height, file, recording.size().height);
  const auto mass = Choose(request.size.mass, processor.mass, file, recording.size().mass);
  const auto hand_length =
      Choose(request.size.hand_length, processor.hand_length, file, recording.size().hand_length);
  person->height = height.value_or(PersonValue());
  person->mass = mass ? *mass : PersonValue{kAssumedMass, kAssumed};
  if (hand_length) person->hand_length = hand_length->value;
}

// The lengths of a skeleton are the person's.
void UseSkeleton(const Recording& recording, const KinematicModel& reference, Person* person) {
  const bool is_known = !person->height.source.empty();
  Subject subject = SubjectOfSkeleton(
      recording, reference, is_known ? std::optional(person->height.value) : std::nullopt);
  subject.mass = person->mass.value;
  subject.hand_length = person->hand_length;
  if (!is_known) {
    person->height = {subject.height, "by the lengths of the skeleton"};
    person->height_deviation = kSkeletonHeightDeviation;
  }
  person->subject = std::make_shared<const Subject>(std::move(subject));
}

Person Find(const PersonRequest& request, const KinematicModel& reference,
            const Recording& recording, const ConverterConfig& config,
            const std::function<void(Person*)>& estimate_height, bool has_names,
            Warnings* warnings) {
  Person person;
  BodySize processor;
  if (!request.processor_file.empty()) processor = ReadProcessorConfig(request.processor_file);
  person.subject_file = request.subject_file.empty() ? config.subject_file : request.subject_file;
  if (!person.subject_file.empty()) {
    person.subject =
        std::make_shared<Subject>(ReadSubject(person.subject_file, reference, has_names));
    UseSubject(request, processor, recording, &person, warnings);
    return person;
  }
  UseNumbers(request, processor, recording, &person);
  if (!recording.body.empty() && HasBody(reference)) {
    UseSkeleton(recording, reference, &person);
  } else if (person.height.source.empty()) {
    estimate_height(&person);
  }
  return person;
}

Person LeaveUnscaled(const PersonRequest& request, const ConverterConfig& config,
                     Warnings* warnings) {
  if (!request.subject_file.empty()) {
    throw Error(fmt::format("{}, but the subject {} is relative to the scaled one",
                            WhyUnscaled(config), request.subject_file));
  }
  if (!request.size.empty() || !request.processor_file.empty()) {
    warnings->Add(WhyUnscaled(config) + "; height, mass and hand length are left out");
  }
  Person person;
  person.height = {0, "model is not scaled"};
  person.mass = person.height;
  return person;
}

}  // namespace

bool IsAssumed(const PersonValue& value) { return value.source == kAssumed; }

bool IsByPlates(const PersonValue& value) { return value.source == kByPlates; }

PersonValue MassByForcePlates(double mass) { return {mass, kByPlates}; }

bool IsGiven(const PersonRequest& request) {
  return !request.processor_file.empty() || !request.subject_file.empty() || !request.size.empty();
}

std::string DescribeHeight(const Person& person) {
  const double deviation = person.height_deviation;
  return fmt::format("{:.3g} m{} ({})", person.height.value,
                     deviation > 0 ? fmt::format(" +- {:.2g}", deviation) : "",
                     person.height.source);
}

std::string WhyUnscaled(const ConverterConfig& config) {
  const std::string why = "the model is not scaled (it is a URDF or one of OpenSim";
  if (config.file.empty()) return why + ")";
  return why + ", or " + config.file + " has <Model name=\"None\">)";
}

PersonScaling ScalingOf(const Person& person, const ConverterConfig& config) {
  if (config.model_processor == "None") return {std::nullopt, person.subject};
  return {WinterScaling{person.height.value, person.mass.value, person.hand_length}, person.subject,
          person.landmarks};
}

Person FindPerson(const PersonRequest& request, const TrackingSetup& setup,
                  const Recording& recording, const ConverterConfig& config, Warnings* warnings,
                  const NamedMarkers* names) {
  if (config.model_processor == "None") return LeaveUnscaled(request, config, warnings);
  const auto estimate = [&](Person* person) { Estimate(setup, recording.markers, names, person); };
  // Where nothing is tracked, what wears markers does not count.
  const bool leaves_others = names != nullptr || setup.assignments().empty();
  Person person = Find(request, *setup.model, recording, config, estimate, leaves_others, warnings);
  const bool is_of_names = names != nullptr || setup.marker_set == kSetOfNames;
  if (is_of_names && !person.subject) {
    TrackingSetup scaled = setup;
    ScaleToPerson(ScalingOf(person, config), &scaled);
    const NamedMarkers named = names != nullptr ? *names : NamesOfSet(setup, recording.markers);
    person.landmarks =
        std::make_shared<const Subject>(FindLandmarkBody(scaled, named, recording.markers));
  }
  return person;
}

Person FindPersonOfPoints(const PersonRequest& request, const KinematicModel& reference,
                          const Recording& recording, const ConverterConfig& config,
                          Warnings* warnings) {
  if (config.model_processor == "None") return LeaveUnscaled(request, config, warnings);
  const auto fail = [](Person* /*person*/) {
    throw Error(fmt::format(
        "who wears the markers? Points without names don't tell the height: give {}, another "
        "recording of the person whose labels are right ({}), or {}",
        OptionText("subject-file"), OptionText("like"), OptionText("height")));
  };
  return Find(request, reference, recording, config, fail, false, warnings);
}

Person FindKnownPerson(const PersonRequest& request, const KinematicModel& reference,
                       const ConverterConfig& config, Warnings* warnings) {
  const std::string unknown = fmt::format(
      "how tall and heavy is the person? Give {} and {}, {} or {}", OptionText("height"),
      OptionText("mass"), OptionText("person"), OptionText("subject-file"));
  if (config.model_processor == "None") throw Error(WhyUnscaled(config));
  const auto fail = [&](Person* /*person*/) { throw Error(unknown); };
  Person person = Find(request, reference, Recording(), config, fail, true, warnings);
  if (IsAssumed(person.mass)) throw Error(unknown);
  return person;
}

}  // namespace mmm_converter
