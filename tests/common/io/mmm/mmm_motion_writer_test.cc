// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "common/io/mmm/mmm_motion.h"
#include "common/io/xml/xml_document.h"
#include "common/math/rotation.h"
#include "common/support/error.h"
#include "tests/common/io/mmm/mmm_motion_samples.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kPi = std::numbers::pi;

/// Turns about all axes, through pitch +-90 degrees exactly and several times round, at an awkward
/// rate.
PoseTrajectory Tumbling(double rate, double first_time) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  PoseTrajectory trajectory;
  trajectory.rate = rate;
  trajectory.first_time = first_time;
  trajectory.joint_names = {"a_joint", "b_joint", "c_joint"};
  for (int k = 0; k < 721; ++k) {
    Posture q;
    q.position = Eigen::Vector3d(normal(random), normal(random), normal(random));
    const double turn = k * kPi / 90;  // frame 45: 90 degrees
    q.orientation = k < 360 ? Eigen::Quaterniond(RotationFromRpy({0.3, turn, 0.2 - 2 * turn}))
                            : Eigen::Quaterniond(RotationFromRpy({turn, 0.1 * turn, -3 * turn}));
    q.joint_angles = Eigen::Vector3d(normal(random), normal(random), normal(random));
    trajectory.postures.push_back(q);
  }
  return trajectory;
}

MarkerSequence SomeMarkers(double rate, double first_time) {
  MarkerSequence markers({"C7", "a <odd> & \"label\"", "never"}, 721, rate, first_time);
  for (int k = 0; k < markers.num_frames(); ++k) {
    if (k % 5 != 0) markers.frame(k).col(0) = Eigen::Vector3d(k, -0.1 * k, 1.0 / 3);
    if (k % 7 == 0) markers.frame(k).col(1) = Eigen::Vector3d(-k, 1e-5, 2.0 / 3);
  }
  return markers;
}

MmmMotionOutput Output(const PoseTrajectory& trajectory, const MarkerSequence* markers) {
  MmmMotionOutput output;
  output.recording_name = "tumbling <1>";
  output.motion_name = "subject & co";
  output.model_path = "../models/o'mmm.xml";
  output.height = 1.755;
  output.mass = 71.3;
  output.hand_length = 0.189;
  output.trajectory = &trajectory;
  output.markers = markers;
  return output;
}

void ExpectSame(const PoseTrajectory& written, const PoseTrajectory& read) {
  ASSERT_EQ(read.num_frames(), written.num_frames());
  EXPECT_EQ(read.joint_names, written.joint_names);
  // A file has 9 decimals of a time, which leaves this of a rate over 720 frames.
  EXPECT_NEAR(read.rate, written.rate, 1e-6 * written.rate);
  for (int k = 0; k < read.num_frames(); ++k) {
    // Half of the last written digit: 1e-4 mm and 1e-8 rad; three angles add up.
    EXPECT_LT((read.postures[k].position - written.postures[k].position).cwiseAbs().maxCoeff(),
              0.51e-7);
    EXPECT_LT(read.postures[k].orientation.angularDistance(written.postures[k].orientation),
              k == 0 ? 2e-8 : 4e-7)  // the writer freezes roll within 1e-7 of gimbal lock
        << k;
    EXPECT_LT(
        (read.postures[k].joint_angles - written.postures[k].joint_angles).cwiseAbs().maxCoeff(),
        0.51e-8);
  }
}

class MmmMotionWriter : public ::testing::TestWithParam<double> {};  // rates

