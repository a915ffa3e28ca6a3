// SPDX-License-Identifier: MIT
// Models, forward kinematics, and tracking frame by frame.
#include <pybind11/stl.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "MMMConverterS2KF/python/arrays.h"
#include "MMMConverterS2KF/python/estimates.h"
#include "MMMConverterS2KF/python/forward.h"
#include "MMMConverterS2KF/python/module.h"
#include "MMMConverterS2KF/python/requests.h"
#include "MMMConverterS2KF/report/subject_json.h"
#include "common/convert/motion_converter.h"
#include "common/convert/tracked_joints.h"
#include "common/io/mmm/subject_file.h"
#include "common/pipeline/input/matched_labels.h"
#include "common/support/error.h"

namespace mmm_converter::python {

namespace py = pybind11;

namespace {

PersonModel ReadPersonModel(const py::dict& options) {
  const InputRequest request = RequestOf(options).input;
  const py::gil_scoped_release release;
  Warnings warnings;
  Input input = ReadModel(request, {}, &warnings);
  ConverterConfig config;
  MatchModel(request, &input, &config);
  PersonModel result = {input.model_file, input.model, {}, input.reference};
  if (!IsGiven(request.person)) return result;
  const Person person = FindKnownPerson(request.person, *input.reference, config, &warnings);
  result.scaling = ScalingOf(person, config);
  result.model =
      std::make_shared<const KinematicModel>(ScaleModel(*input.reference, result.scaling));
  return result;
}

std::vector<int> JointIndices(const KinematicModel& model, const std::vector<std::string>& names) {
  std::vector<int> indices;
  indices.reserve(names.size());
  for (const std::string& name : names) {
    indices.push_back(model.FindJoint(name));
    if (indices.back() < 0) {
      throw Error("the model " + model.name() + " has no joint \"" + name + "\"");
    }
  }
  return indices;
}

// The model's joints of these names. @throws Error where the arrays are not postures.
std::vector<int> CheckPostures(const KinematicModel& model, const Numbers& positions,
                               const Numbers& quaternions, const Numbers& angles,
                               const std::vector<std::string>& names) {
  std::vector<int> joints = JointIndices(model, names);
  CheckShape(positions, {-1, 3}, "root_positions");
  const py::ssize_t frames = positions.shape(0);
  CheckShape(quaternions, {frames, 4}, "root_quaternions");
  CheckShape(angles, {frames, static_cast<py::ssize_t>(joints.size())}, "joints");
  return joints;
}

// (frames, segments, 3), (frames, segments, 3, 3), (frames, markers, 3).
py::tuple Forward(const PersonModel& person, const Numbers& positions, const Numbers& quaternions,
                  const Numbers& angles, const std::vector<std::string>& names) {
  const KinematicModel& model = *person.model;
  const std::vector<int> joints = CheckPostures(model, positions, quaternions, angles, names);
  const py::ssize_t frames = positions.shape(0);
  const auto segments = static_cast<py::ssize_t>(model.segments().size());
  const auto markers = static_cast<py::ssize_t>(model.markers().size());
  py::array_t<double> p_WS({frames, segments, py::ssize_t{3}});
  py::array_t<double> R_WS({frames, segments, py::ssize_t{3}, py::ssize_t{3}});
  py::array_t<double> p_WM({frames, markers, py::ssize_t{3}});
  const ForwardArrays arrays = {positions.data(),    quaternions.data(),  angles.data(),
                                p_WS.mutable_data(), R_WS.mutable_data(), p_WM.mutable_data()};
  {
    const py::gil_scoped_release release;
    ComputeForward(model, joints, frames, arrays);
  }
  return py::make_tuple(p_WS, R_WS, p_WM);
}

// (frames, markers, 3).
py::array_t<double> MarkerPlaces(const PersonModel& person, const Numbers& positions,
                                 const Numbers& quaternions, const Numbers& angles,
                                 const std::vector<std::string>& names) {
  const std::vector<int> joints =
      CheckPostures(*person.model, positions, quaternions, angles, names);
  const py::ssize_t frames = positions.shape(0);
  const auto markers = static_cast<py::ssize_t>(person.model->markers().size());
  py::array_t<double> p_WM({frames, markers, py::ssize_t{3}});
  const ForwardArrays arrays = {positions.data(), quaternions.data(), angles.data(), nullptr,
                                nullptr,          p_WM.mutable_data()};
  const py::gil_scoped_release release;
  ComputeMarkerPlaces(*person.model, joints, frames, arrays);
  return p_WM;
}

// As AnglesOf. deviations: (frames, 6 + joints), or None.
py::tuple Angles(const PersonModel& person, const Numbers& positions, const Numbers& quaternions,
                 const Numbers& angles, const std::vector<std::string>& names,
                 const py::object& deviations) {
  CheckPostures(*person.model, positions, quaternions, angles, names);
  PoseTrajectory motion = TrajectoryOf(positions, quaternions, angles, names);
  if (!deviations.is_none()) {
    const auto sd = deviations.cast<Numbers>();
    const auto size = static_cast<py::ssize_t>(6 + names.size());
    CheckShape(sd, {positions.shape(0), size}, "sd");
    motion.standard_deviations =
        Eigen::Map<const Eigen::MatrixXd>(sd.data(), size, positions.shape(0));
  }
  return AnglesOf(*person.model, motion);
}

/// A converter that is fed frame by frame.
class Tracker {
 public:
  Tracker(const PersonModel& person, const std::vector<std::string>& labels,
          const ConverterRequest& request, const std::string& marker_set) {
    Warnings warnings;
    choice_ = ChooseConverter(request, &warnings);
    Input input;
    input.model_file = person.file;
    input.model = person.loaded;
    input.reference = std::shared_ptr<const KinematicModel>(person.loaded, &person.loaded->model);
    InputRequest input_request;
    input_request.marker_set = marker_set;
    MatchModel(input_request, &input, &choice_.config);
    const bool is_scaled = person.scaling.size.has_value();
    if (!is_scaled) choice_.config.model_processor = "None";
    TrackingSetup setup = MatchLabels({labels}, &input, choice_.config, &warnings);
    WarnOfFreeJoints(setup, choice_.config, &warnings);
    if (is_scaled) ScaleToPerson(person.scaling, &setup);
    joint_names_ = TrackedJoints(setup);
    marker_labels_ = UsedLabels(setup, labels);
    converter_ = choice_.plugin->factory().Create(setup, choice_.config);
    num_labels_ = static_cast<py::ssize_t>(labels.size());
    warnings_ = warnings.texts();
  }

