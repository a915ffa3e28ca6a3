// SPDX-License-Identifier: MIT
#include "common/io/urdf/urdf_model_writer.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>

#include "common/io/xml/xml_text.h"
#include "common/math/rotation.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr double kEffort = 1000;         // [N m]; more than a person has
constexpr double kVelocity = 100;        // [rad/s]; faster than a person is
constexpr double kMarkerRadius = 0.007;  // [m]; markers are balls of 14 mm
constexpr double kShortestShape = 0.02;  // [m]; nearer joints are one in a person
constexpr double kThickness = 0.125;     // radius of a cylinder over its length
constexpr double kBodyDensity = 1000;    // [kg/m^3]; about that of water

constexpr const char* kHead = R"(
  The root link floats: a simulator adds its free joint. Links without mass have no <inertial>.
  Limits of effort and velocity are not known; these only satisfy the format. The shapes only show
  where joints are.)";

/// Letters, digits and what else every reader of URDF takes.
std::string Portable(const std::string& name) {
  std::string portable = name;
  for (char& c : portable) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool is_other = (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
    if (!is_letter && !is_other) c = '_';
  }
  return portable.empty() ? "unnamed" : portable;
}

/// Exact: what is read back is the same double.
std::string Exact(double value) { return fmt::format("{}", value + 0.0); }

std::string Exact(const Eigen::Vector3d& v) {
  return Exact(v.x()) + " " + Exact(v.y()) + " " + Exact(v.z());
}

/// Roll, pitch and yaw that give R to the last digits, near gimbal lock too: pitch and yaw are
/// those that belong to the roll that was found.
Eigen::Vector3d ExactRpy(const Eigen::Matrix3d& R) {
  const double roll = std::atan2(R(2, 1), R(2, 2));
  const Eigen::Matrix3d R_zy =
      R * Eigen::AngleAxisd(-roll, Eigen::Vector3d::UnitX()).toRotationMatrix();
  return {roll, std::atan2(-R_zy(2, 0), R_zy(2, 2)), std::atan2(-R_zy(0, 1), R_zy(1, 1))};
}

std::string Origin(const Eigen::Isometry3d& X) {
  return fmt::format("<origin xyz=\"{}\" rpy=\"{}\"/>", Exact(Eigen::Vector3d(X.translation())),
                     Exact(ExactRpy(X.linear())));
}

std::string Visual(const Eigen::Isometry3d& X, const std::string& shape) {
  return fmt::format("    <visual>{}<geometry>{}</geometry></visual>\n", Origin(X), shape);
}

std::string Sphere(const Eigen::Vector3d& center, double radius) {
  return Visual(Eigen::Isometry3d(Eigen::Translation3d(center)),
                fmt::format("<sphere radius=\"{:.4g}\"/>", radius));
}

/// From the origin to p; nothing where it is near.
std::string Cylinder(const Eigen::Vector3d& p) {
  const double length = p.norm();
  if (length < kShortestShape) return "";
  Eigen::Isometry3d X(Eigen::Translation3d(0.5 * p));
  X.rotate(RotationBetween(Eigen::Vector3d::UnitZ(), p));
  return Visual(X, fmt::format("<cylinder radius=\"{:.4g}\" length=\"{:.4g}\"/>",
                               kThickness * length, length));
}

/// Nothing for a joint without end; the reach of others without limits.
std::string Limits(const Segment& joint) {
  if (IsEndless(joint)) return "";
  const bool has_none = HasNoLimits(joint);
  return fmt::format("lower=\"{}\" upper=\"{}\" ",
                     Exact(has_none ? joint.rest - joint.reach : joint.lower),
                     Exact(has_none ? joint.rest + joint.reach : joint.upper));
}

/// Of a joint that follows another. URDF has no others.
ScalarFunction::Line LineOf(const Segment& joint) {
  return joint.function ? joint.function->AsLine().value_or(ScalarFunction::Line{})
                        : ScalarFunction::Line{};
}

class UrdfWriter {
 public:
  UrdfWriter(const KinematicModel& model, std::string comment, Warnings* warnings)
      : model_(model), comment_(std::move(comment)), warnings_(warnings) {}

  UrdfText Write();

 private:
  std::string Unique(const std::string& name, std::set<std::string>* taken);
  void ChooseNames();
  void AppendLink(std::size_t index);
  std::string Inertial(const Segment& segment);
  std::string Shapes(std::size_t index) const;
  void AppendJoint(std::size_t index);
  void AppendMarker(const ModelMarker& marker);
  void CheckInertia(const Segment& segment);

  const KinematicModel& model_;
  const std::string comment_;
  std::set<std::string> taken_links_, taken_joints_;
  std::vector<std::string> links_, joints_;  ///< of the segments
  std::vector<std::string> renamed_;
  Warnings* warnings_;
  UrdfText urdf_;
};

/// A portable name that is not taken.
std::string UrdfWriter::Unique(const std::string& name, std::set<std::string>* taken) {
  std::string unique = Portable(name);
  while (!taken->insert(unique).second) unique += "_";
  if (unique != name) renamed_.push_back(fmt::format("\"{}\" as {}", name, unique));
  return unique;
}

void UrdfWriter::ChooseNames() {
  for (const Segment& segment : model_.segments()) {
    const bool is_root = segment.parent < 0;
    joints_.push_back(is_root ? "" : Unique(segment.name, &taken_joints_));
    links_.push_back(is_root ? Unique(segment.name, &taken_links_)
                             : Unique(joints_.back() + "_link", &taken_links_));
  }
}

