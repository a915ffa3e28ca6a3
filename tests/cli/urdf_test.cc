// SPDX-License-Identifier: MIT
// A robot as the model of a conversion, and the model of a person as a robot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/mjcf/mjcf_robot.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/mmm/subject_file.h"
#include "common/io/urdf/urdf_model_reader.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using testing::Handstand;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ReadText;
using testing::RunProgram;
using testing::SourcePath;
using testing::TestFolder;
using testing::WriteText;

constexpr int kFrames = 100;

std::string Humanoid() { return SourcePath("tests/support/humanoid.urdf"); }

/// One second in which every joint swings in the middle of its range, each at its own pace, and the
/// robot turns.
PoseTrajectory Swing(const KinematicModel& model) {
  PoseTrajectory motion;
  motion.rate = 100;
  for (int j = 0; j < model.num_joints(); ++j) motion.joint_names.push_back(model.joint(j).name);
  motion.postures.resize(kFrames);
  for (int k = 0; k < kFrames; ++k) {
    Posture& q = motion.postures[k];
    const double t = k / motion.rate;
    q.position = {0.1 * t, 0.2, 0.9 + 0.05 * std::sin(6 * t)};
    q.orientation = Eigen::AngleAxisd(0.5 * t, Eigen::Vector3d::UnitZ());
    q.joint_angles.resize(model.num_joints());
    for (int j = 0; j < model.num_joints(); ++j) {
      const Segment& joint = model.joint(j);
      const double range = std::min(joint.upper - joint.lower, 2.0);
      const double middle = IsEndless(joint) ? 0 : 0.5 * (joint.lower + joint.upper);
      q.joint_angles[j] = middle + 0.3 * range * std::sin((2 + 0.1 * j) * t + j);
    }
  }
  return motion;
}

/// Markers of the robot where they are exactly, as a C3D file.
std::string WriteRecording(const KinematicModel& model, const PoseTrajectory& motion) {
  std::string file = TestFolder() + "/robot.c3d";
  WriteC3d(file, SynthesizeMarkers(model, motion, {0, 0, 1, 0}, 1));
  return file;
}

/// The largest error of a joint angle in the second half [rad].
double LargestError(const PoseTrajectory& truth, const std::string& motion_file) {
  const PoseTrajectory found = ReadMmmMotionFile(motion_file).motions.at(0).trajectory;
  EXPECT_EQ(found.joint_names, truth.joint_names);
  EXPECT_EQ(found.num_frames(), truth.num_frames());
  double largest = 0;
  for (int k = truth.num_frames() / 2; k < truth.num_frames(); ++k) {
    largest = std::max(
        largest,
        (found.postures[k].joint_angles - truth.postures[k].joint_angles).cwiseAbs().maxCoeff());
  }
  return largest;
}

// Least squares without a pull to the natural posture end within a tolerance of their own; C3D has
// floats of millimetres.
constexpr double kFittedAngle = 1e-3;

// The shipped filter weighs markers against where joints were and naturally are: it is behind a
// finger that turns by a radian a second and has one marker 46 mm from its axis; 0.3 rad are 14 mm,
// less than three of the deviations of 5 mm that it assumes of a marker.
constexpr double kFilteredAngle = 0.3;

/// A configuration of framewise least squares that believes the markers alone.
std::string WriteExactConfig(const std::string& mapping = "auto") {
  std::string file = TestFolder() + "/exact.xml";
  WriteText(file, "<ConverterConfig type='JacobianConverter'><Model><MarkerMapping set='" +
                      mapping +
                      "'/></Model><Method type='leastSquares' naturalWeight_mm_per_rad='0'/>"
                      "<LeastSquares previousWeight_mm_per_rad='0'/></ConverterConfig>");
  return file;
}

