// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/python/arrays.h"
#include "MMMConverterS2KF/python/background.h"
#include "MMMConverterS2KF/python/module.h"
#include "MMMConverterS2KF/python/requests.h"
#include "MMMConverterS2KF/report/conversion_page.h"
#include "MMMConverterS2KF/report/conversion_summary.h"
#include "common/angles/gait_table.h"
#include "common/contacts/contact_table.h"
#include "common/convert/marker_incidents.h"
#include "common/convert/tracked_joints.h"
#include "common/motion/anatomical_angles.h"
#include "common/pipeline/ground_study.h"

namespace mmm_converter::python {

namespace py = pybind11;

namespace {

Conversion Convert(const py::dict& options, const py::object& progress) {
  const ConversionRequest request = RequestOf(options);
  return InBackground(progress, [&](const Progress& on_progress) {
    return FinishConversion(request, on_progress);
  });
}

void Save(Conversion* conversion, const std::string& file) {
  const py::gil_scoped_release release;
  SaveMotion(file, conversion);
}

void Export(Conversion* conversion, const std::string& name, const std::string& file) {
  const py::gil_scoped_release release;
  SaveExport(name, file, conversion);
}

void WritePage(const Conversion& conversion, const std::string& file) {
  const py::gil_scoped_release release;
  SaveText(conversion, file, Whole(FormatConversionPage({&conversion.report})));
}

py::array_t<double> TimesOf(const PoseTrajectory& trajectory) {
  py::array_t<double> times(trajectory.num_frames());
  for (int k = 0; k < trajectory.num_frames(); ++k) times.mutable_data()[k] = trajectory.time(k);
  return times;
}

// Frames and covariances (k, n, n); None where they were not asked for.
py::object CovariancesOf(const Conversion& conversion) {
  if (!conversion.report.plan.keeps_covariances) return py::none();
  const std::vector<PoseCovariance>& all = conversion.report.result.covariances;
  const auto count = static_cast<py::ssize_t>(all.size());
  const auto size = static_cast<py::ssize_t>(6 + conversion.trajectory().joint_names.size());
  py::array_t<int> frames(count);
  py::array_t<double> covariances({count, size, size});
  double* next = covariances.mutable_data();
  for (py::ssize_t i = 0; i < count; ++i) {
    const PoseCovariance& one = all[i];
    frames.mutable_data()[i] = one.frame;
    next = std::copy(one.covariance.data(), one.covariance.data() + one.covariance.size(), next);
  }
  return py::make_tuple(frames, covariances);
}

py::list IncidentsOf(const Conversion& conversion) {
  py::list incidents;
  for (const MarkerIncident& incident : conversion.report.result.incidents) {
    py::dict one;
    one["kind"] = Name(incident.kind);
    one["marker"] = LabelOf(conversion.report.plan, incident.assignment);
    one["other"] = incident.other < 0 ? py::object(py::none())
                                      : py::cast(LabelOf(conversion.report.plan, incident.other));
    one["first_frame"] = incident.first_frame;
    one["last_frame"] = incident.last_frame;
    incidents.append(one);
  }
  return incidents;
}

// An array for each figure of the frames.
py::dict FramesOf(const Conversion& conversion) {
  const std::vector<FrameDiagnostic>& frames = conversion.report.result.frames;
  const auto count = static_cast<py::ssize_t>(frames.size());
  py::array_t<int> seen(count);
  py::array_t<int> wrong(count);
  py::array_t<double> nis(count);
  py::array_t<bool> reassembled(count);
  py::array_t<bool> converged(count);
  for (py::ssize_t k = 0; k < count; ++k) {
    const FrameDiagnostic& frame = frames[static_cast<std::size_t>(k)];
    seen.mutable_data()[k] = frame.markers_seen;
    wrong.mutable_data()[k] = frame.markers_wrong;
    nis.mutable_data()[k] = frame.nis;
    reassembled.mutable_data()[k] = frame.reassembled;
    converged.mutable_data()[k] = frame.converged;
  }
  py::dict result;
  result["markers_seen"] = seen;
  result["markers_wrong"] = wrong;
  result["nis"] = nis;
  result["reassembled"] = reassembled;
  result["converged"] = converged;
  return result;
}

std::vector<std::string> MarkerLabelsOf(const Conversion& conversion) {
  const ConversionPlan& plan = conversion.report.plan;
  return UsedLabels(plan.setup, plan.input.recording.markers.labels());
}

// None: the model has no feet, or is no person's.
py::object GroundOf(const Conversion& conversion) {
  const ConversionReport& report = conversion.report;
  const KinematicModel& model = *report.plan.setup.model;
  if (report.plan.object || !HasFeet(model) || !HasAnatomy(model)) return py::none();
  const auto ground = StudyGround(report);
  const Gait gait = ground->gait ? *ground->gait : GaitOf(report, *ground);
  const std::string contacts =
      FormatContactsJson(SeenContacts(report, *ground), *ground->forces, ground->mass);
  return PythonOf(
      Json{{"contacts", ParseJson(contacts)}, {"gait", ParseJson(FormatGaitJson({{"", &gait}}))}});
}

PersonModel ModelOf(const Conversion& conversion) {
  const ConversionReport& report = conversion.report;
  return {report.plan.input.model_file, report.plan.input.model,
          ScalingOf(report.plan.person, report.plan.converter.config), report.plan.setup.model};
}

}  // namespace

void BindConversions(py::module_* module) {
  py::class_<Conversion>(*module, "Conversion")
      .def_property_readonly("rate", [](const Conversion& c) { return c.trajectory().rate; })
      .def_property_readonly("times", [](const Conversion& c) { return TimesOf(c.trajectory()); })
      .def_property_readonly("joint_names",
                             [](const Conversion& c) { return c.trajectory().joint_names; })
      .def_property_readonly("postures",
                             [](const Conversion& c) {
                               return PostureArrays(
                                   c.trajectory().postures,
                                   static_cast<int>(c.trajectory().joint_names.size()));
                             })
      .def_property_readonly(
          "sd",
          [](const Conversion& c) { return RowsOfColumns(c.trajectory().standard_deviations); })
      .def_property_readonly(
          "velocities",
          [](const Conversion& c) { return RowsOfColumns(c.trajectory().velocities); })
      .def_property_readonly(
          "accelerations",
          [](const Conversion& c) { return RowsOfColumns(c.trajectory().accelerations); })
      .def_property_readonly(
          "residuals", [](const Conversion& c) { return RowsOfColumns(c.report.result.residuals); })
      .def_property_readonly("covariances", &CovariancesOf)
      .def_property_readonly(
          "angles",
          [](const Conversion& c) { return AnglesOf(*c.report.plan.setup.model, c.trajectory()); })
      .def_property_readonly("marker_labels", &MarkerLabelsOf)
      .def_property_readonly("incidents", &IncidentsOf)
      .def_property_readonly("frames", &FramesOf)
      .def_property_readonly("model", &ModelOf)
      .def_property_readonly("ground", &GroundOf)
      .def_property_readonly("summary",
                             [](const Conversion& c) { return PythonOf(ToJson(c.report)); })
      .def_property_readonly("text", [](const Conversion& c) { return FormatSummary(c.report); })
      .def_property_readonly("verdict",
                             [](const Conversion& c) { return Name(c.report.verdict.level); })
      .def_property_readonly("reasons",
                             [](const Conversion& c) { return c.report.verdict.reasons; })
      .def_property_readonly("warnings",
                             [](const Conversion& c) { return c.report.warnings.texts(); })
      .def("save", &Save)
      .def("export", &Export)
      .def("report", &WritePage);
  module->def("convert", &Convert);
  module->def("exporters", [] {
    std::vector<std::pair<std::string, std::string>> names;
    for (const Exporter& one : Exporters()) names.emplace_back(one.name, one.ending);
    return names;
  });
}

}  // namespace mmm_converter::python
