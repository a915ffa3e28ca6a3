// SPDX-License-Identifier: MIT
// Models, forward kinematics, and tracking frame by frame.
#include <pybind11/stl.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>
#include <vector>

#include "MMMConverterS2KF/python/arrays.h"
#include "MMMConverterS2KF/python/estimates.h"
#include "MMMConverterS2KF/python/module.h"
#include "MMMConverterS2KF/python/requests.h"
#include "MMMConverterS2KF/report/subject_json.h"
#include "common/convert/motion_converter.h"
#include "common/convert/tracked_joints.h"
#include "common/io/mmm/subject_file.h"
#include "common/model/kinematic_model.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"
#include "common/pipeline/input/matched_labels.h"
#include "common/support/error.h"

namespace mmm_converter::python {

namespace py = pybind11;

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Postures and what is computed of them, arrays in C order with frames first.
struct ForwardArrays {
  const double* positions;    ///< frames x 3, of the root [m]
  const double* quaternions;  ///< frames x 4, w, x, y, z
  const double* angles;       ///< frames x joints [rad]
  double* p_WS;               ///< frames x segments x 3 [m]
  double* R_WS;               ///< frames x segments x 3 x 3
  double* p_WM;               ///< frames x markers x 3 [m]
};

// The segments of one posture. What is the identity is left out, which changes no bit of a product.
class SegmentChain {
 public:
  explicit SegmentChain(const KinematicModel& model)
      : model_(model), p_(model.segments().size()), R_(model.segments().size()) {
    is_turned_.reserve(p_.size());
    for (const Segment& segment : model.segments()) {
      is_turned_.push_back(segment.X_PF.linear() != Matrix3d::Identity());
    }
  }

  void Compute(const Posture& posture) {
    p_[0] = posture.position;
    R_[0] = posture.orientation.toRotationMatrix();
    for (std::size_t i = 1; i < p_.size(); ++i) {
      const Segment& segment = model_.segments()[i];
      const Matrix3d& R_WP = R_[segment.parent];
      p_[i] = R_WP * segment.X_PF.translation() + p_[segment.parent];
      R_[i] = is_turned_[i] ? Matrix3d(R_WP * segment.X_PF.linear()) : R_WP;
      if (segment.joint < 0) continue;
      const double value = JointValue(segment, posture.joint_angles[segment.joint]);
      if (value == 0) continue;
      if (segment.type == JointType::kSliding) {
        p_[i] += R_[i] * (value * segment.axis);
        continue;
      }
      const Eigen::AngleAxisd turn(value, segment.axis);
      R_[i] = R_[i] * turn.toRotationMatrix();
    }
  }

  void Store(double* p_WS, double* R_WS) const {
    for (std::size_t i = 0; i < p_.size(); ++i) {
      Eigen::Map<Vector3d>(p_WS + 3 * i) = p_[i];
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R_WS + 9 * i) = R_[i];
    }
  }

  Vector3d PlaceOf(const ModelMarker& marker) const {
    return R_[marker.segment] * marker.p_SM + p_[marker.segment];
  }

 private:
  const KinematicModel& model_;
  std::vector<Vector3d> p_;
  std::vector<Matrix3d> R_;
  std::vector<bool> is_turned_;
};

// Fills a batch with the postures [begin, begin + samples).
void FillBatch(const KinematicModel& model, const std::vector<int>& joints,
               const ForwardArrays& arrays, std::ptrdiff_t begin, int samples, MarkerBatch* batch) {
  const Posture rest = ZeroPosture(model);
  const auto count = static_cast<std::ptrdiff_t>(joints.size());
  for (int j = 0; j < model.num_joints(); ++j) {
    std::fill_n(batch->angles.col(j), samples, rest.joint_angles[j]);
  }
  for (int i = 0; i < samples; ++i) {
    const std::ptrdiff_t k = begin + i;
    const double* q = arrays.quaternions + 4 * k;
    const Eigen::Matrix3d R = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    for (int e = 0; e < 9; ++e) batch->rotation.col(e)[i] = R(e / 3, e % 3);
    for (int e = 0; e < 3; ++e) batch->position.col(e)[i] = arrays.positions[3 * k + e];
    for (std::ptrdiff_t j = 0; j < count; ++j) {
      batch->angles.col(joints[j])[i] = arrays.angles[count * k + j];
    }
  }
}

/// Poses of all segments and places of all markers, to the bit those of SegmentPoses. joints: the
/// model's, of the columns of angles; others are as in ZeroPosture.
void ComputeForward(const KinematicModel& model, const std::vector<int>& joints,
                    std::ptrdiff_t frames, const ForwardArrays& arrays) {
  const std::size_t segments = model.segments().size();
  const double* angles = arrays.angles;
  double* p_WM = arrays.p_WM;
  Posture posture = ZeroPosture(model);
  SegmentChain chain(model);
  for (std::ptrdiff_t k = 0; k < frames; ++k) {
    posture.position = Eigen::Map<const Vector3d>(arrays.positions + 3 * k);
    const double* q = arrays.quaternions + 4 * k;
    posture.orientation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    for (const int joint : joints) posture.joint_angles[joint] = *angles++;
    chain.Compute(posture);
    chain.Store(arrays.p_WS + 3 * segments * k, arrays.R_WS + 9 * segments * k);
    for (const ModelMarker& marker : model.markers()) {
      Eigen::Map<Vector3d>{p_WM} = chain.PlaceOf(marker);
      p_WM += 3;
    }
  }
}

/// Places of all markers alone; p_WS and R_WS are not used.
void ComputeMarkerPlaces(const KinematicModel& model, const std::vector<int>& joints,
                         std::ptrdiff_t frames, const ForwardArrays& arrays) {
  constexpr std::ptrdiff_t kSamples = 256;  // what stays in the cache
  std::vector<int> all(model.num_joints());
  std::iota(all.begin(), all.end(), 0);
  std::vector<MarkerIx> markers;
  markers.reserve(model.markers().size());
  for (std::size_t i = 0; i < model.markers().size(); ++i) {
    markers.emplace_back(static_cast<int>(i));
  }
  const MarkerKinematics kinematics(model, all, markers, std::vector<int>());
  MarkerBatch batch = kinematics.MakeBatch(kSamples);
  const int columns = 3 * kinematics.num_markers();
  for (std::ptrdiff_t begin = 0; begin < frames; begin += kSamples) {
    const int samples = static_cast<int>(std::min(kSamples, frames - begin));
    FillBatch(model, joints, arrays, begin, samples, &batch);
    kinematics.ComputeBatch(&batch);
    Eigen::Map<Eigen::MatrixXd>(arrays.p_WM + columns * begin, columns, samples) =
        batch.markers.view().topLeftCorner(samples, columns).transpose();
  }
}

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
