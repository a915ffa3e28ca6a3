// SPDX-License-Identifier: MIT
#include "common/io/mjcf/mjcf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "common/io/mjcf/mjcf_geom.h"
#include "common/io/mjcf/mjcf_meshes.h"
#include "common/io/mjcf/mjcf_values.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMaxJointsOfBody = 6;
constexpr double kShortestAxis = 1e-9;
constexpr double kLeastVolume = 0.1;  // of three axes that span space

class MjcfDocumentReader {
 public:
  explicit MjcfDocumentReader(MjcfText* text)
      : text_(*text),
        defaults_(text),
        settings_(ReadMjcfSettings(defaults_, text)),
        meshes_(defaults_, settings_, text) {}

  MjcfDocument Read();

 private:
  /// Where an element stands.
  struct Place {
    int body = -1;                                           // -1: the world
    Eigen::Isometry3d X_BF = Eigen::Isometry3d::Identity();  // of the frame around it
    int childclass = 0;
  };
  /// What the geoms and the `<inertial>` of a body say of its mass.
  struct Masses {
    std::optional<MjcfMass> inertial;
    MjcfMass of_geoms;
    bool has_unknown = false;  // meshes
  };

  MjcfAttributes Attributes(const XmlElement& element, int of_class) {
    return {element, of_class, defaults_, settings_, &text_};
  }
  MjcfAttributes Attributes(const XmlElement& element) { return Attributes(element, -1); }
  MjcfBody& BodyAt(int index) { return document_.bodies[static_cast<std::size_t>(index)]; }

  void ReadChildren(const XmlElement& element, const Place& place, Masses* masses);
  void ReadPart(const XmlElement& element, const Place& place, Masses* masses);
  void ReadBody(const XmlElement& element, const Place& place);
  void ReadFrame(const XmlElement& element, Place place, Masses* masses);
  void ReadJoint(const XmlElement& element, const Place& place);
  void FreeRoot(MjcfBody* body);
  void ReadRange(const MjcfAttributes& attributes, const XmlElement& element, MjcfJoint* joint);
  void ReadGeom(const XmlElement& element, const Place& place, Masses* masses);
  void ReadSite(const XmlElement& element, const Place& place);
  void CountShape(const XmlElement& element);
  void SetMass(const Masses& masses, MjcfBody* body);
  void ScaleMasses();
  void ReadEquality(const XmlElement& element);
  std::string TiedBody(const MjcfAttributes& attributes, const std::string& which) const;
  std::string NameOf(const XmlElement& element, const char* kind, std::size_t number,
                     std::set<std::string>* taken);

  MjcfText& text_;
  MjcfDefaults defaults_;
  MjcfSettings settings_;
  MjcfMeshes meshes_;
  MjcfDocument document_;
  std::set<std::string> body_names_{"world"}, joint_names_, site_names_;
  std::vector<std::string> without_mass_;
  std::vector<ContactShape> looks_;  // of geoms that touch nothing
  std::size_t num_joints_ = 0, num_shapes_ = 0;
};

/// Elements without a name are called by their number, from 1, as others would see them.
std::string MjcfDocumentReader::NameOf(const XmlElement& element, const char* kind,
                                       std::size_t number, std::set<std::string>* taken) {
  const std::string* given = element.FindAttribute("name");
  std::string name = given == nullptr ? "" : *given;
  if (name.empty()) {
    name = fmt::format("{}_{}", kind, number);
    while (taken->count(name) > 0) name += "_";
  } else if (taken->count(name) > 0) {
    text_.Fail(element,
               fmt::format("<{} name=\"{}\">: a second one of that name", element.name, name));
  }
  taken->insert(name);
  return name;
}

void MjcfDocumentReader::ReadChildren(const XmlElement& element, const Place& place,
                                      Masses* masses) {
  for (const XmlElement& child : element.children) ReadPart(child, place, masses);
}

