// SPDX-License-Identifier: MIT
// `label` and `convert --label` on a real recording whose labels were taken away or exchanged.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "common/io/c3d/c3d_file.h"
#include "common/io/c3d/c3d_relabelling.h"
#include "common/io/c3d/c3d_writer.h"
#include "common/io/recording/recording.h"
#include "tests/cli/batch_manifest.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/strict_c3d.h"

namespace mmm_converter::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string Labelled() { return SharedData("recordings/kit_bimanual_c3d/Pour_1480.c3d"); }

std::string InFolder(const std::string& name) { return TestFolder() + "/" + name; }

// The points in the opposite order and without labels; the sixth breaks and goes on as another.
std::string Unlabelled() {
  const C3dFile file(Labelled());
  const int frames = file.layout().frames;
  std::vector<C3dRelabelledPoint> points;
  for (int i = file.layout().points - 1; i >= 0; --i) {
    points.push_back({"", i, {{0, frames, i}}});
  }
  points.push_back({"", 0, {{40, frames, points[5].stretches[0].point}}});
  points[5].stretches[0].end = 38;
  for (std::size_t i = 0; i < points.size(); ++i) points[i].label = "*" + std::to_string(i + 1);
  std::string path = InFolder("unlabelled.c3d");
  WriteRelabelledC3d(Labelled(), points, path);
  return path;
}

struct Score {
  int right = 0, wrong = 0;
  double share() const { return static_cast<double>(right) / (right + wrong); }
};

// Of the positions under names, how many are those that the labelled recording has there. Within a
// tenth of a millimetre, of which the output formats hold more.
Score Compare(const MarkerSequence& found) {
  const MarkerSequence truth = ReadRecording(Labelled(), {}).markers;
  Score score;
  for (int i = 0; i < found.num_labels(); ++i) {
    const int label = truth.FindLabel(found.labels()[i]);
    if (label < 0) continue;
    for (int k = 0; k < found.num_frames(); ++k) {
      const Eigen::Vector3d p = found.frame(k).col(i);
      if (!IsSeen(p)) continue;
      const bool is_right = (p - truth.frame(k).col(label)).norm() < 1e-4;
      (is_right ? score.right : score.wrong) += 1;
    }
  }
  return score;
}

void ExpectLabelled(const std::string& file) {
  const MarkerSequence found = ReadRecording(file, {}).markers;
  const Score score = Compare(found);
  EXPECT_GE(score.share(), 0.998) << file;  // of what has a name; a wrong name is worse than none
  EXPECT_GE(score.right, 0.97 * 53 * found.num_frames()) << file;
}

TEST(LabelRealFiles, NamesByAnotherRecordingOfThePerson) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string output = InFolder("out.xml");
  const ProgramRun run = RunProgram({"label", Unlabelled(), "--like", Labelled(), "-o", output});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("of 53 names found"), HasSubstr("written    " + output),
                             HasSubstr("verdict    good")));
  ExpectLabelled(output);
}

// The shipped recording has all its labels; they are right.
TEST(Label, NamesThatAreThereAndRightStay) {
  const std::string summary = InFolder("summary.json");
  const ProgramRun run =
      RunProgram({"label", Handstand(), "--height", "1.75", "--summary", summary});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("changed    nothing"), HasSubstr("verdict    good")));
  EXPECT_EQ(nlohmann::json::parse(ReadText(summary)).at("changes").size(), 0);
}

// The shipped recording with left and right labels exchanged, of all markers or of the legs.
std::string WithSidesExchanged(bool of_legs_only) {
  MarkerSequence markers = ReadRecording(Handstand(), {}).markers.Slice(100, 140);
  std::vector<std::string> labels = markers.labels();
  const std::set<std::string> legs = {"ANK", "HEE", "HIP", "KNE", "MT1",
                                      "MT5", "THI", "TIP", "TOE"};
  for (std::string& label : labels) {
    const bool is_sided = label.size() == 4 && (label[0] == 'L' || label[0] == 'R');
    if (!is_sided || markers.FindLabel((label[0] == 'L' ? "R" : "L") + label.substr(1)) < 0)
      continue;
    if (of_legs_only && !legs.contains(label.substr(1))) continue;
    label[0] = label[0] == 'L' ? 'R' : 'L';
  }
  MarkerSequence exchanged(labels, markers.num_frames(), markers.rate(), markers.first_time());
  for (int k = 0; k < markers.num_frames(); ++k) exchanged.frame(k) = markers.frame(k);
  std::string file = InFolder("sides.c3d");
  WriteC3d(file, exchanged, {});
  return file;
}

