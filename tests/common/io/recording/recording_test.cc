// SPDX-License-Identifier: MIT
#include "common/io/recording/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <fstream>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/recording/recording_axes.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::mmm_converter::testing::SharedData;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Remedy RemedyOf(const std::string& path) {
  try {
    ReadRecording(path, {});
  } catch (const Error& error) {
    return error.remedy();
  }
  return Remedy::kNone;
}

std::string MessageOf(const std::string& path, const ReadRecordingOptions& options = {}) {
  try {
    ReadRecording(path, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string WriteRecording(const std::string& name, const std::string& content) {
  std::string path = testing::TestFolder() + "/" + name;
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

Recording ReadSynthetic(const std::string& name, const ReadRecordingOptions& options = {},
                        Warnings* warnings = nullptr) {
  return ReadRecording(SharedData("recordings/synthetic/" + name), options, warnings);
}

/// Largest distance between equal markers and frames; infinite where one of them is not seen.
double LargestDistance(const MarkerSequence& a, const MarkerSequence& b) {
  double largest = 0;
  for (int k = 0; k < a.num_frames(); ++k) {
    const double distance = (a.frame(k) - b.frame(k)).colwise().norm().maxCoeff();
    if (!(distance <= largest)) largest = distance;
  }
  return largest;
}

TEST(RecordingRealFiles, IsInMetresAndZUpWhateverTheFileHas) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Warnings warnings;
  const Recording reference = ReadSynthetic("kit53_intel_float.c3d", {}, &warnings);
  EXPECT_EQ(reference.format, "C3D");
  EXPECT_EQ(reference.unit, "mm");
  EXPECT_TRUE(reference.up_axis_was_decided);
  EXPECT_EQ(reference.up_axis, UpAxis::kZ);
  EXPECT_EQ(reference.subject, "");
  EXPECT_THAT(warnings.texts(), ElementsAre());
  const Eigen::Vector3d c7 = reference.markers.frame(0).col(reference.markers.FindLabel("C7"));
  EXPECT_TRUE(c7.isApprox(Eigen::Vector3d(0.114158, -0.251796, 1.39602), 1e-6));  // float

  // Floats of other units round differently (1e-7 of 1.7 m); integers have steps of 0.05 mm.
  for (const char* name :
       {"kit53_metres.c3d", "kit53_cm.c3d", "kit53_dec_float.c3d", "kit53_mips_float.c3d"}) {
    EXPECT_LT(LargestDistance(ReadSynthetic(name).markers, reference.markers), 5e-7) << name;
  }
  for (const char* name : {"kit53_intel_int.c3d", "kit53_dec_int.c3d", "kit53_mips_int.c3d"}) {
    EXPECT_LT(LargestDistance(ReadSynthetic(name).markers, reference.markers), 5e-5) << name;
  }
}

TEST(RecordingRealFiles, TurnsYUpToZUp) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const Recording reference = ReadSynthetic("kit53_intel_float.c3d");
  const Recording turned = ReadSynthetic("kit53_yup_screen_X_Y.c3d");
  EXPECT_EQ(turned.up_axis, UpAxis::kY);
  EXPECT_TRUE(turned.up_axis_was_decided);
  EXPECT_EQ(turned.stated_up_axis, UpAxis::kY);
  EXPECT_TRUE(turned.doubts.empty());
  for (int k = 0; k < turned.markers.num_frames(); k += 20) {
    for (int i = 0; i < turned.markers.num_labels(); ++i) {  // the file is (y, z, x)
      const Eigen::Vector3d p = reference.markers.frame(k).col(i);
      const Eigen::Vector3d q = turned.markers.frame(k).col(i);
      EXPECT_LT((q - Eigen::Vector3d(p.y(), -p.x(), p.z())).norm(), 1e-12);
    }
  }
  const Recording forced = ReadSynthetic("kit53_yup_screen_X_Y.c3d", {.up_axis = UpAxis::kZ});
  EXPECT_FALSE(forced.up_axis_was_decided);
  ASSERT_EQ(forced.doubts.size(), 1U);
  EXPECT_THAT(forced.doubts[0].text, HasSubstr("head is towards +y"));
  EXPECT_EQ(forced.doubts[0].remedy, Remedy::kUpAxis);
  const Eigen::Vector3d p = reference.markers.frame(0).col(0);
  EXPECT_LT((forced.markers.frame(0).col(0) - Eigen::Vector3d(p.y(), p.z(), p.x())).norm(), 1e-12);
}

TEST(Recording, RotatesProperlyFromEveryAxis) {
  for (int i = 0; i < 6; ++i) {
    const auto axis = static_cast<UpAxis>(i);
    const Eigen::Matrix3d rotation = RotationToZUp(axis);
    EXPECT_EQ(rotation.determinant(), 1);
    const Eigen::Vector3d up = (i < 3 ? 1 : -1) * Eigen::Vector3d::Unit(i % 3);
    EXPECT_EQ(rotation * up, Eigen::Vector3d::UnitZ()) << Name(axis);
    EXPECT_EQ(ParseUpAxis(Name(axis)), axis);
  }
  EXPECT_EQ(ParseUpAxis(" Y"), UpAxis::kY);
  EXPECT_THROW(ParseUpAxis("up"), Error);
}

/// A person, 100 frames, of which the last ones are upside down on the same ground.
MarkerSequence Acrobat(int frames_upside_down, UpAxis file_axis) {
  MarkerSequence markers({"LFHD", "RFHD", "LTOE", "RTOE", "LASI", "RASI"}, 100, 100, 0);
  for (int k = 0; k < 100; ++k) {
    const double stretch = 0.1 * std::sin(0.3 * k);  // what is not on the ground moves
    const bool upside_down = k >= 100 - frames_upside_down;
    const double head = upside_down ? 0.02 : 1.7 + stretch;
    const double feet = upside_down ? 1.6 + stretch : 0.01;
    markers.frame(k) << 0, 0.1, 0, 0.1, 0, 0.1, 0.2, 0.2, 0, 0, 0.1, 0.1, head, head, feet, feet,
        0.9, 0.9;
  }
  const Eigen::Matrix3d to_file = RotationToZUp(file_axis).transpose();
  for (int k = 0; k < 100; ++k) markers.frame(k) = (to_file * markers.frame(k)).eval();
  return markers;
}

TEST(Recording, DecidesUpOverTheWholeTrial) {
  for (int i = 0; i < 6; ++i) {
    for (const int upside_down : {0, 30, 70, 90}) {
      const auto axis = static_cast<UpAxis>(i);
      const UpAxisDecision decision =
          DecideUpAxis(Acrobat(upside_down, axis), 1, {.usual = {axis}});
      EXPECT_TRUE(decision.decided);
      EXPECT_EQ(decision.axis, axis) << Name(axis) << ", upside down " << upside_down << " %";
    }
  }
}

TEST(Recording, WeighsWhatIsSaidOfUpAgainstTheMarkers) {
  const MarkerSequence standing = Acrobat(0, UpAxis::kZ);
  // Nothing contradicts, and nothing is said.
  EXPECT_EQ(DecideUpAxis(standing, 1, {.stated = UpAxis::kZ}).warning, "");
  // Lies, as far as the file goes.
  UpAxisDecision decision = DecideUpAxis(standing, 1, {.stated = UpAxis::kY});
  EXPECT_EQ(decision.axis, UpAxis::kY);
  EXPECT_FALSE(decision.decided);
  EXPECT_THAT(decision.warning, HasSubstr("states that +y is up, but"));
  // The user is right, whatever there is.
  decision = DecideUpAxis(standing, 1, {.given = UpAxis::kMinusZ, .stated = UpAxis::kZ});
  EXPECT_EQ(decision.axis, UpAxis::kMinusZ);
  EXPECT_THAT(decision.warning, HasSubstr("-z is given as up, but"));
  // No one goes up and down by two metres.
  MarkerSequence walking = standing;
  for (int k = 0; k < walking.num_frames(); ++k) walking.frame(k).row(1).array() += 0.02 * k;
  decision = DecideUpAxis(walking, 1, {.stated = UpAxis::kY});
  EXPECT_EQ(decision.axis, UpAxis::kZ);
  EXPECT_THAT(decision.warning, HasSubstr("+z is taken"));
}

// A head above a thorax tells more than shoulders behind it; a wheelchair's wheels are far off.
TEST(Recording, AnUpperBodyTellsItsAxisAndUnitBesideOtherThings) {
  MarkerSequence upper({"C7", "T10", "STRN", "CLAV", "LFHD", "RFHD", "LSHO", "RSHO", "wheel"}, 1,
                       100, 0);
  upper.frame(0) << 0, 0, 0.1, 0.1, 0.1, 0.1, -0.2, -0.2, 4,  //
      0.2, 0, 0, 0.2, 0.3, 0.3, 0.15, 0.15, -1, 0, 0, 0, 0, 0.1, -0.1, 0.2, -0.2, 0;
  EXPECT_EQ(DecideUpAxis(upper, 1, {}).axis, UpAxis::kY);
  EXPECT_FALSE(DecideUnit(upper, "m").is_doubtful);
}

/// A start of a sprint, on hands and toes, then away along the second axis behind up.
MarkerSequence Start(UpAxis file_axis) {
  MarkerSequence markers({"LFHD", "RFHD", "LTOE", "RTOE", "LASI", "RASI", "LWRA", "RWRA"}, 60, 100,
                         0);
  for (int k = 0; k < markers.num_frames(); ++k) {
    const double way = 2 + 0.02 * k;
    markers.frame(k) << 0, 0.1, 0, 0.1, 0, 0.1, -0.1, 0.2,                           //
        way + 0.9, way + 0.9, way, way, way + 0.3, way + 0.3, way + 0.8, way + 0.8,  //
        0.8, 0.8, 0.02, 0.02, 0.9, 0.9, 0.02, 0.02;
  }
  const Eigen::Matrix3d to_file = RotationToZUp(file_axis).transpose();
  for (int k = 0; k < 60; ++k) markers.frame(k) = (to_file * markers.frame(k)).eval();
  return markers;
}

TEST(Recording, WhoIsBentStandsOnTheGroundOfAUsualAxis) {
  for (const UpAxis axis : {UpAxis::kY, UpAxis::kZ}) {
    const UpAxisDecision decision =
        DecideUpAxis(Start(axis), 1, {.usual = {UpAxis::kY, UpAxis::kZ}});
    EXPECT_EQ(decision.axis, axis);
    EXPECT_FALSE(decision.is_doubtful) << decision.warning;
  }
  MarkerSequence floating = Start(UpAxis::kY);
  for (int k = 0; k < floating.num_frames(); ++k) floating.frame(k).array() += 5;
  const UpAxisDecision decision = DecideUpAxis(floating, 1, {.usual = {UpAxis::kY, UpAxis::kZ}});
  EXPECT_EQ(decision.axis, UpAxis::kY);
  EXPECT_TRUE(decision.is_doubtful);
}

TEST(Recording, AnUnusualUpAxisIsOneWithGround) {
  MarkerSequence markers = Acrobat(0, UpAxis::kX);
  UpAxisDecision decision = DecideUpAxis(markers, 1, {.usual = {UpAxis::kZ}});
  EXPECT_EQ(decision.axis, UpAxis::kX);
  EXPECT_THAT(decision.warning, HasSubstr("unusual"));
  // Lies on the ground, the feet somewhere in the room.
  for (int k = 0; k < markers.num_frames(); ++k) markers.frame(k).row(0).array() -= 1;
  decision = DecideUpAxis(markers, 1, {.usual = {UpAxis::kZ}});
  EXPECT_EQ(decision.axis, UpAxis::kZ);
  EXPECT_THAT(decision.warning, HasSubstr("the ground is along +z"));
}

TEST(Recording, AssumesZUpWhereLabelsTellNothing) {
  const MarkerSequence markers({"box1", "box2"}, 1, 100, 0);
  const UpAxisDecision decision = DecideUpAxis(markers, 1, {});
  EXPECT_FALSE(decision.decided);
  EXPECT_EQ(decision.axis, UpAxis::kZ);
  EXPECT_THAT(decision.warning, HasSubstr("z is taken"));
}

TEST(RecordingRealFiles, ChecksTheUnit) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string path = testing::TestFolder() + "/metres_called_mm.c3d";
  MarkerSequence markers = ReadSynthetic("kit53_intel_float.c3d").markers;
  ToMetresAndZUp(0.001, UpAxis::kZ, &markers);  // a file that says mm, with metres inside
  WriteC3d(path, markers);
  Warnings warnings;
  const Recording guessed = ReadRecording(path, {}, &warnings);
  EXPECT_EQ(guessed.unit, "m");
  EXPECT_TRUE(guessed.unit_was_guessed);
  EXPECT_THAT(warnings.texts(), Contains(HasSubstr("the file says mm; read as m")));
  const Recording forced = ReadRecording(path, {.unit = "mm"});
  EXPECT_FALSE(forced.unit_was_guessed);
  EXPECT_NEAR(forced.markers.frame(0)(2, 0), 0.00139602, 1e-9);  // float
  EXPECT_THAT(MessageOf(path, {.unit = "furlong"}), HasSubstr("use mm, cm, m or in"));

  EXPECT_EQ(DecideUnit(markers, "mete").unit, "m");
  EXPECT_EQ(DecideUnit(Acrobat(0, UpAxis::kZ), "").unit, "m");
  EXPECT_TRUE(DecideUnit(Acrobat(0, UpAxis::kZ), "238").guessed);
}

TEST(RecordingRealFiles, LetsTheUserChooseASubject) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string path = SharedData("recordings/synthetic/kit53_two_subjects_same_labels.c3d");
  EXPECT_THAT(MessageOf(path), HasSubstr("several subjects: A, B; choose one"));
  EXPECT_EQ(RemedyOf(path), Remedy::kSubjectPrefix);
  ReadRecordingOptions options;
  options.subject = "b";
  const Recording b = ReadRecording(path, options);
  EXPECT_EQ(b.subject, "B");
  EXPECT_THAT(b.subjects, ElementsAre("A", "B"));
  EXPECT_EQ(b.markers.num_labels(), 53);
  const Recording reference = ReadSynthetic("kit53_intel_float.c3d");
  EXPECT_EQ(b.markers.labels(), reference.markers.labels());
  options.subject = "C";
  EXPECT_THAT(MessageOf(path, options), HasSubstr("no subject C; the file has: A, B"));
  const std::string serve =
      SharedData("recordings/whole_body/kinematics_tennis_serve_2players.c3d");
  EXPECT_THAT(MessageOf(serve), HasSubstr("Derrick, Viktor"));
}