void MjcfDocumentReader::ReadPart(const XmlElement& element, const Place& place, Masses* masses) {
  const std::string kind = ToLower(element.name);
  if (kind == "body") {
    ReadBody(element, place);
  } else if (kind == "frame") {
    ReadFrame(element, place, masses);
  } else if (kind == "attach" || kind == "replicate" || kind == "composite" || kind == "flexcomp") {
    text_.Fail(element, fmt::format("<{}> makes bodies and is not read; save the model with "
                                    "MuJoCo, which writes them out",
                                    kind));
  } else if (kind == "camera" || kind == "light" || kind == "plugin" || place.body < 0) {
    // nothing of a robot
  } else if (kind == "joint" || kind == "freejoint") {
    ReadJoint(element, place);
  } else if (kind == "geom") {
    ReadGeom(element, place, masses);
  } else if (kind == "site") {
    ReadSite(element, place);
  } else if (kind == "inertial") {
    masses->inertial = ReadMjcfInertial(Attributes(element), place.X_BF, element, &text_);
  } else {
    text_.Fail(element, fmt::format("<{}> in a body is not known", element.name));
  }
}

void MjcfDocumentReader::ReadFrame(const XmlElement& element, Place place, Masses* masses) {
  place.childclass = defaults_.ClassOf(element, place.childclass, "childclass");
  place.X_BF = place.X_BF * Attributes(element).Pose();
  ReadChildren(element, place, masses);
}

void MjcfDocumentReader::ReadBody(const XmlElement& element, const Place& place) {
  if (document_.bodies.size() >= kMaxMjcfBodies) {
    text_.Fail(element,
               fmt::format("has more than the {} bodies that are read at most", kMaxMjcfBodies));
    text_.ThrowIfErrors();
  }
  const MjcfAttributes attributes = Attributes(element);
  Place inside;
  inside.body = static_cast<int>(document_.bodies.size());
  inside.childclass = defaults_.ClassOf(element, place.childclass, "childclass");
  MjcfBody& body = document_.bodies.emplace_back();
  body.name = NameOf(element, "body", document_.bodies.size(), &body_names_);
  body.line = element.line;
  body.parent = place.body;
  body.X_PB = place.X_BF * attributes.Pose();
  body.is_moved = attributes.Word("mocap", "false") == "true";
  Masses masses;
  ReadChildren(element, inside, &masses);
  if (place.body < 0) FreeRoot(&BodyAt(inside.body));
  SetMass(masses, &BodyAt(inside.body));
}

void MjcfDocumentReader::ReadJoint(const XmlElement& element, const Place& place) {
  const int of_class = defaults_.ClassOf(element, place.childclass, "class");
  const MjcfAttributes attributes = Attributes(element, of_class);
  MjcfBody& body = BodyAt(place.body);
  const std::string type = element.Is("freejoint") ? "free" : attributes.Word("type", "hinge");
  MjcfJoint joint;
  joint.line = element.line;
  joint.name = NameOf(element, "joint", ++num_joints_, &joint_names_);
  if (type == "free") {
    if (body.parent >= 0 || body.is_free || !body.joints.empty()) {
      text_.Fail(element, fmt::format("joint '{}': a free joint must be the only one of a body of "
                                      "the world",
                                      joint.name));
    }
    body.is_free = true;
    return;
  }
  if (type != "hinge" && type != "slide") {
    text_.Fail(element, fmt::format("joint '{}': of type \"{}\", which is not read{}", joint.name,
                                    type, type == "ball" ? "; use three hinges" : ""));
    return;
  }
  joint.slides = type == "slide";
  if (body.is_free || body.joints.size() >= kMaxJointsOfBody) {
    text_.Fail(element, fmt::format("joint '{}': body '{}' has more than 6 degrees of freedom",
                                    joint.name, body.name));
    return;
  }
  joint.anchor = place.X_BF * attributes.Vector("pos", Eigen::Vector3d::Zero());
  const Eigen::Vector3d axis = attributes.Vector("axis", Eigen::Vector3d::UnitZ());
  if (axis.norm() < kShortestAxis) {
    text_.Fail(element, fmt::format("joint '{}': its axis has no direction", joint.name));
  } else {
    joint.axis = place.X_BF.linear() * axis.normalized();
  }
  ReadRange(attributes, element, &joint);
  body.joints.push_back(std::move(joint));
}

