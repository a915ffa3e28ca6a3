// SPDX-License-Identifier: MIT
// A skeleton's motion is an input of the commands that take a recording.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/units.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;
using testing::WriteText;

/// The beginning of the sample, tracked and exported.
std::string Exported() {
  std::string file = TestFolder() + "/sample.bvh";
  const auto run = RunProgram({"convert", testing::Handstand(), "--height", "1.8", "--frames",
                               ":60", "-o", TestFolder() + "/sample.xml", "--export-bvh", file,
                               "--export-amass", TestFolder() + "/sample.npz"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return file;
}

TEST(Skeleton, IsConvertedDescribedAndShown) {
  const std::string file = Exported();
  const auto info = RunProgram({"info", file});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("BVH"));
  EXPECT_THAT(info.out, HasSubstr("60"));
  const std::string page = TestFolder() + "/page.html";
  const auto run = RunProgram({"convert", file, "-o", TestFolder() + "/again.xml", "--export-bvh",
                               TestFolder() + "/again.bvh", "--report", page});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("by the lengths of the skeleton"));
  EXPECT_TRUE(std::filesystem::exists(page));
  EXPECT_THAT(ReadText(TestFolder() + "/again.bvh"), HasSubstr("Frames: 60"));
}

PoseTrajectory MotionIn(const std::string& name) {
  return ReadMmmMotionFile(TestFolder() + "/" + name).motions.at(0).trajectory;
}

TEST(Skeleton, MotionsOfSmplHaveTheSameLimbs) {
  Exported();
  const std::string file = TestFolder() + "/sample.npz", out = TestFolder() + "/again.xml";
  EXPECT_THAT(RunProgram({"info", file}).out, HasSubstr("AMASS recording"));
  const auto run = RunProgram({"convert", file, "-o", out});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out + run.err, HasSubstr("SMPL's own model is not given"));
  const KinematicModel model = ScaleWinter(
      ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")), {1.8, 75, std::nullopt});
  const PoseTrajectory before = MotionIn("sample.xml"), after = MotionIn("again.xml");
  ASSERT_EQ(after.num_frames(), before.num_frames());
  const std::pair<const char*, const char*> kBones[] = {
      {"LHx_joint", "LKx_joint"}, {"RKx_joint", "RAx_joint"}, {"LSx_joint", "LEx_joint"},
      {"RSx_joint", "REx_joint"}, {"LEx_joint", "LWx_joint"}, {"REx_joint", "RWx_joint"}};
  for (const auto& ends : kBones) {
    double sum = 0;
    for (int k = 0; k < before.num_frames(); ++k) {
      const auto bone = [&](const PoseTrajectory& motion) {
        const auto X = SegmentPoses(model, ModelPosture(model, motion, k));
        return (X[model.FindSegment(ends.second)].translation() -
                X[model.FindSegment(ends.first)].translation())
            .normalized();
      };
      sum += std::acos(std::min(1.0, bone(before).dot(bone(after))));
    }
    EXPECT_LT(sum / before.num_frames(), 2 / kDegrees) << ends.second;
  }
}

TEST(Skeleton, AModelOfSmplThatIsNoneIsRefused) {
  Exported();
  const std::string npz = TestFolder() + "/sample.npz", out = TestFolder() + "/again.xml";
  const auto run = RunProgram({"convert", npz, "-o", out, "--smpl-model", npz});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("sample.npz: has no array v_template"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(Skeleton, CutFilesAreRefusedOrReadAsFarAsTheyGo) {
  const std::string whole = ReadText(Exported());
  const std::string file = TestFolder() + "/cut.bvh", out = TestFolder() + "/cut.xml";
  WriteText(file, whole.substr(0, 400));
  const auto refused = RunProgram({"convert", file, "-o", out});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("cut.bvh:"));
  EXPECT_FALSE(std::filesystem::exists(out));
  WriteText(file, whole.substr(0, whole.size() * 3 / 4));
  const auto read = RunProgram({"convert", file, "-o", out});
  EXPECT_EQ(read.exit_code, 0) << read.err;
  EXPECT_THAT(read.out + read.err, HasSubstr("cut off"));
}

}  // namespace
}  // namespace mmm_converter