  py::dict Assemble(const Numbers& frame) {
    return Estimate(frame, [this](const auto& points) -> const FrameEstimate& {
      return converter_->Assemble(points);
    });
  }

  py::dict Track(const Numbers& frame, double dt) {
    if (!(dt > 0 && dt < 1e6)) throw Error("dt: must be seconds greater than 0");
    if (!is_assembled_) throw Error("assemble() a first frame, then track() the others");
    return Estimate(frame, [this, dt](const auto& points) -> const FrameEstimate& {
      return converter_->Track(points, dt);
    });
  }

  const std::vector<std::string>& joint_names() const { return joint_names_; }
  const std::vector<std::string>& marker_labels() const { return marker_labels_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  template <typename Work>
  py::dict Estimate(const Numbers& frame, const Work& work) {
    CheckShape(frame, {num_labels_, 3}, "frame");
    const Eigen::Map<const Eigen::Matrix3Xd> points(frame.data(), 3, num_labels_);
    const FrameEstimate* estimate = nullptr;
    {
      const py::gil_scoped_release release;
      estimate = &work(points);
    }
    is_assembled_ = true;
    return EstimateDict(converter_->setup(), *estimate);
  }

  ConverterChoice choice_;  // its plugin outlives the converter
  std::unique_ptr<MotionConverter> converter_;
  std::vector<std::string> joint_names_, marker_labels_, warnings_;
  py::ssize_t num_labels_ = 0;
  bool is_assembled_ = false;
};

std::vector<std::string> JointNames(const KinematicModel& model) {
  std::vector<std::string> names;
  names.reserve(model.num_joints());
  for (int j = 0; j < model.num_joints(); ++j) names.push_back(model.joint(j).name);
  return names;
}

py::array_t<double> Limits(const KinematicModel& model) {
  py::array_t<double> limits({py::ssize_t{model.num_joints()}, py::ssize_t{2}});
  double* out = limits.mutable_data();
  for (int j = 0; j < model.num_joints(); ++j) {
    *out++ = model.joint(j).lower;
    *out++ = model.joint(j).upper;
  }
  return limits;
}

template <typename Items>
std::vector<std::string> Names(const Items& items) {
  std::vector<std::string> names;
  names.reserve(items.size());
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

std::vector<int> Parents(const PersonModel& person) {
  std::vector<int> parents;
  parents.reserve(person.model->segments().size());
  for (const Segment& segment : person.model->segments()) parents.push_back(segment.parent);
  return parents;
}

py::object ReadSubjectFile(const std::string& file, const PersonModel& person) {
  return PythonOf(ToJson(ReadSubject(file, person.loaded->model)));
}

}  // namespace

void BindModels(py::module_* module) {
  py::class_<PersonModel>(*module, "Model")
      .def_readonly("file", &PersonModel::file)
      .def_property_readonly("name", [](const PersonModel& p) { return p.model->name(); })
      .def_property_readonly("segments",
                             [](const PersonModel& p) { return Names(p.model->segments()); })
      .def_property_readonly("parents", &Parents)
      .def_property_readonly("markers",
                             [](const PersonModel& p) { return Names(p.model->markers()); })
      .def_property_readonly("joint_names",
                             [](const PersonModel& p) { return JointNames(*p.model); })
      .def_property_readonly("limits", [](const PersonModel& p) { return Limits(*p.model); })
      .def_property_readonly("mass", [](const PersonModel& p) { return p.model->total_mass(); })
      .def_property_readonly("height",
                             [](const PersonModel& p) {
                               return p.scaling.size ? std::optional(p.scaling.size->height)
                                                     : std::nullopt;
                             })
      .def("forward", &Forward)
      .def("place_markers", &MarkerPlaces)
      .def("angles", &Angles);
  py::class_<Tracker>(*module, "Tracker")
      .def(py::init([](const PersonModel& person, const std::vector<std::string>& labels,
                       const py::dict& options) {
        return std::make_unique<Tracker>(person, labels, RequestOf(options).converter,
                                         TextOf(options, "marker_set"));
      }))
      .def_property_readonly("joint_names", &Tracker::joint_names)
      .def_property_readonly("marker_labels", &Tracker::marker_labels)
      .def_property_readonly("warnings", &Tracker::warnings)
      .def("assemble", &Tracker::Assemble)
      .def("track", &Tracker::Track);
  module->def("read_model", &ReadPersonModel);
  module->def("read_subject", &ReadSubjectFile);
}

}  // namespace mmm_converter::python
