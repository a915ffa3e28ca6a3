// SPDX-License-Identifier: MIT
#include "common/pipeline/conversion_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/model/model_scaling.h"
#include "common/motion/marker_sequence.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

// Tasks that read recordings, write motions, name points, read motions, and have a person.
constexpr Task kTrackings = task::kConvert | task::kLabel | task::kCalibrate | task::kCompare |
                            task::kEvaluate | task::kLearnMarkers | task::kReport | task::kLive |
                            task::kRetarget;
constexpr Task kWritings = task::kConvert | task::kLive;
constexpr Task kConversions = kWritings | task::kRetarget;
constexpr Task kLabellings = task::kConvert | task::kLabel | task::kRetarget;
constexpr Task kVerdicts = kConversions | task::kLabel | task::kCalibrate | task::kBatch;
constexpr Task kReadings = kTrackings | task::kServe | task::kRead;
constexpr Task kMotions = task::kCheckDynamics | task::kExportPoses;
constexpr Task kPersons = kTrackings | kMotions | task::kModel;

constexpr OptionValue kSwitch = {};
constexpr OptionValue kName = {OptionKind::kText, "NAME"};
constexpr OptionValue kFile = {OptionKind::kFile, "FILE"};
constexpr OptionValue kFolder = {OptionKind::kFile, "DIR"};
constexpr OptionValue kShipped = {OptionKind::kShipped, "FILE"};
constexpr OptionValue kSubject = {OptionKind::kSubject, "FILE"};

std::optional<int> ReadFrame(const std::string& text, bool* is_right) {
  if (text.empty()) return std::nullopt;
  const auto frame = ParseLong(text);
  *is_right &= frame && *frame >= 0 && *frame <= std::numeric_limits<int>::max();
  return *is_right ? std::optional(static_cast<int>(*frame)) : std::nullopt;
}

bool SetFrames(const std::string& text, InputRequest* request) {
  const std::size_t colon = text.find(':');
  bool is_right = colon != std::string::npos;
  request->first_frame = ReadFrame(text.substr(0, colon), &is_right);
  if (is_right) request->end_frame = ReadFrame(text.substr(colon + 1), &is_right);
  return is_right;
}

bool SetLabel(const std::string& text, ConversionRequest* request) {
  request->label = text == "true" || text == "repair";
  request->label_hints.repair = text == "repair";
  return request->label || text == "false";
}

void Add(const char* group, std::vector<Option> rows, std::vector<Option>* options) {
  for (Option& row : rows) {
    row.group = group;
    options->push_back(std::move(row));
  }
}

