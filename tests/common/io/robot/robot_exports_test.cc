// SPDX-License-Identifier: MIT
// Files are read back by Python's own modules and NumPy, where these are installed.
#include "common/io/robot/robot_exports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "common/io/bytes/file_content.h"
#include "common/io/mjcf/mjcf_robot.h"
#include "common/io/robot/robot_file.h"
#include "common/io/urdf/urdf_robot.h"
#include "common/model/forward_kinematics.h"
#include "common/support/error.h"
#include "tests/support/random_posture.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::SharedData;
using testing::TestFolder;

/// A trunk with two legs of two joints and a head that follows the first joint; the second joint of
/// the left leg turns beside its body's origin.
Robot Walker() {
  return ParseMjcf(
      "<mujoco model='walker'><compiler angle='radian'/><worldbody><body name='trunk'><freejoint/>"
      "<body name='l1' pos='0 0.1 0'><joint name='left_hip' axis='0 1 0' range='-1 1'/>"
      "<geom size='0.1'/><body name='l2' pos='0 0 -0.4'><joint name='left_knee' axis='1 0 0' "
      "pos='0 0 0.05' range='-1 1'/><geom size='0.1'/><body name='l3' pos='0 0 "
      "-0.1'/></body></body>"
      "<body name='r1' pos='0 -0.1 0'><joint name='right_hip' axis='0 1 0' range='-1 1'/>"
      "<geom size='0.1'/><body name='r2' pos='0 0 -0.4'><joint name='right_knee' axis='1 0 0' "
      "range='-1 1'/><geom size='0.1'/></body></body>"
      "<body name='head' pos='0 0 0.4'><joint name='neck' axis='0 0 1'/><geom size='0.1'/></body>"
      "</body></worldbody><equality><joint joint1='neck' joint2='left_hip' polycoef='0.1 2'/>"
      "</equality></mujoco>",
      "walker.xml", {});
}

/// Smooth, at 100 Hz for one second, with a root that turns through -q.
PoseTrajectory Swing(const KinematicModel& model) {
  PoseTrajectory motion;
  motion.rate = 100;
  for (int i = 0; i < model.num_joints(); ++i) motion.joint_names.push_back(model.joint(i).name);
  for (int k = 0; k <= 100; ++k) {
    const double t = 0.01 * k;
    Posture posture;
    posture.position = Eigen::Vector3d(t, 0.1 * std::sin(6 * t), 0.8);
    posture.orientation = Eigen::AngleAxisd(7 * t, Eigen::Vector3d(0.1, 0.2, 1).normalized());
    if (k % 2 == 1) posture.orientation.coeffs() *= -1;
    posture.joint_angles.resize(model.num_joints());
    for (int i = 0; i < model.num_joints(); ++i) {
      posture.joint_angles[i] = 0.9 * std::sin(5 * t + i);
    }
    motion.postures.push_back(posture);
  }
  return motion;
}

bool HasNumPy() { return std::system("/usr/bin/python3 -c 'import numpy' 2> /dev/null") == 0; }

/// What a script prints, word by word, as numbers. f is the file.
std::vector<double> RunPython(const std::string& file, const std::string& script) {
  const std::string code = TestFolder() + "/script.py", out = TestFolder() + "/out.txt";
  std::ofstream(code) << "import pickle, sys\nimport numpy as np\nf = sys.argv[1]\n" << script;
  const std::string command = "/usr/bin/python3 -W error " + code + " " + file + " > " + out;
  EXPECT_EQ(std::system(command.c_str()), 0) << script;
  std::ifstream in(out);
  std::vector<double> numbers;
  for (double number = 0; in >> number;) numbers.push_back(number);
  return numbers;
}

std::string Write(const std::string& name, const Robot& robot, const PoseTrajectory& motion,
                  const RobotExportOptions& options = {}) {
  std::string file = TestFolder() + "/" + name + ".out";
  FindRobotExporter(name).write(file, robot, motion, options);
  return file;
}

RobotExportOptions At(double rate) {
  RobotExportOptions options;
  options.rate = rate;
  return options;
}

