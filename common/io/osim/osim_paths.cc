// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_paths.h"

#include <fmt/format.h>

#include <map>

#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_values.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"

namespace mmm_converter {

using Eigen::Vector3d;

namespace {

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

}  // namespace

std::vector<XmlPlace> OsimPathPoints(const XmlPlace& force) {
  return OsimEdit::Objects(force.Child("GeometryPath"), "PathPointSet");
}

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

}  // namespace mmm_converter