// All of them, or none: half a repair is worse than none.
TEST(LabelSides, RepairExchangesThemWhole) {
  const MarkerSequence truth = ReadRecording(Handstand(), {}).markers.Slice(100, 140);
  const std::string like = InFolder("short.c3d");
  WriteC3d(like, truth.Slice(0, 3), {});
  for (const bool of_legs_only : {false, true}) {
    SCOPED_TRACE(of_legs_only);
    const std::string output = InFolder("repaired.c3d");
    const ProgramRun run = RunProgram({"label", WithSidesExchanged(of_legs_only), "--repair",
                                       "--like", like, "--height", "1.8", "-o", output});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, AllOf(HasSubstr("left and right labels of"), HasSubstr("mirrored")));
    const std::string doubt = "short.c3d: the person can't be calibrated on it";
    EXPECT_THAT(run.err, HasSubstr(doubt));
    EXPECT_EQ(run.err.find(doubt), run.err.rfind(doubt));  // said once
    EXPECT_THAT(run.out, HasSubstr("verdict    good"));
    const MarkerSequence repaired = ReadRecording(output, {}).markers;
    for (int i = 0; i < truth.num_labels(); ++i) {
      const int label = repaired.FindLabel(truth.labels()[i]);
      ASSERT_GE(label, 0) << truth.labels()[i];
      for (int k = 0; k < truth.num_frames(); k += 10) {
        ASSERT_LT((repaired.frame(k).col(label) - truth.frame(k).col(i)).norm(), 1e-4)
            << truth.labels()[i];
      }
    }
  }
}

// Whose labels are names of landmarks, at which the model gets markers.
TEST(LabelRealFiles, RepairKnowsNamesOfLandmarks) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const ProgramRun run =
      RunProgram({"label", SharedData("field/btk_FunctionalWalk.c3d"), "--repair"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("verdict    "));
}

// Labels that are wrong all along, whose right names the body tells, get these.
TEST(LabelRealFiles, RepairGivesTheNamesOfWhereLabelsAre) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const MarkerSequence all = ReadRecording(SharedData("field/btk_FunctionalWalk.c3d"), {}).markers;
  const std::string legs[] = {"ASI", "PSI", "THI", "KNE", "TIB", "ANK", "HEE", "TOE"};
  std::vector<std::string> right;
  for (const char* side : {"L", "R"}) {
    for (const std::string& one : legs) right.push_back(side + one);
  }
  const auto other_side = [](std::string label) {
    label[0] = label[0] == 'L' ? 'R' : 'L';
    return label;
  };
  const std::map<std::string, std::string> pairs[] = {
      {},
      {{"LTHI", "LTIB"}, {"LTIB", "LTHI"}},
      {{"LASI", "LPSI"}, {"LPSI", "LASI"}, {"RASI", "RPSI"}, {"RPSI", "RASI"}}};
  for (const auto& exchanged : pairs) {
    std::vector<std::string> wrong;
    for (const std::string& label : right) {
      const auto other = exchanged.find(label);
      wrong.push_back(exchanged.empty()          ? other_side(label)
                      : other == exchanged.end() ? label
                                                 : other->second);
    }
    SCOPED_TRACE(wrong[0] + wrong[2]);
    const int frames = 120;
    MarkerSequence recording(wrong, frames, all.rate(), 0);
    for (int k = 0; k < frames; ++k) {
      for (std::size_t i = 0; i < right.size(); ++i) {
        recording.frame(k).col(static_cast<Eigen::Index>(i)) =
            all.frame(2 * k + 100).col(all.FindLabel(right[i]));
      }
    }
    const std::string input = InFolder("wrong.c3d"), output = InFolder("right.c3d");
    WriteC3d(input, recording, {});
    const auto unchanged = RunProgram({"label", input});
    EXPECT_THAT(unchanged.out, ::testing::Not(HasSubstr("verdict    good")));
    const auto run = RunProgram({"label", input, "--repair", "-o", output});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("get the names of where they are"));
    EXPECT_THAT(run.out, HasSubstr("verdict    good"));
    const MarkerSequence repaired = ReadRecording(output, {}).markers;
    for (std::size_t i = 0; i < right.size(); ++i) {
      const int label = repaired.FindLabel(right[i]);
      ASSERT_GE(label, 0) << right[i];
      for (int k = 0; k < frames; k += 20) {
        const Eigen::Vector3d p = recording.frame(k).col(static_cast<Eigen::Index>(i));
        if (!IsSeen(p)) continue;
        ASSERT_LT((repaired.frame(k).col(label) - p).norm(), 1e-4) << right[i];
      }
    }
  }
}

