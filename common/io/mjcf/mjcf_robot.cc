// SPDX-License-Identifier: MIT
#include "common/io/mjcf/mjcf_robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

#include "common/io/bytes/file_content.h"
#include "common/io/mjcf/mjcf_document.h"
#include "common/io/xml/xml_text.h"
#include "common/support/error.h"
#include "common/support/error_of_file.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMaxPartBytes = std::size_t{8} << 20;  // as of other models
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kWidestRange = 4 * EIGEN_PI;  // [rad]; beyond it a limit limits nothing
constexpr double kSlideReach = 1;              // [m], of slides without limits
constexpr double kUpright = 0.7;               // cosine of the lean of a body whose z is up
constexpr std::string_view kMarkerSuffix = "_marker";

class MjcfRobotBuilder {
 public:
  MjcfRobotBuilder(const MjcfDocument& document, MjcfText* text)
      : document_(document), text_(*text), links_(document.bodies.size(), -1) {}

  Robot Build();

 private:
  const MjcfBody& BodyAt(int index) const {
    return document_.bodies[static_cast<std::size_t>(index)];
  }
  std::vector<int> CountJoints() const;
  std::vector<int> ChooseTops();
  int ChooseFloating(const std::vector<int>& floating, const std::vector<int>& joints);
  void AddBodies(const std::vector<int>& tops);
  void AddBody(int index);
  void SetStanding(const Eigen::Matrix3d& R_WB);
  Segment& AddSegment(const std::string& name, int parent, const Eigen::Isometry3d& X_PF);
  void SetJoint(const MjcfJoint& joint, Segment* segment);
  void Couple(const MjcfCoupling& coupling);
  std::string Unique(std::string name);

  const MjcfDocument& document_;
  MjcfText& text_;
  ModelDescription description_;
  std::set<std::string> names_;
  std::vector<int> links_;  // of bodies; -1: not the robot's
  std::vector<Robot::Link> robot_links_;
  std::map<std::string, int> segment_of_joint_;
  std::set<int> leaders_;  // segments that others follow
  std::map<std::string, double> ref_of_joint_;
};

/// Of each body with all below it.
std::vector<int> MjcfRobotBuilder::CountJoints() const {
  std::vector<int> counts(document_.bodies.size(), 0);
  for (std::size_t i = counts.size(); i-- > 0;) {
    counts[i] += static_cast<int>(document_.bodies[i].joints.size());
    const int parent = document_.bodies[i].parent;
    if (parent >= 0) counts[static_cast<std::size_t>(parent)] += counts[i];
  }
  return counts;
}

int MjcfRobotBuilder::ChooseFloating(const std::vector<int>& floating,
                                     const std::vector<int>& joints) {
  const auto count = [&](int body) { return joints[static_cast<std::size_t>(body)]; };
  const int chosen = *std::max_element(floating.begin(), floating.end(),
                                       [&](int a, int b) { return count(a) < count(b); });
  std::vector<std::string> others;
  for (const int body : floating) {
    if (body == chosen) continue;
    if (count(body) == count(chosen)) {
      throw Error(fmt::format("{}: has two robots, '{}' and '{}'; remove one", text_.file(),
                              BodyAt(chosen).name, BodyAt(body).name));
    }
    others.push_back(BodyAt(body).name);
  }
  if (!others.empty()) {
    text_.Warn(
        fmt::format("the robot is '{}'; left out: {}", BodyAt(chosen).name, FirstNames(others)));
  }
  return chosen;
}

/// The bodies of the world that are the robot: one that floats, or all that have joints.
std::vector<int> MjcfRobotBuilder::ChooseTops() {
  const std::vector<int> joints = CountJoints();
  std::vector<int> floating, fixed;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const MjcfBody& body = document_.bodies[i];
    if (body.parent >= 0 || body.is_moved || joints[i] == 0) continue;
    (body.is_free ? floating : fixed).push_back(static_cast<int>(i));
  }
  if (!floating.empty()) return {ChooseFloating(floating, joints)};
  if (fixed.empty()) {
    throw Error(fmt::format("{}: is no robot: no body has a hinge or a slide", text_.file()));
  }
  description_.is_root_fixed = true;
  AddSegment(Unique("world"), -1, Eigen::Isometry3d::Identity());
  return fixed;
}

std::string MjcfRobotBuilder::Unique(std::string name) {
  while (!names_.insert(name).second) name += "_body";
  return name;
}

Segment& MjcfRobotBuilder::AddSegment(const std::string& name, int parent,
                                      const Eigen::Isometry3d& X_PF) {
  Segment& segment = description_.segments.emplace_back();
  segment.name = name;
  segment.parent = parent;
  segment.X_PF = X_PF;
  return segment;
}

