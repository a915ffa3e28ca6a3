// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_scaling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/osim/osim_edit.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_values.h"
#include "common/io/xml/xml_text.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// A force that acts along a path.
struct OsimPath {
  XmlPlace force;
  double length = 0;  ///< straight from point to point, at the default posture [m]
  bool wraps = false;
};

class PathMeter {
 public:
  explicit PathMeter(OsimEdit* edit) : edit_(*edit) {
    const OsimDocument& document = edit_.document();
    for (const OsimCoordinate& one : document.coordinates) rest_[one.name] = one.default_value;
    const KinematicModel model = MakeOsimModel(document, edit_.diagnostics());
    const auto poses = SegmentPoses(model, RestPosture(model));
    for (const OsimBody& body : document.bodies) {
      const int segment = model.FindSegment(body.name);
      X_WB_.push_back(segment < 0 ? Eigen::Isometry3d(model.coordinates()->R_WG())
                                  : poses[segment]);
    }
  }

  double Measure(const std::string& owner, const std::vector<XmlPlace>& points) {
    double length = 0;
    std::optional<Vector3d> last;
    for (const XmlPlace& point : points) {
      if (!IsActive(point.element())) continue;
      const OsimFrames::Place place = edit_.FrameOf(owner, point.element());
      const Vector3d p_W = X_WB_[place.body] * (place.X_BF * Location(point.element()));
      if (last) length += (p_W - *last).norm();
      last = p_W;
    }
    return length;
  }

 private:
  double RestOf(const XmlElement& point, std::string_view socket) const {
    std::string_view name = OsimText(point, socket);
    if (name.empty()) name = OsimText(point, "socket_" + std::string(socket));
    const auto rest = rest_.find(std::string(name.substr(name.rfind('/') + 1)));
    return rest == rest_.end() ? 0 : rest->second;
  }

  bool IsActive(const XmlElement& point) {
    if (!point.Is("ConditionalPathPoint")) return true;
    const std::vector<double> range =
        ReadOsimNumbers(point, "range", 2, {0, 0}, edit_.diagnostics());
    // A coordinate that is on the end of the range is in it, whatever the digits of the file.
    constexpr double kTolerance = 1e-4;
    const double q = RestOf(point, "coordinate");
    return q >= range[0] - kTolerance && q <= range[1] + kTolerance;
  }

  Vector3d Location(const XmlElement& point) {
    Vector3d location = edit_.Vector(point, "location", Vector3d::Zero());
    if (!point.Is("MovingPathPoint")) return location;
    constexpr const char* kAxes[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i) {
      const std::string axis = kAxes[i];
      const XmlElement* function = FindOsimObject(point, axis + "_location");
      if (function == nullptr) continue;
      const double q = RestOf(point, axis + "_coordinate");
      const OsimExpression value =
          ReadOsimFunction(function, {"q"}, false, nullptr, edit_.diagnostics());
      location[i] = value.constant;
      for (const auto& term : value.terms) location[i] += term.function.Value(q);
    }
    return location;
  }

  OsimEdit& edit_;
  std::map<std::string, double> rest_;
  std::vector<Eigen::Isometry3d> X_WB_;
};

/// The points of a force's path; none: it has no path.
std::vector<XmlPlace> OsimPathPoints(const XmlPlace& force) {
  return OsimEdit::Objects(force.Child("GeometryPath"), "PathPointSet");
}

/// The paths of all forces of the model, in its order, with the points that are active at the
/// default posture. They are valid as long as `edit`.
std::vector<OsimPath> MeasureOsimPaths(OsimEdit* edit) {
  PathMeter meter(edit);
  std::vector<OsimPath> paths;
  for (const XmlPlace& force : OsimEdit::Objects(edit->model(), "ForceSet")) {
    const std::vector<XmlPlace> points = OsimPathPoints(force);
    if (points.empty()) continue;
    OsimPath& path = paths.emplace_back();
    path.force = force;
    path.length = meter.Measure("/forceset/" + OsimName(force.element()), points);
    path.wraps = !OsimEdit::Objects(force.Child("GeometryPath"), "PathWrapSet").empty();
  }
  return paths;
}