TEST(Recording, TakesThePersonNotTheObject) {
  std::vector<std::string> labels = {"Box:1", "Box:2", "Box:LKNE"};
  for (const char* name : {"LFHD", "RFHD", "LTOE", "RTOE", "LASI", "RASI", "C7", "CLAV"}) {
    labels.push_back(std::string("Anna:") + name);
  }
  MarkerSequence markers(labels, 2, 100, 0);
  for (int k = 0; k < 2; ++k) markers.frame(k).setConstant(0.5);
  const std::string path = testing::TestFolder() + "/anna_and_box.c3d";
  WriteC3d(path, markers);
  Warnings warnings;
  const Recording recording = ReadRecording(path, {}, &warnings);
  EXPECT_EQ(recording.subject, "Anna");
  EXPECT_EQ(recording.markers.num_labels(), 8);
  EXPECT_THAT(warnings.texts(), Contains(HasSubstr("those of Box")));
}

TEST(RecordingRealFiles, LeavesOutWhatIsNoMarker) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Warnings warnings;
  const Recording gait =
      ReadRecording(SharedData("recordings/whole_body/pycgm_movement_trial.c3d"), {}, &warnings);
  EXPECT_EQ(gait.markers.num_labels(), 39);
  EXPECT_EQ(gait.markers.FindLabel("LTIP"), -1);  // the tibia axis of Plug-in Gait
  EXPECT_EQ(gait.markers.FindLabel("*115"), -1);
  EXPECT_NE(gait.markers.FindLabel("LTIB"), -1);
  EXPECT_EQ(gait.first_frame, 695);
  EXPECT_THAT(warnings.texts(), AllOf(Contains(HasSubstr("LTIP is a computed point")),
                                      Contains(HasSubstr("unlabelled points left out"))));
  // KIT's LTIP is a marker.
  EXPECT_NE(ReadSynthetic("kit53_intel_float.c3d").markers.FindLabel("LTIP"), -1);
}

