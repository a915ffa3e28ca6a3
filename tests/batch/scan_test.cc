// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "MMMConverterS2KF/batch/manifest.h"
#include "common/support/error.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

class ScanTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) {
    const fs::path path = fs::path(root_) / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path.string();
  }

  Scan Run(const std::string& subjects = "") { return ScanFolder(root_ + "/kit", subjects); }

  static BatchManifest Manifest(const Scan& scan) {
    return ParseManifest(scan.manifest, "/elsewhere/manifest.xml");
  }

  static std::string Motion(const std::string& height, const std::string& inside) {
    return "<MMM version='2.0' name='x'><Motion name='1723' "
           "type='mmm'><Model><File>m.xml</File></Model>"
           "<ModelProcessorConfig type=\"Winter\"><Height>" +
           height + "</Height><Mass>62</Mass></ModelProcessorConfig>" + inside + "</Motion></MMM>";
  }

  const std::string root_ = testing::TestFolder();
};

TEST_F(ScanTest, KitsTreeWithMotionsBesideTheRecordings) {
  Write("kit/files_motions_2/Peel.C3D", "x");
  Write("kit/files_motions_2/Peel.xml", Motion("1.68", ""));
  Write("kit/files_motions_2/Cut & run.c3d", "x");
  Write("kit/files_motions_2/Cut & run.xml", Motion("1.68", ""));
  Write("kit/files_motions_1/walk.trc", "x");
  Write("kit/files_motions_1/notes.xml", "<Notes/>");
  Write("kit/files_motions_1/own.xml", Motion("1.8", "<MarkerPosition name='A'/>"));
  Write("kit/files_motions_1/own_mmm.xml", Motion("1.8", "<MarkerPosition name='A'/>"));
  Write("kit/readme.txt", "x");
  const Scan scan = Run();
  EXPECT_EQ(scan.recordings, 4);
  EXPECT_THAT(scan.warnings.texts(), IsEmpty());
  const BatchManifest manifest = Manifest(scan);
  EXPECT_EQ(manifest.name, "kit");
  ASSERT_EQ(manifest.entries.size(), 4U);
  EXPECT_EQ(manifest.entries[0].id, "files_motions_1/walk");
  EXPECT_EQ(manifest.entries[0].group, "files_motions_1");
  EXPECT_EQ(manifest.entries[0].request.input.file,
            fs::canonical(root_ + "/kit/files_motions_1/walk.trc"));
  EXPECT_FALSE(manifest.entries[0].request.input.person.size.height);
  EXPECT_EQ(manifest.entries[1].id, "files_motions_1/own");
  EXPECT_EQ(manifest.entries[2].id, "files_motions_2/Cut & run");
  EXPECT_EQ(manifest.entries[2].request.input.person.size.height, 1.68);
  EXPECT_EQ(manifest.entries[3].request.input.person.size.mass, 62);
  EXPECT_EQ(manifest.entries[3].request.converter.config, "s2kf_default");
  EXPECT_THAT(scan.manifest,
              HasSubstr("<Group name=\"files_motions_2\" height_m=\"1.68\" mass_kg=\"62\">"));
}

TEST_F(ScanTest, ATableSaysWhoTheyAre) {
  Write("kit/a/1.c3d", "x");
  Write("kit/a/2.c3d", "x");
  Write("kit/3.c3d", "x");
  const std::string table = Write("subjects.csv",
                                  "\xEF\xBB\xBF"
                                  "folder,height_m,mass_kg,subject_file,who\r\n"
                                  "a/,1.7,,persons/anna.xml,\"Anna, \"\"A\"\"\"\r\n\r\n"
                                  "./a/2,1.8,80,,\nnowhere,1.9,90,,\n");
  const Scan scan = Run(table);
  ASSERT_EQ(scan.warnings.all().size(), 1U);
  EXPECT_THAT(scan.warnings.texts()[0], HasSubstr("there is no recording in or at \"nowhere\""));
  const BatchManifest manifest = Manifest(scan);
  ASSERT_EQ(manifest.entries.size(), 3U);
  EXPECT_FALSE(manifest.entries[0].request.input.person.size.height);
  const BatchEntry& one = manifest.entries[1];
  EXPECT_EQ(one.request.input.person.size.height, 1.7);
  EXPECT_EQ(one.request.input.person.subject_file, fs::absolute(root_ + "/persons/anna.xml"));
  EXPECT_THAT(one.metadata, ElementsAre(Pair("who", "Anna, \"A\"")));
  EXPECT_EQ(manifest.entries[2].request.input.person.size.height, 1.8);
  EXPECT_EQ(manifest.entries[2].request.input.person.size.mass, 80);
}