/// What MuJoCo's qpos is at a frame of the motion at 100 Hz.
std::vector<double> QPosAt(const Robot& robot, const PoseTrajectory& motion, int k) {
  const Posture& q = motion.postures[static_cast<std::size_t>(k)];
  std::vector<double> row = {q.position.x(),    q.position.y(),    q.position.z(),
                             q.orientation.w(), q.orientation.x(), q.orientation.y(),
                             q.orientation.z()};
  for (const Segment& segment : robot.model.segments()) {
    if (segment.joint < 0) continue;
    const double value = q.joint_angles[segment.joint];
    row.push_back(segment.leader < 0 ? value : 0.1 + 2 * value);
  }
  return row;
}

/// The same turn, whatever the sign of the quaternion at `at`.
void ExpectSameRow(std::vector<double> row, std::vector<double> expected, double tolerance,
                   std::size_t at = 3) {
  ASSERT_EQ(row.size(), expected.size());
  double dot = 0;
  for (std::size_t i = at; i < at + 4; ++i) dot += row[i] * expected[i];
  for (std::size_t i = at; i < at + 4; ++i) row[i] *= dot < 0 ? -1 : 1;
  for (std::size_t i = 0; i < row.size(); ++i) EXPECT_NEAR(row[i], expected[i], tolerance) << i;
}

constexpr double kCsvDigits = 1e-9;

TEST(RobotExports, LafanIsAsUnitreeHasIt) {
  const Robot robot = Walker();
  const PoseTrajectory motion = Swing(robot.model);
  const std::string file = Write("lafan1", robot, motion, At(50));
  std::ifstream in(file);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  ASSERT_EQ(rows.size(), 51u);
  for (int k = 0; k <= 50; ++k) {
    std::vector<double> expected = QPosAt(robot, motion, 2 * k);
    std::rotate(expected.begin() + 3, expected.begin() + 4, expected.begin() + 7);  // x y z w
    ExpectSameRow(rows[static_cast<std::size_t>(k)], expected, kCsvDigits);
  }
  for (std::size_t k = 1; k < rows.size(); ++k) {
    double dot = 0;
    for (std::size_t i = 3; i < 7; ++i) dot += rows[k][i] * rows[k - 1][i];
    EXPECT_GT(dot, 0.9);
  }
  EXPECT_THAT(ReadFileContent(file + ".names.json"),
              HasSubstr("\"joints\": [\"left_hip\", \"left_knee\", \"right_hip\", \"right_knee\", "
                        "\"neck\"]"));
}

TEST(RobotExports, OwnRatesAreUsedWhereNoneIsAskedFor) {
  const Robot robot = Walker();
  const std::string csv = ReadFileContent(Write("lafan1", robot, Swing(robot.model)));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 31);
}

TEST(RobotExports, GmrIsReadByPickle) {
  if (!HasNumPy()) GTEST_SKIP() << "needs Debian's python3 with numpy";
  const Robot robot = Walker();
  const PoseTrajectory motion = Swing(robot.model);
  const std::string file = Write("gmr", robot, motion);
  const auto row = RunPython(file, R"(with open(f, 'rb') as file: d = pickle.load(file)
assert d['root_rot'].shape == (101, 4) and d['dof_pos'].shape == (101, 5)
assert d['local_body_pos'].shape == (101, 7, 3) and d['root_pos'].dtype == np.float64
assert d['link_body_list'] == ['trunk', 'l1', 'l2', 'l3', 'r1', 'r2', 'head'], d['link_body_list']
assert d['joint_names'][0] == 'left_hip'
d['root_pos'][0, 0] += 1  # own and writable
print(d['fps'], *d['root_pos'][37], *d['root_rot'][37], *d['dof_pos'][37], *d['local_body_pos'][37].ravel())
)");
  ASSERT_EQ(row.size(), 1u + 12 + 21);
  EXPECT_EQ(row[0], 100);
  std::vector<double> expected = QPosAt(robot, motion, 37);
  std::rotate(expected.begin() + 3, expected.begin() + 4, expected.begin() + 7);
  ExpectSameRow({row.begin() + 1, row.begin() + 13}, expected, 1e-15);
  Posture posture = motion.postures[37];
  posture.position.setZero();
  posture.orientation.setIdentity();
  const auto X_WS = SegmentPoses(robot.model, posture);
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const Robot::Link& link = robot.links[i];
    const Eigen::Isometry3d X = X_WS[static_cast<std::size_t>(link.segment)] * link.X_SL;
    const Eigen::Vector3d p = Eigen::Map<const Eigen::Vector3d>(row.data() + 13 + 3 * i);
    EXPECT_LT((p - X.translation()).norm(), 1e-6) << link.name;
  }
}

