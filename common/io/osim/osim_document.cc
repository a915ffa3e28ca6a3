// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "common/io/osim/osim_frames.h"
#include "common/io/osim/osim_values.h"
#include "common/io/osim/osim_xml.h"
#include "common/io/xml/xml_document.h"
#include "common/support/error.h"
#include "common/support/error_of_file.h"
#include "common/support/text.h"

namespace mmm_converter {

using Eigen::Matrix3d;
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

/// The coordinates that the joint's element lists, in either layout.
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

/// Reads a joint of either layout, but for the frames, and appends its coordinates to the
/// document's. @throws nothing; errors are of the diagnostics.
OsimJoint ReadOsimJoint(const XmlElement& element, OsimDocument* document,
                        Diagnostics* diagnostics) {
  return JointReader(element, document, diagnostics).Read();
}

/// Whether an element is a joint of a kind that is not read: "ScapulothoracicJoint".
bool IsOsimJointName(std::string_view name) { return ToLower(name).ends_with("joint"); }

constexpr std::size_t kMostMarkers = 4096;
constexpr const char* kGround = "ground";

/// Nothing: it is no marker, or, with an error, hangs on nothing.
std::optional<OsimMarker> ReadMarker(const XmlElement& element, OsimFrames* frames,
                                     Diagnostics* diagnostics) {
  if (!element.Is("Marker")) return std::nullopt;
  OsimMarker marker;
  marker.name = OsimName(element);
  marker.line = element.line;
  const XmlElement* body = element.FindChild("body");
  const auto place =
      frames->Find("/markerset/" + marker.name,
                   body != nullptr ? body->text : OsimText(element, "socket_parent_frame"),
                   element.line, fmt::format("marker '{}'", marker.name));
  if (!place) return std::nullopt;
  if (marker.name.empty()) diagnostics->AddError(element.line, "a marker has no name");
  marker.body = place->body;
  marker.p_BM = place->X_BF * ReadOsimVector(element, "location", Vector3d::Zero(), diagnostics);
  marker.is_fixed = ReadOsimFlag(element, "fixed", false, diagnostics);
  return marker;
}

/// The elements of a set of the model, in a file of its own or not.
class OsimReader {
 public:
  OsimReader(const OsimPartReader& read_part, Diagnostics* diagnostics)
      : read_part_(read_part), diagnostics_(diagnostics), frames_(diagnostics) {}

  OsimDocument Read(const XmlElement& root);

 private:
  void ReadBodies(const XmlElement& model);
  OsimBody ReadBody(const XmlElement& element);
  void ReadOldJoint(const XmlElement& body, int child);
  void ReadFrames(const XmlElement& model);
  void ReadJoints(const XmlElement& model);
  void ReadConstraints(const XmlElement& model);
  void ReadConstraint(const XmlElement& element);
  void ReadMarkers(const XmlElement& model);
  void CountForces(const XmlElement& model);
  void RefuseInComponents(const XmlElement& owner);
  void CheckNames();

  /// Calls visit for each object of a set.
  template <typename Visit>
  void ForEach(const XmlElement& model, const char* set, const Visit& visit);

  bool IsOld() const { return document_.version < 40000; }
  void Fail(int line, const std::string& what) { diagnostics_->AddError(line, what); }
  int FindBody(std::string_view name) const {
    const auto found = body_of_name_.find(std::string(name));
    return found == body_of_name_.end() ? -1 : found->second;
  }

