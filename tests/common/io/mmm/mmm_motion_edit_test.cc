// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "common/io/mmm/mmm_motion.h"
#include "common/io/xml/xml_document.h"
#include "common/support/error.h"
#include "tests/common/io/mmm/mmm_motion_samples.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Two motions; the second, to be converted, has unknown things in and between everything.
const char* const kFile =
    "<?xml version=\"1.0\"?>\r\n<!-- kept -->\n<MMM version='2.0'>\n"
    "  <Motion name='cup'><Model path='cup.xml'/><Sensors><Sensor type='ModelPose'/></Sensors>"
    "</Motion>\n"
    "  <Motion name='human' type='object'>\n"
    "    <Annotation text='&lt;Sensors>'>waves</Annotation>\n"
    "    <Model path='old.xml'/><!-- </Motion> -->\n"
    "    <ModelProcessorConfig type='Winter'><Height>1</Height></ModelProcessorConfig>\n"
    "    <Sensors>\n"
    "      <Sensor type='Force'><Data>1 2 3</Data></Sensor>\n"
    "      <Sensor type='Kinematic'><Configuration><Joint "
    "name='finger'/></Configuration></Sensor>\n"
    "      <Sensor type='Kinematic'><Configuration><Joint name='a'/></Configuration></Sensor>\n"
    "      <Sensor type='MoCapMarker'><Data><Measurement timestep='0'>"
    "<MarkerPosition name='C7'>1   2 3</MarkerPosition></Measurement></Data></Sensor>\n"
    "      <Sensor type='ModelPose'></Sensor>\n"
    "    </Sensors>\n  </Motion>\n</MMM><!-- end -->\n";

PoseTrajectory OneFrame() {
  PoseTrajectory trajectory;
  trajectory.rate = 100;
  trajectory.joint_names = {"a"};
  trajectory.postures.resize(1);
  trajectory.postures[0].joint_angles = Eigen::VectorXd::Constant(1, 0.5);
  return trajectory;
}

MmmMotionOutput Output(const PoseTrajectory& trajectory, const std::string& name) {
  MmmMotionOutput output;
  output.motion_name = name;
  output.model_path = "new.xml";
  output.height = 1.7;
  output.mass = 70;
  output.trajectory = &trajectory;
  return output;
}

