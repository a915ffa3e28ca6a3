// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_joint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "common/io/osim/osim_values.h"
#include "common/support/text.h"

namespace mmm_converter {

using Eigen::Vector3d;

namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kShortestAxis = 1e-6;  // of a direction

/// Joints whose coordinates are turns about and shifts along the axes of their frame.
struct PlainJoint {
  const char* name;
  std::string_view axes;  ///< of the coordinates: "XYZ" turns, "xyz" shifts
};

constexpr PlainJoint kPlainJoints[] = {
    {"WeldJoint", ""},      {"PinJoint", "Z"},    {"SliderJoint", "x"},    {"UniversalJoint", "XY"},
    {"GimbalJoint", "XYZ"}, {"BallJoint", "XYZ"}, {"FreeJoint", "XYZxyz"}, {"PlanarJoint", "Zxy"},
};

void ReadRange(const XmlElement& element, OsimCoordinate* coordinate, Diagnostics* diagnostics) {
  const XmlElement* range = element.FindChild("range");
  if (range == nullptr || range->text.empty()) return;
  std::vector<double> ends;
  const bool is_range = AppendDoubles(range->text, &ends) && ends.size() == 2 &&
                        ends[0] <= ends[1] && ends[0] < kUnbounded && ends[1] > -kUnbounded;
  if (!is_range) {  // NaN is not <= anything
    diagnostics->AddError(range->line, fmt::format("<range>: \"{:.60}\" is not two numbers, the "
                                                   "lower first",
                                                   range->text));
    return;
  }
  coordinate->lower = ends[0];
  coordinate->upper = ends[1];
}

OsimCoordinate ReadCoordinate(const XmlElement& element, Diagnostics* diagnostics) {
  OsimCoordinate coordinate;
  coordinate.name = OsimName(element);
  coordinate.line = element.line;
  coordinate.default_value = ReadOsimNumber(element, "default_value", 0, diagnostics);
  ReadRange(element, &coordinate, diagnostics);
  coordinate.is_clamped = ReadOsimFlag(element, "clamped", false, diagnostics);
  coordinate.is_locked = ReadOsimFlag(element, "locked", false, diagnostics);
  if (ReadOsimFlag(element, "prescribed", false, diagnostics)) {
    diagnostics->AddError(element.line,
                          fmt::format("coordinate '{}' is prescribed as a function of time, which "
                                      "is not read; set <prescribed> to false",
                                      coordinate.name));
  }
  return coordinate;
}

/// Those that the joint's element lists, of either layout.
std::vector<OsimCoordinate> ListedCoordinates(const XmlElement& joint, Diagnostics* diagnostics) {
  std::vector<OsimCoordinate> coordinates;
  const XmlElement* list = joint.FindChild("coordinates");
  if (list == nullptr) list = FindOsimObjects(joint, "CoordinateSet");
  if (list == nullptr) return coordinates;
  for (const XmlElement* element : list->FindChildren("Coordinate")) {
    coordinates.push_back(ReadCoordinate(*element, diagnostics));
    if (coordinates.back().name.empty()) {
      diagnostics->AddError(element->line, "a coordinate has no name");
    }
  }
  return coordinates;
}

class JointReader {
 public:
  JointReader(const XmlElement& element, OsimDocument* document, Diagnostics* diagnostics)
      : element_(element), document_(document), diagnostics_(diagnostics) {
    joint_.name = OsimName(element);
    joint_.type = element.name;
    joint_.line = element.line;
    for (int i = 0; i < 3; ++i) {
      joint_.rotations[i].axis = joint_.translations[i].axis = Vector3d::Unit(i);
    }
    listed_ = ListedCoordinates(element, diagnostics);
  }

  OsimJoint Read() {
    const auto* plain = std::find_if(std::begin(kPlainJoints), std::end(kPlainJoints),
                                     [&](const PlainJoint& one) { return element_.Is(one.name); });
    if (plain != std::end(kPlainJoints)) {
      ReadPlain(plain->axes);
    } else if (element_.Is("CustomJoint")) {
      ReadCustom();
    } else {
      diagnostics_->AddError(
          element_.line,
          fmt::format("joint '{}' is a {}, which is not read; Custom, Weld, Pin, Slider, "
                      "Universal, Gimbal, Ball, Free and Planar joints are",
                      joint_.name, element_.name));
    }
    return std::move(joint_);
  }

 private:
  void ReadPlain(std::string_view axes);
  void ReadCustom();
  void ReadTransformAxis(const XmlElement* element, bool is_turn, OsimAxis* axis);
  /// The coordinate of that name becomes the joint's next one, if it is none yet.
  OsimCoordinate* Use(const std::string& name);