constexpr double kSameFactor = 1e-8;  // relative; factors of one measurement are the same anyway

/// A turning body of the same shape, by OpenSim's rules: equal factors scale it exactly; else it is
/// a cylinder about the axis of its smallest moment, held at one end.
Matrix3d ScaleInertia(const Matrix3d& inertia, double mass_before, double mass, const Vector3d& f) {
  if (mass_before <= 0 || mass <= 0) return Matrix3d::Zero();
  const double ratio = mass / mass_before;
  if ((f.array() - f[0]).abs().maxCoeff() <= kSameFactor * f[0])
    return ratio * f[0] * f[0] * inertia;
  int axis = 0;
  inertia.diagonal().minCoeff(&axis);
  const int next = (axis + 1) % 3;
  const int last = (axis + 2) % 3;
  const int other = axis == 0 ? 1 : 0;  // whose moment tells the length
  const double radius2 = std::max(0.0, 2 * inertia(axis, axis) / mass_before);
  const double length2 = std::max(0.0, 3 * (inertia(other, other) / mass_before - radius2 / 4));
  const double scaled_radius2 = radius2 * f[next] * f[last];
  const double scaled_length2 = length2 * f[axis] * f[axis];
  Matrix3d scaled = ratio * inertia.cwiseProduct(f * f.transpose());  // off the diagonal
  scaled(axis, axis) = mass * scaled_radius2 / 2;
  scaled(next, next) = scaled(last, last) = mass * (scaled_length2 / 3 + scaled_radius2 / 4);
  return scaled;
}

/// How long factors make a unit vector.
double LengthAlong(const Vector3d& direction, const Vector3d& f) {
  return (f.array() == f[0]).all() ? f[0] : direction.cwiseProduct(f).norm();
}

class Scaler {
 public:
  Scaler(OsimEdit* edit, const OsimScaling& scaling);

  void ScaleBodies();
  void ScaleJoints();
  void ScaleMarkers();
  void ScalePaths();

 private:
  const Vector3d& FactorOf(const OsimFrames::Place& place) const { return factors_[place.body]; }
  void ScaleMass(const XmlPlace& place, const OsimBody& body, const Vector3d& f);
  void ScaleFrame(const std::string& owner, const XmlPlace& frame);
  void ScaleAttached(const XmlPlace& frame, const Vector3d& f);
  void ScaleWrap(const XmlPlace& wrap, const Vector3d& f);
  void ScaleTransform(const XmlPlace& joint, const Vector3d& f);
  int BodyIndex(std::string_view name) const;

  OsimEdit& edit_;
  std::map<std::string, int, std::less<>> index_;  // of bodies
  std::vector<Vector3d> factors_;                  // by body
  std::vector<double> masses_;                     // by body [kg]
};

Scaler::Scaler(OsimEdit* edit, const OsimScaling& scaling) : edit_(*edit) {
  const std::vector<OsimBody>& bodies = edit_.document().bodies;
  factors_.assign(bodies.size(), Vector3d::Ones());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    index_.emplace(bodies[i].name, static_cast<int>(i));
  }
  for (const auto& [name, factor] : scaling.factors) {
    const int body = BodyIndex(name);
    if (body == 0) continue;
    if (body < 0 || !factor.allFinite() || factor.minCoeff() <= 0) {
      throw Error(fmt::format(
          "body '{}' can't be scaled by {}: {}", name, OsimVectorText(factor),
          body < 0 ? "the model has no such body" : "a factor must be larger than zero"));
    }
    factors_[body] = factor;
  }
  double total = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    masses_.push_back(bodies[i].mass * (scaling.keeps_mass_distribution ? 1 : factors_[i].prod()));
    total += masses_.back();
  }
  if (!scaling.mass || total <= 0) return;
  for (double& mass : masses_) mass *= *scaling.mass / total;
}

int Scaler::BodyIndex(std::string_view name) const {
  const auto found = index_.find(name);
  return found == index_.end() ? -1 : found->second;
}