std::string EditMessageOf(const std::string& content, const std::string& name) {
  const PoseTrajectory trajectory = OneFrame();
  try {
    Join(WithConvertedMotions(BytesOf(content), "walk.xml", {Output(trajectory, name)}));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(MmmMotionEdit, MarkersAloneReplaceNothingElse) {
  MarkerSequence markers({"LFHD"}, 1, 100, 0);
  markers.frame(0).col(0) = Eigen::Vector3d(1, 2, 3);
  MmmMotionOutput output;
  output.motion_name = "human";
  output.markers = &markers;
  const std::string content = kFile;
  const std::string edited = Join(WithConvertedMotions(BytesOf(content), "walk.xml", {output}));
  const std::size_t begin = content.find("<Sensor type='MoCapMarker'>");
  const std::size_t end = content.find("</Sensor>", begin);
  EXPECT_TRUE(edited.starts_with(content.substr(0, begin)));
  EXPECT_TRUE(edited.ends_with(content.substr(end)));
  EXPECT_THAT(edited, HasSubstr("name=\"LFHD\">1000 2000 3000<"));
  EXPECT_THAT(edited, Not(HasSubstr("name='C7'")));
}

TEST(MmmMotionEdit, ElementsOfAnyNameMayStandWhereMmmHasNone) {
  std::string content = kFile;
  const std::string own = "<Notes><Measurement>1</Measurement><Measurement>2</Measurement></Notes>";
  content.insert(content.find("    <Annotation"), own);
  const PoseTrajectory trajectory = OneFrame();
  EXPECT_THAT(
      Join(WithConvertedMotions(BytesOf(content), "walk.xml", {Output(trajectory, "human")})),
      HasSubstr(own));
}

TEST(MmmMotionEdit, ChangesOnlyWhatIsConverted) {
  const PoseTrajectory trajectory = OneFrame();
  const std::string content = kFile;
  const std::string text =
      Join(WithConvertedMotions(BytesOf(content), "walk.xml", {Output(trajectory, "human")}));
  // Up to the model, and from the marker sensor on, nothing has changed.
  const std::string head = content.substr(0, content.find("<Model path='old.xml'/>"));
  EXPECT_EQ(text.substr(0, head.size()), head);
  EXPECT_THAT(text, HasSubstr("<Model path=\"new.xml\">\n"));
  EXPECT_THAT(text, HasSubstr("<!-- </Motion> -->\n    <Sensors>\n"
                              "      <Sensor type='Force'><Data>1 2 3</Data></Sensor>\n"
                              "      <Sensor type='Kinematic'><Configuration><Joint name='finger'/>"
                              "</Configuration></Sensor>\n      <Sensor type=\"ModelPose\""));
  EXPECT_THAT(text,
              HasSubstr("<MarkerPosition name='C7'>1   2 3</MarkerPosition></Measurement>"
                        "</Data></Sensor>\n    </Sensors>\n  </Motion>\n</MMM><!-- end -->\n"));
  EXPECT_THAT(text, Not(HasSubstr("<Height>1</Height>")));
  EXPECT_THAT(text, Not(HasSubstr("<Joint name='a'/>")));
  EXPECT_THAT(text, Not(HasSubstr("<Sensor type='ModelPose'></Sensor>")));
  EXPECT_THAT(text, HasSubstr("<Joint name=\"a\"/>"));
  const MmmMotionFile file = ParseMmmMotionFile(text, "own.xml");
  EXPECT_EQ(file.Find("human")->size.height, 1.7);
  EXPECT_EQ(file.Find("human")->trajectory.postures[0].joint_angles[0], 0.5);
  EXPECT_EQ(file.Find("human")->markers.num_frames(), 1);
  // A second conversion of the result changes nothing more.
  EXPECT_EQ(Join(WithConvertedMotions(BytesOf(text), "walk.xml", {Output(trajectory, "human")})),
            text);
}

TEST(MmmMotionEdit, ReplacesMarkersWhereSomeAreGiven) {
  const PoseTrajectory trajectory = OneFrame();
  const MarkerSequence markers({"T10"}, 1, 100, 0);
  MmmMotionOutput output = Output(trajectory, "human");
  output.markers = &markers;
  const std::string text = Join(WithConvertedMotions(BytesOf(kFile), "walk.xml", {output}));
  EXPECT_THAT(text, Not(HasSubstr("name='C7'")));
  EXPECT_THAT(text, HasSubstr("<Sensor type=\"MoCapMarker\""));
}

TEST(MmmMotionEdit, FillsWhatIsMissing) {
  const PoseTrajectory trajectory = OneFrame();
  for (const char* const sensors : {"<Sensors/>", "<Sensors></Sensors>", "<Sensors>\n</Sensors>"}) {
    const std::string content =
        "<MMM version='2.0'><Motion name='a'>" + std::string(sensors) + "</Motion></MMM>";
    const std::string text =
        Join(WithConvertedMotions(BytesOf(content), "walk.xml", {Output(trajectory, "a")}));
    const MmmMotionFile file = ParseMmmMotionFile(text, "own.xml");
    EXPECT_EQ(file.motions[0].trajectory.num_frames(), 1) << text;
    EXPECT_EQ(file.motions[0].model_path, "new.xml");
  }
}

TEST(MmmMotionEdit, SaysWhyItCannot) {
  EXPECT_THAT(EditMessageOf(kFile, "nobody"),
              HasSubstr("walk.xml: has no motion \"nobody\"; its motions are: cup, human"));
  EXPECT_THAT(EditMessageOf("<MMM><Motion name='a'><Sensors/></Motion>\n"
                            "<Motion name='a'><Sensors/></Motion></MMM>",
                            "a"),
              HasSubstr("walk.xml:2: a second motion \"a\""));
  EXPECT_THAT(EditMessageOf("<MMM><Motion name='a'><MotionFrames/></Motion></MMM>", "a"),
              HasSubstr("has no <Sensors>"));
  EXPECT_THAT(EditMessageOf("<MMM><Motion name='a'/></MMM>", "a"), HasSubstr("has no <Sensors>"));
  EXPECT_THAT(EditMessageOf("<Robot/>", "a"), HasSubstr("the root is <Robot>"));
  EXPECT_THAT(EditMessageOf("<MMM>", "a"), HasSubstr("not well-formed"));
}

// Where a damaged file is still XML, the edited one is XML too.
TEST(MmmMotionEdit, DamagedFilesAreEditedOrRefused) {
  const PoseTrajectory trajectory = OneFrame();
  std::mt19937_64 random(3);
  constexpr std::string_view kBytes("<>/='\"!-?[]& aM\0\xFF", 17);
  int edited = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string content = kFile;
    for (int n = 0; n < 1 + i % 3; ++n)
      content[random() % content.size()] = kBytes[random() % kBytes.size()];
    try {
      const std::string text =
          Join(WithConvertedMotions(BytesOf(content), "walk.xml", {Output(trajectory, "human")}));
      EXPECT_NO_THROW(ParseXml(text, "own.xml")) << content;
      ++edited;
      ParseMmmMotionFile(content, "walk.xml");
    } catch (const Error&) {
    }
  }
  EXPECT_GT(edited, 1000);
}

TEST(MmmMotionEditRealFiles, KeepsTheOtherMotionsOfARealFile) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string content = ReadFileContent(testing::StirringFile());
  const MmmMotionFile file = ParseMmmMotionFile(content, "stir.xml");
  const PoseTrajectory trajectory = OneFrame();
  PoseTrajectory body = file.Find("true_1723")->trajectory;
  body.joint_names.resize(44);
  for (Posture& q : body.postures) q.joint_angles = q.joint_angles.head(44).eval();
  MmmMotionOutput output = Output(body, "true_1723");
  const std::string text = Join(WithConvertedMotions(BytesOf(content), "stir.xml", {output}));
  const auto motion_at = [](const std::string& t, const std::string& name) {
    return t.find("<Motion name=\"" + name + "\"");
  };
  EXPECT_TRUE(text.substr(0, motion_at(text, "true_1723")) ==
              content.substr(0, motion_at(content, "true_1723")));
  EXPECT_TRUE(text.substr(motion_at(text, "pred_1723")) ==
              content.substr(motion_at(content, "pred_1723")));
  const MmmMotionFile own = ParseMmmMotionFile(text, "own.xml");
  const MmmMotion& converted = *own.Find("true_1723");
  EXPECT_EQ(converted.trajectory.joint_names, file.Find("true_1723")->trajectory.joint_names);
  EXPECT_EQ(converted.markers.num_frames(), 79);
  EXPECT_EQ(converted.markers.frame(78), file.Find("true_1723")->markers.frame(78));
  EXPECT_EQ(converted.size.height, 1.7);
  EXPECT_TRUE(Join(WithConvertedMotions(BytesOf(text), "own.xml", {output})) == text);
}