TEST(Urdf, KnownAnglesOfARobotAreRecovered) {
  const KinematicModel robot = ReadUrdfModel(Humanoid()).model;
  const PoseTrajectory truth = Swing(robot);
  const std::string recording = WriteRecording(robot, truth);
  const std::string output = TestFolder() + "/o.xml";
  for (const std::string& config : {WriteExactConfig(), std::string("s2kf_default")}) {
    const auto run = RunProgram({"convert", recording, "--model", Humanoid(), "-c", config, "-o",
                                 output, "--report", TestFolder() + "/o.html"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("model is not scaled"));
    const double tolerance = config == "s2kf_default" ? kFilteredAngle : kFittedAngle;
    EXPECT_LT(LargestError(truth, output), tolerance) << config;
  }
  const MmmMotion motion = ReadMmmMotionFile(output).motions.at(0);
  EXPECT_THAT(motion.model_path, ::testing::EndsWith("humanoid.urdf"));
  EXPECT_FALSE(motion.size.height.has_value());
  const auto shown = RunProgram(
      {"report", recording, output, "--model", Humanoid(), "-o", TestFolder() + "/r.html"});
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
}

/// An arm on a box whose hand, the last link, turns without end.
std::string Arm() {
  const auto joint = [](const std::string& name, const std::string& type, const std::string& links,
                        const std::string& xyz, const std::string& more) {
    return "<joint name='" + name + "' type='" + type + "'>" + links + "<origin xyz='" + xyz +
           "'/>" + more + "</joint>";
  };
  const auto between = [](const std::string& parent, const std::string& child) {
    return "<parent link='" + parent + "'/><child link='" + child + "'/>";
  };
  const std::string limit = "<limit lower='-2' upper='2' effort='1' velocity='1'/>";
  std::string urdf =
      "<robot name='arm'><link name='box'/><link name='upper'/><link name='fore'/><link "
      "name='hand'/>" +
      joint("shoulder", "revolute", between("box", "upper"), "0 0 0.5",
            "<axis xyz='0 1 0'/>" + limit) +
      joint("elbow", "revolute", between("upper", "fore"), "0.3 0 0",
            "<axis xyz='0 1 0'/>" + limit) +
      joint("wrist", "continuous", between("fore", "hand"), "0.3 0 0", "<axis xyz='1 0 0'/>");
  const std::vector<std::array<std::string, 3>> markers = {
      {"A", "box", "0.2 0.2 0"},    {"B", "box", "-0.2 0.2 0"},   {"C", "box", "0 -0.2 0.3"},
      {"D", "upper", "0.1 0 0.05"}, {"E", "upper", "0.2 0.05 0"}, {"F", "fore", "0.1 0 0.05"},
      {"G", "fore", "0.2 -0.05 0"}, {"H", "hand", "0.05 0.1 0"},  {"I", "hand", "0.05 -0.1 0"},
      {"J", "hand", "0.1 0 0.1"}};
  for (const auto& [label, link, xyz] : markers) {
    urdf += "<link name='" + label + "_marker'/>" +
            joint(label, "fixed", between(link, label + "_marker"), xyz, "");
  }
  return urdf + "</robot>";
}

// The filter expects joints to stay; one that turns is behind by what a frame brings, 0.025 rad,
// times the share of it that the frame's markers do not yet make up for, below 1.
constexpr double kTurningAngle = 0.05;

TEST(Urdf, ContinuousJointsTurnOnAndOn) {
  const std::string urdf = TestFolder() + "/arm.urdf";
  WriteText(urdf, Arm());
  const KinematicModel arm = ReadUrdfModel(urdf).model;
  PoseTrajectory truth;
  truth.rate = 100;
  truth.joint_names = {"shoulder", "elbow", "wrist"};
  truth.postures.resize(500);
  for (int k = 0; k < truth.num_frames(); ++k) {
    const double t = k / truth.rate;
    truth.postures[k].joint_angles = Eigen::Vector3d(0.3 * std::sin(t), 0.5, 2.5 * t);
  }
  const std::string recording = WriteRecording(arm, truth);
  for (const char* config : {"s2kf_default", "s2kf_offline", "jacobian_least_squares"}) {
    const std::string output = TestFolder() + "/o.xml";
    const auto run =
        RunProgram({"convert", recording, "--model", urdf, "-c", config, "-o", output});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr(", 0 reinitialised")) << config;
    EXPECT_LT(LargestError(truth, output), kTurningAngle) << config;
  }
}

