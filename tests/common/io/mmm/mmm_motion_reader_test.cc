// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/mmm/mmm_motion.h"
#include "common/math/rotation.h"
#include "common/support/error.h"
#include "tests/common/io/mmm/mmm_motion_samples.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// Decimal text times 0.001 is off by a rounding error of double precision at most.
constexpr double kRounding = 1e-12;

std::string MotionMessageOf(const std::string& xml) {
  try {
    ParseMmmMotionFile(xml, "walk.xml");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string Motion2(const std::string& sensors) {
  return "<MMM version='2.0'><Motion name='a'><Sensors>\n" + sensors + "</Sensors></Motion></MMM>";
}

std::string Markers(const std::string& measurements) {
  return Motion2("<Sensor type='MoCapMarker'><Data>\n" + measurements + "</Data></Sensor>");
}

std::string PoseXml(const std::string& position, const std::string& rotation) {
  return Motion2("<Sensor type='ModelPose'><Data><Measurement timestep='0'><RootPosition>" +
                 position + "</RootPosition><RootRotation>" + rotation +
                 "</RootRotation></Measurement></Data></Sensor>");
}

TEST(MmmMotionReader, RefusesWhatNobodyCanMeasure) {
  EXPECT_EQ(MotionMessageOf(PoseXml("1 2e9 3", "0 0 0")),
            "walk.xml:2: <RootPosition>: found \"1 2e9 3\", expected numbers up to 1e+09");
  EXPECT_THAT(MotionMessageOf(PoseXml("1 2 3", "0 -1e300 0")), HasSubstr("<RootRotation>: found"));
  EXPECT_EQ(MotionMessageOf(PoseXml("1 nan 3", "0 0 0")), "no error");
}

TEST(MmmMotionReader, CountsWarningsOfAKind) {
  std::string sensors;
  for (int i = 0; i < 30; ++i) {
    sensors +=
        "<Sensor type='Kinematic'><Configuration><Joint name='a'/></Configuration><Data>"
        "<Measurement timestep='0'><JointPosition>nan</JointPosition></Measurement></Data>"
        "</Sensor>";
  }
  Warnings warnings;
  ParseMmmMotionFile(Motion2(sensors), "walk.xml", &warnings);
  EXPECT_THAT(warnings.texts(), SizeIs(23));  // 10 and a count of two kinds, and no root pose
}

std::string Marker(const std::string& time, const std::string& name, const std::string& text) {
  return "<Measurement timestep='" + time + "'><MarkerPosition name='" + name + "'>" + text +
         "</MarkerPosition></Measurement>\n";
}

TEST(MmmMotionReaderRealFiles, RealLegacyFiles) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Warnings warnings;
  const MmmMotionFile file = ReadMmmMotionFile(testing::LegacyStandingFile(), &warnings);
  EXPECT_EQ(file.version, "1.0");
  EXPECT_THAT(warnings.texts(), IsEmpty());
  ASSERT_THAT(file.motions, SizeIs(1));
  const MmmMotion& motion = file.motions[0];
  EXPECT_EQ(motion.name, "subject_id_314");
  EXPECT_EQ(motion.model_path, "model/mmm.xml");
  EXPECT_EQ(motion.size.height, 1.67);
  EXPECT_EQ(motion.size.mass, 100);
  EXPECT_EQ(motion.size.hand_length, std::nullopt);
  EXPECT_EQ(motion.trajectory.num_frames(), 265);
  EXPECT_EQ(motion.trajectory.rate, 100);
  EXPECT_EQ(motion.trajectory.first_time, 0);
  EXPECT_THAT(motion.trajectory.joint_names, SizeIs(40));
  EXPECT_EQ(motion.center_of_mass.cols(), 265);
  EXPECT_TRUE(motion.center_of_mass.allFinite());
  EXPECT_EQ(motion.markers.num_frames(), 0);

  const MmmMotionFile walk = ReadMmmMotionFile(testing::LegacyWalkingFile());
  const MmmMotion* found = walk.Find("subject_id_3");
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(walk.Find("nobody"), nullptr);
  EXPECT_EQ(found->trajectory.num_frames(), 318);
  EXPECT_THAT(found->trajectory.joint_names, SizeIs(44));
  const Posture& second = found->trajectory.postures[1];
  EXPECT_TRUE(second.position.isApprox(Eigen::Vector3d(1.1418, 0.381598, 0.914384), kRounding));
  EXPECT_TRUE(second.orientation.isApprox(
      Eigen::Quaterniond(RotationFromRpy({-0.0244129, -0.137233, 1.58878})), kRounding));
  EXPECT_EQ(second.joint_angles[0], -0.385355);
}

TEST(MmmMotionReaderRealFiles, SeveralKinematicSensorsBecomeOneTrajectory) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const MmmMotionFile old = ReadMmmMotionFile(testing::LegacyWalkingFile());
  Warnings warnings;
  const MmmMotionFile file = ReadMmmMotionFile(testing::WalkingFile(), &warnings);
  EXPECT_EQ(file.version, "2.0");
  EXPECT_EQ(file.name, "walking_medium01_motion395");
  // The file's second sensor has eight timestamps twice.
  ASSERT_THAT(warnings.texts(), SizeIs(1));
  EXPECT_THAT(warnings.texts()[0], HasSubstr("8 measurements repeat the time"));
  const PoseTrajectory& a = old.motions[0].trajectory;
  const PoseTrajectory& b = file.motions[0].trajectory;
  EXPECT_EQ(b.rate, 100);
  ASSERT_EQ(b.num_frames(), 318);
  ASSERT_THAT(b.joint_names, SizeIs(44));
  for (int k = 0; k < 318; ++k) {
    EXPECT_EQ(a.postures[k].position, b.postures[k].position);
    EXPECT_TRUE(b.postures[k].joint_angles.allFinite());
    for (int i = 0; i < 37; ++i) {  // the first sensor: all but the right leg, the same digits
      const auto at = std::find(a.joint_names.begin(), a.joint_names.end(), b.joint_names[i]);
      ASSERT_NE(at, a.joint_names.end());
      EXPECT_EQ(a.postures[k].joint_angles[at - a.joint_names.begin()],
                b.postures[k].joint_angles[i]);
    }
  }
}