std::vector<Option> ReadingOptions(ConversionRequest* request) {
  ReadRecordingOptions* reading = &request->input.reading;
  const auto set_motion = [request](const std::string& text) {
    request->input.reading.motion = request->motion_name = text;
    return true;
  };
  const auto set_frames = [request](const std::string& text) {
    return SetFrames(text, &request->input);
  };
  const auto set_up = [reading](const std::string& text) {
    return (reading->up_axis = StatedUpAxis(text)).has_value();
  };
  return {
      Row({"subject", "subject", "prefix"}, kName,
          "label prefix of the subject, if a recording has several; A,B: of one person under "
          "several; \"\": labels without prefix",
          "", kReadings | task::kInfo, &reading->subject, {.remedy = Remedy::kSubjectPrefix}),
      Row({"motion", "motion", "motion"}, kName,
          "MMM files: the motion to read (convert: or all); other files: the name of the written "
          "motion",
          "", kReadings | kMotions, set_motion, {.alias = "motionName", .remedy = Remedy::kMotion}),
      Row({"frames", "frames", "frames"}, {OptionKind::kFrames, "A:B"},
          "frames A to B-1 only, counted from 0; either may be left out", "",
          (kReadings & ~(task::kLabel | task::kLive | task::kRead)) | kMotions, set_frames,
          {.remedy = Remedy::kFrames}),
      Row({"unit", "unit", "unit"}, {OptionKind::kChoice, "mm|cm|m|in"},
          "overrides the unit that the file states", "", kReadings | task::kInfo, &reading->unit,
          {.remedy = Remedy::kUnit}),
      Row({"rate", "rate_hz", "rate"},
          {OptionKind::kNumber, "HZ", "frames a second", kLowestRate, kHighestRate},
          "overrides the frame rate that the file states", "", kReadings, &reading->rate,
          {.remedy = Remedy::kRate}),
      Row({"ignore-residuals", "ignoreResiduals", "ignore_residuals"}, kSwitch,
          "C3D files: also use points that the file marks as invalid", "", kReadings,
          &reading->ignore_residuals, {.remedy = Remedy::kIgnoreResiduals}),
      Row({"forces", "forces", "forces"}, kFile,
          "the ground's forces, in the recording's axes and time, for exports that need them: "
          "OpenSim's .mot or ExternalLoads",
          "those of the recording's force plates", task::kConvert | task::kCheckDynamics,
          &request->input.forces_file, {.of_motions = "none: the ground is assumed"}),
      Row({"events", "events", "events"}, {OptionKind::kChoice, "file|found"},
          "when feet come to the ground and leave it, for contacts and strides: as the file says, "
          "or as it is found, which then replaces the file's events in copies of it",
          "the file's of a foot where it has all that are found", task::kConvert,
          &request->input.events),
      Row({"emg", "emg", "emg"}, {OptionKind::kText, "LABELS"},
          "analog channels of muscles, separated by commas, or \"all\" that are called EMG: "
          "high-passed (20 Hz), rectified, low-passed (6 Hz), over the strides beside the angles",
          "", task::kConvert, &request->input.emg),
      Row({"up", "up", "up"}, {OptionKind::kAxis, "AXIS"},
          "the file's axis that points up: x, y, z, -x, -y or -z", "", kReadings | task::kInfo,
          set_up, {.remedy = Remedy::kUpAxis}),
      Row({"smpl-model", "smplModel", "smpl_model"}, kFile,
          "motions of SMPL (AMASS), read and written: the body model as .npz, as "
          "SMPLX_NEUTRAL.npz",
          "a body of the MMM model", kReadings | task::kInfo, &reading->smpl_model)};
}

std::vector<Option> PersonOptions(InputRequest* input) {
  PersonRequest* person = &input->person;
  return {
      Row({"height", "height_m", "height"},
          {OptionKind::kNumber, "METRES", "metres", kLeastHeight, kLargestHeight}, "of the person",
          "from the files, else estimated from the markers", kPersons, &person->size.height,
          {.of_motions = "from the motion's file", .remedy = Remedy::kHeight}),
      Row({"mass", "mass_kg", "mass"},
          {OptionKind::kNumber, "KG", "kilograms", kLeastMass, kLargestMass}, "of the person",
          "from the files, else 70", kPersons, &person->size.mass, {.remedy = Remedy::kMass}),
      Row({"hand-length", "handLength_mm", "hand_length"},
          {OptionKind::kNumber, "METRES", "metres", kLeastHandLength, kLargestHandLength},
          "of the person", "from the files, else by the height", kPersons,
          &person->size.hand_length),
      Row({"person", "person", "person"}, kFile,
          "ModelProcessorConfig file with height, mass and hand length", "", kPersons,
          &person->processor_file, {.alias = "outputModelProcessorConfigFile"}),
      Row({"subject-file", "subjectFile", "subject"}, kSubject,
          "calibrated person: height, mass, segment lengths and marker places", "",
          kPersons & ~(task::kCalibrate | task::kLearnMarkers), &person->subject_file),
      Row({"model", "model", "model"}, kFile, "MMM model, or a URDF or a model of OpenSim as it is",
          "the shipped MMM model", kPersons, &input->model_file,
          {.alias = "outputModelFile",
           .of_motions = "the one that the motion's file names, else the shipped one",
           .remedy = Remedy::kModel}),
      Row({"marker-set", "markerSet", "marker_set"}, kShipped,
          "assigns labels to model markers, and can place these; or an IKTaskSet of OpenSim, which "
          "weighs them, also in the set-up of a tool",
          "what the configuration says", kPersons & ~(kMotions | task::kLearnMarkers),
          &input->marker_set, {.remedy = Remedy::kMarkerSet}),
      Row({"marker-file", "markerFile", "marker_file"}, kFile,
          "markers for a model of OpenSim: a MarkerSet of its own", "",
          kPersons & ~(kMotions | task::kLearnMarkers), &input->marker_file)};
}

