// SPDX-License-Identifier: MIT
#include "common/io/urdf/urdf_document.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "common/io/xml/xml_document.h"
#include "common/io/xml/xml_text.h"
#include "common/model/body_bounds.h"
#include "common/model/inertia_check.h"
#include "common/support/diagnostics.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

std::optional<int> FloatingJoint(const UrdfDocument& document) {
  std::optional<int> floating;
  for (std::size_t i = 0; i < document.joints.size(); ++i) {
    if (document.joints[i].parent != document.root) continue;
    if (floating || document.joints[i].type != UrdfJointType::kFloating) return {};
    floating = static_cast<int>(i);
  }
  if (document.links[static_cast<std::size_t>(document.root)].mass != 0) return {};
  return floating;
}

void MoveUp(int removed, int* index) {
  if (*index > removed) --*index;
}

/// Where the root is a link without mass that only carries the next one by a floating joint, that
/// one becomes the root: the joint's origin is a start pose only.
void RemoveFloatingWorld(UrdfDocument* document) {
  const std::optional<int> floating = FloatingJoint(*document);
  if (!floating) return;
  const int world = document->root;
  document->root = document->joints[static_cast<std::size_t>(*floating)].child;
  document->links[static_cast<std::size_t>(document->root)].parent_joint = -1;
  document->links.erase(document->links.begin() + world);
  document->joints.erase(document->joints.begin() + *floating);
  MoveUp(world, &document->root);
  for (UrdfLink& link : document->links) MoveUp(*floating, &link.parent_joint);
  for (UrdfJoint& joint : document->joints) {
    MoveUp(world, &joint.parent);
    MoveUp(world, &joint.child);
  }
  std::erase_if(document->shapes, [&](const ContactShape& one) { return one.segment == world; });
  std::erase_if(document->meshes, [&](const RobotMesh& one) { return one.segment == world; });
  for (ContactShape& shape : document->shapes) MoveUp(world, &shape.segment);
  for (RobotMesh& mesh : document->meshes) MoveUp(world, &mesh.segment);
}

constexpr double kLargestSize = 100;  // [m]; beyond it the number is of another unit

/// So many finite numbers, or nothing.
std::optional<Eigen::VectorXd> Numbers(const XmlElement& element, const char* attribute,
                                       std::size_t count) {
  const std::string* text = element.FindAttribute(attribute);
  std::vector<double> numbers;
  if (text == nullptr || !AppendDoubles(*text, &numbers) || numbers.size() != count) return {};
  const bool is_sane = std::all_of(numbers.begin(), numbers.end(),
                                   [](double x) { return std::abs(x) <= kLargestSize; });
  if (!is_sane) return {};
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(),
                                           static_cast<Eigen::Index>(numbers.size()));
}

bool IsSize(const std::optional<Eigen::VectorXd>& size) {
  return size && size->minCoeff() >= 0 && size->maxCoeff() > 0;
}

/// R = Rz(yaw) Ry(pitch) Rx(roll).
std::optional<Eigen::Isometry3d> Origin(const XmlElement& collision) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  const XmlElement* origin = collision.FindChild("origin");
  if (origin == nullptr) return X;
  if (origin->FindAttribute("xyz") != nullptr) {
    const auto xyz = Numbers(*origin, "xyz", 3);
    if (!xyz) return {};
    X.translation() = *xyz;
  }
  if (origin->FindAttribute("rpy") != nullptr) {
    const auto rpy = Numbers(*origin, "rpy", 3);
    if (!rpy) return {};
    X.rotate(Eigen::AngleAxisd((*rpy)[2], Eigen::Vector3d::UnitZ()));
    X.rotate(Eigen::AngleAxisd((*rpy)[1], Eigen::Vector3d::UnitY()));
    X.rotate(Eigen::AngleAxisd((*rpy)[0], Eigen::Vector3d::UnitX()));
  }
  return X;
}

bool ReadRound(const XmlElement& element, ContactShape::Kind kind, ContactShape* shape) {
  const auto radius = Numbers(element, "radius", 1);
  const auto length = kind == ContactShape::Kind::kSphere ? radius : Numbers(element, "length", 1);
  if (!IsSize(radius) || !length || (*length)[0] < 0) return false;
  shape->kind = kind;
  shape->radius = (*radius)[0];
  if (kind != ContactShape::Kind::kSphere) shape->half_length = 0.5 * (*length)[0];
  return true;
}