TEST(RecordingRealFiles, ReadsRealPeopleInPlausibleSize) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  struct {
    const char* file;
    const char* unit;
    UpAxis up;
    int labels;
  } const expected[] = {{"whole_body/85_02.c3d", "mm", UpAxis::kZ, 41},
                        {"whole_body/cmu_02_05.c3d", "mm", UpAxis::kZ, 41},
                        {"whole_body/kinematics_tennis_serve.c3d", "m", UpAxis::kZ, 39},
                        {"whole_body/pycgm_movement_trial.c3d", "mm", UpAxis::kZ, 39},
                        {"kit_bimanual_c3d/Pour_1480.c3d", "mm", UpAxis::kZ, 53},
                        {"conformance/opensim_walking2.c3d", "mm", UpAxis::kZ, 44},
                        {"trc/motek_T.trc", "mm", UpAxis::kY, 41},
                        {"trc/tennis_serve.trc", "m", UpAxis::kZ, 39}};
  for (const auto& e : expected) {
    SCOPED_TRACE(e.file);
    const Recording recording = ReadRecording(SharedData(std::string("recordings/") + e.file), {});
    EXPECT_EQ(recording.up_axis, e.up);
    EXPECT_TRUE(recording.up_axis_was_decided);
    EXPECT_EQ(recording.unit, e.unit);
    EXPECT_FALSE(recording.unit_was_guessed);
    EXPECT_EQ(recording.markers.num_labels(), e.labels);
    double head = 0;
    int seen = 0;
    for (int k = 0; k < recording.markers.num_frames(); ++k) {
      const Eigen::Vector3d p = recording.markers.frame(k).col(recording.markers.FindLabel("LFHD"));
      if (!IsSeen(p)) continue;
      head += p.z();
      ++seen;
    }
    ASSERT_GT(seen, 0);
    EXPECT_GT(head / seen, 0.7);  // of a standing or jumping adult, the floor at 0
    EXPECT_LT(head / seen, 2.6);  // the Plug-in Gait trial has its origin below the floor
  }
}