std::vector<Option> PageOptions(PatientRequest* patient) {
  return {
      Row({"subject-name", "subjectName", "subject_name"}, {OptionKind::kText, "NAME"},
          "the person's name or number on the page", "what the recording says", task::kConvert,
          &patient->name),
      Row({"condition", "condition", "condition"}, {OptionKind::kText, "TEXT"},
          "on the page: how the person moved, as \"barefoot\"; of several recordings one for each "
          "(A,B,B), whose strides are compared",
          "", task::kConvert, &patient->condition),
      Row({"normal", "normal", "normal"}, kFile,
          "CSV with bands of healthy gait (joint, angle, percent, mean_degrees, sd_degrees), which "
          "the page draws behind the strides and scores them by",
          "", task::kConvert, &patient->normal_file)};
}

std::vector<Option> ConverterOptions(ConverterRequest* converter) {
  return {
      Row({"config,c", "config", "config"}, kShipped, "configuration, or the name of a shipped one",
          "s2kf_default", kLabellings | kConversions | task::kCalibrate | task::kLearnMarkers,
          &converter->config, {.alias = "converterConfigFile"}),
      Row({"converter", "converter", "converter"}, kName, "another converter, by its name",
          "what the configuration says, else S2KFConverter", kConversions, &converter->converter),
      Row({"plugin", "plugin", "plugin"}, kFile, "take the converter from this plugin file", "",
          kConversions, &converter->plugin_file)};
}

std::vector<Option> LabelOptions(ConversionRequest* request) {
  const auto set_label = [request](const std::string& text) { return SetLabel(text, request); };
  const auto set_repair = [request](const std::string& text) {
    return text != "true" || SetLabel("repair", request);
  };
  const auto set_models = [request](const std::string& text) {
    request->object_models = request->label_hints.object_models = text;
    return true;
  };
  return {
      Row({"label", "label", "label"}, {OptionKind::kSwitch, "true|repair|false"},
          "find the names of points that have none first, as label does: by {subject-file}, or by "
          "{height} and {marker-set}",
          "", kConversions, set_label),
      Row({"repair", "", "repair"}, kSwitch,
          "the recording has labels: keep them except where the body says that they are wrong", "",
          kLabellings, set_repair, {.absent = "label=\"repair\" of manifests"}),
      Row({"like", "labelLike", "like"}, {OptionKind::kFile, "RECORDING"},
          "another recording of the person with these markers, whose labels are right", "",
          kLabellings, &request->label_hints.like, {.with = "label"}),
      Row({"and-subject-file", "labelAndSubjectFiles", "and_subjects"}, kSubject,
          "another person who is there too and is not converted, calibrated; for each of them", "",
          kLabellings, &request->label_hints.other_persons, {.with = "label"}),
      Row({"object-models", "labelObjectModels", "object_models"}, kFolder,
          "models of rigid objects, DIR/MOTION.xml each: those that may be there beside a person; "
          "where an object is converted, that of its motion, which is built from its markers and "
          "written there if it is missing",
          "it is built into OUTPUT without ending + _objects", kLabellings, set_models)};
}

std::vector<Option> MotionOptions(ConversionRequest* request) {
  return {
      Row({"format", "format", "format"}, {OptionKind::kChoice, "2.0|1.0"}, "of the motion",
          "what the configuration says, 2.0", kWritings, &request->output_format),
      Row({"model-path", "modelPath", "model_path"}, {OptionKind::kText, "PATH"},
          "path of the model that is written into the motion", "relative to the motion", kWritings,
          &request->model_path),
      Row({"", "", "covariances"}, kSwitch, "keep the covariances of the postures", "",
          task::kConvert, &request->keeps_covariances, {.absent = "elsewhere they are exported"})};
}