TEST_P(MmmMotionWriter, ReadsItsOwn20BackAndWritesTheSameBytes) {
  const PoseTrajectory trajectory = Tumbling(GetParam(), 5.79);
  const MarkerSequence markers = SomeMarkers(GetParam(), 5.79);
  const std::string text = Join(FormatMmmMotion2(Output(trajectory, &markers)));
  Warnings warnings;
  const MmmMotionFile file = ParseMmmMotionFile(text, "own.xml", &warnings);
  EXPECT_EQ(file.version, "2.0");
  EXPECT_EQ(file.name, "tumbling <1>");
  EXPECT_THAT(warnings.texts(), IsEmpty());
  ASSERT_EQ(file.motions.size(), 1u);
  const MmmMotion& motion = file.motions[0];
  EXPECT_EQ(motion.name, "subject & co");
  EXPECT_EQ(motion.type, "mmm");
  EXPECT_EQ(motion.model_path, "../models/o'mmm.xml");
  EXPECT_EQ(motion.size.height, 1.755);
  EXPECT_EQ(motion.size.mass, 71.3);
  EXPECT_DOUBLE_EQ(motion.size.hand_length.value(), 0.189);
  ExpectSame(trajectory, motion.trajectory);
  EXPECT_EQ(motion.markers.num_frames(), 721);
  EXPECT_EQ(motion.markers.labels(), (std::vector<std::string>{"C7", "a <odd> & \"label\""}));
  for (int k = 0; k < 721; ++k) {
    EXPECT_EQ(IsSeen(motion.markers.frame(k).col(1)), k % 7 == 0);
    EXPECT_EQ(IsSeen(motion.markers.frame(k).col(0)), k % 5 != 0);
  }
  EXPECT_TRUE(motion.markers.frame(14).col(1).isApprox(Eigen::Vector3d(-14, 1e-5, 0.6666667),
                                                       1e-12));  // as 4 decimals of mm have it

  MmmMotionOutput again = testing::OutputOf(motion);
  again.recording_name = file.name;
  EXPECT_TRUE(Join(FormatMmmMotion2(again)) == text);
}

TEST_P(MmmMotionWriter, ReadsItsOwn10BackAndWritesTheSameBytes) {
  const PoseTrajectory trajectory = Tumbling(GetParam(), 0);
  const std::string text = Join(FormatMmmMotion1(Output(trajectory, nullptr)));
  Warnings warnings;
  const MmmMotionFile file = ParseMmmMotionFile(text, "own.xml", &warnings);
  EXPECT_EQ(file.version, "1.0");
  EXPECT_THAT(warnings.texts(), IsEmpty());
  EXPECT_EQ(file.motions[0].size.height, 1.755);
  EXPECT_EQ(file.motions[0].model_path, "../models/o'mmm.xml");
  ExpectSame(trajectory, file.motions[0].trajectory);
  EXPECT_TRUE(Join(FormatMmmMotion1(testing::OutputOf(file.motions[0]))) == text);
}

// Where roll and yaw turn about nearly the same axis, what is read has to be written alike.
TEST(MmmMotionWriter, NearGimbalLockTheSameBytesToo) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> angle(-3, 3);
  std::uniform_real_distribution<double> off(-9e-8, 9e-8);
  PoseTrajectory trajectory;
  trajectory.rate = 100;
  for (int k = 0; k < 200; ++k) {
    Posture q;
    const double pitch = (k % 2 == 0 ? 1 : -1) * (kPi / 2 + off(random));
    q.orientation = RotationFromRpy({angle(random), pitch, angle(random)});
    trajectory.postures.push_back(q);
  }
  const std::string text = Join(FormatMmmMotion2(Output(trajectory, nullptr)));
  const MmmMotionFile file = ParseMmmMotionFile(text, "own.xml");
  MmmMotionOutput again = testing::OutputOf(file.motions[0]);
  again.recording_name = file.name;
  EXPECT_TRUE(Join(FormatMmmMotion2(again)) == text);
}

INSTANTIATE_TEST_SUITE_P(Rates, MmmMotionWriter,
                         ::testing::Values(10, 29.97, 100, 119.88011932373047, 120));