void Scaler::ScaleMass(const XmlPlace& place, const OsimBody& body, const Vector3d& f) {
  const double mass = masses_[BodyIndex(body.name)];
  const Matrix3d I = ScaleInertia(body.inertia, body.mass, mass, f);
  edit_.SetNumber(place, "mass", body.mass, mass);
  edit_.ScaleVector(place, "mass_center", f);
  if (edit_.document().version >= 40000) {
    if (I == body.inertia) return;
    edit_.edit().SetProperty(
        place, "inertia",
        OsimVectorText(I.diagonal()) + " " + OsimVectorText({I(0, 1), I(0, 2), I(1, 2)}));
    return;
  }
  constexpr const char* kAxes = "xyz";
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      edit_.SetNumber(place, fmt::format("inertia_{}{}", kAxes[i], kAxes[j]), body.inertia(i, j),
                      I(i, j));
    }
  }
}

/// A wrapping surface: its place with the body, its size by how long the body's factors make its
/// own axes.
void Scaler::ScaleWrap(const XmlPlace& wrap, const Vector3d& f) {
  const Vector3d turns = edit_.Vector(wrap.element(), "xyz_body_rotation", Vector3d::Zero());
  Matrix3d R = Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) R = R * Eigen::AngleAxisd(turns[i], Vector3d::Unit(i));
  const Vector3d own = (f.asDiagonal() * R).colwise().norm();
  edit_.ScaleVector(wrap, "translation", f);
  edit_.ScaleVector(wrap, "dimensions", own);
  edit_.ScaleNumber(wrap, "length", own.z());
  const bool is_round = wrap.element().Is("WrapSphere");
  edit_.ScaleNumber(wrap, "radius", is_round ? own.mean() : own.head<2>().mean());
  for (const char* radius : {"inner_radius", "outer_radius"}) {
    edit_.ScaleNumber(wrap, radius, own.head<2>().mean());
  }
}

/// What a frame carries: wrapping surfaces and what is drawn.
void Scaler::ScaleAttached(const XmlPlace& frame, const Vector3d& f) {
  for (const XmlPlace& wrap : OsimEdit::Objects(frame, "WrapObjectSet")) ScaleWrap(wrap, f);
  for (const XmlPlace& drawn : frame.Child("attached_geometry").Children()) {
    if (drawn.Child("scale_factors")) edit_.ScaleVector(drawn, "scale_factors", f);
  }
  if (const XmlPlace drawn = frame.Child("VisibleObject"); drawn.Child("scale_factors")) {
    edit_.ScaleVector(drawn, "scale_factors", f);
  }
}

/// An offset frame, and those among its components.
void Scaler::ScaleFrame(const std::string& owner, const XmlPlace& frame) {
  if (!frame.element().Is("PhysicalOffsetFrame")) return;
  const std::string path = owner + "/" + OsimName(frame.element());
  const Vector3d& f = FactorOf(
      edit_.FrameAt(path, OsimText(frame.element(), "socket_parent"), frame.element().line));
  edit_.ScaleVector(frame, "translation", f);
  ScaleAttached(frame, f);
  for (const XmlPlace& inner : frame.Child("components").Children()) ScaleFrame(path, inner);
}

void Scaler::ScaleBodies() {
  for (const XmlPlace& place : OsimEdit::Objects(edit_.model(), "BodySet")) {
    const std::string name = OsimName(place.element());
    const int index = BodyIndex(name);
    for (const XmlPlace& frame : place.Child("components").Children()) {
      ScaleFrame("/bodyset/" + name, frame);
    }
    if (index <= 0) continue;
    ScaleMass(place, edit_.document().bodies[index], factors_[index]);
    ScaleAttached(place, factors_[index]);
  }
}

/// Lengths that a joint moves by, but for a coordinate that is the length itself. OpenSim takes
/// |axis| . f, which is the same along x, y and z, and no length along other axes.
void Scaler::ScaleTransform(const XmlPlace& joint, const Vector3d& f) {
  for (const XmlPlace& axis : joint.Child("SpatialTransform").Children()) {
    const std::string name = ToLower(OsimName(axis.element()));
    if (!name.starts_with("translation")) continue;
    const int index = std::clamp(name.back() - '1', 0, 2);
    const Vector3d direction =
        edit_.Vector(axis.element(), "axis", Vector3d::Unit(index)).normalized();
    const XmlElement* function = FindOsimObject(axis.element(), "function");
    if (function == nullptr) continue;
    if (function->Is("LinearFunction")) {
      std::vector<double> line;
      AppendDoubles(OsimText(*function, "coefficients"), &line);
      if (line == std::vector<double>{1, 0}) continue;
    }
    edit_.ScaleFunction(axis, "function", LengthAlong(direction, f));
  }
}

