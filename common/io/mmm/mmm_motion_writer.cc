// SPDX-License-Identifier: MIT
#include "common/io/mmm/mmm_motion_writer.h"

#include <fmt/core.h>

#include <cassert>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "common/io/xml/xml_text.h"
#include "common/math/rotation.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kCentimetresPerMetre = 1e2;

double Rounded(double value, double scale) { return std::round(value * scale) / scale; }

/// Roll, pitch, yaw for one orientation after the other, without jumps. It goes on from what was
/// written, so that a file that is read and written again comes out the same.
class RpyWriter {
 public:
  const Eigen::Vector3d& Next(const Eigen::Quaterniond& orientation) {
    const Eigen::Matrix3d R = orientation.toRotationMatrix();
    const double scale = std::pow(10.0, kRadianDecimals);
    Eigen::Vector3d rpy = RpyFromRotation(R);
    // Nearer to gimbal lock than this, the digits that are written do not separate roll and yaw:
    // roll stays. What is written decides, so that it is decided alike when it is read.
    constexpr double kNearLock = 1e-7;
    if (std::abs(std::cos(Rounded(rpy.y(), scale))) < kNearLock) {
      const Eigen::Matrix3d R_zy =
          R * Eigen::AngleAxisd(-rpy_.x(), Eigen::Vector3d::UnitX()).toRotationMatrix();
      rpy = {rpy_.x(), std::atan2(-R_zy(2, 0), R_zy(2, 2)), std::atan2(-R_zy(0, 1), R_zy(1, 1))};
    }
    if (!is_first_) rpy = ContinuousRpy(rpy, rpy_);
    is_first_ = false;
    for (double& angle : rpy) angle = Rounded(angle, scale);
    rpy_ = rpy;
    return rpy_;
  }

 private:
  bool is_first_ = true;
  Eigen::Vector3d rpy_ = Eigen::Vector3d::Zero();
};

/// Appends to a text; indentation is part of what callers append.
class Text {
 public:
  explicit Text(std::string* text) : text_(*text) {}

  Text& operator<<(std::string_view text) {
    text_ += text;
    return *this;
  }
  Text& Millimetres(const Eigen::Ref<const Eigen::Vector3d>& position) {
    for (int i = 0; i < 3; ++i) {
      if (i > 0) text_ += ' ';
      AppendDecimal(position[i] * kMillimetres, kMillimetreDecimals, &text_);
    }
    return *this;
  }
  Text& Radians(const Eigen::Ref<const Eigen::VectorXd>& angles) {
    for (Eigen::Index i = 0; i < angles.size(); ++i) {
      if (i > 0) text_ += ' ';
      AppendDecimal(angles[i], kRadianDecimals, &text_);
    }
    return *this;
  }
  /// Time of frame k; first_time counts as it is written, which makes reading it back exact.
  Text& Seconds(double first_time, double rate, int k) {
    AppendDecimal(Rounded(first_time, std::pow(10.0, kSecondDecimals)) + k / rate, kSecondDecimals,
                  &text_);
    return *this;
  }
  Text& Number(double value) {
    AppendDecimal(value, kSecondDecimals, &text_);
    return *this;
  }

 private:
  std::string& text_;
};

void CheckFinite(const PoseTrajectory& trajectory) {
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const Posture& q = trajectory.postures[k];
    if (!q.position.allFinite() || !q.orientation.coeffs().allFinite()) {
      throw Error(fmt::format("frame {} can't be written: its root pose is not finite", k));
    }
    for (Eigen::Index i = 0; i < q.joint_angles.size(); ++i) {
      if (std::isfinite(q.joint_angles[i])) continue;
      throw Error(fmt::format("frame {} can't be written: joint {} is not finite", k,
                              trajectory.joint_names[i]));
    }
  }
  if (!trajectory.velocities.allFinite() || !trajectory.accelerations.allFinite()) {
    throw Error("the motion can't be written: a velocity or an acceleration is not finite");
  }
}

void AppendProcessor(const MmmMotionOutput& output, std::string_view indent, char quote,
                     Text text) {
  if (output.height <= 0) return;
  const std::string quoted = fmt::format("{0}Winter{0}", quote);
  text << indent << "<ModelProcessorConfig type=" << quoted << ">\n" << indent << "\t<Height>";
  text.Number(output.height) << "</Height>\n" << indent << "\t<Mass>";
  text.Number(output.mass) << "</Mass>\n";
  if (output.hand_length) {
    text << indent << "\t<HandLength>";
    text.Number(*output.hand_length * kCentimetresPerMetre) << "</HandLength>\n";
  }
  text << indent << "</ModelProcessorConfig>\n";
}

