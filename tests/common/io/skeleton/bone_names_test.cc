// SPDX-License-Identifier: MIT
#include "common/io/skeleton/bone_names.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/support/error.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

BoneName Find(const std::string& joint) {
  static const BoneNames names(testing::SourcePath("xml_config/bones.xml"));
  return names.Find(joint);
}

TEST(BoneNames, KnowTheNamesOfProgramsAndLaboratories) {
  const struct {
    const char* joint;
    BoneKind kind;
    char side;
  } kNames[] = {
      {"LeftUpLeg", BoneKind::kHip, 'L'},             // LAFAN1, MotionBuilder
      {"mixamorig:RightUpLeg", BoneKind::kHip, 'R'},  // Mixamo
      {"LeftLeg", BoneKind::kLeg, 'L'},
      {"LeftShin", BoneKind::kKnee, 'L'},  // SOMA
      {"RightAnkle", BoneKind::kAnkle, 'R'},
      {"RightToeBase", BoneKind::kToe, 'R'},
      {"Bip01 L Thigh", BoneKind::kHip, 'L'},  // 3ds Max
      {"Bip001 R UpperArm", BoneKind::kUpperArm, 'R'},
      {"Bip01 L Toe0", BoneKind::kToe, 'L'},
      {"rShldr", BoneKind::kShoulder, 'R'},  // Poser
      {"lfemur", BoneKind::kHip, 'L'},       // CMU
      {"rradius", BoneKind::kElbow, 'R'},
      {"LHipJoint", BoneKind::kHip, 'L'},
      {"f_avg_L_Shoulder", BoneKind::kShoulder, 'L'},  // SMPL
      {"L_Foot", BoneKind::kFoot, 'L'},
      {"UpperLeg_L", BoneKind::kHip, 'L'},
      {"lowerleg01.R", BoneKind::kKnee, 'R'},  // MakeHuman
      {"L_upLeg_jnt", BoneKind::kHip, 'L'},
      {"HIP_LEFT", BoneKind::kHip, 'L'},                 // Kinect
      {"Skeleton 001_LUArm", BoneKind::kUpperArm, 'L'},  // Motive
      {"lThighBend", BoneKind::kHip, 'L'},               // DAZ
      {"左足首", BoneKind::kAnkle, 'L'},                 // MikuMikuDance
      {"RechterUnterschenkel", BoneKind::kKnee, 'R'},
      {"右太もも", BoneKind::kHip, 'R'},
      {"Ginocchio_sx", BoneKind::kKnee, 'L'},
      {"Antebraço_Direito", BoneKind::kElbow, 'R'},
      {"ik_lfoot", BoneKind::kNone, ' '},
      {"hip", BoneKind::kHip, ' '},
      {"Neck1", BoneKind::kNeck, ' '},
      {"Head", BoneKind::kHead, ' '},
      {"LeftArm", BoneKind::kArm, 'L'},
      {"LeftHand", BoneKind::kHand, 'L'},
      {"LeftHandThumb1", BoneKind::kNone, 'L'},
      {"LeftForeArmRoll", BoneKind::kNone, 'L'},
      {"LeftFootHeel", BoneKind::kNone, 'L'},
      {"Hips", BoneKind::kNone, ' '},
      {"", BoneKind::kNone, ' '},
  };
  for (const auto& [joint, kind, side] : kNames) {
    EXPECT_EQ(Find(joint).kind, kind) << joint;
    EXPECT_EQ(Find(joint).side, side) << joint;
  }
}

TEST(BoneNames, SayWhatIsWrongWithAFile) {
  const std::string file = testing::TestFolder() + "/bones.xml";
  const auto refusal = [&](const std::string& text) -> std::string {
    std::ofstream(file) << text;
    try {
      BoneNames names(file);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("<Bones><Bone kind='hip'>thigh</Bone></Bones>"), "");
  EXPECT_NE(refusal("<Bone/>").find(":1: <Bone>: expected <Bones>"), std::string::npos);
  EXPECT_NE(refusal("<Bones>\n<Bone kind='tail'/></Bones>").find(":2: <Bone>: its kind"),
            std::string::npos);
  EXPECT_NE(refusal("<Bones><Bone kind='hip'>a a</Bone></Bones>").find("a is there twice"),
            std::string::npos);
  EXPECT_NE(refusal("<Bones><Side left='l'/></Bones>").find("needs the attribute right"),
            std::string::npos);
}

}  // namespace
}  // namespace mmm_converter
