// SPDX-License-Identifier: MIT
#include <algorithm>

#include "common/convert/tracking_setup.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/recording.h"
#include "common/support/error.h"
#include "plugins/jacobian/jacobian_converter.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/stick_model.h"

namespace mmm_converter::testing {
namespace {

constexpr int kMostFrames = 20;

/// A converter knows no file: its errors are about the recording.
ConversionResult Convert(MotionConverter* converter, const MarkerSequence& markers) {
  try {
    return converter->Convert(markers, {});
  } catch (const Error& error) {
    throw Error(std::string(kInputName) + ": " + error.what());
  }
}

void ConvertBy(MotionConverter* converter, const MarkerSequence& markers) {
  const ConversionResult result = Convert(converter, markers);
  Require(result.trajectory.num_frames() == markers.num_frames(), "a posture for each frame");
  for (const Posture& posture : result.trajectory.postures) {
    Require(posture.position.allFinite() && posture.orientation.coeffs().allFinite() &&
                posture.joint_angles.allFinite(),
            "postures that are finite");
    for (std::size_t i = 0; i < converter->setup().joints.size(); ++i) {
      const Segment& joint = converter->setup().model->joint(converter->setup().joints[i]);
      const double angle = posture.joint_angles(static_cast<Eigen::Index>(i));
      Require(angle >= joint.lower - 1e-9 && angle <= joint.upper + 1e-9,
              "joint angles within their limits");
    }
  }
  MmmMotionOutput output;
  output.motion_name = "converted";
  output.trajectory = &result.trajectory;
  output.markers = &markers;
  const MmmMotionFile read = ParseMmmMotionFile(Join(FormatMmmMotion2(output)), kInputName);
  Require(read.motions.at(0).trajectory.num_frames() == markers.num_frames(),
          "the frames that were written");
}

}  // namespace

void ConvertRecordingBytes(std::string_view bytes) {
  static const auto model = std::make_shared<const KinematicModel>(StickModel());
  ConverterConfig config;
  config.file = kInputName;
  config.joint_set = "all";
  config.marker_pairs = {
      {"A", "MARKER_A"}, {"B", "MARKER_B"}, {"C", "MARKER_C"}, {"D", "MARKER_D"}};
  Warnings warnings;
  const Recording recording = ReadRecording(FileOf(bytes), {}, &warnings);
  const MarkerSequence markers =
      recording.markers.Slice(0, std::min(kMostFrames, recording.markers.num_frames()));
  const TrackingSetup setup =
      MakeTrackingSetup(LabelsOf(markers, kInputName), model, config, {}, &warnings);
  for (const s2kf::FilterType filter : {s2kf::FilterType::kUkf, s2kf::FilterType::kEkf}) {
    s2kf::S2kfSettings settings;
    settings.filter = filter;
    settings.smoothing = filter == s2kf::FilterType::kEkf;
    s2kf::S2kfConverter converter(setup, settings);
    ConvertBy(&converter, markers);
  }
  jacobian::JacobianConverter converter(setup, {});
  ConvertBy(&converter, markers);
}

}  // namespace mmm_converter::testing