TEST(MmmMotionReaderRealFiles, RealFilesWithMarkersAndObjects) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Warnings warnings;
  const MmmMotionFile file = ReadMmmMotionFile(testing::StirringFile(), &warnings);
  EXPECT_THAT(warnings.texts(), IsEmpty());
  std::vector<std::string> names;
  for (const MmmMotion& motion : file.motions) names.push_back(motion.name);
  EXPECT_THAT(names, ElementsAre("true_cup_large", "true_tablespoon", "true_kitchen_sideboard",
                                 "true_1723", "pred_1723", "pred_cup_large", "pred_tablespoon"));
  const MmmMotion& human = *file.Find("true_1723");
  EXPECT_EQ(human.type, "object");  // as the file says
  EXPECT_EQ(human.size.height, 1.68);
  EXPECT_EQ(human.size.mass, 62);
  EXPECT_DOUBLE_EQ(human.size.hand_length.value(), 0.18);
  EXPECT_EQ(human.markers.num_labels(), 53);
  EXPECT_EQ(human.markers.num_frames(), 79);
  EXPECT_EQ(human.markers.rate(), 10);
  EXPECT_EQ(human.markers.labels()[0], "C7");
  EXPECT_TRUE(human.markers.frame(78).allFinite());
  EXPECT_EQ(human.trajectory.num_frames(), 79);
  EXPECT_THAT(human.trajectory.joint_names, SizeIs(44 + 19 + 19));
  const MmmMotion& sideboard = *file.Find("true_kitchen_sideboard");  // no marker data
  EXPECT_EQ(sideboard.markers.num_frames(), 0);
  EXPECT_EQ(sideboard.trajectory.num_frames(), 79);
  EXPECT_EQ(sideboard.size.height, std::nullopt);
}

