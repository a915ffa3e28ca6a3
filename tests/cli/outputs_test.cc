// SPDX-License-Identifier: MIT
// No command overwrites what it reads, or one output with another, or starts work whose output
// can't be written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/cli/program.h"
#include "tests/support/test_folder.h"

namespace mmm_converter::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// A call that would lose a file: words with {R} for a recording, {M} for a motion of it, {S} for a
// subject.
struct Call {
  std::string words;
  std::string lost;  // "{R}"
};

std::string WithReplaced(std::string text, const std::string& mark, const std::string& value) {
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark)) {
    text.replace(at, mark.size(), value);
  }
  return text;
}

class Outputs : public ::testing::TestWithParam<Call> {
 protected:
  std::string In(const std::string& name) const { return TestFolder() + "/" + name; }
  std::string Filled(const std::string& text) const {
    std::string filled = WithReplaced(text, "{R}", In("walk.c3d"));
    filled = WithReplaced(filled, "{M}", In("walk_mmm.xml"));
    return WithReplaced(filled, "{NEW}", In("new"));
  }
  std::vector<std::string> Words(const std::string& text) const {
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; stream >> word;) words.push_back(Filled(word));
    return words;
  }
};

TEST_P(Outputs, NothingThatIsReadIsLost) {
  fs::copy_file(Handstand(), In("walk.c3d"));
  fs::copy_file(fs::path(Handstand()).parent_path() / "handstand_true.xml", In("walk_mmm.xml"));
  const std::string lost = Filled(GetParam().lost);
  const std::string before = ReadText(lost);
  const ProgramRun run = RunProgram(Words(GetParam().words));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr(lost + ": is read, and would be lost"));
  EXPECT_EQ(ReadText(lost), before);
  EXPECT_FALSE(fs::exists(In("new")));
}

INSTANTIATE_TEST_SUITE_P(
    Commands, Outputs,
    ::testing::Values(
        Call{"compare {R} --height 1.8 -c s2kf_default --csv {NEW} --json {R}", "{R}"},
        Call{"compare {R} --height 1.8 -c s2kf_default --csv {R}", "{R}"},
        Call{"compare {R} --height 1.8 -c s2kf_default --gnuplot {R}", "{R}"},
        Call{"compare {R} --height 1.8 -c s2kf_default --report {R}", "{R}"},
        Call{"compare {R} --height 1.8 -c s2kf_default --truth {M} --report {M}", "{M}"},
        Call{"report {R} {M} --json {NEW} -o {M}", "{M}"},
        Call{"report {R} {M} -o {NEW} --csv {R}", "{R}"},
        Call{"calibrate {R} --height 1.8 -o {NEW} --summary {R}", "{R}"},
        Call{"calibrate {R} --height 1.8 -o {NEW} --report {R}", "{R}"},
        Call{"calibrate {R} --height 1.8 -o {NEW} --model-out {R}", "{R}"},
        Call{"calibrate {R} --height 1.8 -o {R}", "{R}"},
        Call{"check-dynamics {M} --summary {M}", "{M}"},
        Call{"check-dynamics {M} --summary {NEW} --report {M}", "{M}"},
        Call{"convert {R} --height 1.8 -o {NEW} --summary {R}", "{R}"},
        Call{"convert {R} --height 1.8 -o {NEW} --export-csv {R}", "{R}"},
        Call{"live replay:{R}@max --height 1.8 -o {R}", "{R}"},
        Call{"live replay:{R}@max --height 1.8 -o {NEW} --export-csv {R}", "{R}"},
        Call{"export-urdf --height 1.8 --mass 75 --model {M} -o {M}", "{M}"}));

TEST(TwoOutputs, AreNotOneFile) {
  const std::string file = TestFolder() + "/one";
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"calibrate", Handstand(), "--height", "1.8", "-o", file,
                                 "--model-out", file},
        std::vector<std::string>{"compare", Handstand(), "--height", "1.8", "--json", file, "--csv",
                                 file},
        std::vector<std::string>{"convert", Handstand(), "--height", "1.8", "-o", file, "--report",
                                 file}}) {
    const ProgramRun run = RunProgram(words);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr(file + ": is to hold two outputs"));
    EXPECT_FALSE(fs::exists(file));
  }
}

TEST(OutputsThatCantBeWritten, AreNamedBeforeTheWork) {
  const std::string file = TestFolder() + "/absent/file";
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"calibrate", Handstand(), "--height", "1.8", "--summary", file},
        std::vector<std::string>{"compare", Handstand(), "--height", "1.8", "--json", file},
        std::vector<std::string>{"report", Handstand(), Handstand(), "-o", file},
        std::vector<std::string>{"evaluate", "-o", "/dev/null/folder"}}) {
    const ProgramRun run = RunProgram(words);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(run.out, "");
  }
}

}  // namespace
}  // namespace mmm_converter::testing
