// SPDX-License-Identifier: MIT
#include "common/io/urdf/urdf_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/support/text.h"

namespace mmm_converter {
namespace {

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

}  // namespace

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

}  // namespace mmm_converter