TEST(RecordingRealFiles, ReadsTheSameTrialFromC3dAndTrc) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const Recording c3d =
      ReadRecording(SharedData("recordings/whole_body/kinematics_tennis_serve.c3d"), {});
  const Recording trc = ReadRecording(SharedData("recordings/trc/tennis_serve.trc"), {});
  EXPECT_EQ(trc.format, "TRC");
  EXPECT_EQ(trc.subject, "Derrick");
  ASSERT_EQ(trc.markers.labels(), c3d.markers.labels());
  ASSERT_EQ(trc.markers.num_frames(), c3d.markers.num_frames());
  EXPECT_LT(LargestDistance(trc.markers, c3d.markers),
            1e-5);  // the TRC file has 5 decimals of a metre
}

TEST(RecordingRealFiles, ReadsMarkersOfMmmMotions) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string folder = SharedData("mmm/kit_bimanual_10hz/");
  const std::string path = folder + "Pour_files_motions_2967_Pour1_cs_ms_0_20l_04.xml";
  ReadRecordingOptions options;
  options.motion = "true_1480";
  const Recording mmm = ReadRecording(path, options);
  const Recording c3d = ReadRecording(SharedData("recordings/kit_bimanual_c3d/Pour_1480.c3d"), {});
  EXPECT_EQ(mmm.format, "MMM 2.0");
  EXPECT_EQ(mmm.motion(), "true_1480");
  EXPECT_EQ(mmm.size().height, 1.79);
  EXPECT_EQ(mmm.size().mass, 78);
  ASSERT_TRUE(mmm.size().hand_length.has_value());
  EXPECT_NEAR(*mmm.size().hand_length, 0.189, 1e-12);
  ASSERT_EQ(mmm.markers.labels(), c3d.markers.labels());
  ASSERT_EQ(mmm.markers.num_frames(), c3d.markers.num_frames());
  EXPECT_LT(LargestDistance(mmm.markers, c3d.markers), 1e-6);  // floats of up to 1.5 m
  options.motion = "nobody";
  EXPECT_THAT(MessageOf(path, options),
              AllOf(HasSubstr("no motion nobody"), HasSubstr("true_1480")));
  const std::string wave = SharedData("mmm/motions_mmm2/wave_left01.xml");
  EXPECT_THAT(MessageOf(wave), HasSubstr("no motion carries markers"));
}

