// SPDX-License-Identifier: MIT
// MuJoCo puts the bodies of a robot's file where we put them.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <array>
#include <fstream>
#include <memory>
#include <string>

#include "common/io/bytes/file_content.h"
#include "common/io/robot/robot_file.h"
#include "common/io/robot/robot_motion.h"
#include "common/math/seeded_random.h"
#include "common/model/forward_kinematics.h"
#include "tests/support/random_posture.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using testing::RandomPosture;
using testing::SharedData;
using testing::TestFolder;

constexpr double kSame = 1e-9;  // [m] and of rotation matrices: what long chains round

void Erase(const std::string& begin, const std::string& end, std::string* text) {
  for (std::size_t at = text->find(begin); at != std::string::npos; at = text->find(begin, at)) {
    text->erase(at, text->find(end, at + begin.size()) + end.size() - at);
  }
}

/// Without meshes, which are not there, and what is newer than Debian's MuJoCo. What
/// URDF's bodies weigh does not count; those that are fixed to others stay bodies.
std::string ForMujoco(std::string text) {
  const std::size_t robot = text.find("<robot");
  if (robot != std::string::npos) {
    Erase("<visual", "</visual>", &text);
    Erase("<collision", "</collision>", &text);
    Erase("<mujoco>", "</mujoco>", &text);
    return text.insert(text.find('>', robot) + 1,
                       "<mujoco><compiler fusestatic='false' balanceinertia='true' "
                       "boundmass='1e-3' boundinertia='1e-6'/></mujoco>");
  }
  Erase("<geom ", "/>", &text);
  Erase("<mesh ", "/>", &text);
  Erase(" actuatorfrclimited=\"", "\"", &text);
  Erase(" actuatorfrcrange=\"", "\"", &text);
  return text.insert(text.find('>', text.find("<mujoco")) + 1, "<compiler autolimits='true'/>");
}

using MujocoModel = std::unique_ptr<mjModel, decltype(&mj_deleteModel)>;
using MujocoData = std::unique_ptr<mjData, decltype(&mj_deleteData)>;

MujocoModel ReadByMujoco(const std::string& file) {
  const std::string copy = TestFolder() + "/robot.xml";
  std::ofstream(copy) << ForMujoco(ReadFileContent(file));
  std::array<char, 1000> message = {};
  MujocoModel model(mj_loadXML(copy.c_str(), nullptr, message.data(), message.size()),
                    &mj_deleteModel);
  EXPECT_NE(model, nullptr) << file << ": " << message.data();
  return model;
}

/// The posture as the files for robot learning have it, whose order of joints is MuJoCo's.
void SetPosture(const Robot& robot, const Posture& posture, const mjModel& model, mjData* data) {
  PoseTrajectory still;
  still.rate = 1;
  still.postures = {posture};
  for (int i = 0; i < robot.model.num_joints(); ++i) {
    still.joint_names.push_back(robot.model.joint(i).name);
  }
  const RobotMotion motion = MakeRobotMotion(robot, still, {}, RobotOrder::kDepthFirst);
  int at = 0, joint = 0;
  if (model.njnt > 0 && model.jnt_type[0] == mjJNT_FREE) {
    for (int i = 0; i < 3; ++i) data->qpos[at++] = motion.root_positions(i, 0);
    for (int i = 0; i < 4; ++i) data->qpos[at++] = motion.root_quaternions(i, 0);
    ++joint;
  }
  ASSERT_EQ(model.nq - at, motion.joint_positions.rows());
  for (std::size_t i = 0; i < motion.joints.size(); ++i, ++joint) {
    EXPECT_EQ(mj_id2name(&model, mjOBJ_JOINT, joint), motion.joints[i]);
    data->qpos[at++] = motion.joint_positions(static_cast<Eigen::Index>(i), 0);
  }
}

