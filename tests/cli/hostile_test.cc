// SPDX-License-Identifier: MIT
// What an attack on the readers found, each file as it was: the right behaviour of each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string In(const std::string& name) { return TestFolder() + "/" + name; }

/// A copy of the files of a sample; their names.
std::set<std::string> Take(const std::string& sample) {
  std::set<std::string> names;
  for (const auto& one : fs::directory_iterator(SharedData("hostile/" + sample))) {
    const std::string name = one.path().filename().string();
    if (name == "CMD") continue;
    fs::copy_file(one.path(), In(name));
    fs::permissions(In(name), fs::perms::owner_write, fs::perm_options::add);
    names.insert(name);
  }
  return names;
}

/// Words that are files of the sample or begin with "out" stand in the test's folder.
ProgramRun RunCase(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) {
    const bool is_file = fs::exists(In(word)) || word.starts_with("out");
    words.push_back(is_file ? In(word) : word);
  }
  return RunProgram(words);
}

/// Everything but the sample's files; none: nothing was written.
std::vector<std::string> Written(const std::set<std::string>& sample) {
  std::vector<std::string> written;
  for (const auto& one : fs::directory_iterator(TestFolder())) {
    const std::string name = one.path().filename().string();
    if (sample.count(name) == 0) written.push_back(name);
  }
  return written;
}

// A run that is refused, says so, and writes nothing.
struct Refused {
  const char* sample;
  const char* words;
  const char* said;
};

void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.words; }

class HostileReal : public ::testing::TestWithParam<Refused> {};

TEST_P(HostileReal, IsRefusedAndNothingIsWritten) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::set<std::string> sample = Take(GetParam().sample);
  const ProgramRun run = RunCase(GetParam().words);
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr(GetParam().said));
  EXPECT_THAT(Written(sample), ::testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    Files, HostileReal,
    ::testing::Values(
        Refused{"A3_blames_plugin", "convert w.trc --model m.osim -o out.mot",
                "m.osim: model node"},
        Refused{"A4_state_dimension", "convert w.trc --model m.osim -o out.mot",
                "<Filter samples=\"301\"/>"},
        Refused{"A5_calibrate_1000_bodies", "calibrate s.trc --model m.osim -o out.osim",
                "m.osim: has"},
        Refused{"A7_markerfile_limit",
                "convert w.trc --model m.osim --marker-file mf.xml -o out.mot", "4096 markers"},
        Refused{"A8_polynomials_work", "convert w.trc --model m.osim -o out.mot",
                "more than the 32 that are read"},
        Refused{"B1_map_forward_nan", "retarget h.xml --robot m.xml --map map.xml -o out.xml",
                "forward=\"nan 0 0\""},
        Refused{"B2_urdf_mass_dropped", "export-urdf --model m_8,5.urdf -o out.urdf",
                "<mass value=\"8,5\">"},
        Refused{"B2_urdf_mass_dropped", "export-urdf --model m_nan.urdf -o out.urdf",
                "<mass value=\"nan\">"},
        Refused{"B2_urdf_mass_dropped", "export-urdf --model m_1e400.urdf -o out.urdf",
                "<mass value=\"1e400\">"},
        Refused{"B3_mimic_1e200", "retarget h.xml --robot m_1e140.urdf -o out.xml", "<mimic>"},
        Refused{"B3_mimic_1e200", "retarget h.xml --robot m_1e155.urdf -o out.xml", "<mimic>"},
        Refused{"B3_mimic_1e200", "retarget h.xml --robot mo_1e200.urdf -o out.xml", "<mimic>"},
        Refused{"B3_mimic_1e200", "retarget h.xml --robot mf_1e200.urdf -o out.xml",
                "mf_1e200.urdf"},
        Refused{"C1_grf_without_forces",
                "convert cal_nan.c3d --height 1.8 -o out.xml --export-grf out.mot",
                "none of its forces is a number"},
        Refused{"C1_grf_without_forces",
                "convert ana_nan.c3d --height 1.8 -o out.xml --export-grf out.mot", "is a number"},
        Refused{"C2_error_after_outputs",
                "convert i.c3d --height 1.8 -o out.xml --export-contacts out.json --export-gait "
                "out_g.json --export-grf outg.mot",
                "i.c3d: force plate"},
        Refused{"C3_forces_huge_times_hang",
                "convert i.c3d --height 1.8 -o out.xml --forces f.mot --export-grf outg.mot",
                "f.mot: its rows are"},
        Refused{"D2_text_called_c3d", "convert i.csv --model g.osim -o out.mot",
                "is text with bytes that no text has"},
        Refused{"E1_input_destroyed/ca_o_mk",
                "calibrate s.trc --model g.osim --scale-setup st.xml -o mk.xml", "mk.xml: is read"},
        Refused{"E1_input_destroyed/ca_o_part",
                "calibrate s.trc --model g.osim --scale-setup st.xml -o mm.xml", "mm.xml: is read"},
        Refused{"E1_input_destroyed/cv_o_part", "convert w.trc --model g.osim -o ms.xml",
                "ms.xml: is read"},
        Refused{"E1_input_destroyed/cv_o_part",
                "convert w.trc --model g.osim -o out.mot --summary ms.xml", "ms.xml: is read"},
        Refused{"E1_input_destroyed/grf_data",
                "convert i.c3d --height 1.8 -o out.xml --forces f.xml --export-grf dat.mot",
                "dat.mot: is read"},
        Refused{"E1_input_destroyed/o_is_include", "retarget h.xml --robot m.xml -o a.xml",
                "a.xml: is read"},
        Refused{"E1_input_destroyed/o_is_include",
                "retarget h.xml --robot m.xml -o out.xml --summary a.xml", "a.xml: is read"}));