bool ReadShape(const XmlElement& element, ContactShape* shape) {
  if (element.Is("box")) {
    const auto size = Numbers(element, "size", 3);
    if (!IsSize(size)) return false;
    shape->kind = ContactShape::Kind::kBox;
    shape->half = 0.5 * *size;
    return true;
  }
  if (element.Is("sphere")) return ReadRound(element, ContactShape::Kind::kSphere, shape);
  if (element.Is("cylinder")) return ReadRound(element, ContactShape::Kind::kCylinder, shape);
  return element.Is("capsule") && ReadRound(element, ContactShape::Kind::kCapsule, shape);
}

/// `<mesh filename="" scale="">`; nothing where that is damaged.
std::optional<RobotMesh> MeshOf(const XmlElement& element, const Eigen::Isometry3d& X_LG) {
  const std::string* file = element.FindAttribute("filename");
  if (file == nullptr || Trim(*file).empty()) return {};
  RobotMesh mesh;
  mesh.file = Trim(*file);
  mesh.A_SM = X_LG;
  if (element.FindAttribute("scale") != nullptr) {
    const auto scale = Numbers(element, "scale", 3);
    if (!scale || scale->cwiseAbs().minCoeff() == 0) return {};
    mesh.A_SM.scale(Eigen::Vector3d(*scale));
  }
  return mesh;
}

/// What is looked at only has its use where what touches tells nothing.
void AddVisualMeshes(const XmlElement& element, int link, UrdfDocument* document) {
  for (const XmlElement* visual : element.FindChildren("visual")) {
    const XmlElement* geometry = visual->FindChild("geometry");
    const XmlElement* named = geometry == nullptr ? nullptr : geometry->FindChild("mesh");
    const auto X = Origin(*visual);
    if (named == nullptr || !X) continue;
    auto mesh = MeshOf(*named, *X);
    if (!mesh) continue;
    mesh->segment = link;
    mesh->touches = false;
    document->meshes.push_back(*std::move(mesh));
  }
}

/// Appends the shapes of a `<link>`'s `<collision>` elements, and its meshes, `link` being its
/// index. Damaged ones are left out, with a warning where they would touch.
void AddUrdfShapes(const XmlElement& element, int link, UrdfDocument* document,
                   Diagnostics* diagnostics) {
  for (const XmlElement* collision : element.FindChildren("collision")) {
    const XmlElement* geometry = collision->FindChild("geometry");
    const bool is_empty = geometry == nullptr || geometry->children.empty();
    const auto X = Origin(*collision);
    if (!is_empty && X && geometry->children.front().Is("mesh")) {
      if (auto mesh = MeshOf(geometry->children.front(), *X)) {
        mesh->segment = link;
        document->meshes.push_back(*std::move(mesh));
        continue;
      }
    }
    ContactShape shape;
    shape.segment = link;
    if (is_empty || !X || !ReadShape(geometry->children.front(), &shape)) {
      diagnostics->AddWarning(
          collision->line,
          fmt::format("link '{}': a <collision> is not a box, sphere, cylinder or capsule of "
                      "numbers in metres, or a mesh with a filename, and is left out",
                      document->links[static_cast<std::size_t>(link)].name),
          "collisions that can't be read");
      continue;
    }
    shape.X_SG = *X;
    document->shapes.push_back(shape);
  }
  AddVisualMeshes(element, link, document);
}

constexpr std::size_t kFewestOfRobot = 6;  // joints that turn, as of one limb

/// What urdfdom would print, for as long as it lives.
class CapturedLog : public console_bridge::OutputHandler {
 public:
  CapturedLog() : previous_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~CapturedLog() override { console_bridge::useOutputHandler(previous_); }
  CapturedLog(const CapturedLog&) = delete;
  CapturedLog& operator=(const CapturedLog&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/,
           int /*line*/) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors_.push_back(text);
  }
  const std::vector<std::string>& errors() const { return errors_; }

 private:
  console_bridge::OutputHandler* previous_;
  std::vector<std::string> errors_;
};

/// Appends an element with all below it but shapes. Blanks around and line breaks in values, which
/// urdfdom takes for parts of numbers, become spaces.
void AppendElement(const XmlElement& element, std::string* xml) {
  *xml += "<" + element.name;
  for (const auto& [key, value] : element.attributes) {
    *xml += fmt::format(" {}=\"{}\"", key, EscapeXml(Trim(value)));
  }
  *xml += ">" + EscapeXml(element.text);
  for (const XmlElement& child : element.children) {
    if (child.name != "collision" && child.name != "visual") AppendElement(child, xml);
  }
  *xml += "</" + element.name + ">";
}