TEST(MmmMotionReaderRealFiles, EveryRealFileHasWhatItShould) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string folder = "mmm/kit_bimanual_10hz/";
  for (const auto& [name, frames] :
       {std::pair("Close_files_motions_3072_Close1_aj_180_30h_08.xml", 85),
        {"Cut_files_motions_3021_Cut1_c_0_05cm_03.xml", 107},
        {"Peel_files_motions_3109_Peel1_cucumber_cb_07.xml", 110},
        {"Pour_files_motions_2967_Pour1_cs_ms_0_20l_04.xml", 78}}) {
    const MmmMotionFile file = ReadMmmMotionFile(testing::SharedData(folder + name));
    for (const MmmMotion& motion : file.motions) {
      if (!motion.size.height) continue;
      EXPECT_EQ(motion.markers.num_frames(), frames) << name;
      EXPECT_EQ(motion.markers.num_labels(), 53) << name;
      EXPECT_EQ(motion.trajectory.num_frames(), frames) << name;
      EXPECT_EQ(motion.trajectory.rate, 10) << name;
    }
  }
  const MmmMotionFile wave = ReadMmmMotionFile(testing::WavingFile());
  EXPECT_EQ(wave.motions[0].trajectory.num_frames(), 427);
  EXPECT_EQ(wave.motions[0].trajectory.rate, 100);
}

TEST(MmmMotionReader, MissingFramesAreNaNMarkersAndInterpolatedPostures) {
  const std::string xml = Motion2(
      "<Sensor type='ModelPose'><Data>"
      "<Measurement timestep='1'><RootPosition>0 0 0</RootPosition>"
      "<RootRotation>0 0 3</RootRotation></Measurement>"
      "<Measurement timestep='1.01'><RootPosition>10 0 0</RootPosition>"
      "<RootRotation>0 0 3.1</RootRotation></Measurement>"
      "<Measurement timestep='1.03'><RootPosition>30 0 4</RootPosition>"
      "<RootRotation>0 0 -3.1</RootRotation></Measurement></Data></Sensor>"
      "<Sensor type='Kinematic'><Configuration><Joint name='j'/></Configuration><Data>"
      "<Measurement timestep='1.005'><JointPosition>1</JointPosition></Measurement>"
      "<Measurement timestep='1.015'><JointPosition>2 </JointPosition></Measurement>"
      "</Data></Sensor>"
      "<Sensor type='MoCapMarker'><Configuration/><Data>"
      "<Measurement timestep='0'><MarkerPosition name='A'>1 2 3</MarkerPosition>"
      "<MarkerPosition>7 8 9</MarkerPosition></Measurement>"
      "<Measurement timestep='0.01'/><Measurement/>"
      "<Measurement timestep='0.03'><MarkerPosition name='B'> 4 5 nan</MarkerPosition>"
      "<MarkerPosition name=' A'>-1e1 0 1</MarkerPosition></Measurement></Data></Sensor>");
  Warnings warnings;
  const MmmMotionFile file = ParseMmmMotionFile(xml, "walk.xml", &warnings);
  const PoseTrajectory& trajectory = file.motions[0].trajectory;
  EXPECT_EQ(trajectory.rate, 100);
  EXPECT_EQ(trajectory.first_time, 1);
  ASSERT_EQ(trajectory.num_frames(), 4);
  EXPECT_TRUE(trajectory.postures[2].position.isApprox(Eigen::Vector3d(0.02, 0, 0.002), kRounding));
  // Half way from 3.1 to -3.1 the shorter way is pi.
  EXPECT_NEAR(std::abs(trajectory.postures[2].orientation.z()), 1, kRounding);
  EXPECT_EQ(trajectory.postures[0].joint_angles[0], 1);  // half a step before its first: held
  EXPECT_NEAR(trajectory.postures[1].joint_angles[0], 1.5, kRounding);
  EXPECT_EQ(trajectory.postures[2].joint_angles[0], 2);
  EXPECT_TRUE(std::isnan(trajectory.postures[3].joint_angles[0]));
  ASSERT_THAT(warnings.texts(), SizeIs(1));
  EXPECT_THAT(warnings.texts()[0], HasSubstr("NaN, or outside of their sensor's time"));

  const MarkerSequence& markers = file.motions[0].markers;
  EXPECT_THAT(markers.labels(), ElementsAre("A", "B"));
  ASSERT_EQ(markers.num_frames(), 4);
  EXPECT_TRUE(markers.frame(0).col(0).isApprox(Eigen::Vector3d(0.001, 0.002, 0.003), kRounding));
  EXPECT_FALSE(IsSeen(markers.frame(1).col(0)));
  EXPECT_FALSE(IsSeen(markers.frame(2).col(0)));
  EXPECT_TRUE(markers.frame(3).col(0).isApprox(Eigen::Vector3d(-0.01, 0, 0.001), kRounding));
  EXPECT_FALSE(IsSeen(markers.frame(3).col(1)));
}