TEST(HostileRealFiles, AJointOfTheGroundStaysAsItIs) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Take("A1_scale_oldground");
  const ProgramRun run = RunCase("calibrate s.trc --model m.osim --scale-setup st.xml -o out.osim");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(ReadText(In("out.osim")), HasSubstr("<location_in_parent>1 2 3<"));
}

TEST(HostileRealFiles, DeviationsAreNumbers) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Take("A2_deviations_nan");
  const ProgramRun run = RunCase("convert w.trc --model m.osim -o out.mot");
  if (run.exit_code == 0) {
    EXPECT_THAT(ReadText(In("out_deviations.sto")), Not(HasSubstr("nan")));
  } else {
    EXPECT_THAT(run.err, HasSubstr("m.osim"));
  }
}

TEST(HostileRealFiles, ManyBodiesThatNoMarkerTellsTakeNoTime) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Take("A6_scale_2000_bodies");
  const ProgramRun run = RunCase("calibrate s.trc --model m.osim --scale-setup st.xml -o out.osim");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(fs::exists(In("out.osim")));
}

TEST(HostileRealFiles, AMassThatIsRightStaysReadable) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Take("B2_urdf_mass_dropped");
  EXPECT_EQ(RunCase("info m_8.urdf").exit_code, 0);
}

TEST(HostileRealFiles, ColumnsOfForcesAreTakenByName) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Take("C4_forces_columns_by_position");
  const ProgramRun run =
      RunCase("convert i.c3d --height 1.8 -o out.xml --forces f.mot --export-grf outg.mot");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("its forces point along y"));
}

TEST(HostileRealFiles, RowsThatRunBackwardsAreSaid) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Take("D1_nexus_reversed");
  EXPECT_THAT(RunCase("convert i.csv --model g.osim --up y -o out.mot").err,
              HasSubstr("more such steps back"));
}

TEST(HostileRealFiles, ResumeComparesWhatInputsName) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Take("E4_resume_part_changed");
  const auto resumed = [](const std::string& manifest) {
    return RunCase("batch " + manifest + " -o out_" + manifest + " --reports none --resume").out;
  };
  EXPECT_THAT(resumed("b3.xml"), HasSubstr("1 converted"));
  EXPECT_THAT(resumed("b3.xml"), HasSubstr("1 unchanged"));
  fs::copy_file(In("ms2.xml"), In("ms.xml"), fs::copy_options::overwrite_existing);
  EXPECT_THAT(resumed("b3.xml"), AllOf(HasSubstr("1 converted"), Not(HasSubstr("unchanged"))));
  EXPECT_THAT(resumed("b4.xml"), HasSubstr("1 converted"));
  EXPECT_THAT(resumed("b4.xml"), HasSubstr("1 unchanged"));
  WriteText(In("dat.mot"), ReadText(In("dat.mot")) + "\n");
  EXPECT_THAT(resumed("b4.xml"), AllOf(HasSubstr("1 converted"), Not(HasSubstr("unchanged"))));
}

TEST(HostileRealFiles, ACommaInANameIsNoCell) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Take("X1_csv_comma_in_name");
  ASSERT_EQ(RunCase("convert w.trc --model m.osim -o out.mot --export-csv out.csv").exit_code, 0);
  std::istringstream table(ReadText(In("out.csv")));
  std::string names, row;
  std::getline(table, names);
  std::getline(table, row);
  EXPECT_EQ(std::count(names.begin(), names.end(), ','), std::count(row.begin(), row.end(), ','));
}

}  // namespace
}  // namespace mmm_converter::testing
