// SPDX-License-Identifier: MIT
#include "common/pipeline/exporters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/angles/angle_table.h"
#include "common/io/tables/bvh_writer.h"
#include "common/io/tables/npz_writer.h"
#include "common/io/tables/osim_tables.h"
#include "common/io/tables/pose_table.h"
#include "common/io/tables/trajectory_csv.h"
#include "common/io/tables/trc_writer.h"
#include "common/motion/anatomical_angles.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/pose_trajectory.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/force_exports.h"
#include "common/pipeline/pose_output.h"
#include "common/retarget/keypoints.h"
#include "common/retarget/smpl_motion.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {
namespace {

/// Covariances as arrays of a .npz file, float64: names (n): root_x, root_y, root_z [m], in the
/// world; root_about_x, root_about_y, root_about_z, about the root's own axes, and the joints
/// [rad]; frame (k), from 0; time (k) [s]; covariance (k, n, n).
/// @throws Error where the file would have 4 GiB or more.
TextPieces FormatCovarianceNpz(const PoseTrajectory& trajectory,
                               const std::vector<PoseCovariance>& covariances) {
  std::vector<std::string> names = {"root_x",       "root_y",       "root_z",
                                    "root_about_x", "root_about_y", "root_about_z"};
  names.insert(names.end(), trajectory.joint_names.begin(), trajectory.joint_names.end());
  const auto k = static_cast<std::int64_t>(covariances.size());
  const auto n = static_cast<std::int64_t>(names.size());
  NpyArray frames = {"frame", {k}, {}, {}};
  NpyArray times = {"time", {k}, {}, {}};
  NpyArray values = {"covariance", {k, n, n}, {}, {}};
  values.numbers.reserve(k * n * n);
  for (const PoseCovariance& one : covariances) {
    frames.numbers.push_back(one.frame);
    times.numbers.push_back(trajectory.time(one.frame));
    const double* const numbers = one.covariance.data();
    values.numbers.insert(values.numbers.end(), numbers, numbers + one.covariance.size());
  }
  const auto arrays = std::make_shared<const std::vector<NpyArray>>(
      std::vector<NpyArray>{{"names", {n}, {}, std::move(names)},
                            std::move(frames),
                            std::move(times),
                            std::move(values)});
  const TextPieces file = FormatNpz(*arrays);
  return [arrays, file](const TextSink& sink) { file(sink); };
}

void WriteCsv(const std::string& file, const ConversionReport& report) {
  WriteFileAtomically(file, FormatTrajectoryCsv(report.result.trajectory));
}

void WriteAngles(const std::string& file, const ConversionReport& report) {
  const AnatomicalAngles angles =
      ComputeAnatomicalAngles(*report.plan.setup.model, report.result.trajectory);
  WriteFileAtomically(file, FormatAngleCsv(angles));
}

void WriteTrc(const std::string& file, const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  const Recording& recording = plan.input.recording;
  TrcOutput output;
  output.file_name = std::filesystem::path(file).filename().string();
  output.first_frame = recording.first_frame + plan.input.first_frame;
  output.measured = &recording.markers;
  output.model_markers.reserve(plan.setup.assignments().size());
  for (const MarkerAssignment& one : plan.setup.assignments()) {
    output.model_markers.push_back({one.label, one.marker});
  }
  output.model = plan.setup.model.get();
  output.trajectory = &report.result.trajectory;
  WriteFileAtomically(file, FormatTrc(output));
}

void WriteMot(const std::string& file, const ConversionReport& report) {
  const KinematicModel& model = *report.plan.setup.model;
  if (model.coordinates()) {
    WriteFileAtomically(file, FormatOsimMotion(model, report.result.trajectory));
    return;
  }
  WriteFileAtomically(file, FormatMot(report.result.trajectory, model.segments().front().name));
}

void WriteMarkerErrors(const std::string& file, const ConversionReport& report) {
  std::vector<std::string> names;
  for (const MarkerAssignment& one : report.plan.setup.assignments()) {
    names.push_back(report.plan.setup.model->markers()[one.marker].name);
  }
  WriteFileAtomically(
      file, FormatOsimMarkerErrors(names, report.result.residuals, report.result.trajectory));
}

/// All of its markers, which are a recording for other models.
void WriteModelMarkersAsRecording(const std::string& file, const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  constexpr MarkerErrors kNone{0, 0, 1, 0};
  const MarkerSequence markers =
      SynthesizeMarkers(*plan.setup.model, report.result.trajectory, kNone, 0);
  TrcOutput output;
  output.file_name = std::filesystem::path(file).filename().string();
  output.first_frame = plan.input.recording.first_frame + plan.input.first_frame;
  output.measured = &markers;
  WriteFileAtomically(file, FormatTrc(output));
}

void WriteModelMarkers(const std::string& file, const ConversionReport& report) {
  if (std::filesystem::path(file).extension() == ".trc") {
    WriteModelMarkersAsRecording(file, report);
    return;
  }
  const ConversionPlan& plan = report.plan;
  WriteFileAtomically(file, FormatOsimMarkers(*plan.setup.model, report.result.trajectory,
                                              MarkerIndices(plan.setup.assignments())));
}

void WritePoses(const std::string& file, const ConversionReport& report) {
  const KinematicModel& model = *report.plan.setup.model;
  const PoseChoice choice;
  BodySelection selection = SelectBodies(model, choice);
  const Recording& recording = report.plan.input.recording;
  if (recording.mmm && recording.mmm->num_motions > 1) {
    selection.objects = ObjectsBeside(recording.file, recording.motion());
  }
  const BodyPoses poses = ComputeBodyPoses(model, report.result.trajectory, selection);
  WriteFileAtomically(file, FormatPoseFile(file, poses, choice.rotation));
}

void WriteBvh(const std::string& file, const ConversionReport& report) {
  WriteFileAtomically(file, FormatBvh(*report.plan.setup.model, report.result.trajectory));
}

void WriteBvhInMetres(const std::string& file, const ConversionReport& report) {
  WriteFileAtomically(
      file, FormatBvh(*report.plan.setup.model, report.result.trajectory, BvhUnit::kMetres));
}

void WriteCovariances(const std::string& file, const ConversionReport& report) {
  const ConversionResult& result = report.result;
  WriteFileAtomically(file, FormatCovarianceNpz(result.trajectory, result.covariances));
}

/// What holosoma retargets by itself: it takes 30 Hz for granted.
void WriteKeypoints(const std::string& file, const ConversionReport& report) {
  constexpr double kRate = 30;
  constexpr double kLegs = 0.53;  // of the height (Winter 2009, figure 4.1)
  const KinematicModel& model = *report.plan.setup.model;
  const HumanBody body = FindHumanBody(model);
  const double told = report.plan.person.height.value;
  const double height = told > 0 ? told : body.leg_length() / kLegs;
  const Eigen::MatrixXd points =
      Keypoints(MoveHuman(model, body, report.result.trajectory), height, kRate);
  const std::vector<std::string>& names = KeypointNames();
  const auto n = static_cast<std::int64_t>(names.size());
  const std::vector<NpyArray> arrays = {{"global_joint_positions",
                                         {points.cols(), n, 3},
                                         {points.data(), points.data() + points.size()},
                                         {}},
                                        {"height", {}, {height}, {}},
                                        {"fps", {}, {kRate}, {}},
                                        {"joint_names", {n}, {}, names}};
  WriteFileAtomically(file, FormatNpz(arrays));
}

/// The joints of hands and face do not turn.
void WriteAmass(const std::string& file, const ConversionReport& report) {
  const std::string& model_file = report.plan.input.smpl_model;
  const SmplModel smpl =
      model_file.empty() ? StandInSmplModel(SmplKind::kSmplH) : ReadSmplModel(model_file);
  const SmplMotion motion =
      MakeSmplMotion(*report.plan.setup.model, report.result.trajectory, smpl);
  const std::int64_t frames = motion.poses.cols();
  Eigen::MatrixXd poses = Eigen::MatrixXd::Zero(3 * smpl.num_joints, frames);
  poses.topRows(motion.poses.rows()) = motion.poses;
  std::vector<double> betas = motion.betas;
  if (betas.empty()) betas.resize(16, 0);
  const auto numbers = [](const auto& matrix) {
    return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
  };
  const std::vector<NpyArray> arrays = {
      {"poses", {frames, poses.rows()}, numbers(poses), {}},
      {"trans", {frames, 3}, numbers(motion.translation), {}},
      {"betas", {static_cast<std::int64_t>(betas.size())}, betas, {}},
      {"gender", {}, {}, {"neutral"}},
      {"mocap_framerate", {}, {report.result.trajectory.rate}, {}}};
  WriteFileAtomically(file, FormatNpz(arrays));
}

bool IsAny(const ExportFiles& files, bool Exporter::*is_so) {
  const std::vector<Exporter>& all = Exporters();
  return std::any_of(all.begin(), all.end(),
                     [&](const Exporter& one) { return one.*is_so && files.count(one.name) > 0; });
}

void CheckAnatomy(const std::string& file, const KinematicModel& model) {
  if (HasAnatomy(model)) return;
  throw Error(
      fmt::format("{}: pelvis, hips and knees are known of MMM's and OpenSim's models of persons, "
                  "not of {}",
                  file, model.name()));
}

void CheckLimbs(const std::string& file, const KinematicModel& model) {
  try {
    FindHumanBody(model);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file, error.what()));
  }
}

