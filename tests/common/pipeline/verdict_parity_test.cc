// SPDX-License-Identifier: MIT
// What a recording is judged to be does not depend on what is written of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/pipeline/conversion.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

ConversionRequest RequestOf(const std::string& file) {
  ConversionRequest request;
  request.input.file = file;
  request.input.end_frame = 150;
  request.input.person.size.height = 1.75;
  request.output = testing::TestFolder() + "/motion.xml";
  return request;
}

Verdict JudgedWith(const ExportFiles& exports, const std::string& file) {
  ConversionRequest request = RequestOf(file);
  request.exports = exports;
  ConversionReport report = RunConversion(request, {}, {});
  const Verdict before = report.verdict;
  WriteConversion(request, &report);
  EXPECT_EQ(report.verdict.reasons, before.reasons) << file << " while it is written";
  return report.verdict;
}

/// Every export that the recording can have: those that need a C3D file, plates, or a whole body
/// are left out together where it has none.
ExportFiles AllExports(const std::string& file) {
  ExportFiles all;
  const auto add = [&](const auto& is_added) {
    ConversionRequest request = RequestOf(file);
    for (const Exporter& one : Exporters()) {
      if (!is_added(std::string(one.name))) continue;
      request.exports[one.name] = testing::TestFolder() + "/" + one.name + "." + one.ending;
    }
    try {
      PlanConversion(request, {});
      all.insert(request.exports.begin(), request.exports.end());
    } catch (const Error&) {
    }
  };
  const auto needs_plates = [](const std::string& name) {
    return name == "grf" || name == "inverse-dynamics";
  };
  const auto needs_more = [](const std::string& name) {
    return name == "c3d" || name == "holosoma" || name == "amass";
  };
  add(needs_plates);
  add(needs_more);
  add([&](const std::string& name) { return !needs_plates(name) && !needs_more(name); });
  return all;
}

void ExpectParity(const std::string& file) {
  const ExportFiles all = AllExports(file);
  EXPECT_GE(all.size(), 10) << file;
  const Verdict alone = JudgedWith({}, file), with_all = JudgedWith(all, file);
  EXPECT_EQ(alone.level, with_all.level) << file;
  EXPECT_EQ(alone.reasons, with_all.reasons) << file;
}

TEST(VerdictParity, TheSampleIsJudgedAlikeWhateverIsWritten) {
  ExpectParity(testing::SourcePath("examples/handstand.c3d"));
}

TEST(RealVerdictParity, RecordingsAreJudgedAlikeWhateverIsWritten) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const char* file :
       {"field/btk_FunctionalWalk.c3d", "field/btk_561xxa01_anonym.C3D", "field/c3dio_gait-pig.c3d",
        "field/c3dio_newwalk.c3d", "field/c3dio_sub_labels.c3d",
        "field/kineticstoolkit_Qualisys.c3d", "field/osim_test_walking.c3d",
        "reports/f_corners_mirror.c3d", "reports/f_baseline.c3d",
        "recordings/whole_body/pycgm_movement_trial.c3d"}) {
    ExpectParity(testing::SharedData(file));
  }
}

}  // namespace
}  // namespace mmm_converter
