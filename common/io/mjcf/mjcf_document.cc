// SPDX-License-Identifier: MIT
#include "common/io/mjcf/mjcf_document.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/io/mjcf/mjcf_values.h"
#include "common/model/body_bounds.h"
#include "common/model/inertia_check.h"
#include "common/model/robot.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

using Kind = ContactShape::Kind;

/// A mass and how it is spread, in the axes of a body.
struct MjcfMass {
  double mass = 0;                                    ///< [kg]
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();     ///< its centre [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about it [kg m^2]

  void Add(const MjcfMass& other);
};

struct MjcfGeom {
  bool touches = true;                ///< not only looked at
  std::optional<ContactShape> shape;  ///< `segment` is not set; nothing: a mesh or the like
  std::optional<MjcfMass> mass;       ///< nothing: of a mesh, whose size is not known
};

constexpr double kDensity = 1000;  // [kg/m^3], MuJoCo's default

struct KindOfGeom {
  Kind kind;
  int sizes;         // numbers of `size`
  int sizes_beside;  // beside fromto; 0: has none
};

const std::map<std::string, KindOfGeom, std::less<>> kKinds = {
    {"sphere", {Kind::kSphere, 1, 0}},
    {"capsule", {Kind::kCapsule, 2, 1}},
    {"cylinder", {Kind::kCylinder, 2, 1}},
    {"ellipsoid", {Kind::kEllipsoid, 3, 1}},
    {"box", {Kind::kBox, 3, 1}}};

void SetSizes(Kind kind, const Eigen::Vector3d& size, ContactShape* shape) {
  shape->kind = kind;
  if (kind == Kind::kBox || kind == Kind::kEllipsoid) {
    shape->half = size;
  } else {
    shape->radius = size[0];
    if (kind != Kind::kSphere) shape->half_length = size[1];
  }
}

/// By `fromto`, the ends of the axis: its pose, and its half length.
std::optional<double> PlaceBetween(const MjcfAttributes& attributes, const XmlElement& element,
                                   MjcfText* text, Eigen::Isometry3d* X) {
  const auto ends = attributes.Numbers("fromto", 6, 6);
  if (!ends) return {};
  const Eigen::Vector3d way = ends->head<3>() - ends->tail<3>();  // MuJoCo's sense
  if (way.norm() < 1e-9) {
    text->Fail(element, fmt::format("<{}>: the ends of its fromto are one point", element.name));
    return {};
  }
  *X = Eigen::Translation3d(0.5 * (ends->head<3>() + ends->tail<3>())) * TurnOfZ(way);
  return 0.5 * way.norm();
}

std::optional<ContactShape> ReadPrimitive(const MjcfAttributes& attributes, const KindOfGeom& kind,
                                          const XmlElement& element, MjcfText* text) {
  ContactShape shape;
  const bool is_between = attributes.Find("fromto") != nullptr;
  const int fewest = is_between ? kind.sizes_beside : kind.sizes;
  if (fewest == 0) {
    text->Fail(element, fmt::format("<{}>: a sphere has no fromto", element.name));
    return {};
  }
  const auto sizes = attributes.Numbers("size", fewest, 3);
  if (!sizes || sizes->head(fewest).minCoeff() <= 0) {
    text->Fail(element, fmt::format("<{}>: needs a size of {} {} above 0", element.name, fewest,
                                    fewest == 1 ? "number" : "numbers"));
    return {};
  }
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  size.head(sizes->size()) = *sizes;
  if (!is_between) {
    shape.X_SG = attributes.Pose();
  } else if (const auto half = PlaceBetween(attributes, element, text, &shape.X_SG)) {
    const bool is_thick = kind.kind == Kind::kBox || kind.kind == Kind::kEllipsoid;
    size = is_thick ? Eigen::Vector3d(size[0], size[0], *half) : Eigen::Vector3d(size[0], *half, 0);
  } else {
    return {};
  }
  SetSizes(kind.kind, size, &shape);
  return shape;
}