/// Three slides and three hinges of a body of the world are as good as a free joint.
void MjcfDocumentReader::FreeRoot(MjcfBody* body) {
  const auto slides = std::count_if(body->joints.begin(), body->joints.end(),
                                    [](const MjcfJoint& joint) { return joint.slides; });
  if (body->joints.size() != kMaxJointsOfBody || slides != 3) return;
  const bool carries_joints =
      std::any_of(document_.bodies.begin() + (body - document_.bodies.data()) + 1,
                  document_.bodies.end(), [](const MjcfBody& one) { return !one.joints.empty(); });
  if (!carries_joints) return;
  Eigen::Matrix3d ways[2];
  std::array<int, 2> counts = {0, 0};
  for (const MjcfJoint& joint : body->joints) {
    const std::size_t kind = joint.slides ? 0 : 1;
    ways[kind].col(counts[kind]++) = joint.axis;
  }
  if (std::abs(ways[0].determinant()) < kLeastVolume) return;
  if (std::abs(ways[1].determinant()) < kLeastVolume) return;
  text_.Warn(
      fmt::format("the three slides and three hinges of '{}' ({} to {}) are one free joint: "
                  "files of the robot's motion have a position and a quaternion",
                  body->name, body->joints.front().name, body->joints.back().name));
  body->joints.clear();
  body->is_free = true;
}

void MjcfDocumentReader::ReadRange(const MjcfAttributes& attributes, const XmlElement& element,
                                   MjcfJoint* joint) {
  const double unit = joint->slides ? 1 : settings_.angle;
  joint->ref = unit * attributes.Number("ref", 0);
  const auto range = attributes.Numbers("range", 2, 2);
  if (range) {
    joint->lower = unit * (*range)[0];
    joint->upper = unit * (*range)[1];
  }
  const auto effort = attributes.Numbers("actuatorfrcrange", 2, 2);
  if (effort && attributes.Word("actuatorfrclimited", "auto") != "false") {
    joint->effort = effort->cwiseAbs().maxCoeff();
  }
  const bool is_range = joint->lower < joint->upper;
  const std::string limited = attributes.Word("limited", "auto");
  joint->is_limited =
      limited == "true" || (limited != "false" && settings_.limits_by_range && is_range);
  if (joint->is_limited && !is_range) {
    text_.Fail(element, fmt::format("joint '{}': its range is crossed or empty: {:g} to {:g}",
                                    joint->name, joint->lower, joint->upper));
  } else if (is_range && limited == "auto" && !settings_.limits_by_range) {
    text_.Warn(element, fmt::format("joint '{}': its range does not count, as autolimits is "
                                    "\"false\" and it does not say limited",
                                    joint->name));
  }
}

void MjcfDocumentReader::CountShape(const XmlElement& element) {
  if (++num_shapes_ <= kMaxMjcfShapes) return;
  text_.Fail(element, fmt::format("has more than {} shapes and sites", kMaxMjcfShapes));
  text_.ThrowIfErrors();
}

void MjcfDocumentReader::ReadGeom(const XmlElement& element, const Place& place, Masses* masses) {
  CountShape(element);
  const int of_class = defaults_.ClassOf(element, place.childclass, "class");
  const MjcfAttributes attributes = Attributes(element, of_class);
  MjcfGeom geom = ReadMjcfGeom(attributes, place.X_BF, element, &text_);
  if (geom.shape) {
    geom.shape->segment = place.body;
    (geom.touches ? document_.shapes : looks_).push_back(*geom.shape);
  } else if (attributes.Find("mesh") != nullptr) {
    meshes_.Add(attributes, place.X_BF * attributes.Pose(), geom.touches, place.body, element,
                &document_.meshes);
  }
  const double group = attributes.Number("group", 0);
  if (group < settings_.inertia_groups[0] || group > settings_.inertia_groups[1]) return;
  geom.mass ? masses->of_geoms.Add(*geom.mass) : void(masses->has_unknown = true);
}

void MjcfDocumentReader::ReadSite(const XmlElement& element, const Place& place) {
  CountShape(element);
  const int of_class = defaults_.ClassOf(element, place.childclass, "class");
  const MjcfAttributes attributes = Attributes(element, of_class);
  Robot::Site& site = document_.sites.emplace_back();
  site.name = NameOf(element, "site", document_.sites.size(), &site_names_);
  site.segment = place.body;
  site.X_SP = place.X_BF * attributes.Pose();
  if (const auto ends = attributes.Numbers("fromto", 6, 6)) {
    site.X_SP.translation() =
        place.X_BF * Eigen::Vector3d(0.5 * (ends->head<3>() + ends->tail<3>()));
  }
}