std::vector<Option> RobotOptions(RobotRequest* robot) {
  constexpr const char* kInPython = "retarget() and live() have an argument for it";
  return {
      Row({"robot", "robot", ""}, kFile, "the robot to which the motion is brought: URDF or MJCF",
          "", task::kRetarget | task::kLive, &robot->file, {.absent = kInPython}),
      Row({"map", "robotMap", ""}, kFile,
          "which joints are its limbs (XML), instead of what its structure tells", "",
          task::kRetarget | task::kLive, &robot->map_file, {.absent = kInPython}),
      Row({"sole-height", "soleHeight_mm", ""}, {OptionKind::kNumber, "METRES", "metres"},
          "of the origin of the robot's last ankle link above the sole, where its file does not "
          "tell it",
          "", task::kRetarget | task::kLive, &robot->sole_height, {.absent = kInPython}),
      Row({"sole", "robotSole", ""}, {OptionKind::kText, "L,W,H"},
          "length and width of the robot's feet and the height of that origin above the sole, in "
          "metres, where its file has neither shapes nor meshes; or which of both counts: shapes "
          "or "
          "meshes",
          "shapes, for links without any meshes", task::kRetarget | task::kLive, &robot->sole,
          {.absent = kInPython}),
      Row({"hold", "robotHold", ""}, {OptionKind::kText, "JOINT=DEG,..."},
          "angles of joints that follow nobody, as of fingers; * is any text, sliding joints are "
          "given in mm: left_hand_*=30,neck=0",
          "joints that no limb or trunk has stay at 0, or the nearest that they may",
          task::kRetarget | task::kLive, &robot->hold, {.absent = kInPython}),
      Row({"weights", "robotWeights", ""}, {OptionKind::kText, "GROUP=W,..."},
          "how much the robot's feet, hands, trunk and limbs count against each other, 0.01 to 100 "
          "each: feet=2,hands=0.5, or a file with one of these a line",
          "1", task::kRetarget | task::kLive, &robot->weights, {.absent = kInPython}),
      Row({"objects", "robotObjects", ""}, {OptionKind::kFile, "FILE[:NAMES]"},
          "MMM file with the motions of rigid objects that were tracked beside the person, or some "
          "of them (A,B); hands that hold one keep their place at it, and it is written with the "
          "robot",
          "", task::kRetarget, &robot->objects, {.absent = kInPython})};
}

std::vector<Option> RobotLearningOptions(RobotRequest* robot) {
  constexpr const char* kInPython = "export() of a robot's motion has an argument for it";
  return {Row({"export-rate", "robotRate_hz", ""}, {OptionKind::kNumber, "HZ", "hertz", 1e-3, 1e3},
              "of the files for robot learning", "what their readers expect", task::kRetarget,
              &robot->export_rate, {.absent = kInPython}),
          Row({"order", "robotOrder", ""}, {OptionKind::kChoice, "isaac|mujoco"},
              "of joints where no file for robot learning tells it: isaac (breadth first) or "
              "mujoco (depth first)",
              "", task::kRetarget, &robot->order, {.absent = kInPython})};
}

}  // namespace

std::vector<Option> Options(ConversionRequest* request) {
  std::vector<Option> options;
  Add("Files", MotionOptions(request), &options);
  Add("Recording", ReadingOptions(request), &options);
  Add("Person and model", PersonOptions(&request->input), &options);
  Add("Page", PageOptions(&request->input.patient), &options);
  Add("Converter", ConverterOptions(&request->converter), &options);
  Add("Labels", LabelOptions(request), &options);
  Add("Calibration",
      {Row({"self-calibrate", "selfCalibrate", "self_calibrate"}, kSwitch,
           "estimate segment lengths and marker places from what is recorded first, as calibrate "
           "does",
           "", kConversions, &request->self_calibrate)},
      &options);
  Add("Objects",
      {Row({"object", "object", "object"}, kSwitch,
           "the recording shows a rigid object, not a person; MMM motions state this themselves",
           "", task::kConvert, &request->is_object),
       Row({"and-model", "", "and_models"}, kFile,
           "also track the rigid object of this model without joints; for each of them. Its labels "
           "are those of the subject that is called as the file (box.xml: Box:M1), else the names "
           "of its markers; its motion is OUTPUT_box.xml",
           "", task::kLive, &request->other_objects,
           {.absent = "a batch converts all motions of a file"})},
      &options);
  Add("Robot", RobotOptions(&request->robot), &options);
  Add("Robot learning", RobotLearningOptions(&request->robot), &options);
  Add("Verdict",
      {Row({"strict", "", ""}, kSwitch,
           "exit code 3 where a verdict is failed; all is written as without it", "", kVerdicts, {},
           {.absent = "results have their verdict, and exit codes are none"})},
      &options);
  return options;
}

const std::vector<Option>& DescribedOptions() {
  static ConversionRequest nobodys;
  static const std::vector<Option> options = Options(&nobodys);
  return options;
}

