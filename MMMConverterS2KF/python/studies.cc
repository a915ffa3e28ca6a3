// SPDX-License-Identifier: MIT
// What the commands calibrate, compare, label, check-dynamics and retarget do.
#include <pybind11/stl.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "MMMConverterS2KF/python/arrays.h"
#include "MMMConverterS2KF/python/background.h"
#include "MMMConverterS2KF/python/module.h"
#include "MMMConverterS2KF/python/requests.h"
#include "MMMConverterS2KF/report/calibration_summary.h"
#include "MMMConverterS2KF/report/comparison_json.h"
#include "MMMConverterS2KF/report/comparison_table.h"
#include "MMMConverterS2KF/report/dynamics_page.h"
#include "MMMConverterS2KF/report/dynamics_summary.h"
#include "MMMConverterS2KF/report/label_page.h"
#include "MMMConverterS2KF/report/label_summary.h"
#include "MMMConverterS2KF/report/learn_summary.h"
#include "MMMConverterS2KF/report/report.h"
#include "MMMConverterS2KF/report/retarget_page.h"
#include "MMMConverterS2KF/report/retarget_summary.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/robot/robot_exports.h"
#include "common/label/track/relabelled.h"
#include "common/pipeline/comparison/comparison_setup.h"
#include "common/pipeline/dynamics/dynamics_check.h"
#include "common/pipeline/dynamics/retarget_run.h"
#include "common/pipeline/finished_work.h"
#include "common/pipeline/labelled_output.h"
#include "common/pipeline/marker_learning.h"
#include "common/pipeline/recording_labels.h"
#include "common/support/atomic_file.h"

namespace mmm_converter::python {

namespace py = pybind11;

namespace {

std::vector<InputRequest> InputRequestsOf(const py::list& inputs) {
  std::vector<InputRequest> requests;
  requests.reserve(inputs.size());
  for (const py::handle& one : inputs) requests.push_back(RequestOf(one.cast<py::dict>()).input);
  return requests;
}

// An output that may not be one of the inputs.
void Write(const std::vector<InputRequest>& inputs, const std::set<std::string>& opened,
           const std::string& file, const TextPieces& text) {
  const py::gil_scoped_release release;
  WriteBeside(inputs, opened, file, text);
}

struct Calibration {
  FinishedCalibration work;
  std::string output = {};  ///< where the subject was saved; empty: nowhere