/// Volume [m^3], and the moments of inertia of a mass of 1 kg in the shape's axes.
double VolumeAndMoments(const ContactShape& shape, Eigen::Vector3d* moments) {
  const double r = shape.radius, h = shape.half_length;
  const auto round = [](double along, double across) {
    return Eigen::Vector3d(across, across, along);
  };
  const auto of_squares = [](const Eigen::Vector3d& s) {
    return Eigen::Vector3d(s.y() + s.z(), s.x() + s.z(), s.x() + s.y());
  };
  switch (shape.kind) {
    case Kind::kSphere:
      *moments = Eigen::Vector3d::Constant(0.4 * r * r);
      return 4 * EIGEN_PI / 3 * r * r * r;
    case Kind::kBox:
      *moments = of_squares(shape.half.cwiseAbs2()) / 3;
      return 8 * shape.half.prod();
    case Kind::kEllipsoid:
      *moments = of_squares(shape.half.cwiseAbs2()) / 5;
      return 4 * EIGEN_PI / 3 * shape.half.prod();
    case Kind::kCylinder:
      *moments = round(0.5 * r * r, (3 * r * r + 4 * h * h) / 12);
      return 2 * EIGEN_PI * r * r * h;
    case Kind::kCapsule: {
      // A cylinder and two half spheres, whose centres of mass are 3/8 r beyond its ends.
      const double cylinder = 2 * EIGEN_PI * r * r * h;
      const double caps = 4 * EIGEN_PI / 3 * r * r * r;
      const double whole = cylinder + caps;
      const double along = (0.5 * cylinder + 0.4 * caps) * r * r;
      const double across =
          cylinder * (3 * r * r + 4 * h * h) / 12 + caps * (0.4 * r * r + h * h + 0.75 * r * h);
      *moments = round(along, across) / whole;
      return whole;
    }
    case Kind::kHull:
      break;
  }
  return 0;
}

std::optional<MjcfMass> MassOf(const MjcfAttributes& attributes,
                               const std::optional<ContactShape>& shape, const XmlElement& element,
                               MjcfText* text) {
  const bool has_mass = attributes.Find("mass") != nullptr;
  const double given = attributes.Number("mass", 0);
  const double density = attributes.Number("density", kDensity);
  if (given < 0 || density < 0) {
    text->Fail(element, fmt::format("<{}>: its mass or density is below 0", element.name));
    return MjcfMass{};
  }
  if (!shape) {
    if (has_mass ? given == 0 : density == 0) return MjcfMass{};
    return {};
  }
  MjcfMass mass;
  Eigen::Vector3d moments;
  const double volume = VolumeAndMoments(*shape, &moments);
  mass.mass = has_mass ? given : density * volume;
  mass.p_BC = shape->X_SG.translation();
  const Eigen::Matrix3d& R = shape->X_SG.linear();
  mass.inertia = R * (mass.mass * moments).asDiagonal() * R.transpose();
  return mass;
}

/// About a point at r from the centre of mass, less what it is about that.
Eigen::Matrix3d Steiner(double mass, const Eigen::Vector3d& r) {
  return mass * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
}

void MjcfMass::Add(const MjcfMass& other) {
  const double sum = mass + other.mass;
  if (other.mass <= 0 || sum <= 0) return;
  const Eigen::Vector3d center = (mass * p_BC + other.mass * other.p_BC) / sum;
  inertia +=
      other.inertia + Steiner(mass, p_BC - center) + Steiner(other.mass, other.p_BC - center);
  p_BC = center;
  mass = sum;
}

/// Reads a `<geom>`. X_BF: the frame around it in the body.
MjcfGeom ReadMjcfGeom(const MjcfAttributes& attributes, const Eigen::Isometry3d& X_BF,
                      const XmlElement& element, MjcfText* text) {
  MjcfGeom geom;
  geom.touches = attributes.Number("contype", 1) != 0 || attributes.Number("conaffinity", 1) != 0;
  const std::string type = attributes.Word("type", "sphere");
  const auto kind = kKinds.find(type);
  const bool is_of_mesh = attributes.Find("mesh") != nullptr;  // also a box fitted to one
  if (kind != kKinds.end() && !is_of_mesh) {
    geom.shape = ReadPrimitive(attributes, kind->second, element, text);
  } else if (!is_of_mesh && type != "mesh" && type != "sdf" && type != "hfield" &&
             type != "plane") {
    text->Fail(element, fmt::format("<{} type=\"{}\">: there is no such type", element.name, type));
  }
  if (geom.shape) geom.shape->X_SG = X_BF * geom.shape->X_SG;
  geom.mass = type == "plane" || type == "hfield" ? MjcfMass{}
                                                  : MassOf(attributes, geom.shape, element, text);
  return geom;
}

