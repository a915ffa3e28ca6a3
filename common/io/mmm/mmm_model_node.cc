// SPDX-License-Identifier: MIT
#include "common/io/mmm/mmm_model_node.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/math/rotation.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr double kDegree = EIGEN_PI / 180;
constexpr double kLongestPartOffset = 10;       // [m]; no body part is longer
constexpr double kLargestAngle = 4 * EIGEN_PI;  // [rad]; beyond it the unit must be wrong
constexpr double kLargestPartMass = 1000;       // [kg]
constexpr double kLargestPartInertia = 1e6;     // [kg m^2]
constexpr double kRotationTolerance = 1e-3;     // files have 3 to 6 digits

enum class Quantity { kLength, kAngle, kMass, kInertia };

struct UnitName {
  const char* name;
  Quantity quantity;
  double factor;  ///< to SI
};

constexpr UnitName kModelUnits[] = {
    {"mm", Quantity::kLength, 1e-3},    {"millimeter", Quantity::kLength, 1e-3},
    {"cm", Quantity::kLength, 1e-2},    {"centimeter", Quantity::kLength, 1e-2},
    {"m", Quantity::kLength, 1},        {"meter", Quantity::kLength, 1},
    {"rad", Quantity::kAngle, 1},       {"radian", Quantity::kAngle, 1},
    {"deg", Quantity::kAngle, kDegree}, {"degree", Quantity::kAngle, kDegree},
    {"kg", Quantity::kMass, 1},         {"kilogram", Quantity::kMass, 1},
    {"g", Quantity::kMass, 1e-3},       {"gram", Quantity::kMass, 1e-3},
    {"kg*m^2", Quantity::kInertia, 1},  {"kgm2", Quantity::kInertia, 1},
};

const UnitName* FindUnit(std::string_view name) {
  for (const UnitName& unit : kModelUnits) {
    if (EqualIgnoringCase(unit.name, Trim(name))) return &unit;
  }
  return nullptr;
}

const char* UnitsOf(Quantity quantity) {
  switch (quantity) {
    case Quantity::kLength:
      return "mm, cm or m";
    case Quantity::kAngle:
      return "degree or radian";
    case Quantity::kMass:
      return "g or kg";
    case Quantity::kInertia:
      return "kg*m^2";
  }
  return "";
}

constexpr const char* kUnitAttributes[] = {"unit", "units", "unitsLength", "unitsAngle",
                                           "unitsWeight"};

class NodeReader {
 public:
  explicit NodeReader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  ModelNode Read(const XmlElement& element);

 private:
  template <typename... Args>
  void Fail(const XmlElement& at, fmt::format_string<Args...> text, Args&&... args) {
    diagnostics_.AddError(at.line, fmt::format("node '{}': {}", node_.segment.name,
                                               fmt::format(text, std::forward<Args>(args)...)));
  }

  std::string Name(const XmlElement& element);
  double Number(const XmlElement& element, const char* attribute);
  Eigen::Vector3d Vector(const XmlElement& element);
  double Unit(const XmlElement& element, std::string_view default_unit);
  double LengthUnit(const XmlElement& element) { return Unit(element, "mm"); }
  double AngleUnit(const XmlElement& element) { return Unit(element, "radian"); }
  void CheckOffset(const XmlElement& element, const Eigen::Vector3d& offset);

  Eigen::Matrix3d Rotation(const XmlElement& matrix);
  Eigen::Isometry3d Matrix4x4(const XmlElement& matrix);
  Eigen::Isometry3d Transform(const XmlElement& element);
  void ReadJoint(const XmlElement& joint);
  void ReadAxis(const XmlElement& joint, const char* axis_name);
  void ReadLimits(const XmlElement& joint);
  void ReadPhysics(const XmlElement& physics);
  void ReadCenterOfMass(const XmlElement& com);
  void ReadInertia(const XmlElement& inertia);
  void ReadSensor(const XmlElement& sensor);
  void ReadChild(const XmlElement& child);

  Diagnostics& diagnostics_;
  ModelNode node_;
};

std::string NodeReader::Name(const XmlElement& element) {
  const std::string* name = element.FindAttribute("name");
  if (name != nullptr && !Trim(*name).empty()) return std::string(Trim(*name));
  Fail(element, "<{}> needs an attribute name=\"...\"", element.name);
  return {};
}

double NodeReader::Number(const XmlElement& element, const char* attribute) {
  const std::string* text = element.FindAttribute(attribute);
  if (text == nullptr) {
    Fail(element, "<{}> needs an attribute {}=\"number\"", element.name, attribute);
    return 0;
  }
  const std::optional<double> number = ParseDouble(*text);
  if (number && std::isfinite(*number)) return *number;
  Fail(element, "<{} {}=\"{}\">: expected a finite number", element.name, attribute, *text);
  return 0;
}

Eigen::Vector3d NodeReader::Vector(const XmlElement& element) {
  return {Number(element, "x"), Number(element, "y"), Number(element, "z")};
}

