// SPDX-License-Identifier: MIT
// `learn-markers` on the shipped handstand under labels that mean nothing, and what other commands
// say of these labels and make of the set.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/io/recording/recording.h"
#include "common/io/tables/trc_writer.h"
#include "common/support/atomic_file.h"
#include "tests/cli/program.h"

namespace mmm_converter::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string OfThisTest(const std::string& name) { return TestFolder() + "/" + name; }

// The handstand's markers in the opposite order as m1, m2, ...
std::string Meaningless() {
  const MarkerSequence named = ReadRecording(Handstand(), {}).markers;
  std::vector<std::string> labels;
  for (int i = 0; i < named.num_labels(); ++i) labels.push_back("m" + std::to_string(i + 1));
  MarkerSequence renamed(labels, named.num_frames(), named.rate(), named.first_time());
  for (int k = 0; k < named.num_frames(); ++k) {
    renamed.frame(k) = named.frame(k).rowwise().reverse();
  }
  std::string file = OfThisTest("meaningless.trc");
  TrcOutput output;
  output.file_name = "meaningless.trc";
  output.measured = &renamed;
  WriteFileAtomically(file, FormatTrc(output));
  return file;
}

TEST(LearnMarkers, ASetThatCalibrateTakes) {
  const std::string recording = Meaningless();
  const std::string set = OfThisTest("our_set.xml");
  const std::string summary = OfThisTest("learnt.json");
  const std::string page = OfThisTest("our_set.html");
  const auto learnt = RunProgram({"learn-markers", recording, "--height", "1.75", "-o", set,
                                  "--summary", summary, "--report", page});
  ASSERT_EQ(learnt.exit_code, 0) << learnt.err;
  EXPECT_THAT(learnt.out, HasSubstr("labels, on"));
  EXPECT_THAT(ReadText(page), AllOf(HasSubstr("Marker set our_set"), HasSubstr("were learnt on"),
                                    HasSubstr("meaningless.trc"), HasSubstr("</html>")));
  const auto json = nlohmann::json::parse(ReadText(summary));
  EXPECT_EQ(json["markers"].size(), 53U);
  EXPECT_EQ(json["output"], set);
  EXPECT_THAT(RunProgram({"info", set}).out, HasSubstr("marker set our_set"));
  const auto calibrated = RunProgram({"calibrate", recording, "--height", "1.75", "--marker-set",
                                      set, "-o", OfThisTest("person.xml")});
  EXPECT_EQ(calibrated.exit_code, 0) << calibrated.err;
  EXPECT_THAT(calibrated.out, HasSubstr("person.xml has the person"));
}

TEST(LearnMarkers, OtherCommandsSayThatItExists) {
  const auto run = RunProgram({"convert", Meaningless(), "-o", OfThisTest("motion.xml")});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("learn-markers"));
}

TEST(LearnMarkers, TheHeightIsNeeded) {
  const std::string set = OfThisTest("our_set.xml");
  const auto run = RunProgram({"learn-markers", Meaningless(), "-o", set});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("--height"));
  EXPECT_FALSE(std::filesystem::exists(set));
}

}  // namespace
}  // namespace mmm_converter::testing