  const CalibrationReport& report() const { return work.report; }
};

Calibration Calibrate(const py::list& inputs, const py::dict& options, const py::object& progress) {
  CalibrationRequest request;
  request.inputs = InputRequestsOf(inputs);
  request.converter = RequestOf(options).converter;
  request.name = TextOf(options, "name");
  return InBackground(progress, [&](const Progress& on_progress) {
    return Calibration{FinishCalibration(request, on_progress)};
  });
}

void SaveSubjectOf(Calibration* calibration, const std::string& file) {
  {
    const py::gil_scoped_release release;
    SaveSubject(calibration->work, file);
  }
  calibration->output = file;
}

void SaveModelOf(const Calibration& calibration, const std::string& file) {
  const py::gil_scoped_release release;
  SaveSubjectsModel(calibration.work, file);
}

struct Comparing {
  std::vector<InputRequest> inputs;
  Comparison comparison;
  std::set<std::string> opened = {};
};

Comparing CompareAll(const py::list& inputs, const std::vector<std::string>& configs,
                     const std::vector<std::string>& truths, const py::dict& options,
                     const py::object& progress) {
  Comparing result;
  result.inputs = InputRequestsOf(inputs);
  ComparisonOptions comparison;
  ReadKeywords(options, Options(&comparison));
  result.comparison = InBackground(progress, [&](const Progress& on_progress) {
    std::vector<Contender> contenders;
    for (const std::string& config : configs) {
      contenders.push_back(MakeContender(config));
      if (!result.inputs.empty()) UseMarkerSet(result.inputs.front(), &contenders.back().config);
    }
    std::vector<Trial> trials;
    Warnings warnings;
    for (std::size_t i = 0; i < result.inputs.size(); ++i) {
      trials.push_back(MakeTrial(result.inputs[i], truths.at(i),
                                 contenders.empty() ? ConverterConfig() : contenders.front().config,
                                 &warnings));
    }
    MakeNamesUnique(&trials, &contenders);
    return Compare(std::move(trials), std::move(contenders), comparison, OrThrow(on_progress));
  });
  return result;
}

struct LabelledRecording {
  LabelRequest request;
  LabelReport report;
  std::set<std::string> opened = {};
};

LabelledRecording LabelPoints(const py::dict& options, const py::object& progress) {
  ConversionRequest asked = RequestOf(options);
  LabelRequest request;
  request.input = std::move(asked.input);
  request.converter = std::move(asked.converter);
  request.hints = std::move(asked.label_hints);
  return InBackground(progress, [&](const Progress& on_progress) {
    return LabelledRecording{request, RunLabelling(request, on_progress)};
  });
}

void SaveLabelled(LabelledRecording* labelled, const std::string& file) {
  const py::gil_scoped_release release;
  CheckLabelledOutput(file, labelled->request.hints.has_others());
  CheckKeepsRecording(file, labelled->report.input.recording);
  OutputPlan plan;
  NameInputs(labelled->request.input, &plan);
  plan.Read(labelled->opened);
  for (const std::string& hint : FilesOf(labelled->request.hints)) plan.Read(hint);
  plan.Rewrite(file, labelled->request.input.file);
  plan.Check();
  labelled->report.output = file;
  WriteLabelled(labelled->report);
}

ReadRecordingResult RecordingOf(const LabelledRecording& labelled) {
  auto recording = std::make_shared<Recording>(labelled.report.input.recording);
  recording->markers = Relabelled(labelled.report.found.points, recording->markers);
  const std::string path = std::filesystem::absolute(recording->file).string();
  return {std::move(recording), labelled.report.warnings, path};
}

struct CheckedDynamics {
  InputRequest request;
  DynamicsReport report;
  std::set<std::string> opened = {};
};

MmmMotion MotionOf(const py::dict& arrays) {
  MmmMotion motion;
  motion.name = arrays["name"].cast<std::string>();
  motion.model_path = arrays["model"].cast<std::string>();
  motion.size.height = arrays["height"].cast<std::optional<double>>();
  motion.size.mass = arrays["mass"].cast<std::optional<double>>();
  motion.size.hand_length = arrays["hand_length"].cast<std::optional<double>>();
  motion.trajectory = TrajectoryOf(
      arrays["root_positions"].cast<Numbers>(), arrays["root_quaternions"].cast<Numbers>(),
      arrays["joints"].cast<Numbers>(), arrays["joint_names"].cast<std::vector<std::string>>());
  motion.trajectory.rate = arrays["rate"].cast<double>();
  motion.trajectory.first_time = arrays["first_time"].cast<double>();
  if (!IsFrameRate(motion.trajectory.rate)) {
    throw Error("rate: must be from 1 to 100000 frames a second");
  }
  return motion;
}

// motion: a dictionary of arrays, a conversion, or None: of the options' file.
CheckedDynamics CheckMotion(const py::object& motion, const py::dict& options,
                            const py::object& progress) {
  const InputRequest request = RequestOf(options).input;
  DynamicsOptions dynamics;
  ReadKeywords(options, Options(&dynamics));
  std::optional<MmmMotion> arrays;
  if (py::isinstance<py::dict>(motion)) arrays = MotionOf(motion);
  const auto* conversion =
      py::isinstance<Conversion>(motion) ? motion.cast<const Conversion*>() : nullptr;
  return InBackground(progress, [&](const Progress& on_progress) {
    CheckedMotion checked = conversion != nullptr ? CheckedMotionOf(conversion->report, request)
                            : arrays              ? CheckedMotionOf(*std::move(arrays), request)
                                                  : ReadCheckedMotion(request);
    return CheckedDynamics{request,
                           CheckDynamics(std::move(checked), dynamics, OrThrow(on_progress))};
  });
}

struct Learning {
  LearnRequest request;
  LearnReport report;
  std::set<std::string> opened = {};
};

Learning Learn(const py::list& inputs, const py::dict& options, const py::object& progress) {
  LearnRequest request;
  request.inputs = InputRequestsOf(inputs);
  if (request.inputs.empty()) throw Error("learn_markers: which recordings?");
  request.converter = RequestOf(options).converter;
  request.name = TextOf(options, "name");
  return InBackground(progress, [&](const Progress& on_progress) {
    return Learning{request, RunLearning(request, OrThrow(on_progress))};
  });
}

void SaveMarkerSet(Learning* learning, const std::string& file) {
  LearnReport& report = learning->report;
  if (learning->request.name.empty()) report.name = std::filesystem::path(file).stem().string();
  Write(learning->request.inputs, learning->opened, file, Whole(FormatLearnedSet(report)));
  report.output = file;
}

struct RetargetedMotion {
  RetargetRequest request;
  RetargetReport report;
  std::set<std::string> opened = {};
};

// motion: as of CheckMotion.
RetargetedMotion Retarget(const py::object& motion, const py::dict& options, const std::string& map,
                          std::optional<double> sole_height, const py::object& progress) {
  RetargetRequest request;
  request.conversion = RequestOf(options);
  RobotRequest& robot = request.conversion.robot;
  robot.file = TextOf(options, "robot");
  robot.map_file = map;
  robot.sole_height = sole_height;
  robot.hold = TextOf(options, "hold");
  robot.weights = TextOf(options, "weights");
  robot.sole = TextOf(options, "sole");
  if (options.contains("objects")) {
    robot.objects = options["objects"].cast<std::vector<std::string>>();
  }
  if (py::isinstance<py::dict>(motion)) request.motion = MotionOf(motion);
  if (py::isinstance<Conversion>(motion)) {
    request.converted = &motion.cast<const Conversion&>().report;
  }
  return InBackground(progress, [&](const Progress& on_progress) {
    RetargetedMotion result{request, RunRetargeting(request, on_progress)};
    result.request.motion.reset();
    result.request.converted = nullptr;
    return result;
  });
}

// None of them may be one of the inputs.
void CheckOutputs(const RetargetedMotion& motion, const std::vector<std::string>& files) {
  OutputPlan plan;
  NameInputs(motion.request, &plan);
  plan.Read(motion.opened);
  for (const std::string& file : files) plan.Write(file);
  plan.Check();
}

void SaveRobotMotion(RetargetedMotion* motion, const std::string& file) {
  const py::gil_scoped_release release;
  CheckOutputs(*motion, {file});
  motion->report.output = file;
  WriteRobotMotion(&motion->report);
}

void ExportRobot(RetargetedMotion* motion, const std::string& format, const std::string& file,
                 std::optional<double> rate, const std::optional<std::string>& order) {
  const py::gil_scoped_release release;
  RobotExportOptions options;
  options.rate = rate;
  options.motion_name = motion->report.motion_name;
  if (order) options.order = ParseRobotOrder(*order);
  const RobotExporter& exporter = FindRobotExporter(format);
  CheckOutputs(*motion, FilesOf(exporter, file));
  ExportRobotMotion(exporter, file, options, &motion->report);
}

void WriteRobotPage(const RetargetedMotion& motion, const std::string& file) {
  const py::gil_scoped_release release;
  CheckOutputs(motion, {file});
  WriteFileAtomically(file, FormatRetargetPage(motion.report));
}

}  // namespace

void BindStudies(py::module_* module) {
  py::class_<Calibration>(*module, "Calibration")
      .def_property_readonly(
          "summary", [](const Calibration& c) { return PythonOf(ToJson(c.report(), c.output)); })
      .def_property_readonly(
          "text",
          [](const Calibration& c) { return FormatCalibrationSummary(c.report(), c.output); })
      .def_property_readonly("verdict",
                             [](const Calibration& c) { return Name(c.report().verdict.level); })
      .def_property_readonly("warnings",
                             [](const Calibration& c) { return c.report().warnings.texts(); })
      .def("save", &SaveSubjectOf)
      .def("save_model", &SaveModelOf);
  py::class_<Comparing>(*module, "Comparison")
      .def_property_readonly("summary",
                             [](const Comparing& c) { return PythonOf(ToJson(c.comparison)); })
      .def_property_readonly("text",
                             [](const Comparing& c) { return FormatComparisonTable(c.comparison); })
      .def("report", [](const Comparing& c, const std::string& file) {
        Write(c.inputs, c.opened, file,
              Whole(FormatReport("Comparison", {{"Comparison", "", &c.comparison}})));
      });
  py::class_<LabelledRecording>(*module, "LabelledRecording")
      .def_property_readonly("summary",
                             [](const LabelledRecording& l) { return PythonOf(ToJson(l.report)); })
      .def_property_readonly(
          "text", [](const LabelledRecording& l) { return FormatLabelSummary(l.report); })
      .def_property_readonly("warnings",
                             [](const LabelledRecording& l) { return l.report.warnings.texts(); })
      .def_property_readonly("recording", &RecordingOf)
      .def("save", &SaveLabelled)
      .def("report", [](const LabelledRecording& l, const std::string& file) {
        Write({l.request.input}, l.opened, file, Whole(FormatLabelPage(l.report)));
      });
  py::class_<CheckedDynamics>(*module, "Dynamics")
      .def_property_readonly("summary",
                             [](const CheckedDynamics& d) { return PythonOf(ToJson(d.report)); })
      .def_property_readonly(
          "text", [](const CheckedDynamics& d) { return FormatDynamicsSummary(d.report); })
      .def_property_readonly(
          "judgement",
          [](const CheckedDynamics& d) { return Name(d.report.plausibility.judgement); })
      .def_property_readonly(
          "warnings", [](const CheckedDynamics& d) { return d.report.motion.warnings.texts(); })
      .def("report", [](const CheckedDynamics& d, const std::string& file) {
        const std::string title = std::filesystem::path(d.report.motion.file).filename().string();
        Write({d.request}, d.opened, file, Whole(FormatDynamicsPage(title, d.report)));
      });
  py::class_<Learning>(*module, "LearnedMarkers")
      .def_property_readonly("summary",
                             [](const Learning& l) { return PythonOf(ToJson(l.report)); })
      .def_property_readonly("text", [](const Learning& l) { return FormatLearnSummary(l.report); })
      .def_property_readonly("warnings",
                             [](const Learning& l) { return l.report.warnings.texts(); })
      .def("save", &SaveMarkerSet);
  py::class_<RetargetedMotion>(*module, "Retargeted")
      .def_property_readonly("summary",
                             [](const RetargetedMotion& r) { return PythonOf(ToJson(r.report)); })
      .def_property_readonly(
          "text", [](const RetargetedMotion& r) { return FormatRetargetSummary(r.report); })
      .def_property_readonly("verdict",
                             [](const RetargetedMotion& r) { return Name(r.report.verdict.level); })
      .def_property_readonly("warnings",
                             [](const RetargetedMotion& r) { return r.report.warnings.texts(); })
      .def_property_readonly(
          "rate", [](const RetargetedMotion& r) { return r.report.retargeted.motion.rate; })
      .def_property_readonly(
          "first_time",
          [](const RetargetedMotion& r) { return r.report.retargeted.motion.first_time; })
      .def_property_readonly(
          "joint_names",
          [](const RetargetedMotion& r) { return r.report.retargeted.motion.joint_names; })
      .def_property_readonly("arrays",
                             [](const RetargetedMotion& r) {
                               const PoseTrajectory& motion = r.report.retargeted.motion;
                               return PostureArrays(motion.postures,
                                                    static_cast<int>(motion.joint_names.size()));
                             })
      .def("save", &SaveRobotMotion)
      .def("export", &ExportRobot)
      .def("report", &WriteRobotPage);
  module->def("retarget", &Retarget);
  module->def("calibrate", &Calibrate);
  module->def("learn_markers", &Learn);
  module->def("compare", &CompareAll);
  module->def("label", &LabelPoints);
  module->def("check_dynamics", &CheckMotion);
}

}  // namespace mmm_converter::python