TEST(Urdf, MarkerSetsPlaceMarkers) {
  const KinematicModel robot = ReadUrdfModel(Humanoid()).model;
  // The same robot without markers; a set has them by link or joint.
  std::string bare = ReadText(Humanoid());
  std::string set = "<MarkerSet name='robot'>\n";
  for (const ModelMarker& marker : robot.markers()) {
    const std::string line = "  <link name=\"" + marker.name + "_marker\"/>";
    const std::size_t begin = bare.find(line);
    bare.erase(begin, bare.find('\n', begin) + 1 - begin);
    const Eigen::Vector3d p = 1e3 * marker.p_SM;
    set += "<Marker name='" + marker.name + "' segment='" + robot.segments()[marker.segment].name +
           "' x_mm='" + std::to_string(p.x()) + "' y_mm='" + std::to_string(p.y()) + "' z_mm='" +
           std::to_string(p.z()) + "'/>\n";
  }
  set.replace(set.find("segment='neck_pitch'"), 20, "segment='head'");
  const std::string model_file = TestFolder() + "/bare.urdf";
  const std::string set_file = TestFolder() + "/set.xml";
  WriteText(model_file, bare);
  WriteText(set_file, set + "</MarkerSet>");
  const PoseTrajectory truth = Swing(robot);
  const std::string recording = WriteRecording(robot, truth);
  const std::string output = TestFolder() + "/o.xml";
  const std::vector<std::string> convert = {"convert", recording, "--model", model_file,
                                            "-o",      output,    "-c",      WriteExactConfig()};
  auto with_option = convert;
  with_option.insert(with_option.end(), {"--marker-set", set_file});
  auto run = RunProgram(with_option);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_LT(LargestError(truth, output), kFittedAngle);
  const std::string by_option = ReadText(output);

  run = RunProgram(convert);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("no marker set"));
  auto with_config = convert;
  with_config.back() = WriteExactConfig("set.xml");
  EXPECT_EQ(RunProgram(with_config).exit_code, 0);
  EXPECT_EQ(ReadText(output), by_option);

  WriteText(set_file,
            "<MarkerSet name='robot'><Marker name='A' segment='haed' x_mm='0' y_mm='0' "
            "z_mm='0'/></MarkerSet>");
  run = RunProgram(with_option);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("set.xml:1: marker A: model humanoid has no segment \"haed\" (did "
                                 "you mean head?)"));
}

TEST(Urdf, RobotsAreNotScaled) {
  const KinematicModel robot = ReadUrdfModel(Humanoid()).model;
  const std::string recording = WriteRecording(robot, Swing(robot));
  const std::vector<std::string> convert = {"convert", recording,
                                            "--model", Humanoid(),
                                            "-o",      TestFolder() + "/o.xml",
                                            "-c",      "jacobian_least_squares"};
  const auto with = [&](std::initializer_list<std::string> more) {
    auto arguments = convert;
    arguments.insert(arguments.end(), more);
    return RunProgram(arguments);
  };
  auto run = with({"--height", "1.7"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("the model is not scaled (it is a URDF or one of OpenSim, "));
  run = with({"--self-calibrate"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("but a subject is relative to the scaled one"));
  run = RunProgram({"calibrate", recording, "--model", Humanoid(), "-o", TestFolder() + "/s.xml"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("the model is not scaled (it is a URDF or one of OpenSim, "));
  run = RunProgram({"export-urdf", "--model", Humanoid(), "-o", TestFolder() + "/again.urdf"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("the model is not scaled (it is a URDF or one of OpenSim)"));
}

TEST(Urdf, InfoDescribesIt) {
  const auto run = RunProgram({"info", Humanoid()});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, AllOf(HasSubstr("model humanoid"), HasSubstr("left_knee"),
                             HasSubstr("joints     32"), HasSubstr("markers    47")));
}

/// Where the shipped model's markers are, read back from a URDF, beside those of the model.
void ExpectSameMarkers(const KinematicModel& model, const std::string& urdf) {
  const KinematicModel read = ReadUrdfModel(urdf).model;
  const Posture posture = ZeroPosture(model);
  const Eigen::Matrix3Xd p = MarkerPositions(model, posture);
  const Eigen::Matrix3Xd q = MarkerPositions(read, posture);
  ASSERT_EQ(q.cols(), p.cols());
  for (Eigen::Index i = 0; i < p.cols(); ++i) {
    const int other = read.FindMarker(model.markers()[i].name);
    ASSERT_GE(other, 0);
    // The accuracy that is promised; rounding is far below.
    EXPECT_LT((q.col(other) - p.col(i)).norm(), 1e-9);
  }
  EXPECT_NEAR(read.total_mass(), model.total_mass(), 1e-9);  // [kg], rounding of a sum
}

KinematicModel Reference() { return ReadMmmModel(SourcePath("xml_config/models/mmm.xml")); }

TEST(ExportUrdf, WritesTheScaledModelThatCheckUrdfAccepts) {
  const std::string urdf = TestFolder() + "/anna.urdf";
  const auto run = RunProgram({"export-urdf", "--height", "1.75", "--mass", "70", "-o", urdf});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("mmm.xml as a person of 1.75 m and 70 kg; "));
  EXPECT_THAT(run.err,
              AllOf(HasSubstr("\"Hand L Root\" as Hand_L_Root"), Not(HasSubstr("arning"))));
  ExpectSameMarkers(ScaleWinter(Reference(), {1.75, 70, std::nullopt}), urdf);
  // An own file of what is exported is converted as any robot, by KIT's labels.
  const auto converted =
      RunProgram({"convert", Handstand(), "--model", urdf, "--frames", "0:20", "-c",
                  "jacobian_least_squares", "-o", TestFolder() + "/o.xml"});
  EXPECT_EQ(converted.exit_code, 0) << converted.err;
  if (std::system("command -v check_urdf > /dev/null") != 0) {
    GTEST_SKIP() << "check_urdf (liburdfdom-tools) is not installed";
  }
  const std::string output = TestFolder() + "/check.txt";
  EXPECT_EQ(std::system(("check_urdf '" + urdf + "' > '" + output + "' 2>&1").c_str()), 0);
  EXPECT_THAT(ReadText(output), AllOf(HasSubstr("Successfully Parsed XML"),
                                      HasSubstr("root Link: root_joint"), Not(HasSubstr("rror"))));
}

TEST(ExportUrdf, WritesTheSubjectsModel) {
  Subject subject;
  subject.name = "nobody";
  subject.model = "MMM";
  subject.height = 1.6;
  subject.mass = 50;
  subject.scales = {{"LKsegment_joint", 1.1, 0.01, 0.1}};
  subject.offsets = {{"MARKER_C7", {0.01, 0.02, 0.03}, Eigen::Vector3d::Ones(), 1, 1}};
  const std::string file = TestFolder() + "/nobody.xml";
  const std::string urdf = TestFolder() + "/nobody.urdf";
  WriteText(file, FormatSubject(subject, "a test"));
  const auto run = RunProgram({"export-urdf", "--subject-file", file, "-o", urdf});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(ReadText(urdf), HasSubstr("the subject nobody"));
  ExpectSameMarkers(FitToSubject(ScaleWinter(Reference(), {1.6, 50, std::nullopt}), subject), urdf);
}

TEST(ExportUrdf, AsksForThePersonAndKeepsItsInputs) {
  const std::string urdf = TestFolder() + "/o.urdf";
  for (const std::vector<std::string>& known :
       {std::vector<std::string>{}, {"--height", "1.7"}, {"--mass", "70"}}) {
    std::vector<std::string> arguments = {"export-urdf", "-o", urdf};
    arguments.insert(arguments.end(), known.begin(), known.end());
    const auto run = RunProgram(arguments);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr("how tall and heavy is the person?"));
  }
  EXPECT_FALSE(std::filesystem::exists(urdf));
  const std::string model = TestFolder() + "/model.xml";
  std::filesystem::copy_file(SourcePath("xml_config/models/mmm.xml"), model);
  const auto run =
      RunProgram({"export-urdf", "--model", model, "--height", "1.7", "--mass", "70", "-o", model});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("would be lost"));
}