void MjcfRobotBuilder::SetJoint(const MjcfJoint& joint, Segment* segment) {
  segment->type = joint.slides ? JointType::kSliding : JointType::kRevolute;
  segment->axis = joint.axis;
  segment->rest = joint.ref;
  segment->lower = joint.is_limited ? joint.lower : -kInfinity;
  segment->upper = joint.is_limited ? joint.upper : kInfinity;
  const bool is_wide[] = {segment->lower<-kWidestRange, segment->upper> kWidestRange};
  if (!joint.slides && is_wide[0] != is_wide[1]) {
    text_.Fail(joint.line,
               fmt::format("joint '{}': its range {:g} to {:g} is not in radian; angles "
                           "are in degrees unless <compiler angle=\"radian\"/> says "
                           "otherwise",
                           joint.name, joint.lower, joint.upper));
  }
  if (!joint.slides && is_wide[0]) {
    segment->lower = -kInfinity;
    segment->upper = kInfinity;
  }
  if (joint.slides && HasNoLimits(*segment)) segment->reach = kSlideReach;
  if (joint.ref != 0) {
    segment->function =
        std::make_shared<const ScalarFunction>(ScalarFunction::Linear(1, -joint.ref));
  }
}

/// A start pose that is turned upright tells which way is up; one that only leans is a start.
void MjcfRobotBuilder::SetStanding(const Eigen::Matrix3d& R_WB) {
  const Eigen::Vector3d up_B = R_WB.row(2).transpose();
  if (up_B.z() > kUpright) return;
  description_.standing = Eigen::Quaterniond::FromTwoVectors(up_B, Eigen::Vector3d::UnitZ());
}

/// A segment for each joint, at its anchor; the last one is the body.
void MjcfRobotBuilder::AddBody(int index) {
  const MjcfBody& body = BodyAt(index);
  Robot::Link link;
  link.name = body.name;
  int parent = description_.segments.empty() ? -1 : 0;
  Eigen::Isometry3d X = body.X_PB;  // of the body in the segment `parent`
  if (body.parent >= 0) {
    link.parent = links_[static_cast<std::size_t>(body.parent)];
    const Robot::Link& carrier = robot_links_[static_cast<std::size_t>(link.parent)];
    parent = carrier.segment;
    X = carrier.X_SL * X;
  }
  if (parent < 0) {  // floats
    SetStanding(X.linear());
    X.setIdentity();
  }
  for (const MjcfJoint& joint : body.joints) {
    Segment& segment = AddSegment(joint.name, parent, X * Eigen::Translation3d(joint.anchor));
    SetJoint(joint, &segment);
    parent = static_cast<int>(description_.segments.size()) - 1;
    segment_of_joint_[joint.name] = parent;
    ref_of_joint_[joint.name] = joint.ref;
    X = Eigen::Isometry3d(Eigen::Translation3d(-joint.anchor));
  }
  if (body.joints.empty()) {
    AddSegment(Unique(body.name), parent, X);
    X.setIdentity();
  }
  Segment& segment = description_.segments.back();
  segment.mass = body.mass;
  segment.p_SB = X * body.p_BC;
  segment.inertia = body.inertia;
  link.segment = static_cast<int>(description_.segments.size()) - 1;
  link.X_SL = X;
  links_[static_cast<std::size_t>(index)] = static_cast<int>(robot_links_.size());
  robot_links_.push_back(std::move(link));
}

void MjcfRobotBuilder::AddBodies(const std::vector<int>& tops) {
  for (std::size_t i = 0; i < document_.bodies.size(); ++i) {
    const int parent = document_.bodies[i].parent;
    const auto index = static_cast<int>(i);
    const bool is_robot = parent < 0 ? std::find(tops.begin(), tops.end(), index) != tops.end()
                                     : links_[static_cast<std::size_t>(parent)] >= 0;
    if (is_robot) AddBody(index);
  }
}

void MjcfRobotBuilder::Couple(const MjcfCoupling& coupling) {
  const auto follower = segment_of_joint_.find(coupling.follower);
  if (follower == segment_of_joint_.end()) return;  // not the robot's
  Segment& segment = description_.segments[static_cast<std::size_t>(follower->second)];
  const std::array<double, 5>& p = coupling.polynomial;
  const bool is_free = segment.leader < 0 && segment.type != JointType::kFixed &&
                       leaders_.count(follower->second) == 0;
  if (coupling.leader.empty() && is_free) {
    segment.X_PF =
        segment.X_PF * (segment.type == JointType::kSliding
                            ? Eigen::Isometry3d(Eigen::Translation3d(p[0] * segment.axis))
                            : Eigen::Isometry3d(Eigen::AngleAxisd(p[0], segment.axis)));
    segment.type = JointType::kFixed;
    segment.function = nullptr;
    segment.lower = segment.upper = segment.rest = segment.reach = 0;
    return;
  }
  const auto leader = segment_of_joint_.find(coupling.leader);
  const bool is_led =
      is_free && leader != segment_of_joint_.end() && leader->second != follower->second;
  const Segment* moved =
      is_led ? &description_.segments[static_cast<std::size_t>(leader->second)] : nullptr;
  if (!is_led || moved->leader >= 0 || moved->type == JointType::kFixed) {
    text_.Warn(
        fmt::format("<equality><joint> of '{}' and '{}' is not kept: one of them follows "
                    "another or does not move",
                    coupling.follower, coupling.leader));
    return;
  }
  // What the segment moves by is the joint's own q, which counts from its ref.
  const double own_ref = ref_of_joint_.at(coupling.follower);
  segment.X_PF = segment.X_PF * JointTransform(segment, 0);
  segment.leader = leader->second;
  leaders_.insert(leader->second);
  segment.lower = moved->lower;
  segment.upper = moved->upper;
  segment.rest = moved->rest;
  segment.reach =
      segment.type == JointType::kSliding && HasNoLimits(*moved) ? kSlideReach : moved->reach;
  segment.function = std::make_shared<const ScalarFunction>(
      ScalarFunction::Polynomial({p[4], p[3], p[2], p[1], p[0] + own_ref})
          .After(ScalarFunction::Linear(1, -ref_of_joint_.at(coupling.leader))));
}