void Scaler::ScaleJoints() {
  for (const XmlPlace& body : OsimEdit::Objects(edit_.model(), "BodySet")) {
    const std::vector<XmlPlace> joints = body.Child("Joint").Children();
    if (joints.empty() || edit_.document().version >= 40000) continue;
    const XmlPlace& joint = joints.front();
    const int child = BodyIndex(OsimName(body.element()));
    const int parent = BodyIndex(OsimText(joint.element(), "parent_body"));
    if (child <= 0 || parent < 0) continue;  // the ground hangs on nothing
    const Vector3d& f = factors_[parent];
    edit_.ScaleVector(joint, "location_in_parent", f);
    edit_.ScaleVector(joint, "location", factors_[child]);
    ScaleTransform(joint, f);
  }
  for (const XmlPlace& joint : OsimEdit::Objects(edit_.model(), "JointSet")) {
    const std::string owner = "/jointset/" + OsimName(joint.element());
    for (const XmlPlace& frame : joint.Child("frames").Children()) ScaleFrame(owner, frame);
    ScaleTransform(joint, FactorOf(edit_.FrameOf(owner, joint.element())));
  }
  for (const XmlPlace& frame : edit_.model().Child("components").Children()) ScaleFrame("", frame);
  for (const XmlPlace& frame : OsimEdit::Objects(edit_.model(), "ComponentSet")) {
    ScaleFrame("/componentset", frame);
  }
}

void Scaler::ScaleMarkers() {
  for (const XmlPlace& marker : OsimEdit::Objects(edit_.model(), "MarkerSet")) {
    if (!marker.element().Is("Marker")) continue;
    const std::string owner = "/markerset/" + OsimName(marker.element());
    edit_.ScaleVector(marker, "location", FactorOf(edit_.FrameOf(owner, marker.element())));
  }
}

void Scaler::ScalePaths() {
  for (const XmlPlace& force : OsimEdit::Objects(edit_.model(), "ForceSet")) {
    const std::string owner = "/forceset/" + OsimName(force.element());
    for (const XmlPlace& point : OsimPathPoints(force)) {
      const Vector3d& f = FactorOf(edit_.FrameOf(owner, point.element()));
      edit_.ScaleVector(point, "location", f);
      if (!point.element().Is("MovingPathPoint")) continue;
      edit_.ScaleFunction(point, "x_location", f.x());
      edit_.ScaleFunction(point, "y_location", f.y());
      edit_.ScaleFunction(point, "z_location", f.z());
    }
  }
}

/// Lengths of fibres, tendons and springs by those of their paths.
std::string ScaleLengths(const std::vector<OsimPath>& before, const std::string& content,
                         const std::string& file, Warnings* warnings) {
  OsimEdit edit(content, file);
  const std::vector<OsimPath> after = MeasureOsimPaths(&edit);
  std::vector<std::string> wrapping;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (before[i].length <= 0) continue;
    const XmlPlace& force = after[i].force;
    const double ratio = after[i].length / before[i].length;
    for (const char* length :
         {"optimal_fiber_length", "tendon_slack_length", "resting_length", "slack_length"}) {
      edit.ScaleNumber(force, length, ratio);
    }
    if (after[i].wraps && ratio != 1) wrapping.push_back(OsimName(force.element()));
  }
  if (!wrapping.empty()) {
    Warn(warnings,
         fmt::format("fibre and tendon lengths go with their path's length at the default "
                     "posture, which is taken straight from point to point although it "
                     "wraps: {}",
                     FirstNames(wrapping, 4)));
  }
  return edit.Finish();
}