std::string HelpOf(Medium medium, const Option& option, Task task) {
  std::string help = option.help;
  const std::string unit = option.value.unit;
  if (medium == Medium::kPython && !unit.empty()) help += ", in " + unit;
  if (medium == Medium::kManifest && IsList(option)) help += "; files, with ; between them";
  const bool of_motions = (task & kMotions) != 0 && *option.notes.of_motions != 0;
  const std::string otherwise = of_motions ? option.notes.of_motions : option.otherwise;
  if (!otherwise.empty()) help += "; default: " + otherwise;
  const std::vector<Option>& table = DescribedOptions();
  const bool says_more = std::any_of(table.begin(), table.end(), [&](const Option& one) {
    return (one.tasks & task) != 0 && *option.notes.with != 0 && LongName(one) == option.notes.with;
  });
  if (says_more) help = "with {" + std::string(option.notes.with) + "}: " + help;
  const std::vector<std::string> choices = Choices(medium, option);
  if (medium == Medium::kManifest && !choices.empty()) help = JoinNames(choices) + "; " + help;
  return Spell(medium, help, table);
}

std::string Contradiction(const ConversionRequest& request) {
  const LabelHints& hints = request.label_hints;
  const auto option = [](const char* name) { return OptionText(name); };
  if (request.label && request.is_object) {
    return option("label") + " names the markers of a person, not those of an " + option("object");
  }
  if (request.label && !request.other_objects.empty()) {
    return fmt::format(
        "{} names the points of a person by the body, and {} is known by its labels; "
        "use one",
        option("label"), option("and-model"));
  }
  if (!request.label && !hints.like.empty()) {
    return fmt::format("{} says by which recording {} or {} finds names", option("like"),
                       option("label"), option("repair"));
  }
  if (!request.label && !hints.other_persons.empty()) {
    return fmt::format("{} says who else wears the points of a {}", option("and-subject-file"),
                       option("label"));
  }
  if (request.self_calibrate && !request.input.person.subject_file.empty()) {
    return fmt::format("{} estimates the person, {} says who it is; use one",
                       option("self-calibrate"), option("subject-file"));
  }
  return "";
}

std::string ExampleOf(Medium medium, Remedy remedy) {
  const std::vector<Option>& options = DescribedOptions();
  const auto option = std::find_if(options.begin(), options.end(), [&](const Option& one) {
    return remedy != Remedy::kNone && one.notes.remedy == remedy;
  });
  if (option == options.end()) return "";
  std::string value = option->value.argument;
  if (remedy == Remedy::kHeight) value = "1.75";
  if (remedy == Remedy::kMass) value = "70";
  if (remedy == Remedy::kUnit) value = "UNIT";
  std::string text = NameIn(medium, *option);
  if (medium == Medium::kCommandLine) {
    if (!value.empty()) text += ' ' + value;
  } else if (medium == Medium::kManifest) {
    text += "=\"" + (value.empty() ? "true" : value) + '"';
  } else if (option->value.kind == OptionKind::kFrames) {
    text += "=(A, B)";
  } else if (option->value.kind == OptionKind::kSwitch) {
    text += "=True";
  } else {
    const bool is_number = option->value.kind == OptionKind::kNumber;
    text += is_number ? '=' + value : "=\"" + value + '"';
  }
  return text;
}

Wording WordingOf(Medium medium) {
  const bool is_python = medium == Medium::kPython;
  const auto name_option = [medium](const std::string& name) {
    for (const Option& option : DescribedOptions()) {
      if (LongName(option) == name) return NameIn(medium, option);
    }
    std::string other = name;
    if (medium == Medium::kCommandLine) return "--" + other;
    std::replace(other.begin(), other.end(), '-', '_');
    return other;
  };
  const auto advise = [medium, is_python](Remedy remedy) -> std::string {
    const std::string label = is_python ? "label()" : "the command label";
    if (remedy == Remedy::kLabels)
      return "; " + label + " finds the names of points that have none";
    const std::string example = ExampleOf(medium, remedy);
    if (example.empty()) return "";
    if (remedy == Remedy::kHeight || remedy == Remedy::kMass) return ", e.g. " + example;
    if (remedy == Remedy::kUnit || remedy == Remedy::kUpAxis)
      return " (another by " + example + ")";
    if (remedy != Remedy::kMarkerSet) return " (" + example + ")";
    return " (" + example + "); points without names get them by " + label +
           (is_python ? ""
                      : ", labels of an unknown meaning become a marker set by the command "
                        "learn-markers");
  };
  return {name_option, advise};
}

}  // namespace mmm_converter
