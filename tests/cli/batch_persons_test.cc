// SPDX-License-Identifier: MIT
// batch: persons who are calibrated once.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/recording/recording.h"
#include "tests/cli/batch_manifest.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using testing::Contents;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;
using testing::WriteManifest;
using testing::WriteText;

std::string PersonsOut(const std::string& name = "out") { return TestFolder() + "/" + name; }

// 2.5 s are enough to calibrate on.
void WriteRange(int begin, int count = 250) {
  WriteC3d(TestFolder() + "/range.c3d",
           ReadRecording(testing::Handstand(), {}).markers.Slice(begin, begin + count));
}

// Three recordings of Anna, and one of somebody else; person: attributes of <Person>.
std::string ManifestOfAnna(const std::string& person = "recordings='range.c3d' height_m='1.8'") {
  std::string more = "\n<Person id='anna' " + person + "/>";
  for (int i = 0; i < 3; ++i) {
    more += fmt::format(
        "\n<Recording file='handstand.c3d' id='anna/{}' frames='{}:{}' "
        "person='anna'/>",
        i, 40 * i, 40 * i + 40);
  }
  return WriteManifest(1, testing::QuickConverter(), more);
}

testing::ProgramRun RunBatchOf(const std::string& manifest, const std::string& jobs = "2",
                               const std::string& out = "out") {
  return RunProgram(
      {"batch", manifest, "-o", PersonsOut(out), "--resume", "--reports", "none", "--jobs", jobs});
}

int Count(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

constexpr const char* kCalibrated = "person anna: calibrated by";

TEST(BatchPersons, OneCalibrationIsForAllOfThePerson) {
  WriteRange(0);
  const std::string manifest =
      ManifestOfAnna("recordings='range.c3d range.c3d' height_m='1.75' mass_kg='62'");
  const auto run = RunBatchOf(manifest);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(Count(run.err, kCalibrated), 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("calibrated by 2 recordings, "));
  // As the commands do it one by one.
  const std::string range = TestFolder() + "/range.c3d";
  const std::string subject = PersonsOut() + "/persons/anna.xml";
  ASSERT_EQ(RunProgram({"calibrate", range, range, "--height", "1.75", "--mass", "62", "--name",
                        "anna", "-o", TestFolder() + "/anna.xml"})
                .exit_code,
            0);
  EXPECT_EQ(ReadText(subject), ReadText(TestFolder() + "/anna.xml"));
  const std::string motion = PersonsOut() + "/motions/anna/one.xml";
  ASSERT_EQ(
      RunProgram(testing::WithTestConverter({"convert", TestFolder() + "/handstand.c3d", "--frames",
                                             "40:80", "--subject-file", subject, "-o", motion}))
          .exit_code,
      0);
  EXPECT_EQ(ReadText(PersonsOut() + "/motions/anna/1.xml"), ReadText(motion));
  const std::string results = ReadText(PersonsOut() + "/results.jsonl");
  EXPECT_EQ(Count(results, "\"subject\":\"anna\""), 3) << results;
  EXPECT_EQ(Count(results, "\"height_m\":1.8,"), 1);
  // Nor does it depend on who waits.
  ASSERT_EQ(RunBatchOf(manifest, "1", "alone").exit_code, 0);
  std::filesystem::remove(motion);
  EXPECT_EQ(Contents(PersonsOut("alone") + "/motions"), Contents(PersonsOut() + "/motions"));
  EXPECT_EQ(ReadText(PersonsOut("alone") + "/persons/anna.xml"), ReadText(subject));
}

TEST(BatchPersons, ResumeCalibratesAnewWhatHasChanged) {
  WriteRange(0);
  const std::string manifest = ManifestOfAnna();
  ASSERT_EQ(RunBatchOf(manifest).exit_code, 0);
  const auto unchanged = RunBatchOf(manifest);
  EXPECT_THAT(unchanged.out, HasSubstr("0 converted, 0 failed, 4 unchanged"));
  EXPECT_THAT(unchanged.err, Not(HasSubstr(kCalibrated)));
  WriteRange(30);
  const auto recording = RunBatchOf(manifest);
  EXPECT_THAT(recording.out, HasSubstr("3 converted, 0 failed, 1 unchanged"));
  EXPECT_EQ(Count(recording.err, kCalibrated), 1);
  ManifestOfAnna("recordings='range.c3d' height_m='1.78'");
  const auto height = RunBatchOf(manifest);
  EXPECT_THAT(height.out, HasSubstr("3 converted, 0 failed, 1 unchanged"));
  EXPECT_EQ(Count(height.err, kCalibrated), 1);
  const std::string subject = ReadText(PersonsOut() + "/persons/anna.xml");
  WriteText(PersonsOut() + "/persons/anna.xml", "cut off");  // the same again: motions stay
  const auto subject_run = RunBatchOf(manifest);
  EXPECT_THAT(subject_run.out, HasSubstr("0 converted, 0 failed, 4 unchanged"));
  EXPECT_EQ(ReadText(PersonsOut() + "/persons/anna.xml"), subject);
  std::filesystem::remove(TestFolder() + "/range.c3d");  // what was made of it stays
  EXPECT_THAT(RunBatchOf(manifest).out, HasSubstr("0 converted, 0 failed, 4 unchanged"));
  WriteText(PersonsOut() + "/persons/anna.json", "{\"fingerprint\": 1}");
  EXPECT_THAT(RunBatchOf(manifest).out, HasSubstr("0 converted, 3 failed, 1 unchanged"));
}

TEST(BatchPersons, ACalibrationThatFailsFailsItsRecordingsOnly) {
  const std::string manifest = ManifestOfAnna();
  const auto run = RunBatchOf(manifest);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("4 recordings, 1 converted, 3 failed"));
  EXPECT_EQ(Count(run.err, manifest + ":3: <Person id=\"anna\"> can't be calibrated: "), 3)
      << run.err;
  EXPECT_THAT(ReadText(PersonsOut() + "/results.jsonl"), HasSubstr("range.c3d: can't be read"));
  EXPECT_EQ(Contents(PersonsOut() + "/persons").size(), 0U);
  WriteRange(0, 3);
  EXPECT_THAT(RunBatchOf(manifest).err, HasSubstr("short"));
  WriteRange(0);
  EXPECT_THAT(RunBatchOf(manifest).out, HasSubstr("3 converted, 0 failed, 1 unchanged"));
}