// Half of a file, by the subject file of somebody else: in doubt, and hardly a name is wrong.
TEST(LabelRealFiles, TheVerdictTellsWhatIsWrong) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string other = SharedData("recordings/kit_bimanual_c3d/Cut_1723.c3d");
  const std::string subject = InFolder("subject.xml"), summary = InFolder("summary.json");
  ProgramRun run = RunProgram({"calibrate", other, "--height", "1.68", "-o", subject});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string input = Unlabelled();
  const std::string bytes = ReadText(input);
  WriteText(input, bytes.substr(0, bytes.size() / 2));
  const std::string output = InFolder("labelled.c3d");
  run = RunProgram({"label", input, "--subject-file", subject, "--summary", summary, "-o", output});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("verdict    check"), HasSubstr("the file is cut off")));
  const auto json = nlohmann::json::parse(ReadText(summary));
  EXPECT_EQ(json.at("verdict").at("level"), "check");
  const MarkerSequence truth = ReadRecording(Labelled(), {}).markers;
  const MarkerSequence found = ReadRecording(output, {}).markers;
  int right = 0, wrong = 0;
  for (int i = 0; i < truth.num_labels(); ++i) {
    const int label = found.FindLabel(truth.labels()[static_cast<std::size_t>(i)]);
    if (label < 0) continue;
    for (int k = 0; k < found.num_frames(); ++k) {
      const Eigen::Vector3d p = found.frame(k).col(label);
      if (IsSeen(p)) ++((p - truth.frame(k).col(i)).norm() < 1e-4 ? right : wrong);
    }
  }
  EXPECT_GT(right, 1500);  // of 38 frames, 53 labels
  EXPECT_LE(wrong, 15);
  EXPECT_THAT(RunProgram({"info", summary}).out, HasSubstr("summary of labels"));
}

TEST(LabelRealFiles, NamesByTheHeightAlone) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string output = InFolder("out.trc");
  const std::string summary = InFolder("summary.json");
  const ProgramRun run =
      RunProgram({"label", Unlabelled(), "--height", "1.76", "-o", output, "--summary", summary});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GE(Compare(ReadRecording(output, {}).markers).share(), 0.98);
  const auto json = nlohmann::json::parse(ReadText(summary));
  EXPECT_EQ(json.at("output"), output);
  EXPECT_EQ(json.at("marker_set"), "KIT");
  EXPECT_EQ(json.at("names").size(), 53);
  EXPECT_GE(json.at("changes").size(), 50);
  EXPECT_EQ(json.at("changes").at(0).at("first_frame"), 0);
}

// The knees exchanged in 20 frames.
TEST(LabelRealFiles, RepairTellsAndMendsWhatIsWrong) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const C3dFile file(Labelled());
  const int frames = file.layout().frames;
  const std::vector<std::string> names = C3dPointNames(file, nullptr);
  std::vector<C3dRelabelledPoint> points;
  points.reserve(names.size());
  for (int i = 0; i < file.layout().points; ++i) points.push_back({names[i], i, {{0, frames, i}}});
  const int left =
      static_cast<int>(std::find(names.begin(), names.end(), "1480:LKNE") - names.begin());
  const int right =
      static_cast<int>(std::find(names.begin(), names.end(), "1480:RKNE") - names.begin());
  points[left].stretches = {{0, 30, left}, {30, 50, right}, {50, frames, left}};
  points[right].stretches = {{0, 30, right}, {30, 50, left}, {50, frames, right}};
  const std::string input = InFolder("exchanged.c3d");
  WriteRelabelledC3d(Labelled(), points, input);
  const std::string bytes = ReadText(input);
  const StrictC3d before = ReadStrictC3d(bytes);

  ProgramRun run = RunProgram({"label", input, "--repair"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("LKNE is RKNE"), HasSubstr("RKNE is LKNE"),
                             HasSubstr(", frames 30 to 49 (3.00 to 4.90 s)")));
  EXPECT_EQ(ReadText(input), bytes);
  run = RunProgram({"label", input, "--repair", "-o", input});  // in its own place
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ExpectLabelled(input);
  const StrictC3d after = ReadStrictC3d(ReadText(input));
  EXPECT_GE(after.Find("1480:LKNE"), 0);
  for (const auto& [name, content] : before.records) {
    if (name.starts_with("POINT:")) continue;
    EXPECT_TRUE(after.records.at(name) == content) << name;
  }
  for (int k = 0; k < before.frames; ++k) {
    const std::set<std::string> words(after.words[k].begin(), after.words[k].end());
    for (const std::string& word : before.words[k]) EXPECT_TRUE(words.contains(word)) << k;
  }
}