TEST(MmmMotionWriterText, RollPitchYawHasNoJumps) {
  PoseTrajectory trajectory = Tumbling(100, 0);
  for (int k = 0; k < trajectory.num_frames(); ++k) {  // round and round, never near gimbal lock
    trajectory.postures[k].orientation =
        Eigen::Quaterniond(RotationFromRpy({0.2, 0.1, k * kPi / 20}));
  }
  const XmlElement root = ParseXml(Join(FormatMmmMotion2(Output(trajectory, nullptr))), "own.xml");
  const XmlElement& data =
      *root.FindChild("Motion")->FindChild("Sensors")->FindChild("Sensor")->FindChild("Data");
  ASSERT_EQ(data.children.size(), 721u);
  double yaw = 0;
  for (std::size_t k = 0; k < data.children.size(); ++k) {
    const std::string& text = data.children[k].FindChild("RootRotation")->text;
    EXPECT_EQ(text.substr(0, 8), "0.2 0.1 ");
    yaw = std::stod(text.substr(8));
    EXPECT_NEAR(yaw, static_cast<double>(k) * kPi / 20, 0.51e-8);  // half of the last digit
  }
  EXPECT_GT(yaw, 100);
}

TEST(MmmMotionWriterText, LayoutOf20) {
  PoseTrajectory trajectory;
  trajectory.rate = 100;
  trajectory.joint_names = {"BLNx_joint", "BLNy_joint"};
  trajectory.postures.resize(4);
  for (Posture& q : trajectory.postures) q.joint_angles = Eigen::Vector2d(-0.25, 1e-12);
  MarkerSequence markers({"C7"}, 2, 100, 0);
  markers.frame(1).col(0) = Eigen::Vector3d(1, 2, -0.5);
  MmmMotionOutput output = Output(trajectory, &markers);
  output.hand_length.reset();
  const std::string text = Join(FormatMmmMotion2(output));
  EXPECT_THAT(text, HasSubstr("<MMM version=\"2.0\" name=\"tumbling &lt;1&gt;\">\n"
                              "\t<Motion name=\"subject &amp; co\" type=\"mmm\">\n"
                              "\t\t<Model path=\"../models/o&apos;mmm.xml\">\n"
                              "\t\t\t<ModelProcessorConfig type=\"Winter\">\n"
                              "\t\t\t\t<Height>1.755</Height>\n\t\t\t\t<Mass>71.3</Mass>\n"
                              "\t\t\t</ModelProcessorConfig>\n\t\t</Model>\n\t\t<Sensors>\n"
                              "\t\t\t<Sensor type=\"ModelPose\" version=\"1.0\">\n"
                              "\t\t\t\t<Configuration/>\n\t\t\t\t<Data>\n"
                              "\t\t\t\t\t<Measurement timestep=\"0\">\n"
                              "\t\t\t\t\t\t<RootPosition>0 0 0</RootPosition>\n"
                              "\t\t\t\t\t\t<RootRotation>0 0 0</RootRotation>\n"
                              "\t\t\t\t\t</Measurement>\n"));
  EXPECT_THAT(text, HasSubstr("\t\t\t\t\t<Joint name=\"BLNy_joint\"/>\n\t\t\t\t</Configuration>\n"
                              "\t\t\t\t<Data>\n\t\t\t\t\t<Measurement timestep=\"0\">\n"
                              "\t\t\t\t\t\t<JointPosition>-0.25 0</JointPosition>\n"));
  EXPECT_THAT(text, HasSubstr("timestep=\"0.03\""));  // 3 / 100., not 0.029999999999999999
  EXPECT_THAT(text, HasSubstr("\t\t\t\t\t<Measurement timestep=\"0\">\n\t\t\t\t\t</Measurement>\n"
                              "\t\t\t\t\t<Measurement timestep=\"0.01\">\n\t\t\t\t\t\t"
                              "<MarkerPosition name=\"C7\">1000 2000 -500</MarkerPosition>\n"));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

TEST(MmmMotionWriterText, MarkersAlone) {
  MarkerSequence markers({"C7", "*1"}, 2, 100, 0);
  markers.frame(1).col(0) = Eigen::Vector3d(1, 2, -0.5);
  MmmMotionOutput output;
  output.motion_name = "walk";
  output.markers = &markers;
  const std::string text = Join(FormatMmmMotion2(output));
  EXPECT_THAT(text, HasSubstr("<Motion name=\"walk\" type=\"mmm\">\n\t\t<Sensors>\n"
                              "\t\t\t<Sensor type=\"MoCapMarker\" version=\"1.0\">\n"));
  const MmmMotionFile file = ParseMmmMotionFile(text, "walk.xml");
  EXPECT_EQ(file.motions.at(0).markers.labels(), std::vector<std::string>{"C7"});
  EXPECT_EQ(file.motions.at(0).markers.frame(1).col(0), Eigen::Vector3d(1, 2, -0.5));
}

TEST(MmmMotionWriterText, LayoutOf10) {
  PoseTrajectory trajectory;
  trajectory.rate = 100;
  trajectory.joint_names = {"BLNx_joint", "BLNy_joint"};
  trajectory.postures.resize(2);
  for (Posture& q : trajectory.postures) q.joint_angles = Eigen::Vector2d(-0.25, 0.5);
  MmmMotionOutput output = Output(trajectory, nullptr);
  const std::string text = Join(FormatMmmMotion1(output));
  EXPECT_THAT(text, HasSubstr("<?xml version='1.0'?>\n<MMM>\n\t<Motion name='subject &amp; co'>\n"
                              "\t\t<Model>\n\t\t\t<File>../models/o&apos;mmm.xml</File>\n"
                              "\t\t</Model>\n\t\t<ModelProcessorConfig type='Winter'>\n"
                              "\t\t\t<Height>1.755</Height>\n\t\t\t<Mass>71.3</Mass>\n"
                              "\t\t\t<HandLength>18.9</HandLength>\n"
                              "\t\t</ModelProcessorConfig>\n\t\t<JointOrder>\n"
                              "\t\t\t<Joint name='BLNx_joint'/>\n"));
  EXPECT_THAT(text, HasSubstr("\t\t\t<MotionFrame>\n\t\t\t\t<Timestep>0.01</Timestep>\n"
                              "\t\t\t\t<RootPosition>0 0 0</RootPosition>\n"
                              "\t\t\t\t<RootRotation>0 0 0</RootRotation>\n"
                              "\t\t\t\t<JointPosition>-0.25 0.5 </JointPosition>\n"
                              "\t\t\t\t<JointVelocity>0 0 </JointVelocity>\n"
                              "\t\t\t\t<JointAcceleration>0 0 </JointAcceleration>\n"
                              "\t\t\t</MotionFrame>\n"));
  // Of the root, then of the joints, which have fields.
  trajectory.velocities.setConstant(8, 2, 9);
  trajectory.velocities.bottomRows(2) << 1.5, 2.5, -0.25, 3;
  trajectory.accelerations = 10 * trajectory.velocities;
  const XmlElement own = ParseXml(Join(FormatMmmMotion1(output)), "own.xml");
  const XmlElement& second =
      *own.FindChild("Motion")->FindChild("MotionFrames")->FindChildren("MotionFrame")[1];
  EXPECT_EQ(second.FindChild("JointVelocity")->text, "2.5 3");
  EXPECT_EQ(second.FindChild("JointAcceleration")->text, "25 30");
  trajectory.accelerations(7, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Join(FormatMmmMotion1(output)), Error);
}

TEST(MmmMotionWriterText, CommentStandsInTheModel) {
  const PoseTrajectory trajectory = Tumbling(100, 0);
  MmmMotionOutput output = Output(trajectory, nullptr);
  const auto text = [&](bool is_legacy) {
    return Join(is_legacy ? FormatMmmMotion1(output) : FormatMmmMotion2(output));
  };
  const std::string plain[] = {text(false), text(true)};
  output.comment = "said -- of </Model>";
  for (const bool is_legacy : {false, true}) {
    std::string commented = text(is_legacy);
    const std::string comment = "\t\t\t<!-- said - - of &lt;/Model&gt; -->\n";
    const std::size_t place = commented.find(comment);
    ASSERT_NE(place, std::string::npos);
    EXPECT_LT(place, commented.find("</Model>"));
    EXPECT_EQ(commented.erase(place, comment.size()), plain[is_legacy ? 1 : 0]);
  }
}

TEST(MmmMotionWriterText, NotFinitePosturesAreErrors) {
  PoseTrajectory trajectory = Tumbling(100, 0);
  trajectory.postures[3].joint_angles[1] = std::numeric_limits<double>::quiet_NaN();
  try {
    Join(FormatMmmMotion2(Output(trajectory, nullptr)));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("frame 3 can't be written: joint b_joint is not finite"));
  }
  trajectory.postures[2].position.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Join(FormatMmmMotion1(Output(trajectory, nullptr))), Error);
}