double NodeReader::Unit(const XmlElement& element, std::string_view default_unit) {
  const UnitName& standard = *FindUnit(default_unit);
  for (const char* attribute : kUnitAttributes) {
    const std::string* text = element.FindAttribute(attribute);
    if (text == nullptr) continue;
    const UnitName* unit = FindUnit(*text);
    if (unit != nullptr && unit->quantity == standard.quantity) return unit->factor;
    Fail(element, "<{} {}=\"{}\">: unknown unit; use {}", element.name, attribute, *text,
         UnitsOf(standard.quantity));
  }
  return standard.factor;
}

void NodeReader::CheckOffset(const XmlElement& element, const Eigen::Vector3d& offset) {
  if (offset.norm() <= kLongestPartOffset) return;
  Fail(element, "<{}> is {:.6g} m long, more than {} m; check its numbers and its unit",
       element.name, offset.norm(), kLongestPartOffset);
}

/// The rotation nearest to the upper left 3 x 3 numbers.
Eigen::Matrix3d NodeReader::Rotation(const XmlElement& matrix) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (int row = 0; row < 3; ++row) {
    const XmlElement* numbers = matrix.FindChild(fmt::format("row{}", row + 1));
    if (numbers == nullptr) {
      Fail(matrix, "<{}> needs a <row{}>", matrix.name, row + 1);
      continue;
    }
    R.row(row) << Number(*numbers, "c1"), Number(*numbers, "c2"), Number(*numbers, "c3");
  }
  if (!R.isUnitary(kRotationTolerance) || R.determinant() < 0) {
    Fail(matrix, "<{}> is not a rotation: its rows are not unit vectors at right angles",
         matrix.name);
    return Eigen::Matrix3d::Identity();
  }
  if (R.isUnitary(1e-12)) return R;
  return NearestRotation(R);
}

Eigen::Isometry3d NodeReader::Matrix4x4(const XmlElement& matrix) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Rotation(matrix);
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  for (int row = 0; row < 3; ++row) {
    const XmlElement* numbers = matrix.FindChild(fmt::format("row{}", row + 1));
    if (numbers != nullptr) offset[row] = Number(*numbers, "c4");
  }
  X.translation() = offset * LengthUnit(matrix);
  CheckOffset(matrix, X.translation());
  return X;
}

Eigen::Isometry3d NodeReader::Transform(const XmlElement& element) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (const XmlElement& part : element.children) {
    if (part.Is("Matrix4x4")) {
      X = Matrix4x4(part);
    } else if (part.Is("Matrix3x3")) {
      X.linear() = Rotation(part);
    } else if (part.Is("Translation")) {
      X.translation() = Vector(part) * LengthUnit(part);
      CheckOffset(part, X.translation());
    } else if (part.Is("rollpitchyaw")) {
      const Eigen::Vector3d rpy(Number(part, "roll"), Number(part, "pitch"), Number(part, "yaw"));
      X.linear() = RotationFromRpy(rpy * AngleUnit(part));
    } else {
      Fail(part,
           "<{}> is not supported in a <Transform>; use Matrix4x4, Matrix3x3, Translation or "
           "rollpitchyaw",
           part.name);
    }
  }
  return X;
}

void NodeReader::ReadAxis(const XmlElement& joint, const char* axis_name) {
  const XmlElement* element = joint.FindChild(axis_name);
  if (element == nullptr) {
    Fail(joint, "<{}> needs an <{} x=\"..\" y=\"..\" z=\"..\"/>", joint.name, axis_name);
    return;
  }
  const Eigen::Vector3d axis = Vector(*element);
  const double length = axis.stableNorm();
  if (length > 1e-6 && std::isfinite(length)) {
    node_.segment.axis = axis / length;
  } else {
    Fail(*element, "<{}> has no direction", element->name);
  }
}

void NodeReader::ReadLimits(const XmlElement& joint) {
  const bool revolute = node_.segment.type == JointType::kRevolute;
  const XmlElement* limits = joint.FindChild("limits");
  if (limits == nullptr) {
    if (revolute) {
      Fail(joint, "a revolute joint needs <limits lo=\"..\" hi=\"..\" units=\"radian\"/>");
    }
    return;
  }
  const double unit = revolute ? AngleUnit(*limits) : LengthUnit(*limits);
  const double lower = Number(*limits, "lo") * unit;
  const double upper = Number(*limits, "hi") * unit;
  const double largest = revolute ? kLargestAngle : 1e3 * kLongestPartOffset;
  const std::string* lower_text = limits->FindAttribute("lo");
  const std::string* upper_text = limits->FindAttribute("hi");
  if (lower_text == nullptr || upper_text == nullptr) return;  // Number has said so
  if (lower > upper) {
    Fail(*limits, "the limits are crossed: lo=\"{}\" is above hi=\"{}\"", *lower_text, *upper_text);
  } else if (std::max(std::abs(lower), std::abs(upper)) > largest) {
    Fail(*limits, "the limits {:.6g} to {:.6g} {} are too wide; check their unit", lower, upper,
         revolute ? "radian" : "m");
  } else {
    node_.segment.lower = lower;
    node_.segment.upper = upper;
  }
}

