// SPDX-License-Identifier: MIT
#include "tests/report/dynamics_cases.h"

#include <limits>
#include <utility>

#include "MMMConverterS2KF/report/dynamics_page.h"
#include "MMMConverterS2KF/report/dynamics_summary.h"
#include "tests/report/comparison_cases.h"

namespace mmm_converter::testing {
namespace {

constexpr int kFrames = 5;

KinematicModel HostileModel() {
  ModelDescription description;
  description.segments.resize(2);
  description.segments[0].name = "root";
  description.segments[0].mass = 1;
  Segment& joint = description.segments[1];
  joint.name = kHostileText;
  joint.parent = 0;
  joint.type = JointType::kRevolute;
  joint.upper = 1;
  return KinematicModel(std::move(description));
}

MotionDynamics HostileDynamics() {
  MotionDynamics dynamics;
  dynamics.rate = 100;
  dynamics.mass = 1;
  dynamics.settled_end = kFrames;
  dynamics.joint_names = {kHostileText};
  for (Eigen::Matrix3Xd* vectors :
       {&dynamics.com, &dynamics.com_velocity, &dynamics.com_acceleration,
        &dynamics.linear_momentum, &dynamics.angular_momentum, &dynamics.residual_force,
        &dynamics.residual_root_moment, &dynamics.residual_moment}) {
    *vectors = Eigen::Matrix3Xd::Random(3, kFrames);
  }
  dynamics.joint_torques = Eigen::RowVectorXd::LinSpaced(kFrames, 1, 5);
  dynamics.joint_power = dynamics.joint_torques;
  dynamics.outside_support = Eigen::VectorXd::Ones(kFrames);
  dynamics.contact_bodies = {{kHostileText, {0}, {}}};
  dynamics.contact_heights = Eigen::RowVectorXd::Zero(kFrames);
  dynamics.contacts = Eigen::RowVectorXi::Ones(kFrames);
  dynamics.ballistic_phases.resize(2);
  dynamics.ballistic_phases[0].end = dynamics.ballistic_phases[1].end = kFrames;
  dynamics.ballistic_phases[1].acceleration.setConstant(std::numeric_limits<double>::quiet_NaN());
  return dynamics;
}

}  // namespace

std::string HostileDynamicsPage() {
  const std::string text = kHostileText;
  const KinematicModel model = HostileModel();
  MotionDynamics dynamics = HostileDynamics();
  Plausibility judged = JudgeDynamics(model, dynamics);
  judged.checks.push_back({text, text, text, DynamicsJudgement::kImplausible, text});
  Person person;
  person.height = {1.8, text};
  person.mass = {75, text};
  Warnings warnings;
  warnings.Add(text);
  const DynamicsReport report = {
      {text, text, 0, text, person, model, PoseTrajectory(), warnings}, dynamics, judged};
  return FormatDynamicsPage(text, report);
}

}  // namespace mmm_converter::testing