TEST(MmmMotionReader, MarkerSensorsAreMerged) {
  const MmmMotionFile file = ParseMmmMotionFile(
      Motion2("<Sensor type='MoCapMarker'><Data>" + Marker("0", "A", "1 1 1") +
              Marker("0.1", "A", "2 2 2") + "</Data></Sensor><Sensor type='MoCapMarker'><Data>" +
              Marker("0.1", "B", "3 3 3") + Marker("0.2", "A", "4 4 4") + "</Data></Sensor>" +
              "<Sensor type='Force'><Data><Measurement/></Data></Sensor>"),
      "walk.xml");
  const MarkerSequence& markers = file.motions[0].markers;
  EXPECT_THAT(markers.labels(), ElementsAre("A", "B"));
  EXPECT_EQ(markers.rate(), 10);
  ASSERT_EQ(markers.num_frames(), 3);
  EXPECT_TRUE(IsSeen(markers.frame(1).col(0)));
  EXPECT_TRUE(IsSeen(markers.frame(1).col(1)));
  EXPECT_TRUE(IsSeen(markers.frame(2).col(0)));
  EXPECT_FALSE(IsSeen(markers.frame(2).col(1)));
}

TEST(MmmMotionReader, TimestepsArePossible) {
  for (const char* step : {"1e-300", "0.000001", "10", "1e300"}) {
    EXPECT_THAT(MotionMessageOf(Markers(Marker("0", "A", "1 2 3") + Marker(step, "A", "1 2 3"))),
                AllOf(HasSubstr("walk.xml:"), HasSubstr("outside 1 to 100000 Hz")))
        << step;
  }
}

TEST(MmmMotionReader, NamesFileAndLineOfEveryProblem) {
  const std::string message = MotionMessageOf(
      "<MMM>\n<Motion name='a'>\n<ModelProcessorConfig><Height>tall</Height>\n"
      "<Mass>-1</Mass></ModelProcessorConfig>\n"
      "<JointOrder><Joint name='j'/><Joint name='k'/>\n<Joint name='j'/></JointOrder>\n"
      "<MotionFrames>\n<MotionFrame><Timestep>0</Timestep><JointPosition>1 2 3</JointPosition>"
      "<RootPosition>1 2</RootPosition></MotionFrame>\n"
      "<MotionFrame><Timestep>soon</Timestep></MotionFrame>\n"
      "<MotionFrame><Timestep>-1</Timestep></MotionFrame>\n"
      "<MotionFrame><RootPosition/></MotionFrame></MotionFrames></Motion></MMM>");
  EXPECT_THAT(message, HasSubstr("walk.xml:3: <Height>: found \"tall\", expected a positive"));
  EXPECT_THAT(message, HasSubstr("walk.xml:4: <Mass>: found \"-1\""));
  EXPECT_THAT(message, HasSubstr("walk.xml:6: joint j is listed twice"));
  EXPECT_THAT(message, HasSubstr("walk.xml:8: <RootPosition> has 2 numbers, expected 3"));
  EXPECT_THAT(message, HasSubstr("walk.xml:9: timestep: found \"soon\""));
  EXPECT_THAT(message, HasSubstr("walk.xml:10: the time -1 s comes after 0 s"));
  EXPECT_THAT(message, HasSubstr("walk.xml:11: <MotionFrame> has no <Timestep>"));

  const std::string markers = MotionMessageOf(
      Markers(Marker("0", "A", "1 2 3x") + Marker("0", "A", "") + Marker("inf", "A", "1 2 3") +
              "<Measurement><MarkerPosition name='A'>1 2 3</MarkerPosition></Measurement>\n"
              "<Measurement timestep='1'><MarkerPosition name='A'>1 2 3</MarkerPosition>"
              "<MarkerPosition name='A'>1 2 3</MarkerPosition></Measurement>\n"));
  EXPECT_THAT(markers, HasSubstr("walk.xml:3: <MarkerPosition>: found \"1 2 3x\", expected 3"));
  EXPECT_THAT(markers, HasSubstr("walk.xml:5: timestep: found \"inf\""));
  EXPECT_THAT(markers, HasSubstr("walk.xml:6: <Measurement> has no timestep"));
  EXPECT_THAT(markers, HasSubstr("walk.xml:7: marker A is there twice at 1 s"));
}