TEST(Recording, TheRateGivenIsPossible) {
  const std::string path = testing::SourcePath("examples/handstand.c3d");
  for (const double rate : {-1.0, 0.0, 0.5, 1e6, 1e300, std::nan("")}) {
    ReadRecordingOptions options;
    options.rate = rate;
    EXPECT_THAT(MessageOf(path, options), HasSubstr("Hz; it must be 1 to 100000 Hz"));
  }
}

// Rows are counted by their frames where there is no time.
TEST(Recording, TheRateGivenIsThatOfAFileWithoutOne) {
  const std::string file =
      WriteRecording("no_rate.trc",
                     "PathFileType\t4\t(X/Y/Z)\ta.trc\nNumFrames\tNumMarkers\tUnits\n2\t2\tmm\n"
                     "Frame#\tTime\tLHEE\t\t\tLASI\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
                     "1\t\t1\t20\t3\t4\t950\t6\n3\t\t1\t21\t3\t4\t951\t6\n");
  EXPECT_EQ(RemedyOf(file), Remedy::kRate);
  ReadRecordingOptions options;
  options.rate = 50;
  const MarkerSequence markers = ReadRecording(file, options).markers;
  EXPECT_EQ(markers.rate(), 50);
  EXPECT_NEAR(markers.frame(markers.num_frames() - 1)(2, 1), 0.951, 1e-12);
}