TEST(BatchPersons, NobodyIsMissedAndNobodyIsLeftOverUnsaid) {
  const std::string manifest = WriteManifest(
      0, testing::QuickConverter(),
      "\n<Person id='anna' recordings='handstand.c3d'/>\n<Recording file='handstand.c3d' "
      "frames=':40' person='ana'/>");
  const auto run = RunProgram({"batch", manifest, "-o", PersonsOut()});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr(manifest + ":3: <Recording>: person=\"ana\" is neither"));
  EXPECT_FALSE(std::filesystem::exists(PersonsOut()));
  WriteManifest(1, testing::QuickConverter(), "\n<Person id='anna' recordings='handstand.c3d'/>");
  const auto unused = RunBatchOf(manifest);
  EXPECT_EQ(unused.exit_code, 0);
  EXPECT_THAT(unused.err, AllOf(HasSubstr(":3: no recording has person=\"anna\""),
                                Not(HasSubstr(kCalibrated))));
  EXPECT_THAT(RunProgram({"info", manifest}).out, HasSubstr("persons    1"));
}

TEST(BatchPersons, OfAModelOfOpenSimThePersonsModelIsMade) {
  const std::string examples = testing::SourcePath("examples/opensim");
  const std::string manifest = TestFolder() + "/osim.xml";
  WriteText(manifest, fmt::format("<Batch folder='{0}'><Person id='anna' model='{0}/generic.osim' "
                                  "recordings='static.trc walk.trc' mass_kg='70.5'/>"
                                  "<Recording file='walk.trc' id='walk' person='anna'/></Batch>",
                                  examples));
  const auto run = RunBatchOf(manifest);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(ReadText(PersonsOut() + "/persons/anna.osim"), HasSubstr("<OpenSimDocument"));
  EXPECT_TRUE(std::filesystem::exists(PersonsOut() + "/motions/walk.mot"));
  EXPECT_THAT(RunBatchOf(manifest).out, HasSubstr("0 converted, 0 failed, 1 unchanged"));
}

}  // namespace
}  // namespace mmm_converter