  const OsimPartReader& read_part_;
  Diagnostics* diagnostics_;
  OsimDocument document_;
  OsimFrames frames_;
  std::map<std::string, int> body_of_name_;
};

template <typename Visit>
void OsimReader::ForEach(const XmlElement& model, const char* set, const Visit& visit) {
  const XmlElement* element = model.FindChild(set);
  if (element == nullptr) return;
  std::optional<XmlElement> part;
  if (const std::string* file = element->FindAttribute("file"); file != nullptr && !file->empty()) {
    if (!read_part_) {
      Fail(element->line,
           fmt::format("<{}> stands in another file, {}, which can't be read here", set, *file));
      return;
    }
    part = NamedBy(fmt::format("{}:{}", diagnostics_->file(), element->line),
                   [&] { return ParseOsimPart(read_part_(*file), *file, set); });
    element = &*part;
  }
  const XmlElement* objects = element->FindChild("objects");
  if (objects == nullptr) return;
  for (const XmlElement& object : objects->children) visit(object);
}

OsimBody OsimReader::ReadBody(const XmlElement& element) {
  OsimBody body;
  body.name = OsimName(element);
  body.line = element.line;
  if (body.name.empty()) Fail(element.line, "a body has no name");
  body.mass = ReadOsimNumber(element, "mass", 0, diagnostics_);
  if (body.mass < 0) Fail(element.line, fmt::format("body '{}' has a negative mass", body.name));
  body.p_BC = ReadOsimVector(element, "mass_center", Vector3d::Zero(), diagnostics_);
  std::vector<double> I;
  if (IsOld()) {
    for (const char* moment : {"inertia_xx", "inertia_yy", "inertia_zz"}) {
      I.push_back(ReadOsimNumber(element, moment, 1, diagnostics_));
    }
    for (const char* product : {"inertia_xy", "inertia_xz", "inertia_yz"}) {
      I.push_back(ReadOsimNumber(element, product, 0, diagnostics_));
    }
  } else {
    I = ReadOsimNumbers(element, "inertia", 6, {0, 0, 0, 0, 0, 0}, diagnostics_);
  }
  body.inertia << I[0], I[3], I[4], I[3], I[1], I[5], I[4], I[5], I[2];
  return body;
}

void OsimReader::ReadBodies(const XmlElement& model) {
  OsimBody ground;
  ground.name = kGround;
  document_.bodies.push_back(ground);
  body_of_name_[kGround] = 0;
  frames_.AddBody("/ground", 0);
  ForEach(model, "BodySet", [&](const XmlElement& element) {
    if (!element.Is("Body")) {
      Fail(element.line, fmt::format("<{}> in the <BodySet> is not read", element.name));
      return;
    }
    OsimBody body = ReadBody(element);
    if (IsOld() && body.name == kGround) return;
    const int index = static_cast<int>(document_.bodies.size());
    if (document_.bodies.size() > kMaxOsimBodies) {
      throw Error(fmt::format("{}: has more than the {} bodies that are read", diagnostics_->file(),
                              kMaxOsimBodies));
    }
    if (!body_of_name_.emplace(body.name, index).second) {
      Fail(body.line, fmt::format("body '{}' is there twice", body.name));
    }
    frames_.AddBody("/bodyset/" + body.name, index);
    document_.bodies.push_back(std::move(body));
  });
}

void OsimReader::ReadOldJoint(const XmlElement& body, int child) {
  const XmlElement* holder = body.FindChild("Joint");
  if (holder == nullptr || holder->children.empty()) return;
  const XmlElement& element = holder->children.front();
  OsimJoint joint = ReadOsimJoint(element, &document_, diagnostics_);
  const std::string_view parent = OsimText(element, "parent_body");
  joint.child = child;
  joint.parent = FindBody(parent);
  if (joint.parent < 0) {
    Fail(element.line, fmt::format("joint '{}' hangs on \"{:.80}\", which is no body of the model",
                                   joint.name, parent));
    return;
  }
  if (ReadOsimFlag(element, "reverse", false, diagnostics_)) {
    Fail(element.line, fmt::format("joint '{}' is reversed, which is not read", joint.name));
  }
  joint.X_PF = ReadOsimPose(element, "location_in_parent", "orientation_in_parent", diagnostics_);
  joint.X_CM = ReadOsimPose(element, "location", "orientation", diagnostics_);
  document_.joints.push_back(std::move(joint));
}

void OsimReader::ReadFrames(const XmlElement& model) {
  if (const XmlElement* ground = model.FindChild("Ground")) {
    frames_.AddOffsetFrames("/ground", *ground, "components");
    RefuseInComponents(*ground);
  }
  frames_.AddOffsetFrames("", model, "components");
  RefuseInComponents(model);
  ForEach(model, "ComponentSet", [&](const XmlElement& element) {
    if (element.Is("PhysicalOffsetFrame")) frames_.AddOffsetFrame("/componentset", element);
  });
  ForEach(model, "BodySet", [&](const XmlElement& element) {
    frames_.AddOffsetFrames("/bodyset/" + OsimName(element), element, "components");
    RefuseInComponents(element);
  });
  ForEach(model, "JointSet", [&](const XmlElement& element) {
    frames_.AddOffsetFrames("/jointset/" + OsimName(element), element, "frames");
  });
}

/// What moves bodies is only read where it belongs.
void OsimReader::RefuseInComponents(const XmlElement& owner) {
  const XmlElement* components = owner.FindChild("components");
  if (components == nullptr) return;
  for (const XmlElement& one : components->children) {
    if (!IsOsimJointName(one.name) && !one.Is("Body") &&
        !ToLower(one.name).ends_with("constraint")) {
      continue;
    }
    Fail(one.line, fmt::format("<{} name=\"{}\"> in <components> is not read; what moves must be "
                               "in <BodySet>, <JointSet> or <ConstraintSet>",
                               one.name, OsimName(one)));
  }
}

void OsimReader::ReadJoints(const XmlElement& model) {
  if (IsOld()) {
    ForEach(model, "BodySet", [&](const XmlElement& element) {
      const int child = FindBody(OsimName(element));
      if (child > 0) ReadOldJoint(element, child);
    });
    return;
  }
  ReadFrames(model);
  ForEach(model, "JointSet", [&](const XmlElement& element) {
    if (document_.joints.size() > kMaxOsimBodies) {
      throw Error(fmt::format("{}: has more than the {} joints that are read", diagnostics_->file(),
                              kMaxOsimBodies));
    }
    OsimJoint joint = ReadOsimJoint(element, &document_, diagnostics_);
    const std::string owner = "/jointset/" + joint.name;
    const std::string what = fmt::format("joint '{}'", joint.name);
    const auto parent =
        frames_.Find(owner, OsimText(element, "socket_parent_frame"), element.line, what);
    const auto child =
        frames_.Find(owner, OsimText(element, "socket_child_frame"), element.line, what);
    if (!parent || !child) return;
    joint.parent = parent->body;
    joint.X_PF = parent->X_BF;
    joint.child = child->body;
    joint.X_CM = child->X_BF;
    document_.joints.push_back(std::move(joint));
  });
}

void OsimReader::ReadConstraint(const XmlElement& element) {
  const bool is_enforced = ReadOsimFlag(element, "isEnforced", true, diagnostics_) &&
                           !ReadOsimFlag(element, "isDisabled", false, diagnostics_);
  if (!is_enforced) return;
  if (!element.Is("CoordinateCouplerConstraint")) {
    Fail(element.line, fmt::format("constraint '{}' is a {}, which is not read; only "
                                   "CoordinateCouplerConstraint is",
                                   OsimName(element), element.name));
    return;
  }
  OsimCoupler coupler;
  coupler.name = OsimName(element);
  coupler.line = element.line;
  coupler.dependent = std::string(OsimText(element, "dependent_coordinate_name"));
  coupler.value = ReadOsimFunction(FindOsimObject(element, "coupled_coordinates_function"),
                                   Words(OsimText(element, "independent_coordinate_names")), false,
                                   nullptr, diagnostics_);
  const double scale = ReadOsimNumber(element, "scale_factor", 1, diagnostics_);
  coupler.value.constant *= scale;
  for (auto& term : coupler.value.terms) term.function = term.function.Scaled(scale);
  document_.couplers.push_back(std::move(coupler));
}

void OsimReader::ReadConstraints(const XmlElement& model) {
  ForEach(model, "ConstraintSet", [&](const XmlElement& element) { ReadConstraint(element); });
}

void OsimReader::ReadMarkers(const XmlElement& model) {
  std::set<std::string> names;
  ForEach(model, "MarkerSet", [&](const XmlElement& element) {
    std::optional<OsimMarker> marker = ReadMarker(element, &frames_, diagnostics_);
    if (!marker) return;
    if (document_.markers.size() >= kMostMarkers) {
      throw Error(fmt::format("{}:{}: has more than the {} markers that are read",
                              diagnostics_->file(), element.line, kMostMarkers));
    }
    if (names.insert(marker->name).second) {
      document_.markers.push_back(std::move(*marker));
      return;
    }
    diagnostics_->AddWarning(
        element.line,
        fmt::format("marker '{}' is there twice; the first one is taken", marker->name),
        "such markers");
  });
}

void OsimReader::CountForces(const XmlElement& model) {
  const XmlElement* set = model.FindChild("ForceSet");
  const XmlElement* objects = set == nullptr ? nullptr : set->FindChild("objects");
  if (objects == nullptr) return;
  for (const XmlElement& force : objects->children) {
    ++document_.num_forces;
    document_.num_muscles += ToLower(force.name).find("muscle") != std::string::npos ? 1 : 0;
  }
}

void OsimReader::CheckNames() {
  std::map<std::string, int> lines;
  for (const OsimCoordinate& one : document_.coordinates) {
    if (lines.emplace(one.name, one.line).second) continue;
    Fail(one.line, fmt::format("coordinate '{}' is there twice; the first is in line {}", one.name,
                               lines[one.name]));
  }
}

OsimDocument OsimReader::Read(const XmlElement& root) {
  document_.version = ReadOsimVersion(root, diagnostics_->file());
  const XmlElement* model = root.FindChild("Model");
  if (model == nullptr) {
    throw Error(
        fmt::format("{}:{}: <{}> holds no <Model>", diagnostics_->file(), root.line, root.name));
  }
  document_.name = OsimName(*model);
  document_.gravity = ReadOsimVector(*model, "gravity", document_.gravity, diagnostics_);
  ReadBodies(*model);
  ReadJoints(*model);
  ReadConstraints(*model);
  ReadMarkers(*model);
  CountForces(*model);
  CheckNames();
  diagnostics_->ThrowIfErrors();
  return std::move(document_);
}

}  // namespace