  const XmlElement& element_;
  OsimDocument* document_;
  Diagnostics* diagnostics_;
  OsimJoint joint_;
  std::vector<OsimCoordinate> listed_;
};

OsimCoordinate* JointReader::Use(const std::string& name) {
  std::vector<OsimCoordinate>& all = document_->coordinates;
  for (const int used : joint_.coordinates) {
    if (all[used].name == name) return &all[used];
  }
  const auto listed = std::find_if(listed_.begin(), listed_.end(),
                                   [&](const OsimCoordinate& one) { return one.name == name; });
  joint_.coordinates.push_back(static_cast<int>(all.size()));
  if (listed != listed_.end()) {
    all.push_back(*listed);
  } else {
    all.emplace_back();
    all.back().name = name;
    all.back().line = joint_.line;
  }
  return &all.back();
}

void JointReader::ReadPlain(std::string_view axes) {
  constexpr std::string_view kTurns = "XYZ";
  constexpr std::string_view kShifts = "xyz";
  if (listed_.size() > axes.size()) {
    diagnostics_->AddError(element_.line,
                           fmt::format("joint '{}' is a {} and has {} coordinates; "
                                       "{} are expected",
                                       joint_.name, element_.name, listed_.size(), axes.size()));
    return;
  }
  // A joint turns about its axes one after the other: the first of these is the first turn.
  std::size_t turns = 0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::string name =
        i < listed_.size() ? listed_[i].name : fmt::format("{}_coord_{}", joint_.name, i);
    const bool is_turn = kTurns.find(axes[i]) != std::string_view::npos;
    OsimCoordinate* coordinate = Use(name);
    coordinate->motion_type =
        is_turn ? OsimMotionType::kRotational : OsimMotionType::kTranslational;
    OsimAxis& axis =
        is_turn ? joint_.rotations[turns++] : joint_.translations[kShifts.find(axes[i])];
    if (is_turn) axis.axis = Vector3d::Unit(static_cast<Eigen::Index>(kTurns.find(axes[i])));
    axis.value.terms.push_back({name, ScalarFunction()});
  }
}

void JointReader::ReadTransformAxis(const XmlElement* element, bool is_turn, OsimAxis* axis) {
  if (element == nullptr) return;
  const Vector3d direction = ReadOsimVector(*element, "axis", axis->axis, diagnostics_);
  if (direction.norm() < kShortestAxis) {
    diagnostics_->AddError(element->line, fmt::format("joint '{}': <{}> has an axis of length 0",
                                                      joint_.name, OsimName(*element)));
    return;
  }
  axis->axis = direction.normalized();
  const std::vector<std::string> names = Words(OsimText(*element, "coordinates"));
  bool is_pure = false;
  axis->value =
      ReadOsimFunction(FindOsimObject(*element, "function"), names, true, &is_pure, diagnostics_);
  for (const std::string& name : names) {
    OsimCoordinate* coordinate = Use(name);
    if (!is_pure) continue;
    coordinate->motion_type =
        is_turn ? OsimMotionType::kRotational : OsimMotionType::kTranslational;
  }
}

void JointReader::ReadCustom() {
  const XmlElement* transform = element_.FindChild("SpatialTransform");
  if (transform == nullptr) {
    const bool is_old = element_.FindChild("TransformAxisSet") != nullptr;
    diagnostics_->AddError(
        element_.line, fmt::format("joint '{}' has no <SpatialTransform>{}", joint_.name,
                                   is_old ? ", but a <TransformAxisSet>, of which OpenSim 2 and "
                                            "later make one when they save the model"
                                          : ""));
    return;
  }
  for (int i = 0; i < 3; ++i) {
    ReadTransformAxis(FindOsimObject(*transform, fmt::format("rotation{}", i + 1)), true,
                      &joint_.rotations[i]);
  }
  for (int i = 0; i < 3; ++i) {
    ReadTransformAxis(FindOsimObject(*transform, fmt::format("translation{}", i + 1)), false,
                      &joint_.translations[i]);
  }
  for (const OsimCoordinate& unused : listed_) Use(unused.name);
}

}  // namespace

OsimJoint ReadOsimJoint(const XmlElement& element, OsimDocument* document,
                        Diagnostics* diagnostics) {
  return JointReader(element, document, diagnostics).Read();
}

bool IsOsimJointName(std::string_view name) { return ToLower(name).ends_with("joint"); }

}  // namespace mmm_converter
