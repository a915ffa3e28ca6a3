// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <utility>

#include "common/io/bytes/file_content.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/recording.h"
#include "common/model/forward_kinematics.h"
#include "common/model/kit_joints.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/synthetic_motion.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using testing::SourcePath;

TEST(SampleRecordingTest, IsWhatItsGeneratorMakes) {
  const std::string& folder = testing::TestFolder();
  const std::string command = std::string("\"") + MAKE_SAMPLE_RECORDING + "\" \"" +
                              SourcePath("xml_config/models/mmm.xml") + "\" \"" + folder + "\"";
  ASSERT_EQ(std::system(command.c_str()), 0);
  for (const char* name : {"/handstand.c3d", "/handstand_true.xml"}) {
    // Not EXPECT_EQ, which would print both files.
    EXPECT_TRUE(ReadFileContent(folder + name) ==
                ReadFileContent(SourcePath(std::string("examples") + name)))
        << name << " differs; make it anew as examples/make_sample_recording.cc says";
  }
}

TEST(SampleRecordingTest, GaitIsWhatItsGeneratorMakes) {
  const std::string& folder = testing::TestFolder();
  const std::string command = std::string("\"") + MAKE_GAIT_RECORDING + "\" \"" +
                              SourcePath("xml_config/models/mmm.xml") + "\" \"" + folder + "\"";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_TRUE(ReadFileContent(folder + "/gait.c3d") ==
              ReadFileContent(SourcePath("examples/gait.c3d")))
      << "make it and its page anew as examples/README.md says";
}

TEST(SampleRecordingTest, SaysThatItIsSynthetic) {
  for (const auto& [file, most_bytes] :
       {std::pair("examples/handstand.c3d", 1500000U), {"examples/gait.c3d", 300000U}}) {
    const std::string content = ReadFileContent(SourcePath(file));
    EXPECT_NE(content.find("Synthetic: not a recorded person"), std::string::npos) << file;
    EXPECT_LT(content.size(), most_bytes) << file;
  }
}

TEST(SampleRecordingTest, ShowsTheTrueMotionWithRealisticMarkers) {
  Warnings warnings;
  const Recording recording = ReadRecording(SourcePath("examples/handstand.c3d"), {}, &warnings);
  ASSERT_EQ(recording.markers.num_labels(), 53);
  ASSERT_EQ(recording.markers.num_frames(), 675);
  EXPECT_EQ(recording.markers.rate(), 100);
  EXPECT_EQ(recording.up_axis, UpAxis::kZ);
  EXPECT_TRUE(warnings.empty());

  const MmmMotionFile file = ReadMmmMotionFile(SourcePath("examples/handstand_true.xml"));
  ASSERT_EQ(file.motions.size(), 1U);
  const MmmMotion& truth = file.motions[0];
  ASSERT_EQ(truth.trajectory.num_frames(), 675);
  ASSERT_EQ(truth.trajectory.joint_names, KitJointNames());
  const KinematicModel model =
      ScaleWinter(ReadMmmModel(SourcePath("xml_config/models/mmm.xml")),
                  {truth.size.height.value(), truth.size.mass.value(), {}});
  const MarkerSequence expected =
      SynthesizeMarkers(model, truth.trajectory, {0, 0, 0.25, 0}, 1);  // no errors
  ASSERT_EQ(recording.markers.labels(), expected.labels());
  double mean = 0;
  for (int k = 0; k < 675; ++k) {
    mean += (recording.markers.frame(k) - expected.frame(k)).colwise().norm().mean() / 675;
  }
  // The norm of three normals of 28.3 mm is 45 mm in the mean, 19 in deviation: 2.6 for 53 markers.
  EXPECT_NEAR(mean, 0.045, 3 * 0.0026);
}

}  // namespace
}  // namespace mmm_converter