Robot MjcfRobotBuilder::Build() {
  description_.name = document_.name.empty() ? "robot" : document_.name;
  for (const MjcfBody& body : document_.bodies) {
    for (const MjcfJoint& joint : body.joints) names_.insert(joint.name);
  }
  AddBodies(ChooseTops());
  for (const MjcfCoupling& coupling : document_.couplings) Couple(coupling);
  const auto link_of = [&](int body) -> const Robot::Link* {
    const int link = links_[static_cast<std::size_t>(body)];
    return link < 0 ? nullptr : &robot_links_[static_cast<std::size_t>(link)];
  };
  const auto on_links = [&](auto parts, auto X_SP) {
    std::erase_if(parts, [&](const auto& part) { return link_of(part.segment) == nullptr; });
    for (auto& part : parts) {
      const Robot::Link& link = *link_of(part.segment);
      part.segment = link.segment;
      part.*X_SP = link.X_SL * part.*X_SP;
    }
    return parts;
  };
  std::vector<Robot::Site> sites = on_links(document_.sites, &Robot::Site::X_SP);
  for (const Robot::Site& site : sites) {
    if (site.name.size() > kMarkerSuffix.size() && site.name.ends_with(kMarkerSuffix)) {
      description_.markers.push_back({site.name.substr(0, site.name.size() - kMarkerSuffix.size()),
                                      site.segment, site.X_SP.translation()});
    }
  }
  std::vector<ContactShape> shapes = on_links(document_.shapes, &ContactShape::X_SG);
  std::vector<RobotMesh> meshes = on_links(document_.meshes, &RobotMesh::A_SM);
  std::vector<std::array<int, 2>> ties;
  for (const MjcfTie& tie : document_.ties) {
    std::array<int, 2> tied = {-1, -1};
    for (const Robot::Link& link : robot_links_) {
      for (std::size_t i = 0; i < 2; ++i) {
        if (link.name == tie[i]) tied[i] = link.segment;
      }
    }
    if (tied[0] >= 0 && tied[1] >= 0) ties.push_back(tied);
  }
  text_.ThrowIfErrors();
  KinematicModel model(std::move(description_));
  const Eigen::VectorXd unknown = Eigen::VectorXd::Constant(model.num_joints(), kInfinity);
  Eigen::VectorXd efforts = unknown;
  for (const MjcfBody& body : document_.bodies) {
    for (const MjcfJoint& joint : body.joints) {
      const int index = joint.effort > 0 ? model.FindJoint(joint.name) : -1;
      if (index >= 0 && model.joint(index).name == joint.name) efforts[index] = joint.effort;
    }
  }
  return {std::move(model),
          std::move(robot_links_),
          std::move(sites),
          std::move(shapes),
          std::move(meshes),
          unknown,
          "MJCF",
          std::move(ties),
          text_.file(),
          std::move(efforts)};
}

}  // namespace

bool IsMjcf(std::string_view content) { return RootName(content) == "mujoco"; }

Robot ParseMjcf(std::string_view content, const std::string& file, const MjcfPartReader& read_part,
                Warnings* warnings) {
  Diagnostics diagnostics(file, warnings);
  MjcfText text(content, read_part, &diagnostics);
  const MjcfDocument document = ReadMjcfDocument(&text);
  return OfFile(file, [&] { return MjcfRobotBuilder(document, &text).Build(); });
}

Robot ReadMjcf(const std::string& path, Warnings* warnings) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const auto read_part = [&](const std::string& name) -> std::optional<std::string> {
    const std::filesystem::path part = folder / name;
    std::error_code unreadable;
    if (!std::filesystem::exists(part, unreadable)) return {};
    return ReadFileContent(part.string(), kMaxPartBytes);
  };
  return ParseMjcf(ReadFileContent(path, kMaxPartBytes), path, read_part, warnings);
}

}  // namespace mmm_converter