TEST(ModelPath, IsRelativeToTheOutputWhereTheyAreNeighbours) {
  namespace fs = std::filesystem;
  EXPECT_EQ(ModelPathFor("/a/b/models/mmm.xml", "/a/b/out/walk.xml"), "../models/mmm.xml");
  EXPECT_EQ(ModelPathFor("/a/b/mmm.xml", "/a/b/walk.xml"), "mmm.xml");
  EXPECT_EQ(ModelPathFor("/a/b/../c/mmm.xml", "/a/walk.xml"), "c/mmm.xml");
  EXPECT_EQ(ModelPathFor("/usr/share/mmm.xml", "/home/me/walk.xml"), "/usr/share/mmm.xml");
  EXPECT_EQ(ModelPathFor("models/mmm.xml", "out/walk.xml"), "../models/mmm.xml");
  EXPECT_EQ(ModelPathFor("mmm.xml", (fs::current_path() / "walk.xml").string()), "mmm.xml");
}

TEST(ModelPath, FollowsLinkedFolders) {
  namespace fs = std::filesystem;
  const fs::path folder = testing::TestFolder();
  fs::create_directories(folder / "real/deep");
  fs::create_directory_symlink(folder / "real/deep", folder / "link");
  EXPECT_EQ(ModelPathFor(folder / "mmm.xml", folder / "link/walk.xml"), "../../mmm.xml");
}

}  // namespace
}  // namespace mmm_converter