TEST(RobotExports, MujocoAndLocoMujocoHaveQposAndQvel) {
  if (!HasNumPy()) GTEST_SKIP() << "needs Debian's python3 with numpy";
  const Robot robot = Walker();
  const PoseTrajectory motion = Swing(robot.model);
  const auto row = RunPython(Write("mujoco", robot, motion), R"(d = np.load(f)
q, v = d['qpos'], d['qvel']
assert q.shape == (101, 12) and v.shape == (101, 11) and d['fps'] == 100
# The root's angular velocity is in its own frame: that of the axis, times 7.
print(*q[20], *v[20][:6], *((q[21] - q[19]) * 50)[:3], *((q[21] - q[19]) * 50 - np.r_[0, v[20]])[7:])
)");
  ASSERT_EQ(row.size(), 12u + 6 + 3 + 5);
  ExpectSameRow({row.begin(), row.begin() + 12}, QPosAt(robot, motion, 20), 1e-15);
  const Eigen::Vector3d w = 7 * Eigen::Vector3d(0.1, 0.2, 1).normalized();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(row[12 + i], row[18 + i], 1e-12);
    EXPECT_NEAR(row[15 + i], w[static_cast<Eigen::Index>(i)], 1e-9);
  }
  for (std::size_t i = 21; i < 26; ++i) EXPECT_NEAR(row[i], 0, 1e-12);
  RunPython(Write("locomujoco", robot, motion), R"(d = np.load(f, allow_pickle=True)
assert set(d) == {'qpos', 'qvel', 'frequency', 'joint_names', 'njnt', 'jnt_type', 'split_points'}
assert d['joint_names'].tolist()[:2] == ['root', 'left_hip'] and d['njnt'] == 6
assert d['jnt_type'].tolist() == [0, 3, 3, 3, 3, 3] and d['frequency'].tolist() == 100.0
assert d['split_points'].tolist() == [0, 101] and d['split_points'].dtype.kind == 'i'
)");
}

TEST(RobotExports, ObjectsAreFreeJointsBehindTheRobot) {
  if (!HasNumPy()) GTEST_SKIP() << "needs Debian's python3 with numpy";
  const Robot robot = Walker();
  const PoseTrajectory motion = Swing(robot.model);
  RobotExportOptions options = At(50);
  PoseTrajectory box = motion;
  box.joint_names.clear();
  for (Posture& posture : box.postures) {
    posture.position.x() += 2;
    posture.joint_angles.resize(0);
  }
  options.objects = {box};
  options.object_names = {"box"};
  RunPython(Write("mujoco", robot, motion, options), R"(d = np.load(f)
q, v = d['qpos'], d['qvel']
assert q.shape == (51, 12 + 7) and v.shape == (51, 11 + 6) and d['object_names'].tolist() == ['box']
assert len(d['joint_names']) == 5
# As holosoma takes them.
assert np.abs(q[:, -7:-4] - q[:, :3] - [2, 0, 0]).max() < 1e-12
assert np.abs(q[:, -4:] - q[:, 3:7]).max() == 0 and np.abs(v[:, -6:] - v[:, :6]).max() < 1e-9
)");
}