/// The same arm with a joint beside its body's origin, one that counts from elsewhere, and a foot.
constexpr const char* kMjcfArm = R"(<mujoco model="arm"><default><geom size="0.03"/>
<joint axis="0 1 0" range="-90 90"/></default>
<worldbody><geom type="plane" size="1 1 1"/><body name="box"><freejoint/><geom/>
  <site name="A_marker" pos="0.2 0.2 0"/><site name="B_marker" pos="-0.2 0.2 0"/>
  <site name="C_marker" pos="0 -0.2 0.3"/>
  <body name="upper" pos="0 0 0.5"><joint name="shoulder" pos="0 0 -0.1"/><geom/>
    <site name="D_marker" pos="0.1 0 0.05"/><site name="E_marker" pos="0.2 0.05 0"/>
    <body name="fore" pos="0.3 0 0"><joint name="elbow" ref="30"/><geom/>
      <site name="F_marker" pos="0.1 0 0.05"/><site name="G_marker" pos="0.2 -0.05 0"/>
    </body></body></body></worldbody></mujoco>)";

TEST(Mjcf, KnownAnglesOfARobotAreRecovered) {
  const std::string file = TestFolder() + "/arm.xml";
  WriteText(file, kMjcfArm);
  const KinematicModel arm = ReadMjcf(file).model;
  ASSERT_EQ(arm.num_joints(), 2);
  const PoseTrajectory truth = Swing(arm);
  const std::string output = TestFolder() + "/o.xml";
  const auto run = RunProgram({"convert", WriteRecording(arm, truth), "--model", file, "-c",
                               WriteExactConfig(), "-o", output});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_LT(LargestError(truth, output), kFittedAngle);
  const auto info = RunProgram({"info", file});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, AllOf(HasSubstr("model arm"), HasSubstr("elbow"), HasSubstr("bodies     3"),
                              HasSubstr("30.0 mm below, 1 sphere of fore")));
}

}  // namespace
}  // namespace mmm_converter