TEST(LabelRealFiles, ConvertLabelsInOneStep) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string output = InFolder("motion.xml");
  const std::string summary = InFolder("motion.json");
  const ProgramRun run = RunProgram(
      {"convert", Unlabelled(), "--label", "--height", "1.76", "-o", output, "--summary", summary});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("labels     "), HasSubstr("verdict    ")));
  EXPECT_GE(Compare(ReadRecording(output, {}).markers).share(), 0.98);
  EXPECT_EQ(nlohmann::json::parse(ReadText(summary)).at("labels").at("names").size(), 53);
}

TEST(LabelRealFiles, ConvertTakesTheNamesOfAnotherRecording) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string output = InFolder("motion.xml");
  const ProgramRun run = RunProgram(
      {"convert", Unlabelled(), "--label", "--like", Labelled(), "--height", "1.76", "-o", output});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ExpectLabelled(output);
}

TEST(LabelRealFiles, BatchesLabelToo) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string manifest =
      WriteManifest(0, "label='true' labelLike='" + Labelled() + "'",
                    "<Recording id='pour' height_m='1.76' file='" +
                        std::filesystem::absolute(Unlabelled()).string() + "'/>");
  const ProgramRun run = RunProgram({"batch", manifest, "-o", InFolder("converted")});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  ExpectLabelled(InFolder("converted/motions/pour.xml"));
}

// Plug-in Gait's bone axes have a point LTIP, as KIT's shin marker is called.
TEST(LabelRealFiles, NamesThatAnotherPointKeepsAreRefusedBeforeTheWork) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string trial = SharedData("recordings/whole_body/pycgm_movement_trial.c3d");
  const std::string output = InFolder("named.c3d");
  const ProgramRun run = RunProgram({"label", trial, "--height", "1.7", "-o", output});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, AllOf(HasSubstr("another point LTIP"), HasSubstr("--like RECORDING")));
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST(LabelRealFiles, WhatIsMissingIsSaid) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string input = Unlabelled();
  const std::string bytes = ReadText(input);
  const auto expect = [&](const std::vector<std::string>& arguments, int exit_code,
                          const std::string& said) {
    const ProgramRun run = RunProgram(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_THAT(run.err, HasSubstr(said));
    EXPECT_EQ(ReadText(input), bytes);
  };
  expect({"label"}, 2, "which recording?");
  expect({"label", input}, 1, "Points without names don't tell the height");
  expect({"label", input, "--height", "1.76", "-o", InFolder("out.zip")}, 1,
         "must end as that of a recording");
  expect({"label", input, "--like", InFolder("none.c3d")}, 1, "none.c3d");
  expect({"label", input, "--like", input, "--height", "1.76"}, 1, "no labelled markers");
  expect({"label", input, "--repair", "--height", "1.76"}, 1, "no marker set");
  expect({"label", input, "--height", "1.76", "-o", Labelled(), "--like", Labelled()}, 1,
         "is read, and would be lost");
  expect({"convert", input, "--height", "1.76"}, 1, "the command label finds the names");
  expect({"convert", input, "--label", "--object"}, 2, "--label names the markers of a person");
  expect({"convert", input, "--like", Labelled(), "--height", "1.76"}, 2, "--label or --repair");
  expect({"convert", input, "--label", "--like", Labelled(), "--height", "1.76", "-o", Labelled()},
         1, "is read, and would be lost");
  const std::string trc = InFolder("same.trc");
  std::filesystem::copy_file(input, trc);
  expect({"label", trc, "--height", "1.76", "-o", trc}, 1, "is the recording itself");
}

}  // namespace
}  // namespace mmm_converter::testing