void CheckTurns(const std::string& file, const KinematicModel& model) {
  if (!model.coordinates()) return;
  throw Error(
      fmt::format("{}: the format has joints that turn only, and those of model {} of OpenSim are "
                  "functions of coordinates",
                  file, model.name()));
}

}  // namespace

const std::vector<Exporter>& Exporters() {
  static const std::vector<Exporter> exporters = {
      {"csv", "export-csv", "csv", "postures and their standard deviations as CSV",
       "postures as CSV; with standard deviations of S2KF, with velocities and accelerations where "
       "postures are smoothed (-c s2kf_offline)",
       WriteCsv},
      {"angles", "export-angles", "csv", "joint angles by their anatomical names as CSV",
       "flexion, adduction and rotation of trunk, hips, knees, ankles, shoulders and others in "
       "degrees with their standard deviations: a row for each frame and angle",
       WriteAngles, false, false, CheckAnatomy},
      {"trc", "export-trc", "trc", "markers, measured and the model's, as TRC",
       "markers as TRC for OpenSim or Mokka, in mm with y up: as measured, and where the model has "
       "them (LABEL_model)",
       WriteTrc},
      {"mot", "export-mot", "mot", "postures for OpenSim",
       "postures as OpenSim's motion, in metres and degrees with y up; with a model of OpenSim its "
       "coordinates",
       WriteMot},
      {"marker-errors", "export-marker-errors", "sto",
       "distances of the markers from the model's, for OpenSim",
       "distances of the markers from where the model has them [m], of each frame and marker, as "
       "OpenSim reports them",
       WriteMarkerErrors},
      {"model-markers", "export-model-markers", "sto", "the model's markers, for OpenSim",
       "where the model has its markers [m], as OpenSim reports it; .trc: as a recording "
       "that moves another model",
       WriteModelMarkers},
      {"poses", "export-poses", "npz", "poses of all segments, as NumPy's .npz",
       "poses of all segments and of the file's objects, 21 points of the body and the centre of "
       "mass: .npz for NumPy, else CSV; see export-poses",
       WritePoses},
      {"bvh", "export-bvh", "bvh", "the skeleton and its motion as BVH",
       "skeleton and motion as BVH for Blender, in centimetres and degrees with y up", WriteBvh,
       false, false, CheckTurns},
      {"bvh-m", "export-bvh-m", "bvh", "the same in metres", "the same in metres", WriteBvhInMetres,
       false, false, CheckTurns},
      {"holosoma", "export-holosoma", "npz", "joint centres for holosoma's retargeting",
       "joint centres at 30 Hz as holosoma's retargeting takes a person in (data format smplx): "
       "global_joint_positions [m] of 22 joints, and height",
       WriteKeypoints, false, false, CheckLimbs},
      {"amass", "export-amass", "npz", "the motion as AMASS has it, for SMPL",
       "the motion of SMPL's joints as AMASS has it (poses, trans, betas, gender, "
       "mocap_framerate), z up; with SMPL's own model its shape is the person's",
       WriteAmass, false, false, CheckLimbs},
      {"covariance", "export-covariance", "npz", "covariances of the postures as NumPy's .npz",
       "covariances of root and joints as NumPy's .npz, of every frame in which S2KF computes "
       "them: "
       "some 13 a second",
       WriteCovariances, true},
      {"contacts", "export-contacts", "csv", "when which foot is on the ground, as CSV",
       "when which foot is on the ground and on which force plate: .json with events, .c3d: the "
       "recording with these events, else CSV",
       WriteContacts},
      {"gait", "export-gait", "csv", "joint angles over the gait cycle, as CSV",
       "joint angles over the gait cycle, and with force plates moments and powers, their mean and "
       "deviation of each foot's strides, as CSV; .json has cadence, speed, lengths and times of "
       "all strides, and work, too",
       WriteGait},
      {"c3d", "export-c3d", "c3d", "the recording with angles, moments, powers and events, as C3D",
       "the C3D recording with joint angles, with force plates moments and powers, and events of "
       "the "
       "feet, as points that Nexus and Mokka show",
       WriteResults, false, false, CheckAnatomy},
      {"grf", "export-grf", "mot", "ground reaction forces for OpenSim",
       "what force plates measured as OpenSim's .mot, with axes and time of the TRC, and the "
       "ExternalLoads as .xml beside it",
       WriteGrf},
      {"inverse-dynamics", "export-id", "csv", "forces and moments of the joints, as CSV",
       "generalised forces of the joints by inverse dynamics (6 Hz) with what force "
       "plates measured: .sto as OpenSim's, from the first to the last frame with values, .json "
       "with residuals and the legs' extremes, else CSV",
       WriteJointForces, false, true}};
  return exporters;
}

bool NeedCovariances(const ExportFiles& files) { return IsAny(files, &Exporter::of_covariances); }
bool TakeCovariances(const ExportFiles& files) {
  return IsAny(files, &Exporter::takes_covariances);
}

void CheckExports(const ExportFiles& files, const KinematicModel& model) {
  for (const Exporter& exporter : Exporters()) {
    const auto file = files.find(exporter.name);
    if (file != files.end() && exporter.check != nullptr) exporter.check(file->second, model);
  }
}

void WriteExports(const ExportFiles& files, const ConversionReport& report) {
  for (const Exporter& exporter : Exporters()) {
    const auto file = files.find(exporter.name);
    if (file != files.end()) exporter.write(file->second, report);
  }
}

}  // namespace mmm_converter