TEST(Recording, SaysWhatIsWrongWithAFile) {
  EXPECT_THAT(MessageOf("/no/such/file.c3d"), HasSubstr("no such file"));
  EXPECT_THAT(MessageOf(testing::TestFolder()), HasSubstr("is a folder"));
  EXPECT_THAT(MessageOf(WriteRecording("empty.c3d", "")), HasSubstr("the file is empty"));
  EXPECT_THAT(MessageOf(WriteRecording("text.c3d", "hello\n")),
              HasSubstr("is text, but no recording"));
  EXPECT_THAT(MessageOf(WriteRecording(
                  "lfs.c3d", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n")),
              HasSubstr("Git LFS pointer"));
  EXPECT_THAT(MessageOf(WriteRecording("page.c3d", "<!DOCTYPE html><html></html>")),
              HasSubstr("root <html>, not an MMM motion"));
  EXPECT_THAT(MessageOf(WriteRecording("zeros.c3d", std::string(2000, '\0'))),
              HasSubstr("begins with 2000 zeros"));
  EXPECT_THAT(MessageOf(WriteRecording("packed.c3d", "\x1f\x8b\x08\x01")),
              HasSubstr("is packed (gzip); unpack it first"));
  EXPECT_THAT(MessageOf(WriteRecording("packed.xml", "PK\x03\x04 walk.xml")),
              HasSubstr("is packed (zip); unpack it first"));
  const std::string wide("<\0M\0M\0M\0>\0", 10);
  EXPECT_THAT(MessageOf(WriteRecording("wide.xml", "\xFF\xFE" + wide)), HasSubstr("UTF-16"));
  EXPECT_THAT(MessageOf(WriteRecording("wide.xml", wide)), HasSubstr("is text in UTF-16"));
  EXPECT_THAT(MessageOf(WriteRecording("odd.c3d", "\x01\x02\x03\x04")),
              HasSubstr("not a C3D file"));
}

}  // namespace
}  // namespace mmm_converter
