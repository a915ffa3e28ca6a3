// SPDX-License-Identifier: MIT
#include "common/live/zmq/posture_message.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/live/marker_states.h"
#include "common/model/forward_kinematics.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are little endian");

using Json = nlohmann::ordered_json;

// Names, element types and shapes of the arrays, in their order.
Json FieldsOf(std::size_t joints, std::size_t segments, std::size_t labels) {
  Json fields = Json::array();
  const auto add = [&](const char* name, const char* type, std::vector<std::size_t> shape) {
    fields.push_back({{"name", name}, {"dtype", type}, {"shape", std::move(shape)}});
  };
  add("root_position", "f64", {3});
  add("root_orientation", "f64", {4});
  add("root_sd", "f64", {6});
  add("joint_angles", "f64", {joints});
  add("joint_sd", "f64", {joints});
  add("segment_positions", "f64", {segments, 3});
  add("segment_orientations", "f64", {segments, 4});
  add("marker_positions", "f64", {labels, 3});
  add("marker_distances", "f64", {labels});
  add("marker_states", "u8", {labels});
  return fields;
}

class ArrayBytes {
 public:
  void Add(double value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    bytes_.append(bytes, sizeof value);
  }
  void Add(const Eigen::Vector3d& v) {
    for (int i = 0; i < 3; ++i) Add(v[i]);
  }
  void Add(const Eigen::Quaterniond& q) {
    for (const double value : {q.w(), q.x(), q.y(), q.z()}) Add(value);
  }
  void AddByte(MarkerState state) { bytes_ += static_cast<char>(state); }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

double Nanoseconds(SteadyTime time) {
  return static_cast<double>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count());
}

}  // namespace

PostureMessageFormat::PostureMessageFormat(const LiveBody& body) {
  const KinematicModel& model = *body.setup.model;
  Json joints = Json::array();
  for (const int joint : body.setup.joints) joints.push_back(model.joint(joint).name);
  Json segments = Json::array();
  for (const Segment& segment : model.segments()) segments.push_back(segment.name);
  const Json fixed = {{"version", 1},
                      {"endian", "little"},
                      {"body", body.name},
                      {"calibrated", body.is_calibrated},
                      {"joints", joints},
                      {"segments", segments},
                      {"markers", body.labels},
                      {"fields", FieldsOf(joints.size(), segments.size(), body.labels.size())}};
  fixed_ = fixed.dump(-1, ' ', false, Json::error_handler_t::replace);
  fixed_.pop_back();  // the brace; what changes follows
}

PostureMessage PostureMessageFormat::Format(const LiveBody& body, const PoseFrame& frame,
                                            SteadyTime now) const {
  PostureMessage message;
  message.header = fmt::format(
      "{},\"frame\":{},\"time\":{},\"tracking\":{},\"held\":{},\"received_ns\":{:.0f},\"sent_ns\":{"
      ":.0f},"
      "\"dropped\":{}}}",
      fixed_, frame.number, frame.time, frame.is_tracking, frame.is_held,
      Nanoseconds(frame.received), Nanoseconds(now), frame.dropped);
  const KinematicModel& model = *body.setup.model;
  const FrameEstimate& estimate = frame.estimate;
  const bool is_tracking = frame.is_tracking;
  const bool has_deviations = is_tracking && estimate.standard_deviations.size() > 0;
  const auto of_posture = [&](double value) { return is_tracking ? value : kNaN; };
  const auto deviation = [&](Eigen::Index i) {
    return has_deviations ? estimate.standard_deviations[i] : kNaN;
  };
  Posture posture = is_tracking ? estimate.posture : ZeroPosture(model);
  ArrayBytes arrays;
  for (int i = 0; i < 3; ++i) arrays.Add(of_posture(posture.position[i]));
  const Eigen::Quaterniond& q = posture.orientation;
  for (const double value : {q.w(), q.x(), q.y(), q.z()}) arrays.Add(of_posture(value));
  for (int i = 0; i < 6; ++i) arrays.Add(deviation(i));
  for (const int joint : body.setup.joints) arrays.Add(of_posture(posture.joint_angles[joint]));
  for (const int joint : body.setup.joints) arrays.Add(deviation(6 + joint));
  const auto poses = SegmentPoses(model, posture);
  for (const Eigen::Isometry3d& X_WS : poses) {
    arrays.Add(is_tracking ? X_WS.translation() : Eigen::Vector3d::Constant(kNaN).eval());
  }
  for (const Eigen::Isometry3d& X_WS : poses) {
    arrays.Add(is_tracking ? Eigen::Quaterniond(X_WS.linear())
                           : Eigen::Quaterniond(kNaN, kNaN, kNaN, kNaN));
  }
  for (Eigen::Index i = 0; i < frame.points.cols(); ++i) arrays.Add(frame.points.col(i).eval());
  const MarkerStates states = StatesOfMarkers(body, frame);
  for (const double distance : states.distances) arrays.Add(distance);
  for (const MarkerState state : states.states) arrays.AddByte(state);
  message.arrays = arrays.Take();
  return message;
}

}  // namespace mmm_converter