bool IsAsInFile(const OsimMarker& marker, const OsimDocument& document) {
  return std::any_of(document.markers.begin(), document.markers.end(), [&](const OsimMarker& one) {
    return one.name == marker.name && one.body == marker.body && one.p_BM == marker.p_BM &&
           one.is_fixed == marker.is_fixed;
  });
}

}  // namespace

std::string ScaleOsim(std::string_view content, const std::string& file, const OsimScaling& scaling,
                      Warnings* warnings) {
  OsimEdit edit(content, file);
  if (!OsimEdit::Objects(edit.model(), "ContactGeometrySet").empty()) {
    Warn(warnings, "contact geometry keeps its size and place");
  }
  const std::vector<OsimPath> before = MeasureOsimPaths(&edit);
  Scaler scaler(&edit, scaling);
  scaler.ScaleBodies();
  scaler.ScaleJoints();
  scaler.ScaleMarkers();
  scaler.ScalePaths();
  return ScaleLengths(before, edit.Finish(), file, warnings);
}

OsimDocument ScaleOsimDocument(OsimDocument document, const std::vector<Vector3d>& factors) {
  const auto scale = [&](int body, auto&& p) {
    p.array() *= factors[static_cast<std::size_t>(body)].array();
  };
  for (std::size_t i = 0; i < document.bodies.size(); ++i) {
    scale(static_cast<int>(i), document.bodies[i].p_BC);
  }
  for (OsimJoint& joint : document.joints) {
    scale(joint.parent, joint.X_PF.translation());
    scale(joint.child, joint.X_CM.translation());
    for (OsimAxis& axis : joint.translations) {
      OsimExpression& value = axis.value;
      const bool is_coordinate = value.constant == 0 && value.terms.size() == 1 &&
                                 value.terms[0].function.AsLine() == ScalarFunction::Line{1, 0};
      if (is_coordinate) continue;
      const double f = LengthAlong(axis.axis, factors[static_cast<std::size_t>(joint.parent)]);
      value.constant *= f;
      for (auto& term : value.terms) term.function = term.function.Scaled(f);
    }
  }
  for (OsimMarker& marker : document.markers) scale(marker.body, marker.p_BM);
  return document;
}

std::string WriteOsimMarkers(std::string_view content, const std::string& file,
                             const OsimDocument& document, const std::vector<OsimMarker>& markers) {
  OsimEdit edit(content, file);
  const bool is_old = edit.document().version < 40000;
  const std::vector<XmlPlace> present = OsimEdit::Objects(edit.model(), "MarkerSet");
  std::string added;
  for (const OsimMarker& marker : markers) {
    const std::string& body = document.bodies[marker.body].name;
    const std::string socket = is_old ? "body" : "socket_parent_frame";
    const std::string frame = is_old ? body : marker.body > 0 ? "/bodyset/" + body : "/ground";
    const auto place = std::find_if(present.begin(), present.end(), [&](const XmlPlace& one) {
      return OsimName(one.element()) == marker.name;
    });
    if (place == present.end()) {
      added += fmt::format(
          "<Marker name=\"{}\"><{}>{}</{}><location>{}</location><fixed>{}</fixed></Marker>\n",
          EscapeXml(marker.name), socket, EscapeXml(frame), socket, OsimVectorText(marker.p_BM),
          marker.is_fixed);
      continue;
    }
    if (IsAsInFile(marker, edit.document())) continue;
    if (OsimText(place->element(), socket) != frame) {
      edit.edit().SetProperty(*place, socket, EscapeXml(frame));
    }
    edit.edit().SetProperty(*place, "location", OsimVectorText(marker.p_BM));
    if (marker.is_fixed) edit.edit().SetProperty(*place, "fixed", "true");
  }
  const XmlPlace set = edit.model().Child("MarkerSet");
  if (added.empty()) return edit.Finish();
  if (const XmlPlace objects = set.Child("objects")) {
    edit.edit().Append(objects, "\n" + added);
  } else if (set) {
    edit.edit().Append(set, "<objects>\n" + added + "</objects>");
  } else {
    edit.edit().Append(edit.model(), "<MarkerSet><objects>\n" + added + "</objects></MarkerSet>\n");
  }
  return edit.Finish();
}

}  // namespace mmm_converter