TEST(MmmMotionReader, RejectsWhatIsNoMotion) {
  EXPECT_THAT(MotionMessageOf("C3D, not XML"), HasSubstr("walk.xml:"));
  EXPECT_THAT(MotionMessageOf("<Robot><RobotNode/></Robot>"), HasSubstr("this is a model"));
  EXPECT_THAT(MotionMessageOf("<MMM/>"), HasSubstr("there is no <Motion>"));
  EXPECT_THAT(MotionMessageOf(Motion2("<Sensor/>")), HasSubstr("walk.xml:2: <Sensor> has no type"));
  EXPECT_EQ(MotionMessageOf("<MMM><Motion/></MMM>"), "no error");
  EXPECT_TRUE(LooksLikeMmmMotion("\xEF\xBB\xBF<?xml version='1.0'?>\n<!-- <a> -->\n<MMM>"));
  EXPECT_TRUE(LooksLikeMmmMotion("<mmm version='2.0'>"));
  EXPECT_FALSE(LooksLikeMmmMotion("<MMMModel>"));
  EXPECT_FALSE(LooksLikeMmmMotion("<Robot>"));
  EXPECT_FALSE(LooksLikeMmmMotion("<!-- "));
  EXPECT_FALSE(LooksLikeMmmMotion(""));
}

TEST(MmmMotionReader, HugeGapsDoNotTakeMemory) {
  for (const char* const far : {"1e9", "1e18", "1e300"}) {
    EXPECT_THAT(MotionMessageOf(Markers(Marker("0", "A", "1 2 3") + Marker("0.01", "A", "1 2 3") +
                                        Marker(far, "A", "1 2 3"))),
                HasSubstr("more than such a file can need"));
  }
  // Each frame with a label of its own: quadratic, were it not for the budget.
  std::string rare;
  for (int i = 0; i < 3000; ++i)
    rare += Marker(std::to_string(i), "m" + std::to_string(i), "1 2 3");
  EXPECT_THAT(MotionMessageOf(Markers(rare)), HasSubstr("more than such a file can need"));
  std::string joints;
  for (int i = 0; i < 10000; ++i) joints += "<Joint name='" + std::to_string(i) + "'/>";
  std::string angles;
  for (int i = 0; i < 10000; ++i) angles += "0 ";
  const std::string many =
      Motion2("<Sensor type='Kinematic'><Configuration>" + joints +
              "</Configuration><Data><Measurement timestep='0'><JointPosition>" + angles +
              "</JointPosition></Measurement></Data></Sensor>");
  const MmmMotionFile file = ParseMmmMotionFile(many, "walk.xml");
  EXPECT_EQ(file.motions[0].trajectory.postures[0].joint_angles.size(), 10000);
  EXPECT_EQ(file.motions[0].trajectory.rate, 100);
}

TEST(MmmMotionReader, MillionsOfMotionsAreRefused) {
  std::string motions;
  for (int i = 0; i < 10001; ++i) motions += "<Motion name='m'></Motion>";
  EXPECT_THAT(MotionMessageOf("<MMM>" + motions + "</MMM>"),
              HasSubstr("walk.xml: has 10001 motions, more than the 10000 that are read"));
}

TEST(MmmMotionReaderRealFiles, TruncatedRealFilesAreErrors) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string content = ReadFileContent(testing::WavingFile());
  for (int part = 1; part < 40; ++part) {
    EXPECT_THAT(MotionMessageOf(content.substr(0, content.size() * part / 40)),
                HasSubstr("not well-formed XML"));
  }
}

}  // namespace
}  // namespace mmm_converter
