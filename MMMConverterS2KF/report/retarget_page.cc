// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/retarget_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "MMMConverterS2KF/report/drawn_frames.h"
#include "MMMConverterS2KF/report/html.h"
#include "MMMConverterS2KF/report/json.h"
#include "MMMConverterS2KF/report/model_json.h"
#include "MMMConverterS2KF/report/packed_array.h"
#include "MMMConverterS2KF/report/page_sources.h"
#include "MMMConverterS2KF/report/retarget_summary.h"
#include "MMMConverterS2KF/report/tracks.h"
#include "common/model/forward_kinematics.h"
#include "common/retarget/body_posture.h"
#include "common/retarget/robot_body.h"

namespace mmm_converter {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;

Json TripleJson(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

const char* NameOf(ContactShape::Kind kind) {
  switch (kind) {
    case ContactShape::Kind::kBox:
      return "box";
    case ContactShape::Kind::kSphere:
      return "sphere";
    case ContactShape::Kind::kCapsule:
      return "capsule";
    case ContactShape::Kind::kCylinder:
      return "cylinder";
    case ContactShape::Kind::kEllipsoid:
      return "ellipsoid";
    case ContactShape::Kind::kHull:
      return "hull";
  }
  return "";
}

Json ToJson(const ContactShape& shape) {
  const Eigen::Quaterniond q(shape.X_SG.linear());
  return {{"kind", NameOf(shape.kind)},
          {"segment", shape.segment},
          {"position", TripleJson(shape.X_SG.translation())},
          {"orientation", {q.x(), q.y(), q.z(), q.w()}},
          {"half", TripleJson(shape.half)},
          {"radius", shape.radius},
          {"half_length", shape.half_length}};
}

/// A joint as people look for it.
struct JointPlace {
  std::string group = "neck", side;
  int order = 0;  ///< of its side's in the group
};

void PlaceLimb(const KinematicModel& model, const LimbMap& limb, bool is_leg, Side side,
               std::vector<JointPlace>* places) {
  int counts[3] = {0, 0, 0};
  const char* const names[2][3] = {{"shoulder", "elbow", "wrist"}, {"hip", "knee", "ankle"}};
  int part = 0;
  for (int i = limb.chain.front(); i < static_cast<int>(model.segments().size()); ++i) {
    const Segment& segment = model.segments()[i];
    if (!model.IsBelow(i, limb.chain.front())) continue;
    const auto of_chain = std::find(limb.chain.begin(), limb.chain.end(), i);
    const auto at = of_chain - limb.chain.begin();
    part = of_chain == limb.chain.end() || at >= limb.beyond ? 2 : at < limb.fold ? 0 : 1;
    if (segment.joint >= 0 && segment.leader < 0) {
      (*places)[segment.joint] = {names[is_leg ? 1 : 0][part], Name(side), counts[part]++};
    }
  }
}

std::vector<JointPlace> PlacesOfJoints(const KinematicModel& model, const BodyMap& map) {
  std::vector<JointPlace> places(model.num_joints());
  for (const int end : {map.pelvis, map.chest}) {
    for (int i = end; i >= 0; i = model.segments()[i].parent) {
      if (model.segments()[i].joint >= 0) places[model.segments()[i].joint].group = "trunk";
    }
  }
  for (const Side side : kSides) {
    if (const auto& leg = map.leg(side)) PlaceLimb(model, *leg, true, side, &places);
    if (const auto& arm = map.arm(side)) PlaceLimb(model, *arm, false, side, &places);
  }
  return places;
}

/// Bones that the segments do not have: feet, and hands without joints.
Json EndsJson(const RobotBody& body) {
  Json ends = Json::array();
  const auto add = [&](int segment, const Vector3d& p_S) {
    ends.push_back({{"segment", segment}, {"position", TripleJson(p_S)}});
  };
  for (std::size_t i = 0; i < 2; ++i) {
    if (body.feet) {
      add((*body.feet)[i].segment, (*body.feet)[i].heel);
      add((*body.feet)[i].segment, (*body.feet)[i].toe);
    }
    const auto& arm = body.map.arms[i];
    if (arm && !arm->has_wrist) add(arm->distal.segment, arm->distal.p_S);
  }
  return ends;
}

/// As ToJson of the model, with which part ("left leg", "right foot"; empty: the trunk) each
/// segment is of.
Json MappedModelJson(const KinematicModel& model, const BodyMap& map) {
  std::vector<std::string> parts(model.segments().size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const int parent = model.segments()[i].parent;
    if (parent >= 0) parts[i] = parts[parent];
    for (const Side side : kSides) {
      const std::string name = Name(side);
      const auto segment = static_cast<int>(i);
      if (const auto& leg = map.leg(side)) {
        if (leg->chain.front() == segment) parts[i] = name + " leg";
        if (leg->end == segment) parts[i] = name + " foot";
      }
      if (const auto& arm = map.arm(side)) {
        if (arm->chain.front() == segment) parts[i] = name + " arm";
      }
    }
  }
  Json json = ToJson(model);
  json["parts"] = parts;
  return json;
}

/// The same of a robot, with its shapes, where its limbs end, and of each joint its place in the
/// body ("knee"), side, and largest speed.
Json RobotJson(const Robot& robot, const RobotBody& body) {
  Json json = MappedModelJson(robot.model, body.map);
  json["ends"] = EndsJson(body);
  Json& shapes = json["shapes"] = Json::array();
  for (const ContactShape& shape : robot.shapes) shapes.push_back(ToJson(shape));
  const std::vector<JointPlace> places = PlacesOfJoints(robot.model, body.map);
  for (int j = 0; j < robot.model.num_joints(); ++j) {
    Json& joint = json["joints"][j];
    joint["group"] = places[j].group;
    joint["side"] = places[j].side;
    joint["order"] = places[j].order;
    joint["slides"] = robot.model.joint(j).type == JointType::kSliding;
    const double speed = robot.velocity_limits[j];
    joint["speed"] = std::isfinite(speed) ? Json(speed) : Json();
    for (const char* limit : {"lower", "upper"}) {
      if (!std::isfinite(joint[limit].get<double>())) joint[limit] = nullptr;
    }
  }
  return json;
}

/// Where the person is drawn: as tall as the robot, so that both go the same way.
struct Place {
  Vector3d position = Vector3d::Zero();  ///< [m]
  double yaw = 0, scale = 1;
};

Vector3d Middle(const std::array<LimbPosture, 2>& arms) {
  return 0.5 * (arms[0].proximal + arms[1].proximal);
}

Place PlaceOfPerson(const RetargetReport& report) {
  Place place;
  place.scale = report.retargeted.scale;
  if (report.body.feet) return place;
  // A robot that goes nowhere: shoulder to shoulder.
  const auto X_WS = SegmentPoses(report.robot.model, report.retargeted.motion.postures.front());
  const BodyPosture robot = PostureOfBody(report.body.map, X_WS);
  const BodyPosture& person = report.retargeted.human.bodies.front();
  const Vector3d left = robot.R_chest.col(1), from = person.R_chest.col(1);
  place.yaw = std::atan2(left.y(), left.x()) - std::atan2(from.y(), from.x());
  const Eigen::AngleAxisd turn(place.yaw, Vector3d::UnitZ());
  place.position = Middle(robot.arms) - place.scale * (turn * Middle(person.arms));
  return place;
}

Json MoverJson(const KinematicModel& model, PoseTrajectory motion) {
  motion.standard_deviations.resize(0, 0);
  Json json = {{"motion", MotionJson(model, motion)}};
  json["motion"].erase("anatomy");
  return json;
}

Json PersonJson(const KinematicModel& model, const PoseTrajectory& motion, const Place& place) {
  Json json = MoverJson(model, motion);
  json["place"] = {{"position", {place.position.x(), place.position.y(), place.position.z()}},
                   {"yaw", place.yaw},
                   {"scale", place.scale}};
  return json;
}

Json BitsOf(const std::vector<bool>& on, const DrawnFrames& drawn) {
  Eigen::Matrix<bool, Eigen::Dynamic, 1> bits(drawn.count());
  for (int i = 0; i < drawn.count(); ++i) bits[i] = on[drawn.frame(i)];
  return ToJson(PackBits(bits));
}

Json FeetJson(const RetargetReport& report, const DrawnFrames& drawn) {
  Json feet = Json::array();
  for (std::size_t i = 0; report.body.feet && i < 2; ++i) {
    const FootRests& rests = report.retargeted.rests[i];
    const FootFigures& foot = report.figures.feet[i];
    feet.push_back({{"side", Name(kSides[i])},
                    {"heel", BitsOf(rests.heel, drawn)},
                    {"toe", BitsOf(rests.toe, drawn)},
                    {"height", ToJson(PackFloats(drawn.LeastOf(foot.height)))},
                    {"speed", ToJson(PackFloats(drawn.MostOf(foot.speed)))}});
  }
  return feet;
}

Json LimbsJson(const RetargetFigures& figures, const DrawnFrames& drawn) {
  Json limbs = Json::array();
  for (const LimbFigures& limb : figures.limbs) {
    const auto size = static_cast<Eigen::Index>(limb.errors.size());
    const MatrixXd errors = Eigen::Map<const Eigen::VectorXd>(limb.errors.data(), size);
    limbs.push_back({{"name", limb.name}, {"errors", ToJson(PackFloats(drawn.MostOf(errors)))}});
  }
  return limbs;
}

Json TimesJson(const std::string& name, const PoseTrajectory& motion) {
  const DrawnFrames drawn(motion.num_frames());
  return {{"name", name},       {"frames", drawn.count()}, {"every", drawn.every()},
          {"optimum_every", 1}, {"rate", motion.rate},     {"first_time", motion.first_time}};
}

Json MotionOfBoth(const RetargetReport& report) {
  const DrawnFrames drawn(report.person.num_frames());
  Json json = TimesJson(report.motion_name.empty() ? "motion" : report.motion_name, report.person);
  json["person"] = PersonJson(*report.person_model, report.person, PlaceOfPerson(report));
  json["robot"] = MoverJson(report.robot.model, report.retargeted.motion);
  json["feet"] = FeetJson(report, drawn);
  json["limbs"] = LimbsJson(report.figures, drawn);
  return json;
}

PoseTrajectory Still(const KinematicModel& model, const Posture& posture) {
  PoseTrajectory still;
  still.rate = 1;
  for (int j = 0; j < model.num_joints(); ++j) still.joint_names.push_back(model.joint(j).name);
  still.postures = {posture, posture};  // a player wants a span of time
  return still;
}

/// The posture at zero, looking along x, and as high as `lowest` of its segments says.
template <typename Lowest>
PoseTrajectory AtZero(const KinematicModel& model, Posture zero, const BodyMap& map,
                      const Lowest& lowest) {
  zero.orientation = Eigen::Quaterniond(map.R_WA.transpose()) * zero.orientation;
  zero.position.setZero();
  zero.position.z() = -lowest(SegmentPoses(model, zero));
  return Still(model, zero);
}

Json ZeroPoses(const RetargetReport& report) {
  const KinematicModel& model = *report.person_model;
  const HumanBody person = FindHumanBody(model);
  const PoseTrajectory persons =
      AtZero(model, StandingPosture(model), person.map, [&](const auto& X_WS) {
        return (X_WS[person.heels[0].segment] * person.heels[0].p_S).z() - person.heel_heights[0];
      });
  const PoseTrajectory robots = AtZero(
      report.robot.model, ZeroPosture(report.robot.model), report.body.map, [&](const auto& X_WS) {
        double lowest = INFINITY;
        for (const auto& X : X_WS) lowest = std::min(lowest, X.translation().z());
        if (!report.body.feet) return lowest;
        for (const RobotFoot& foot : *report.body.feet) {
          lowest = std::min(lowest, LowestOf(foot, X_WS[foot.segment]));
        }
        return lowest;
      });
  Json json = TimesJson("both at their zero poses", persons);
  json["person"] = PersonJson(model, persons, {Vector3d::Zero(), 0, report.retargeted.scale});
  json["robot"] = MoverJson(report.robot.model, robots);
  json["feet"] = json["limbs"] = Json::array();
  return json;
}

Json BodiesJson(const RetargetReport& report) {
  const HumanBody person = FindHumanBody(*report.person_model);
  return {{"person",
           {{"name", "person"}, {"model", MappedModelJson(*report.person_model, person.map)}}},
          {"robot",
           {{"name", report.robot.model.name()}, {"model", RobotJson(report.robot, report.body)}}},
          {"trials", {MotionOfBoth(report), ZeroPoses(report)}}};
}

std::string DescribeMotion(const RetargetReport& report) {
  const RetargetFigures& figures = report.figures;
  std::string text =
      fmt::format("{}: {}, {} frames at {:g} Hz, on {} ({}).",
                  report.file.empty() ? "A made motion" : report.file, report.motion_name,
                  figures.num_frames, figures.rate, report.robot.model.name(), report.robot_file);
  if (report.body.feet) text += fmt::format(" Sole: {}.", (*report.body.feet)[0].said);
  if (!report.unshown.empty()) {
    text += fmt::format(" Not shown: {}: the robot's are as a person's at rest.", report.unshown);
  }
  return text;
}

}  // namespace

std::string FormatRetargetPage(const RetargetReport& report) {
  Json figures = ToJson(report);
  figures["program"] = fmt::format("MMMConverterS2KF {}", MMM_CONVERTER_VERSION);
  figures["sentence"] = fmt::format("Verdict: {}.", DescribeVerdict(report.verdict));
  figures["about"] = DescribeMotion(report);
  const std::string file = std::filesystem::path(report.file).filename().string();
  return FormatPage(
      {.title = fmt::format("{} on {}", file.empty() ? report.motion_name : file,
                            report.robot.model.name()),
       .styles = RobotStyles(),
       .content = RobotContent(),
       .data = DataBlock("figures", FormatJson(figures)) +
               DataBlock("bodies", FormatJsonLine(BodiesJson(report))),
       .libraries = {{PlotLibrary(), PlotLibrarySha256()}, {SceneLibrary(), SceneLibrarySha256()}},
       .script = {RobotScript(), RobotScriptSha256()}});
}

}  // namespace mmm_converter