/// urdfdom refuses joints that turn without a `<limit>`, and limits without effort and velocity.
void CompleteLimit(XmlElement* joint) {
  const std::string* type = joint->FindAttribute("type");
  if (type == nullptr || Trim(*type) != "revolute") return;
  auto limit = std::find_if(joint->children.begin(), joint->children.end(),
                            [](const XmlElement& child) { return child.name == "limit"; });
  if (limit == joint->children.end()) {
    limit = joint->children.insert(limit, XmlElement{"limit", {}, {}, "", joint->line});
  }
  for (const char* name : {"effort", "velocity"}) {
    if (limit->FindAttribute(name) == nullptr) limit->attributes.emplace_back(name, "0");
  }
}

/// What a tree of joints, masses and shapes is made of. urdfdom sees no shapes, so that damaged
/// ones do no harm, and only XML of a depth that is known to be small.
XmlElement Essence(const XmlElement& robot) {
  XmlElement essence;
  essence.name = robot.name;
  for (const char* attribute : {"name", "version"}) {
    const std::string* value = robot.FindAttribute(attribute);
    if (value != nullptr) essence.attributes.emplace_back(attribute, *value);
  }
  for (const XmlElement& element : robot.children) {
    if (element.name != "link" && element.name != "joint") continue;
    XmlElement& kept = essence.children.emplace_back(element);
    if (element.name == "joint") CompleteLimit(&kept);
    if (element.name != "link") continue;
    std::erase_if(kept.children, [](const XmlElement& part) {
      return part.name != "inertial" && part.name != "collision" && part.name != "visual";
    });
  }
  return essence;
}

urdf::ModelInterfaceSharedPtr ParseWithUrdfdom(const XmlElement& robot, const std::string& file) {
  std::string xml = "<?xml version=\"1.0\"?>";
  AppendElement(robot, &xml);
  static std::mutex mutex;  // there is one log for all threads
  const std::scoped_lock lock(mutex);
  const CapturedLog log;
  std::string reason;
  try {
    if (auto model = urdf::parseURDF(xml)) return model;
  } catch (const std::exception& error) {
    reason = error.what();
  }
  std::vector<std::string> reasons = log.errors();
  if (!reason.empty()) reasons.push_back(reason);
  throw Error(fmt::format("{}: urdfdom can't read it: {}", file, fmt::join(reasons, "; ")));
}