void ExpectSameBodies(const std::string& file) {
  const Robot robot = ReadRobotFile(file);
  const MujocoModel model = ReadByMujoco(file);
  if (model == nullptr) return;
  const MujocoData data(mj_makeData(model.get()), &mj_deleteData);
  const bool floats = model->njnt > 0 && model->jnt_type[0] == mjJNT_FREE;
  SeededRandom random(7);
  for (int n = 0; n < 10; ++n) {
    Posture posture = RandomPosture(robot.model, random);
    if (!floats) {  // a URDF's root
      posture.position.setZero();
      posture.orientation.setIdentity();
    }
    SetPosture(robot, posture, *model, data.get());
    mj_kinematics(model.get(), data.get());
    const auto X_WS = SegmentPoses(robot.model, posture);
    int compared = 0;
    for (const Robot::Link& link : robot.links) {
      const int body = mj_name2id(model.get(), mjOBJ_BODY, link.name.c_str());
      ASSERT_GE(body, 0) << link.name;
      const Eigen::Isometry3d X = X_WS[static_cast<std::size_t>(link.segment)] * link.X_SL;
      const Eigen::Map<const Eigen::Vector3d> p(data->xpos + 3 * body);
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data->xmat + 9 * body);
      EXPECT_LT((X.translation() - p).norm(), kSame) << link.name;
      EXPECT_LT((X.linear() - R).norm(), kSame) << link.name;
      ++compared;
    }
    EXPECT_EQ(compared, model->nbody - 1);
  }
}

TEST(Mujoco, HasTheBodiesOfMadeFilesWhereWeHaveThem) {
  ExpectSameBodies(testing::SourcePath("examples/robot/biped.urdf"));
  const std::string urdf = TestFolder() + "/lift.urdf";
  std::ofstream(urdf) << "<robot name='lift'><link name='base'/><link name='mast'/><link "
                         "name='arm'/><link name='finger'/>"
                         "<joint name='up' type='prismatic'><parent link='base'/><child "
                         "link='mast'/><origin xyz='0.1 0 0.2' rpy='0.3 -0.2 0.5'/><axis xyz='0 1 "
                         "2'/><limit lower='-0.2' upper='0.7' effort='9' velocity='1'/></joint>"
                         "<joint name='turn' type='continuous'><parent link='mast'/><child "
                         "link='arm'/><axis xyz='0 0 1'/></joint>"
                         "<joint name='grip' type='prismatic'><parent link='arm'/><child "
                         "link='finger'/><axis xyz='1 0 0'/><limit lower='0' upper='0.04' "
                         "effort='9' velocity='1'/></joint></robot>";
  ExpectSameBodies(urdf);
  const std::string mjcf = TestFolder() + "/made.xml";
  std::ofstream(mjcf)
      << "<mujoco><compiler eulerseq='zyx'/><default><joint "
         "damping='1'/><default class='bent'>"
         "<joint axis='1 0 1' range='-40 50'/></default></default><worldbody><body name='trunk' "
         "pos='0 0 1'><freejoint/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>"
         "<body name='thigh' pos='0 0.1 0' euler='20 30 40' childclass='bent'><joint name='hip'/>"
         "<joint name='twist' axis='0 0 1' pos='0.1 0 0.2' ref='30'/>"
         "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>"
         "<body name='shank' pos='0 0 -0.4' axisangle='0 1 1 25'><joint name='rod' type='slide' "
         "axis='0 0 1' range='-0.1 0.2'/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>"
         "<body name='foot' pos='0 0 -0.4' xyaxes='0 1 0 -1 0 0.2'/></body></body></body>"
         "</worldbody></mujoco>";
  ExpectSameBodies(mjcf);
}

TEST(MujocoReal, HasTheBodiesOfRobotsWhereWeHaveThem) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const char* file :
       {"unitree_g1/g1_custom_collision_29dof.urdf", "unitree_g1/g1_mocap_29dof.xml",
        "unitree_h1/h1.urdf", "unitree_h1/h1.xml", "booster_t1/T1_23dof.urdf",
        "booster_t1/T1_23dof.xml"}) {
    SCOPED_TRACE(file);
    ExpectSameBodies(SharedData(std::string("robots/") + file));
  }
}

}  // namespace
}  // namespace mmm_converter
