// SPDX-License-Identifier: MIT
#include "common/io/mjcf/mjcf_geom.h"
#include "common/model/body_bounds.h"
#include "common/model/inertia_check.h"

#include <fmt/format.h>

#include <map>
#include <string_view>

namespace mmm_converter {
namespace {

using Kind = ContactShape::Kind;

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

}  // namespace

void MjcfMass::Add(const MjcfMass& other) {
  const double sum = mass + other.mass;
  if (other.mass <= 0 || sum <= 0) return;
  const Eigen::Vector3d center = (mass * p_BC + other.mass * other.p_BC) / sum;
  inertia +=
      other.inertia + Steiner(mass, p_BC - center) + Steiner(other.mass, other.p_BC - center);
  p_BC = center;
  mass = sum;
}

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

}  // namespace mmm_converter