Eigen::Vector3d ToEigen(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Eigen::Isometry3d ToEigen(const urdf::Pose& pose) {
  Eigen::Quaterniond q;
  pose.rotation.getQuaternion(q.x(), q.y(), q.z(), q.w());
  return Eigen::Translation3d(ToEigen(pose.position)) * q.normalized();
}

std::string NameOfElement(const XmlElement& element) {
  for (const auto& [key, value] : element.attributes) {
    if (key == "name") return std::string(Trim(value));
  }
  return "";
}

bool IsNearBy(const Eigen::Vector3d& offset) { return offset.stableNorm() <= kLongestLength; }

class DocumentBuilder {
 public:
  DocumentBuilder(const XmlElement& robot, const urdf::ModelInterface& model,
                  Diagnostics* diagnostics)
      : robot_(robot), model_(model), diagnostics_(*diagnostics) {}

  UrdfDocument Build();

 private:
  template <typename... Args>
  void Fail(int line, fmt::format_string<Args...> text, Args&&... args) {
    diagnostics_.AddError(line, fmt::format(text, std::forward<Args>(args)...));
  }

  [[noreturn]] void FailToFind(const XmlElement& element);
  void AddLink(const XmlElement& element);
  void ReadInertial(const urdf::Inertial& inertial, UrdfLink* link);
  void CheckInertialIsRead(const XmlElement& link, bool is_read);
  void CheckInertia(const UrdfLink& link);
  void AddJoint(const XmlElement& element);
  void ReadOrigin(const urdf::Joint& source, UrdfJoint* joint);
  void ReadAxis(const urdf::Joint& source, UrdfJoint* joint);
  void ReadLimits(const urdf::Joint& source, UrdfJoint* joint);
  void CheckLimits(const XmlElement& element, const UrdfJoint& joint);
  void WidenLimits();
  void CheckMimic(const UrdfJoint& joint);
  void LinkChild(int joint);

  const XmlElement& robot_;
  const urdf::ModelInterface& model_;
  Diagnostics& diagnostics_;
  UrdfDocument document_;
  std::map<std::string, int> link_indices_;
  std::vector<std::size_t> without_limits_;  ///< joints that turn
};

void DocumentBuilder::FailToFind(const XmlElement& element) {
  throw Error(fmt::format("{}:{}: <{} name=\"{}\">: use a name of letters, digits and underscores",
                          diagnostics_.file(), element.line, element.name, NameOfElement(element)));
}

void DocumentBuilder::AddLink(const XmlElement& element) {
  const auto source = model_.getLink(NameOfElement(element));
  if (!source || source->name.empty()) FailToFind(element);
  link_indices_[source->name] = static_cast<int>(document_.links.size());
  UrdfLink& link = document_.links.emplace_back();
  link.name = source->name;
  link.line = element.line;
  if (source->inertial) ReadInertial(*source->inertial, &link);
  CheckInertialIsRead(element, source->inertial != nullptr);
  AddUrdfShapes(element, link_indices_[source->name], &document_, &diagnostics_);
}

void DocumentBuilder::ReadInertial(const urdf::Inertial& inertial, UrdfLink* link) {
  const Eigen::Isometry3d X_LB = ToEigen(inertial.origin);
  Eigen::Matrix3d I;
  I << inertial.ixx, inertial.ixy, inertial.ixz,  //
      inertial.ixy, inertial.iyy, inertial.iyz,   //
      inertial.ixz, inertial.iyz, inertial.izz;
  if (!(inertial.mass >= 0 && inertial.mass <= kHeaviestBody)) {
    Fail(link->line, "link '{}': its mass of {:.6g} kg is outside 0 to {:g} kg", link->name,
         inertial.mass, kHeaviestBody);
  } else if (!IsNearBy(X_LB.translation())) {
    Fail(link->line, "link '{}': its centre of mass is more than {} m away; URDF is in metres",
         link->name, kLongestLength);
  } else if (!(I.cwiseAbs().maxCoeff() <= kLargestInertia)) {
    Fail(link->line, "link '{}': its inertia has a number above {:g} kg m^2", link->name,
         kLargestInertia);
  } else {
    link->mass = inertial.mass;
    link->p_LB = X_LB.translation();
    const Eigen::Matrix3d R = X_LB.linear();
    const Eigen::Matrix3d turned = R * I * R.transpose();
    link->inertia = 0.5 * (turned + turned.transpose());
    CheckInertia(*link);
  }
}

/// urdfdom leaves out an <inertial> that it can't read, with its mass.
void DocumentBuilder::CheckInertialIsRead(const XmlElement& link, bool is_read) {
  const XmlElement* inertial = link.FindChild("inertial");
  if (inertial == nullptr) return;
  bool are_numbers = true;
  for (const XmlElement& part : inertial->children) {
    if (!part.Is("mass") && !part.Is("inertia")) continue;
    for (const auto& [key, value] : part.attributes) {
      if (part.Is("mass") ? key != "value" : !key.starts_with("i")) continue;
      const auto number = ParseDouble(value);
      if (number && std::isfinite(*number)) continue;
      are_numbers = false;
      Fail(part.line,
           "link '{}': <{} {}=\"{:.40}\"> is no finite number (decimals come behind a "
           "point)",
           NameOfElement(link), part.name, key, value);
    }
  }
  if (is_read || !are_numbers) return;
  diagnostics_.AddWarning(
      inertial->line,
      fmt::format("link '{}': its <inertial> is not read, and the link counts as without mass: "
                  "<mass value=\"\"> and <inertia ixx=\"\" ixy=\"\" ixz=\"\" iyy=\"\" iyz=\"\" "
                  "izz=\"\"> are expected",
                  NameOfElement(link)));
}

void DocumentBuilder::CheckInertia(const UrdfLink& link) {
  const std::string why_not = WhyNoInertia(link.inertia);
  if (why_not.empty()) return;
  diagnostics_.AddWarning(link.line, fmt::format("link '{}': {}", link.name, why_not));
}

void DocumentBuilder::ReadOrigin(const urdf::Joint& source, UrdfJoint* joint) {
  joint->X_PF = ToEigen(source.parent_to_joint_origin_transform);
  if (IsNearBy(joint->X_PF.translation())) return;
  Fail(joint->line, "joint '{}': its origin is more than {} m away; URDF is in metres", joint->name,
       kLongestLength);
}

void DocumentBuilder::ReadAxis(const urdf::Joint& source, UrdfJoint* joint) {
  const bool has_axis = joint->type == UrdfJointType::kRevolute ||
                        joint->type == UrdfJointType::kContinuous ||
                        joint->type == UrdfJointType::kPrismatic;
  if (!has_axis) return;
  const Eigen::Vector3d axis = ToEigen(source.axis);
  const double length = axis.stableNorm();
  if (length > 1e-6 && std::isfinite(length)) {
    joint->axis = axis / length;
  } else {
    Fail(joint->line, "joint '{}': its <axis> has no direction", joint->name);
  }
}

void DocumentBuilder::ReadLimits(const urdf::Joint& source, UrdfJoint* joint) {
  if (!source.limits) return;
  joint->velocity = std::max(source.limits->velocity, 0.0);
  joint->effort = std::max(source.limits->effort, 0.0);
  joint->lower = source.limits->lower;
  joint->upper = source.limits->upper;
  if (joint->lower <= joint->upper) return;
  Fail(joint->line, "joint '{}': its limits are crossed: lower=\"{:g}\" is above upper=\"{:g}\"",
       joint->name, joint->lower, joint->upper);
}

/// One limit that a revolute joint does not say counts as 0; where it says none, none is known.
void DocumentBuilder::CheckLimits(const XmlElement& element, const UrdfJoint& joint) {
  const XmlElement* limit = element.FindChild("limit");
  if (joint.type != UrdfJointType::kRevolute || limit == nullptr) return;
  std::vector<const char*> missing;
  for (const char* attribute : {"lower", "upper"}) {
    if (limit->FindAttribute(attribute) == nullptr) missing.push_back(attribute);
  }
  if (missing.size() == 2) without_limits_.push_back(document_.joints.size());
  if (missing.size() != 1) return;
  diagnostics_.AddWarning(
      limit->line, fmt::format("joint '{}': <limit> has no {}, which URDF takes for 0", joint.name,
                               fmt::join(missing, " and no ")));
}

/// Files of CAD programs have no limits, or 0 to 0 for all that turns.
void DocumentBuilder::WidenLimits() {
  std::vector<std::size_t> turning;
  for (std::size_t i = 0; i < document_.joints.size(); ++i) {
    if (document_.joints[i].type == UrdfJointType::kRevolute) turning.push_back(i);
  }
  const bool has_none = turning.size() >= kFewestOfRobot &&
                        std::all_of(turning.begin(), turning.end(), [&](std::size_t i) {
                          return document_.joints[i].lower == 0 && document_.joints[i].upper == 0;
                        });
  if (has_none) without_limits_ = turning;
  std::vector<std::string> names;
  for (const std::size_t i : without_limits_) {
    UrdfJoint& joint = document_.joints[i];
    joint.lower = -EIGEN_PI;
    joint.upper = EIGEN_PI;
    names.push_back(joint.name);
  }
  if (names.empty()) return;
  diagnostics_.AddWarning(
      0,
      fmt::format("has no limits (<limit lower=\"\" upper=\"\">) of {}: half a turn to both sides "
                  "counts",
                  FirstNames(names)));
}

void DocumentBuilder::CheckMimic(const UrdfJoint& joint) {
  if (joint.mimicked == joint.name) {
    Fail(joint.line, "joint '{}': mimics itself", joint.name);
  } else if (!model_.getJoint(joint.mimicked)) {
    Fail(joint.line, "joint '{}': mimics joint '{}', which does not exist", joint.name,
         joint.mimicked);
  }
}

void DocumentBuilder::AddJoint(const XmlElement& element) {
  static const std::map<int, UrdfJointType> kTypes = {
      {urdf::Joint::FIXED, UrdfJointType::kFixed},
      {urdf::Joint::REVOLUTE, UrdfJointType::kRevolute},
      {urdf::Joint::CONTINUOUS, UrdfJointType::kContinuous},
      {urdf::Joint::PRISMATIC, UrdfJointType::kPrismatic},
      {urdf::Joint::FLOATING, UrdfJointType::kFloating},
      {urdf::Joint::PLANAR, UrdfJointType::kPlanar}};
  const auto found = model_.getJoint(NameOfElement(element));
  if (!found || found->name.empty()) FailToFind(element);
  const urdf::Joint& source = *found;
  UrdfJoint joint;
  joint.name = source.name;
  joint.line = element.line;
  joint.type = kTypes.at(source.type);
  joint.parent = link_indices_.at(source.parent_link_name);
  joint.child = link_indices_.at(source.child_link_name);
  ReadOrigin(source, &joint);
  ReadAxis(source, &joint);
  ReadLimits(source, &joint);
  CheckLimits(element, joint);
  if (source.mimic) {
    joint.mimicked = source.mimic->joint_name;
    joint.mimic_offset = source.mimic->offset;
    joint.mimic_multiplier = source.mimic->multiplier;
    CheckMimic(joint);
  }
  document_.joints.push_back(std::move(joint));
}

void DocumentBuilder::LinkChild(int joint) {
  const UrdfJoint& added = document_.joints[joint];
  UrdfLink& child = document_.links[added.child];
  if (child.parent_joint >= 0) {
    Fail(added.line, "link '{}' is the child of both the joints '{}' and '{}'", child.name,
         document_.joints[child.parent_joint].name, added.name);
  }
  child.parent_joint = joint;
}

UrdfDocument DocumentBuilder::Build() {
  document_.name = model_.getName();
  for (const XmlElement* link : robot_.FindChildren("link")) AddLink(*link);
  for (const XmlElement* joint : robot_.FindChildren("joint")) AddJoint(*joint);
  const int num_joints = static_cast<int>(document_.joints.size());
  for (int joint = 0; joint < num_joints; ++joint) LinkChild(joint);
  WidenLimits();
  diagnostics_.ThrowIfErrors();
  document_.root = link_indices_.at(model_.getRoot()->name);
  RemoveFloatingWorld(&document_);
  return std::move(document_);
}

void CheckIsUrdf(const XmlElement& robot, const std::string& file) {
  if (robot.name != "robot") {
    throw Error(fmt::format("{}:{}: not a URDF: expected <robot>, found <{}>", file, robot.line,
                            robot.name));
  }
  for (const XmlElement& element : robot.children) {
    if (!element.name.starts_with("xacro:")) continue;
    throw Error(fmt::format("{}:{}: <{}>: is xacro, of which a URDF is made; run xacro on it first",
                            file, element.line, element.name));
  }
  const std::size_t num_links = robot.FindChildren("link").size();
  if (num_links > kMaxUrdfLinks) {
    throw Error(fmt::format("{}: has {} links, more than the {} that are read at most", file,
                            num_links, kMaxUrdfLinks));
  }
}

std::string LinkOf(const XmlElement& joint, const char* end) {
  const XmlElement* element = joint.FindChild(end);
  const std::string* name = element == nullptr ? nullptr : element->FindAttribute("link");
  return name == nullptr ? std::string() : std::string(Trim(*name));
}

/// urdfdom leaks links that carry each other.
void CheckHasNoCircle(const XmlElement& robot, const std::string& file) {
  std::multimap<std::string, std::string> children;
  std::map<std::string, int> num_parents;
  for (const XmlElement* joint : robot.FindChildren("joint")) {
    const std::string parent = LinkOf(*joint, "parent");
    const std::string child = LinkOf(*joint, "child");
    if (parent.empty() || child.empty()) continue;
    children.emplace(parent, child);
    ++num_parents[child];
  }
  std::vector<std::string> free;
  for (const auto& [parent, unused] : children) {
    if (!num_parents.contains(parent)) free.push_back(parent);
  }
  while (!free.empty()) {
    const std::string link = std::move(free.back());
    free.pop_back();
    for (auto [child, end] = children.equal_range(link); child != end; ++child) {
      if (--num_parents[child->second] == 0) free.push_back(child->second);
    }
    children.erase(link);
  }
  if (children.empty()) return;
  for (const XmlElement* joint : robot.FindChildren("joint")) {
    if (!children.contains(LinkOf(*joint, "parent"))) continue;
    throw Error(fmt::format("{}:{}: link '{}' hangs in a circle of joints", file, joint->line,
                            LinkOf(*joint, "parent")));
  }
}

}  // namespace

UrdfDocument ParseUrdf(std::string_view content, Diagnostics* diagnostics) {
  const XmlElement file = ParseXml(content, diagnostics->file());
  CheckIsUrdf(file, diagnostics->file());
  CheckHasNoCircle(file, diagnostics->file());
  const XmlElement robot = Essence(file);
  const auto model = ParseWithUrdfdom(robot, diagnostics->file());
  return DocumentBuilder(robot, *model, diagnostics).Build();
}

}  // namespace mmm_converter