/// Reads an `<inertial>`.
MjcfMass ReadMjcfInertial(const MjcfAttributes& attributes, const Eigen::Isometry3d& X_BF,
                          const XmlElement& element, MjcfText* text) {
  MjcfMass mass;
  mass.mass = attributes.Number("mass", -1);
  if (mass.mass < 0) {
    text->Fail(element, "<inertial> needs a mass that is not below 0");
    return {};
  }
  const Eigen::Isometry3d X = X_BF * attributes.Pose();
  Eigen::Matrix3d I = Eigen::Matrix3d::Zero();
  if (const auto full = attributes.Numbers("fullinertia", 6, 6)) {
    const Eigen::VectorXd& f = *full;
    I << f[0], f[3], f[4], f[3], f[1], f[5], f[4], f[5], f[2];
  } else {
    I = attributes.Vector("diaginertia", Eigen::Vector3d::Zero()).asDiagonal();
  }
  if (!IsWithin(mass.mass, kHeaviestBody) || !IsWithin(I.cwiseAbs().maxCoeff(), kLargestInertia)) {
    text->Fail(element,
               fmt::format("<inertial>: a mass of at most {:g} kg and an inertia of at most "
                           "{:g} kg m^2 are expected",
                           kHeaviestBody, kLargestInertia));
    return {};
  }
  if (const std::string why_not = WhyNoInertia(I); !why_not.empty()) {
    text->Warn(element, "<inertial>: " + why_not);
  }
  mass.p_BC = X.translation();
  mass.inertia = X.linear() * I * X.linear().transpose();
  return mass;
}

/// The meshes of `<asset>`, by which geoms name them.
class MjcfMeshes {
 public:
  MjcfMeshes(const MjcfDefaults& defaults, const MjcfSettings& settings, MjcfText* text);

  /// Appends the mesh of a geom that names one; X_BG: of the geom in the body. One that is not
  /// among the assets is left out, with a warning.
  void Add(const MjcfAttributes& geom, const Eigen::Isometry3d& X_BG, bool touches, int body,
           const XmlElement& element, std::vector<RobotMesh>* meshes) const;

 private:
  MjcfText& text_;
  std::map<std::string, RobotMesh> by_name_;
};

/// As MuJoCo: less its reference, turned, and then scaled.
Eigen::Affine3d FrameOf(const MjcfAttributes& mesh) {
  Eigen::Affine3d A = Eigen::Affine3d::Identity();
  A.scale(mesh.Vector("scale", Eigen::Vector3d::Ones()));
  if (const auto q = mesh.Numbers("refquat", 4, 4)) {
    const Eigen::Quaterniond turn((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
    if (turn.norm() > 0) A.rotate(turn.normalized().conjugate());
  }
  A.translate(-mesh.Vector("refpos", Eigen::Vector3d::Zero()));
  return A;
}

MjcfMeshes::MjcfMeshes(const MjcfDefaults& defaults, const MjcfSettings& settings, MjcfText* text)
    : text_(*text) {
  for (const XmlElement* assets : text_.root().FindChildren("asset")) {
    for (const XmlElement* element : assets->FindChildren("mesh")) {
      const MjcfAttributes attributes(*element, defaults.ClassOf(*element, 0, "class"), defaults,
                                      settings, text);
      std::filesystem::path file = attributes.Word("file", "");
      std::string name = attributes.Word("name", file.stem().string());
      if (name.empty()) continue;
      if (settings.strips_paths) file = file.filename();
      RobotMesh mesh;
      if (!file.empty()) mesh.file = (std::filesystem::path(settings.mesh_folder) / file).string();
      mesh.A_SM = FrameOf(attributes);
      by_name_.emplace(std::move(name), std::move(mesh));
    }
  }
}

void MjcfMeshes::Add(const MjcfAttributes& geom, const Eigen::Isometry3d& X_BG, bool touches,
                     int body, const XmlElement& element, std::vector<RobotMesh>* meshes) const {
  const std::string name = geom.Word("mesh", "");
  if (name.empty()) return;
  const auto asset = by_name_.find(name);
  if (asset == by_name_.end()) {
    text_.Warn(element, fmt::format("<geom mesh=\"{}\">: no <mesh> of <asset> is called so", name));
    return;
  }
  RobotMesh& mesh = meshes->emplace_back(asset->second);
  mesh.segment = body;
  mesh.A_SM = X_BG * mesh.A_SM;
  mesh.touches = touches;
}

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