/// What the format has no element for.
void AppendComment(const MmmMotionOutput& output, Text text) {
  if (!output.comment.empty()) text << "\t\t\t" << FormatXmlComment(output.comment) << "\n";
}

void AppendModelPose(const PoseTrajectory& trajectory, PieceWriter* pieces) {
  Text text(pieces->text());
  text << "<Sensor type=\"ModelPose\" version=\"1.0\">\n\t\t\t\t<Configuration/>\n"
          "\t\t\t\t<Data>\n";
  RpyWriter rpy;
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const Posture& q = trajectory.postures[k];
    text << "\t\t\t\t\t<Measurement timestep=\"";
    text.Seconds(trajectory.first_time, trajectory.rate, k) << "\">\n\t\t\t\t\t\t<RootPosition>";
    text.Millimetres(q.position) << "</RootPosition>\n\t\t\t\t\t\t<RootRotation>";
    text.Radians(rpy.Next(q.orientation)) << "</RootRotation>\n\t\t\t\t\t</Measurement>\n";
    pieces->EndPart();
  }
  text << "\t\t\t\t</Data>\n\t\t\t</Sensor>";
}

void AppendKinematic(const PoseTrajectory& trajectory, PieceWriter* pieces) {
  if (trajectory.joint_names.empty()) return;
  Text text(pieces->text());
  text << "\n\t\t\t<Sensor type=\"Kinematic\" version=\"1.0\">\n\t\t\t\t<Configuration>\n";
  for (const std::string& name : trajectory.joint_names) {
    text << "\t\t\t\t\t<Joint name=\"" << EscapeXml(name) << "\"/>\n";
  }
  text << "\t\t\t\t</Configuration>\n\t\t\t\t<Data>\n";
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    text << "\t\t\t\t\t<Measurement timestep=\"";
    text.Seconds(trajectory.first_time, trajectory.rate, k) << "\">\n\t\t\t\t\t\t<JointPosition>";
    text.Radians(trajectory.postures[k].joint_angles)
        << "</JointPosition>\n\t\t\t\t\t</Measurement>\n";
    pieces->EndPart();
  }
  text << "\t\t\t\t</Data>\n\t\t\t</Sensor>";
}

/// Labels in alphabetical order, as in real files.
void AppendMarkers(const MarkerSequence& markers, PieceWriter* pieces) {
  std::map<std::string, int> sorted;
  for (int i = 0; i < markers.num_labels(); ++i) sorted.emplace(markers.labels()[i], i);
  std::vector<std::pair<std::string, int>> starts;
  starts.reserve(sorted.size());
  for (const auto& [label, i] : sorted) {
    starts.emplace_back("\t\t\t\t\t\t<MarkerPosition name=\"" + EscapeXml(label) + "\">", i);
  }
  Text text(pieces->text());
  text << "<Sensor type=\"MoCapMarker\" version=\"1.0\">\n\t\t\t\t<Configuration/>\n"
          "\t\t\t\t<Data>\n";
  for (int k = 0; k < markers.num_frames(); ++k) {
    text << "\t\t\t\t\t<Measurement timestep=\"";
    text.Seconds(markers.first_time(), markers.rate(), k) << "\">\n";
    const auto frame = markers.frame(k);
    for (const auto& [start, i] : starts) {
      if (!IsSeen(frame.col(i))) continue;
      text << start;
      text.Millimetres(frame.col(i)) << "</MarkerPosition>\n";
    }
    text << "\t\t\t\t\t</Measurement>\n";
    pieces->EndPart();
  }
  text << "\t\t\t\t</Data>\n\t\t\t</Sensor>";
}

/// A joint row of a 1.0 frame, which ends in a blank as in real files.
void AppendLegacyRow(std::string_view name, const Eigen::Ref<const Eigen::VectorXd>& values,
                     Text text) {
  text << "\t\t\t\t<" << name << ">";
  text.Radians(values) << (values.size() > 0 ? " </" : "</") << name << ">\n";
}