// The real 2.0 file has the 1.0 file's root pose in the same digits, so ours must have them too.
TEST(MmmMotionWriterTextRealFiles, Legacy10To20HasTheDigitsOfTheRealPair) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const MmmMotionFile legacy = ReadMmmMotionFile(testing::LegacyWalkingFile());
  const std::string text = Join(FormatMmmMotion2(testing::OutputOf(legacy.motions[0])));
  const auto measurements = [](const XmlElement& root, int sensor) {
    const XmlElement& sensors = *root.FindChild("Motion")->FindChild("Sensors");
    return sensors.children[sensor].FindChild("Data")->FindChildren("Measurement");
  };
  const XmlElement real = ReadXmlFile(testing::WalkingFile());
  const XmlElement own = ParseXml(text, "own.xml");
  const auto real_poses = measurements(real, 0);
  const auto own_poses = measurements(own, 0);
  ASSERT_EQ(own_poses.size(), 318u);
  int different_digits = 0;
  for (std::size_t k = 0; k < own_poses.size(); ++k) {
    EXPECT_EQ(*own_poses[k]->FindAttribute("timestep"), *real_poses[k]->FindAttribute("timestep"));
    for (const char* name : {"RootPosition", "RootRotation"}) {
      if (own_poses[k]->FindChild(name)->text != real_poses[k]->FindChild(name)->text) {
        ++different_digits;
      }
    }
  }
  // Six significant digits are more than our eight decimals where an angle is below 0.001.
  EXPECT_LE(different_digits, 318 / 20);
  EXPECT_EQ(measurements(own, 1).size(), 318u);
}