void UrdfWriter::CheckInertia(const Segment& segment) {
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(segment.inertia, Eigen::EigenvaluesOnly)
          .eigenvalues();
  const double rounding = 1e-6 * moments.cwiseAbs().maxCoeff();  // models have 6 digits
  if (moments[0] > rounding && moments[2] <= moments[0] + moments[1] + rounding) return;
  Warn(warnings_, fmt::format("model node '{}': no body of {:.4g} kg has its inertia (principal "
                              "moments {:.4g}, {:.4g} and "
                              "{:.4g} kg m^2), which is written as it is; simulators may refuse it",
                              segment.name, segment.mass, moments[0], moments[1], moments[2]));
}

std::string UrdfWriter::Inertial(const Segment& segment) {
  if (segment.mass <= 0) {
    if (!segment.inertia.isZero(0)) {
      Warn(warnings_,
           fmt::format("model node '{}': has no mass; its inertia is left out", segment.name));
    }
    return "";
  }
  CheckInertia(segment);
  const Eigen::Matrix3d& I = segment.inertia;
  return fmt::format(
      "    <inertial>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n      <mass value=\"{}\"/>\n"
      "      <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/>\n"
      "    </inertial>\n",
      Exact(segment.p_SB), Exact(segment.mass), Exact(I(0, 0)), Exact(I(0, 1)), Exact(I(0, 2)),
      Exact(I(1, 1)), Exact(I(1, 2)), Exact(I(2, 2)));
}

std::string UrdfWriter::Shapes(std::size_t index) const {
  std::string shapes;
  bool has_children = false;
  for (const Segment& child : model_.segments()) {
    if (child.parent != static_cast<int>(index)) continue;
    has_children = true;
    shapes += Cylinder(child.X_PF.translation());
  }
  const Segment& segment = model_.segments()[index];
  if (has_children || segment.mass <= 0) return shapes;
  return Sphere(segment.p_SB, std::cbrt(0.75 * segment.mass / (EIGEN_PI * kBodyDensity)));
}

void UrdfWriter::AppendLink(std::size_t index) {
  const std::string content = Inertial(model_.segments()[index]) + Shapes(index);
  urdf_.xml += content.empty()
                   ? fmt::format("  <link name=\"{}\"/>\n", links_[index])
                   : fmt::format("  <link name=\"{}\">\n{}  </link>\n", links_[index], content);
}

void UrdfWriter::AppendJoint(std::size_t index) {
  const Segment& segment = model_.segments()[index];
  const bool turns = segment.joint >= 0;
  const char* moving = IsEndless(segment)                    ? "continuous"
                       : segment.type == JointType::kSliding ? "prismatic"
                                                             : "revolute";
  const char* type = turns ? moving : "fixed";
  // A joint that counts from elsewhere.
  const bool is_shifted = turns && segment.leader < 0 && LineOf(segment).offset != 0;
  const Eigen::Isometry3d X_PF =
      is_shifted ? segment.X_PF * JointTransform(segment, 0) : segment.X_PF;
  urdf_.xml += fmt::format(
      "  <joint name=\"{}\" type=\"{}\">\n    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n"
      "    {}\n",
      joints_[index], type, links_[segment.parent], links_[index], Origin(X_PF));
  if (turns) {
    urdf_.xml +=
        fmt::format("    <axis xyz=\"{}\"/>\n    <limit {}effort=\"{:g}\" velocity=\"{:g}\"/>\n",
                    Exact(segment.axis), Limits(segment), kEffort, kVelocity);
  }
  if (segment.leader >= 0) {
    const ScalarFunction::Line line = LineOf(segment);
    urdf_.xml += fmt::format("    <mimic joint=\"{}\" multiplier=\"{}\" offset=\"{}\"/>\n",
                             joints_[static_cast<std::size_t>(segment.leader)], Exact(line.slope),
                             Exact(line.offset));
  }
  urdf_.xml += "  </joint>\n";
}

void UrdfWriter::AppendMarker(const ModelMarker& marker) {
  const std::string link = Unique(marker.name + "_marker", &taken_links_);
  const std::string joint = Unique(link + "_joint", &taken_joints_);
  urdf_.xml += fmt::format(
      "  <link name=\"{}\">\n{}  </link>\n  <joint name=\"{}\" type=\"fixed\">\n"
      "    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n    {}\n  </joint>\n",
      link, Sphere(Eigen::Vector3d::Zero(), kMarkerRadius), joint, links_[marker.segment], link,
      Origin(Eigen::Isometry3d(Eigen::Translation3d(marker.p_SM))));
}

UrdfText UrdfWriter::Write() {
  ChooseNames();
  urdf_.xml = fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}\n<robot name=\"{}\">\n",
                          FormatXmlComment(comment_ + kHead), EscapeXml(Portable(model_.name())));
  for (std::size_t i = 0; i < links_.size(); ++i) AppendLink(i);
  for (std::size_t i = 1; i < links_.size(); ++i) AppendJoint(i);
  for (const ModelMarker& marker : model_.markers()) AppendMarker(marker);
  urdf_.xml += "</robot>\n";
  if (!renamed_.empty()) {
    urdf_.renamed = fmt::format("names of letters, digits and underscores were needed: {}",
                                fmt::join(renamed_, ", "));
  }
  return std::move(urdf_);
}

}  // namespace

UrdfText FormatUrdf(const KinematicModel& model, const std::string& comment, Warnings* warnings) {
  if (model.coordinates()) {
    throw Error(
        fmt::format("model {} is one of OpenSim, whose joints are functions of coordinates; "
                    "a URDF has none of these",
                    model.name()));
  }
  return UrdfWriter(model, comment, warnings).Write();
}

}  // namespace mmm_converter