void AppendLegacyFrames(const MmmMotionOutput& output, PieceWriter* pieces) {
  const PoseTrajectory& trajectory = *output.trajectory;
  const Eigen::VectorXd zeros =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(trajectory.joint_names.size()));
  std::string no_velocity;
  std::string no_acceleration;
  AppendLegacyRow("JointVelocity", zeros, Text(&no_velocity));
  AppendLegacyRow("JointAcceleration", zeros, Text(&no_acceleration));
  Text text(pieces->text());
  RpyWriter rpy;
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const Posture& q = trajectory.postures[k];
    text << "\t\t\t<MotionFrame>\n\t\t\t\t<Timestep>";
    text.Seconds(trajectory.first_time, trajectory.rate, k)
        << "</Timestep>\n\t\t\t\t<RootPosition>";
    text.Millimetres(q.position) << "</RootPosition>\n\t\t\t\t<RootRotation>";
    text.Radians(rpy.Next(q.orientation)) << "</RootRotation>\n";
    AppendLegacyRow("JointPosition", q.joint_angles, text);
    if (trajectory.velocities.size() > 0) {
      AppendLegacyRow("JointVelocity", trajectory.velocities.col(k).tail(zeros.size()), text);
    } else {
      text << no_velocity;
    }
    if (trajectory.accelerations.size() > 0) {
      AppendLegacyRow("JointAcceleration", trajectory.accelerations.col(k).tail(zeros.size()),
                      text);
    } else {
      text << no_acceleration;
    }
    text << "\t\t\t</MotionFrame>\n";
    pieces->EndPart();
  }
}

void AppendMotion(const MmmMotionOutput& output, const char* type, PieceWriter* pieces) {
  std::string& text = *pieces->text();
  text +=
      fmt::format("\t<Motion name=\"{}\" type=\"{}\">\n\t\t", EscapeXml(output.motion_name), type);
  if (output.trajectory != nullptr) text += FormatModelElement(output) + "\n\t\t";
  text += "<Sensors>\n\t\t\t";
  AppendSensorElements(output, pieces);
  text += "\n\t\t</Sensors>\n\t</Motion>\n";
}

void AppendLegacyHead(const MmmMotionOutput& output, Text text) {
  text << "<?xml version='1.0'?>\n<MMM>\n\t<Motion name='" << EscapeXml(output.motion_name)
       << "'>\n\t\t<Model>\n\t\t\t<File>" << EscapeXml(output.model_path) << "</File>\n";
  AppendComment(output, text);
  text << "\t\t</Model>\n";
  AppendProcessor(output, "\t\t", '\'', text);
  text << "\t\t<JointOrder>\n";
  for (const std::string& name : output.trajectory->joint_names) {
    text << "\t\t\t<Joint name='" << EscapeXml(name) << "'/>\n";
  }
  text << "\t\t</JointOrder>\n\t\t<MotionFrames>\n";
}

}  // namespace

std::string FormatModelElement(const MmmMotionOutput& output) {
  std::string model = "<Model path=\"" + EscapeXml(output.model_path) + "\">\n";
  AppendComment(output, Text(&model));
  AppendProcessor(output, "\t\t\t", '"', Text(&model));
  return model + "\t\t</Model>";
}

void CheckWritable(const MmmMotionOutput& output) {
  assert(output.trajectory != nullptr || output.markers != nullptr);
  if (output.trajectory != nullptr) CheckFinite(*output.trajectory);
}

void AppendSensorElements(const MmmMotionOutput& output, PieceWriter* pieces) {
  if (output.trajectory != nullptr) {
    AppendModelPose(*output.trajectory, pieces);
    AppendKinematic(*output.trajectory, pieces);
    if (output.markers != nullptr) *pieces->text() += "\n\t\t\t";
  }
  if (output.markers != nullptr) AppendMarkers(*output.markers, pieces);
}

TextPieces FormatMmmMotion2(const MmmMotionOutput& output,
                            const std::vector<MmmMotionOutput>& objects) {
  CheckWritable(output);
  for (const MmmMotionOutput& object : objects) CheckWritable(object);
  return [output, objects](const TextSink& sink) {
    PieceWriter pieces(sink);
    std::string& text = *pieces.text();
    text += "<MMM version=\"2.0\"";
    if (!output.recording_name.empty()) {
      text += " name=\"" + EscapeXml(output.recording_name) + "\"";
    }
    text += ">\n";
    AppendMotion(output, "mmm", &pieces);
    for (const MmmMotionOutput& object : objects) AppendMotion(object, "object", &pieces);
    text += "</MMM>\n";
    pieces.Flush();
  };
}

TextPieces FormatMmmMotion1(const MmmMotionOutput& output) {
  CheckWritable(output);
  return [output](const TextSink& sink) {
    PieceWriter pieces(sink);
    AppendLegacyHead(output, Text(pieces.text()));
    AppendLegacyFrames(output, &pieces);
    *pieces.text() += "\t\t</MotionFrames>\n\t</Motion>\n</MMM>\n";
    pieces.Flush();
  };
}

}  // namespace mmm_converter