TEST(RobotExports, JointsThatSlideStandInTheirPlaceInMetres) {
  const auto joint = [](const std::string& name, const std::string& type, const std::string& links,
                        const std::string& more) {
    return "<joint name='" + name + "' type='" + type + "'>" + links + "<axis xyz='0 0 1'/>" +
           "<limit lower='-1' upper='1' effort='1' velocity='9'/>" + more + "</joint>";
  };
  const Robot robot = ParseUrdfRobot(
      "<robot name='r'><link name='a'/><link name='b'/><link name='c'/><link name='d'/>" +
          joint("turn", "revolute", "<parent link='a'/><child link='b'/>", "") +
          joint("lift", "prismatic", "<parent link='b'/><child link='c'/>", "") +
          joint("finger", "prismatic", "<parent link='c'/><child link='d'/>",
                "<mimic joint='lift' multiplier='-0.5' offset='0.1'/>") +
          "</robot>",
      "r.urdf");
  PoseTrajectory motion = Swing(robot.model);
  ASSERT_THAT(motion.joint_names, ElementsAre("turn", "lift"));
  for (const RobotOrder order : {RobotOrder::kDepthFirst, RobotOrder::kBreadthFirst}) {
    const RobotMotion moved = MakeRobotMotion(robot, motion, {}, order);
    EXPECT_THAT(moved.joints, ElementsAre("turn", "lift", "finger"));
    const Eigen::VectorXd& q = motion.postures[37].joint_angles;
    EXPECT_EQ(moved.joint_positions.col(37), Eigen::Vector3d(q[0], q[1], 0.1 - 0.5 * q[1]));
  }
  EXPECT_THAT(robot.effort_limits, ElementsAre(1, 1));
}

TEST(RobotExports, BeyondMimicNeedsAnOrderAndHasVelocitiesOfBodies) {
  const Robot robot = Walker();
  const PoseTrajectory motion = Swing(robot.model);
  EXPECT_THROW(Write("beyondmimic", robot, motion), Error);
  if (!HasNumPy()) GTEST_SKIP() << "needs Debian's python3 with numpy";
  RobotExportOptions options = At(100);
  options.order = ParseRobotOrder("isaac");
  const auto row = RunPython(Write("beyondmimic", robot, motion, options), R"(d = np.load(f)
assert d['joint_names'].tolist() == ['left_hip', 'right_hip', 'neck', 'left_knee', 'right_knee']
assert d['body_names'].tolist() == ['trunk', 'l1', 'r1', 'head', 'l2', 'r2'], d['body_names']
p, q, v, w = (d['body_' + n + '_w'] for n in ('pos', 'quat', 'lin_vel', 'ang_vel'))
assert d['fps'].tolist() == [100] and p.shape == (101, 6, 3) and q.shape == (101, 6, 4)
assert np.abs(np.linalg.norm(q, axis=2) - 1).max() < 1e-12 and (np.sum(q[1:] * q[:-1], 2) > 0).all()
difference = (p[2:] - p[:-2]) * 50 - v[1:-1]
def turn(a, b):  # of b conj(a), a rotation vector
    v = a[..., :1] * b[..., 1:] - b[..., :1] * a[..., 1:] - np.cross(b[..., 1:], a[..., 1:])
    n = np.linalg.norm(v, axis=-1, keepdims=True)
    return 2 * np.arcsin(n) / n * v
spin = turn(q[:-2], q[2:]) * 50 - w[1:-1]
print(np.abs(difference).max(), np.abs(spin).max(), *p[10].ravel())
)");
  ASSERT_EQ(row.size(), 2u + 18);
  EXPECT_LT(row[0], 0.02);  // m/s: differences of turns of 7 rad/s over 20 ms
  EXPECT_LT(row[1], 0.02);  // rad/s
  const auto X_WS = SegmentPoses(robot.model, motion.postures[10]);
  const std::vector<int> links = MovingLinks(robot, RobotOrder::kBreadthFirst);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Robot::Link& link = robot.links[static_cast<std::size_t>(links[i])];
    const Eigen::Isometry3d X = X_WS[static_cast<std::size_t>(link.segment)] * link.X_SL;
    const Eigen::Vector3d p = Eigen::Map<const Eigen::Vector3d>(row.data() + 2 + 3 * i);
    EXPECT_LT((p - X.translation()).norm(), 1e-6) << link.name;
  }
}