OsimDocument ParseOsim(std::string_view content, const OsimPartReader& read_part,
                       Diagnostics* diagnostics) {
  return OsimReader(read_part, diagnostics).Read(ParseOsimXml(content, diagnostics->file()));
}

void AddOsimMarkers(std::string_view content, const std::string& file, OsimDocument* document,
                    Warnings* warnings) {
  Diagnostics diagnostics(file, warnings);
  const XmlElement set = ParseOsimPart(content, file, "MarkerSet");
  const XmlElement* objects = set.FindChild("objects");
  OsimFrames frames(&diagnostics);
  for (std::size_t i = 0; i < document->bodies.size(); ++i) {
    const std::string& name = document->bodies[i].name;
    frames.AddBody(i == 0 ? "/ground" : "/bodyset/" + name, static_cast<int>(i));
  }
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < document->markers.size(); ++i) index[document->markers[i].name] = i;
  if (objects == nullptr) return;
  for (const XmlElement& element : objects->children) {
    std::optional<OsimMarker> marker = ReadMarker(element, &frames, &diagnostics);
    if (!marker) continue;
    const auto [known, is_new] = index.emplace(marker->name, document->markers.size());
    if (is_new && index.size() > kMostMarkers) {
      throw Error(fmt::format("{}:{}: with it the model has more than the {} markers that are read",
                              file, element.line, kMostMarkers));
    }
    if (is_new) {
      document->markers.push_back(std::move(*marker));
    } else {
      document->markers[known->second] = std::move(*marker);
    }
  }
  diagnostics.ThrowIfErrors();
}

}  // namespace mmm_converter
