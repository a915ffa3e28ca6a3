// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "MMMConverterS2KF/python/arrays.h"
#include "MMMConverterS2KF/python/module.h"
#include "MMMConverterS2KF/python/requests.h"
#include "common/forces/recording_forces.h"
#include "common/io/c3d/c3d_analog.h"
#include "common/io/c3d/c3d_events.h"
#include "common/io/c3d/c3d_writer.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/marker_recording.h"
#include "common/io/recording/recording_axes.h"
#include "common/io/tables/trc_writer.h"
#include "common/support/atomic_file.h"

namespace mmm_converter::python {

namespace py = pybind11;

namespace {

constexpr const char* kC3d = "C3D";

// The markers as they lie in the recording, (frames, labels, 3); `owner` keeps them.
py::array MarkersOf(const MarkerSequence& markers, const py::handle& owner) {
  const auto frames = static_cast<py::ssize_t>(markers.num_frames());
  const auto labels = static_cast<py::ssize_t>(markers.num_labels());
  if (frames * labels == 0) return py::array_t<double>({frames, labels, py::ssize_t{3}});
  py::array_t<double> view({frames, labels, py::ssize_t{3}}, markers.frame(0).data(), owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

ReadRecordingResult Read(const py::dict& options) {
  const InputRequest request = RequestOf(options).input;
  ReadRecordingOptions reading = request.reading;
  reading.with_unlabelled = IsSet(options, "with_unlabelled");
  const py::gil_scoped_release release;
  ReadRecordingResult result;
  result.recording =
      std::make_shared<Recording>(ReadRecording(request.file, reading, &result.warnings));
  result.path = std::filesystem::absolute(request.file).string();
  return result;
}

ReadRecordingResult FromArrays(const std::vector<std::string>& labels, const Numbers& positions,
                               double rate, double first_time, const std::string& name) {
  const auto count = static_cast<py::ssize_t>(labels.size());
  CheckShape(positions, {-1, count, 3}, "markers");
  CheckFrameRate(rate);
  MarkerSequence markers(labels, static_cast<int>(positions.shape(0)), rate, first_time);
  if (positions.size() > 0) {
    std::copy(positions.data(), positions.data() + positions.size(), markers.frame(0).data());
  }
  return {std::make_shared<Recording>(MakeRecording(std::move(markers), name)), {}, ""};
}

py::list EventsOf(const ReadRecordingResult& read) {
  py::list events;
  if (read.recording->format != kC3d) return events;
  const C3dFile file(read.path);
  for (const C3dEvent& event : ReadC3dEvents(file, nullptr)) {
    py::dict one;
    one["time"] = event.time;
    one["label"] = event.label;
    one["context"] = event.context;
    one["subject"] = event.subject;
    events.append(one);
  }
  return events;
}

// A row for each moment.
py::array_t<double> SamplesOf(C3dFile* file, const C3dAnalog& analog) {
  Eigen::MatrixXd samples;
  {
    const py::gil_scoped_release release;
    samples = ReadC3dAnalogSamples(file, analog);
  }
  py::array_t<double> rows({samples.cols(), samples.rows()});
  std::copy(samples.data(), samples.data() + samples.size(), rows.mutable_data());
  return rows;
}

py::dict AnalogOf(const ReadRecordingResult& read) {
  py::dict result;
  if (read.recording->format != kC3d) return result;
  C3dFile file(read.path);
  const C3dAnalog analog = ReadC3dAnalog(file, nullptr);
  py::list labels;
  py::list units;
  for (const C3dAnalogChannel& channel : analog.channels) {
    labels.append(channel.label);
    units.append(channel.unit);
  }
  result["rate"] = analog.rate;
  result["labels"] = labels;
  result["units"] = units;
  result["samples"] = SamplesOf(&file, analog);
  return result;
}

// Corners in metres, where the recording's markers are; channels counted from 0.
py::list ForcePlatesOf(const ReadRecordingResult& read) {
  py::list plates;
  if (read.recording->format != kC3d) return plates;
  const double metres = ParseUnit(read.recording->unit).metres;
  const Eigen::Matrix3d R = RotationToZUp(read.recording->up_axis);
  const C3dFile file(read.path);
  for (const C3dForcePlate& plate : ReadC3dForcePlates(file.parameters(), nullptr)) {
    py::dict one;
    one["type"] = plate.type;
    py::array_t<int> channels(static_cast<py::ssize_t>(plate.channels.size()));
    std::transform(plate.channels.begin(), plate.channels.end(), channels.mutable_data(),
                   [](int channel) { return channel - 1; });
    one["channels"] = channels;
    one["corners"] = py::none();
    if (plate.corners) one["corners"] = RowsOfColumns(metres * (R * *plate.corners));
    one["origin"] = py::none();
    if (plate.origin) {
      const Eigen::Vector3d origin = metres * *plate.origin;
      one["origin"] = py::array_t<double>(3, origin.data());
    }
    plates.append(one);
  }
  return plates;
}

py::dict ForcesOfPlate(const RecordedForces& forces, const PlateForces& plate) {
  py::dict one;
  one["number"] = plate.plate.number;
  one["force"] = RowsOfColumns(plate.force);
  one["moment"] = RowsOfColumns(plate.moment);
  one["center"] = py::make_tuple(plate.plate.p_WP.x(), plate.plate.p_WP.y(), plate.plate.p_WP.z());
  one["center_of_pressure"] = RowsOfColumns(plate.cop);
  one["free_moment"] = RowsOfColumns(plate.free_moment);
  one["unloaded"] = plate.unloaded_level;
  one["tells_contact"] = plate.tells_contact;
  py::list loads;
  for (const LoadInterval& load : plate.loads) {
    loads.append(py::make_tuple(forces.time(load.begin), forces.time(load.end)));
  }
  one["loads"] = loads;
  return one;
}

// Nothing where the file holds no plates.
py::dict ForcesOfRecording(const ReadRecordingResult& read) {
  Recording recording;  // all but its frames
  recording.file = read.path;
  recording.format = read.recording->format;
  recording.unit = read.recording->unit;
  recording.up_axis = read.recording->up_axis;
  recording.first_frame = read.recording->first_frame;
  recording.markers = MarkerSequence({}, 0, read.recording->markers.rate(), 0);
  Warnings warnings;
  RecordedForces forces;
  {
    const py::gil_scoped_release release;
    forces = ForcesOf(recording, &warnings);
  }
  py::dict result;
  result["rate"] = forces.rate;
  result["first_time"] = forces.first_time;
  result["samples_per_frame"] = forces.samples_per_frame;
  py::list plates;
  for (const PlateForces& plate : forces.plates) plates.append(ForcesOfPlate(forces, plate));
  result["plates"] = plates;
  result["warnings"] = warnings.texts();
  return result;
}

py::dict MotionOf(const MmmMotion& motion) {
  const PoseTrajectory& trajectory = motion.trajectory;
  py::dict one;
  one["name"] = motion.name;
  one["type"] = motion.type;
  one["model"] = motion.model_path;
  one["height"] = motion.size.height;
  one["mass"] = motion.size.mass;
  one["hand_length"] = motion.size.hand_length;
  one["rate"] = trajectory.rate;
  one["first_time"] = trajectory.first_time;
  one["joint_names"] = trajectory.joint_names;
  const py::tuple postures =
      PostureArrays(trajectory.postures, static_cast<int>(trajectory.joint_names.size()));
  one["root_positions"] = postures[0];
  one["root_quaternions"] = postures[1];
  one["joints"] = postures[2];
  auto markers = std::make_shared<MarkerSequence>(motion.markers);
  const py::capsule owner(new std::shared_ptr<MarkerSequence>(markers), [](void* held) {
    delete static_cast<std::shared_ptr<MarkerSequence>*>(held);
  });
  one["labels"] = markers->labels();
  one["markers"] = MarkersOf(*markers, owner);
  return one;
}

py::list ReadMotions(const std::string& file) {
  MmmMotionFile content;
  {
    const py::gil_scoped_release release;
    content = ReadMmmMotionFile(file);
  }
  py::list motions;
  for (const MmmMotion& motion : content.motions) motions.append(MotionOf(motion));
  return motions;
}

}  // namespace

void BindRecordings(py::module_* module) {
  py::class_<ReadRecordingResult>(*module, "Recording")
      .def_property_readonly("file", [](const ReadRecordingResult& r) { return r.recording->file; })
      .def_property_readonly("format",
                             [](const ReadRecordingResult& r) { return r.recording->format; })
      .def_property_readonly(
          "labels", [](const ReadRecordingResult& r) { return r.recording->markers.labels(); })
      .def_property_readonly(
          "rate", [](const ReadRecordingResult& r) { return r.recording->markers.rate(); })
      .def_property_readonly(
          "first_time",
          [](const ReadRecordingResult& r) { return r.recording->markers.first_time(); })
      .def_property_readonly("unit", [](const ReadRecordingResult& r) { return r.recording->unit; })
      .def_property_readonly(
          "up_axis", [](const ReadRecordingResult& r) { return Name(r.recording->up_axis); })
      .def_property_readonly("subjects",
                             [](const ReadRecordingResult& r) { return r.recording->subjects; })
      .def_property_readonly("motion",
                             [](const ReadRecordingResult& r) { return r.recording->motion(); })
      .def_property_readonly(
          "height", [](const ReadRecordingResult& r) { return r.recording->size().height; })
      .def_property_readonly("mass",
                             [](const ReadRecordingResult& r) { return r.recording->size().mass; })
      .def_property_readonly("warnings",
                             [](const ReadRecordingResult& r) { return r.warnings.texts(); })
      .def_property_readonly("markers",
                             [](const py::object& self) {
                               const auto& r = self.cast<const ReadRecordingResult&>();
                               return MarkersOf(r.recording->markers, self);
                             })
      .def_property_readonly("events", &EventsOf)
      .def_property_readonly("analog", &AnalogOf)
      .def_property_readonly("force_plates", &ForcePlatesOf)
      .def_property_readonly("forces", &ForcesOfRecording)
      .def("save_c3d",
           [](const ReadRecordingResult& r, const std::string& file) {
             const py::gil_scoped_release release;
             WriteC3d(file, r.recording->markers);
           })
      .def("save_trc", [](const ReadRecordingResult& r, const std::string& file) {
        const py::gil_scoped_release release;
        TrcOutput output;
        output.file_name = std::filesystem::path(file).filename().string();
        output.first_frame = r.recording->first_frame;
        output.measured = &r.recording->markers;
        WriteFileAtomically(file, FormatTrc(output));
      });
  module->def("read", &Read);
  module->def("from_arrays", &FromArrays);
  module->def("read_motions", &ReadMotions);
}

}  // namespace mmm_converter::python