TEST(MmmMotionWriterTextRealFiles, RealFilesComeBackTheSame) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const std::string& path : {testing::LegacyStandingFile(), testing::WavingFile()}) {
    const MmmMotionFile file = ReadMmmMotionFile(path);
    const std::string text = Join(FormatMmmMotion1(testing::OutputOf(file.motions[0])));
    const MmmMotionFile own = ParseMmmMotionFile(text, "own.xml");
    ExpectSame(file.motions[0].trajectory, own.motions[0].trajectory);
    EXPECT_TRUE(Join(FormatMmmMotion1(testing::OutputOf(own.motions[0]))) == text);
  }
}

TEST(MmmMotionWriter, PiecesAreCutAnywhereAndSmall) {
  PoseTrajectory trajectory;
  trajectory.rate = 100;
  trajectory.joint_names = {"a", "b"};
  trajectory.postures.resize(5000);
  for (int k = 0; k < 5000; ++k) {
    trajectory.postures[k].joint_angles = Eigen::Vector2d(k * 1e-3, -k * 1e-4);
  }
  const auto largest = [](const TextPieces& text) {
    std::size_t bytes = 0;
    text([&](std::string_view piece) { bytes = std::max(bytes, piece.size()); });
    return bytes;
  };
  for (const TextPieces& text : {FormatMmmMotion2(Output(trajectory, nullptr)),
                                 FormatMmmMotion1(Output(trajectory, nullptr))}) {
    const MmmMotionFile file = ParseMmmMotionFile(Join(text), "own.xml");
    ASSERT_EQ(file.motions[0].trajectory.num_frames(), 5000);
    EXPECT_EQ(file.motions[0].trajectory.postures[4999].joint_angles[0], 4.999);
    EXPECT_GT(Join(text).size(), 2 * largest(text));
  }
}

}  // namespace
}  // namespace mmm_converter