void NodeReader::ReadJoint(const XmlElement& joint) {
  const std::string* type = joint.FindAttribute("type");
  if (type == nullptr || EqualIgnoringCase(*type, "fixed")) return;
  if (EqualIgnoringCase(*type, "revolute")) {
    node_.segment.type = JointType::kRevolute;
    ReadAxis(joint, "axis");
  } else if (EqualIgnoringCase(*type, "prismatic")) {
    node_.segment.type = JointType::kPrismatic;
    ReadAxis(joint, "translationdirection");
  } else {
    Fail(joint, "<Joint type=\"{}\">: unknown type; use revolute, prismatic or fixed", *type);
    return;
  }
  ReadLimits(joint);
}

void NodeReader::ReadCenterOfMass(const XmlElement& com) {
  const std::string* location = com.FindAttribute("location");
  if (location != nullptr && !EqualIgnoringCase(*location, "custom")) {
    diagnostics_.AddWarning(
        com.line,
        fmt::format("node '{}': <CoM location=\"{}\"> is not supported; the centre of mass "
                    "is taken to be the node's origin",
                    node_.segment.name, *location));
    return;
  }
  node_.segment.p_SB = Vector(com) * LengthUnit(com);
  CheckOffset(com, node_.segment.p_SB);
}

void NodeReader::ReadInertia(const XmlElement& inertia) {
  Eigen::Matrix3d I = Eigen::Matrix3d::Zero();
  for (int row = 0; row < 3; ++row) {
    const XmlElement* numbers = inertia.FindChild(fmt::format("row{}", row + 1));
    if (numbers == nullptr) {
      Fail(inertia, "<{}> needs a <row{}>", inertia.name, row + 1);
      return;
    }
    I.row(row) << Number(*numbers, "c1"), Number(*numbers, "c2"), Number(*numbers, "c3");
  }
  if (!I.isApprox(I.transpose(), 1e-6) || I.diagonal().minCoeff() < 0) {
    Fail(inertia, "<{}> must be symmetric, without negative numbers on its diagonal", inertia.name);
    return;
  }
  if (I.cwiseAbs().maxCoeff() > kLargestPartInertia) {
    Fail(inertia, "<{}> has a number above {} kg*m^2", inertia.name, kLargestPartInertia);
    return;
  }
  node_.segment.inertia = 0.5 * (I + I.transpose()) * Unit(inertia, "kg*m^2");
}

void NodeReader::ReadPhysics(const XmlElement& physics) {
  if (const XmlElement* mass = physics.FindChild("Mass")) {
    node_.segment.mass = Number(*mass, "value") * Unit(*mass, "kg");
    if (node_.segment.mass < 0 || node_.segment.mass > kLargestPartMass) {
      Fail(*mass, "a mass of {:.6g} kg is outside 0 to {} kg", node_.segment.mass,
           kLargestPartMass);
    }
  }
  if (const XmlElement* com = physics.FindChild("CoM")) ReadCenterOfMass(*com);
  if (const XmlElement* inertia = physics.FindChild("InertiaMatrix")) ReadInertia(*inertia);
}

void NodeReader::ReadSensor(const XmlElement& sensor) {
  const std::string* type = sensor.FindAttribute("type");
  if (type == nullptr || !EqualIgnoringCase(*type, "position")) return;
  ModelMarker marker{Name(sensor), -1, Eigen::Vector3d::Zero()};
  if (const XmlElement* transform = sensor.FindChild("Transform")) {
    marker.p_SM = Transform(*transform).translation();
  }
  node_.markers.push_back(std::move(marker));
}

void NodeReader::ReadChild(const XmlElement& child) {
  node_.children.push_back({Name(child), child.line});
}

ModelNode NodeReader::Read(const XmlElement& element) {
  node_.line = element.line;
  node_.segment.name = Name(element);
  for (const XmlElement& part : element.children) {
    if (part.Is("Transform")) {
      node_.segment.X_PF = Transform(part);
    } else if (part.Is("Joint")) {
      ReadJoint(part);
    } else if (part.Is("Physics")) {
      ReadPhysics(part);
    } else if (part.Is("Sensor")) {
      ReadSensor(part);
    } else if (part.Is("Child")) {
      ReadChild(part);
    } else if (part.Is("Children")) {
      for (const XmlElement* child : part.FindChildren("Child")) ReadChild(*child);
    }
  }
  return std::move(node_);
}

}  // namespace

double LengthUnit(const XmlElement& element) {
  for (const char* attribute : kUnitAttributes) {
    const std::string* text = element.FindAttribute(attribute);
    const UnitName* unit = text == nullptr ? nullptr : FindUnit(*text);
    if (unit != nullptr && unit->quantity == Quantity::kLength) return unit->factor;
  }
  return FindUnit("mm")->factor;
}

ModelNode ReadModelNode(const XmlElement& element, Diagnostics& diagnostics) {
  return NodeReader(diagnostics).Read(element);
}

}  // namespace mmm_converter