TEST(RobotExports, PhcIsReadByPickle) {
  if (!HasNumPy()) GTEST_SKIP() << "needs Debian's python3 with numpy";
  const Robot robot = Walker();
  RobotExportOptions options = At(100);
  options.motion_name = "walk \"ä\"";
  RunPython(Write("phc", robot, Swing(robot.model), options),
            R"(with open(f, 'rb') as file: d = pickle.load(file)
m = d['walk "\u00e4"']
assert m['fps'] == 100 and type(m['fps']) is int
assert m['pose_aa'].shape == (101, 6, 3) and m['dof'].shape == (101, 5)
a = 7 * 0.2 * np.array([0.1, 0.2, 1]) / np.linalg.norm([0.1, 0.2, 1])
assert np.abs(m['pose_aa'][20, 0] - a).max() < 1e-12, m['pose_aa'][20, 0]
assert np.abs(m['pose_aa'][20, 1] - [0, m['dof'][20, 0], 0]).max() == 0
try:
    import joblib
    assert joblib.load(f)['walk "\u00e4"']['root_rot'].shape == (101, 4)
except ImportError:
    pass
)");
}

TEST(RobotExports, UnknownJointsAndOrdersAreRefused) {
  const Robot robot = Walker();
  PoseTrajectory motion = Swing(robot.model);
  motion.joint_names[0] = "tail";
  EXPECT_THROW(MakeRobotMotion(robot, motion, {}, RobotOrder::kDepthFirst), Error);
  EXPECT_THROW(ParseRobotOrder("Isaac"), Error);
}

TEST(RobotExports, RatesThatAreNoneWriteNothing) {
  const Robot robot = Walker();
  const PoseTrajectory motion = Swing(robot.model);
  for (const RobotExporter& exporter : RobotExporters()) {
    const std::string file = TestFolder() + "/rates_" + exporter.name;
    for (const double rate : {-30.0, 0.0, 1e9, std::nan("")}) {
      RobotExportOptions options = At(rate);
      options.order = RobotOrder::kBreadthFirst;
      EXPECT_THROW(exporter.write(file, robot, motion, options), Error) << exporter.name << rate;
    }
    for (const std::string& one : FilesOf(exporter, file)) {
      EXPECT_FALSE(std::ifstream(one).good()) << one;
    }
  }
  EXPECT_THROW(Write("phc", robot, motion, At(29.97)), Error);
  EXPECT_THROW(FindRobotExporter("lafan2"), Error);
}

// The order of Isaac's joints as indices of Unitree's CSV, as its users have it.
TEST(RobotExportsReal, IsaacsOrderOfG1) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const char* file : {"g1_custom_collision_29dof.urdf", "g1_mocap_29dof.xml"}) {
    const Robot robot = ReadRobotFile(SharedData(std::string("robots/unitree_g1/") + file));
    PoseTrajectory motion = Swing(robot.model);
    const auto depth = MakeRobotMotion(robot, motion, {}, RobotOrder::kDepthFirst).joints;
    const auto breadth = MakeRobotMotion(robot, motion, {}, RobotOrder::kBreadthFirst).joints;
    std::vector<std::ptrdiff_t> order;
    order.reserve(breadth.size());
    for (const std::string& joint : breadth) {
      order.push_back(std::find(depth.begin(), depth.end(), joint) - depth.begin());
    }
    EXPECT_THAT(order, ElementsAre(0, 6, 12, 1, 7, 13, 2, 8, 14, 3, 9, 15, 22, 4, 10, 16, 23, 5, 11,
                                   17, 24, 18, 25, 19, 26, 20, 27, 21, 28));
    EXPECT_EQ(MovingLinks(robot, RobotOrder::kBreadthFirst).size(), 30u);
    EXPECT_EQ(depth.front(), "left_hip_pitch_joint");
    EXPECT_EQ(depth[12], "waist_yaw_joint");
  }
}

}  // namespace
}  // namespace mmm_converter