void MjcfDocumentReader::SetMass(const Masses& masses, MjcfBody* body) {
  using Inertia = MjcfSettings::Inertia;
  const bool by_geoms = settings_.inertia == Inertia::kFromGeoms ||
                        (settings_.inertia == Inertia::kAuto && !masses.inertial);
  if (by_geoms && masses.has_unknown) without_mass_.push_back(body->name);
  const MjcfMass mass = by_geoms ? masses.of_geoms : masses.inertial.value_or(MjcfMass{});
  body->mass = mass.mass;
  body->p_BC = mass.p_BC;
  body->inertia = 0.5 * (mass.inertia + mass.inertia.transpose());
}

void MjcfDocumentReader::ScaleMasses() {
  double sum = 0;
  for (const MjcfBody& body : document_.bodies) sum += body.mass;
  if (settings_.total_mass <= 0 || sum <= 0) return;
  for (MjcfBody& body : document_.bodies) {
    body.mass *= settings_.total_mass / sum;
    body.inertia *= settings_.total_mass / sum;
  }
}

/// The body that an <equality> names, itself or by a site of it; empty: none.
std::string MjcfDocumentReader::TiedBody(const MjcfAttributes& attributes,
                                         const std::string& which) const {
  const std::string site = attributes.Word("site" + which, "");
  for (const Robot::Site& one : document_.sites) {
    if (!site.empty() && one.name == site && one.segment >= 0) {
      return document_.bodies[one.segment].name;
    }
  }
  return attributes.Word("body" + which, "");
}

/// Joints that follow others. What else is equal closes loops of bodies or tendons.
void MjcfDocumentReader::ReadEquality(const XmlElement& element) {
  const MjcfAttributes attributes = Attributes(element);
  if (attributes.Word("active", "true") == "false" || element.Is("flex")) return;
  if (!element.Is("joint")) {
    text_.Warn(element, fmt::format("<equality><{}> is not kept: what it ties together moves apart",
                                    element.name));
    document_.ties.push_back({TiedBody(attributes, "1"), TiedBody(attributes, "2")});
    return;
  }
  MjcfCoupling coupling;
  coupling.follower = attributes.Word("joint1", "");
  coupling.leader = attributes.Word("joint2", "");
  if (const auto numbers = attributes.Numbers("polycoef", 1, 5)) {
    for (Eigen::Index i = 0; i < numbers->size(); ++i) {
      coupling.polynomial[static_cast<std::size_t>(i)] = (*numbers)[i];
    }
  }
  const auto is_known = [&](const std::string& joint) {
    if (joint_names_.count(joint) > 0) return true;
    text_.Fail(element, fmt::format("<equality><joint>: there is no joint '{}'", joint));
    return false;
  };
  if (!is_known(coupling.follower)) return;
  if (!coupling.leader.empty() && !is_known(coupling.leader)) return;
  document_.couplings.push_back(std::move(coupling));
}

MjcfDocument MjcfDocumentReader::Read() {
  const std::string* name = text_.root().FindAttribute("model");
  if (name != nullptr) document_.name = *name;
  for (const XmlElement* world : text_.root().FindChildren("worldbody")) {
    ReadChildren(*world, {}, nullptr);
  }
  for (const XmlElement* equality : text_.root().FindChildren("equality")) {
    for (const XmlElement& child : equality->children) ReadEquality(child);
  }
  ScaleMasses();
  const bool has_meshes = std::any_of(document_.meshes.begin(), document_.meshes.end(),
                                      [](const RobotMesh& mesh) { return mesh.touches; });
  if (document_.shapes.empty() && !has_meshes && !looks_.empty()) {
    text_.Warn(
        "no geom of it touches anything (contype and conaffinity are 0), so all its boxes, "
        "spheres, capsules and cylinders count as touching");
    document_.shapes = std::move(looks_);
  }
  if (!without_mass_.empty()) {
    text_.Warn(fmt::format("the masses of meshes are not known, so those of {} are not whole",
                           FirstNames(without_mass_)));
  }
  text_.ThrowIfErrors();
  return std::move(document_);
}

}  // namespace

MjcfDocument ReadMjcfDocument(MjcfText* text) { return MjcfDocumentReader(text).Read(); }

}  // namespace mmm_converter