TEST_F(ScanTest, SameNamesGetIds) {
  Write("kit/walk.c3d", "x");
  Write("kit/walk.trc", "x");
  const BatchManifest manifest = Manifest(Run());
  ASSERT_EQ(manifest.entries.size(), 2U);
  EXPECT_EQ(manifest.entries[0].id, "walk.c3d");
  EXPECT_EQ(manifest.entries[1].id, "walk.trc");
}

// Every name that a file system allows is in the manifest, or told.
TEST_F(ScanTest, StrangeNames) {
  const std::vector<std::string> names = {"-rf.c3d",
                                          "'quoted' \"twice\".c3d",
                                          "a\nb.c3d",
                                          "a_b.c3d",
                                          " blanks .c3d",
                                          "tab\tand\rcr.c3d",
                                          "c1\xC2\x85\x7F.c3d",
                                          "back\\slash.c3d",
                                          "..c3d",
                                          "&lt;.c3d",
                                          std::string(251, 'n') + ".c3d",
                                          "\xC3\xA9.c3d",
                                          "%41.c3d"};
  for (const std::string& name : names) Write("kit/line\nend/" + name, "x");
  Write("kit/latin\xE9.c3d", "x");
  Write("kit/escape\x1B.c3d", "x");
  const Scan scan = Run();
  std::set<std::string> files;
  std::set<std::string> ids;
  for (const BatchEntry& entry : Manifest(scan).entries) {
    EXPECT_TRUE(fs::exists(entry.request.input.file)) << entry.request.input.file;
    files.insert(entry.request.input.file);
    ids.insert(entry.id);
  }
  EXPECT_EQ(files.size(), names.size());
  EXPECT_THAT(ids, ::testing::IsSupersetOf({"line_end/a_b", "line_end/a_b_2", "line_end/-rf",
                                            "line_end/back_slash", "recording", "recording_2"}));
  ASSERT_EQ(scan.warnings.all().size(), 2U);
  for (const std::string& text : scan.warnings.texts()) {
    EXPECT_THAT(text, HasSubstr("is left out: its name is not UTF-8 or has control characters"));
  }
}

TEST_F(ScanTest, AFolderThatNoManifestCanName) {
  Write("kit\xE9/walk.c3d", "x");
  EXPECT_THROW(ScanFolder(root_ + "/kit\xE9", ""), Error);
}

TEST_F(ScanTest, BadMotionsAreWarnings) {
  Write("kit/walk.c3d", "x");
  Write("kit/walk.xml",
        "<MMM><ModelProcessorConfig><Height>tall</Height></ModelProcessorConfig></MMM>");
  const Scan scan = Run();
  EXPECT_EQ(scan.recordings, 1);
  ASSERT_EQ(scan.warnings.all().size(), 1U);
  EXPECT_THAT(scan.warnings.texts()[0], HasSubstr("walk.xml"));
}

TEST_F(ScanTest, SaysWhatIsWrong) {
  EXPECT_THROW(Run(), Error);  // no such folder
  fs::create_directories(root_ + "/kit");
  EXPECT_THROW(Run(), Error);  // nothing in it
  Write("kit/walk.c3d", "x");
  for (const std::string table :
       {"name,height_m\n", "folder,height_m\nkit\n", "folder\na\n./a\n"}) {
    EXPECT_THROW(Run(Write("subjects.csv", table)), Error) << table;
  }
}

}  // namespace
}  // namespace mmm_converter
