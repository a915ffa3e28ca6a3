// SPDX-License-Identifier: MIT
// make_report_cases FOLDER: the reports that no command makes on purpose, for the browser.
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "MMMConverterS2KF/report/label_page.h"
#include "MMMConverterS2KF/report/label_summary.h"
#include "MMMConverterS2KF/report/report.h"
#include "common/support/atomic_file.h"
#include "tests/report/comparison_cases.h"
#include "tests/report/dynamics_cases.h"
#include "tests/report/ground_cases.h"
#include "tests/report/label_cases.h"

namespace {

void MakeReports(const std::string& folder) {
  using namespace mmm_converter;
  const Comparison hostile = mmm_converter::testing::HostileComparison();
  const Comparison failed = mmm_converter::testing::FailedComparison();
  const std::string text = mmm_converter::testing::kHostileText;
  WriteFileAtomically(folder + "/hostile.html",
                      FormatReport(text, {{text, text, &hostile}, {"Failed", "", &failed}}));
  const Json ground = mmm_converter::testing::GroundCase(hostile.trials[0].markers.num_frames());
  const Json patient = mmm_converter::testing::PatientCase();
  WriteFileAtomically(folder + "/ground.html",
                      FormatReport("Ground", {{"Ground", "", &hostile, &ground}}, &patient));
  WriteFileAtomically(folder + "/hostile_dynamics.html",
                      mmm_converter::testing::HostileDynamicsPage());
  const LabelReport labels = mmm_converter::testing::LabelCase("RKNE");
  WriteFileAtomically(folder + "/label.html", FormatLabelPage(labels));
  WriteFileAtomically(folder + "/label.json", FormatJson(ToJson(labels)));
  WriteFileAtomically(folder + "/hostile_label.html",
                      FormatLabelPage(mmm_converter::testing::LabelCase(text)));
  const Comparison thinned = mmm_converter::testing::ThinnedComparison();
  WriteFileAtomically(folder + "/thinned.html", FormatReport("130 s", {{"130 s", "", &thinned}}));
  const Comparison whole = mmm_converter::testing::LongComparison();
  WriteFileAtomically(folder + "/long.html", FormatReport("60 s", {{"60 s", "", &whole}}));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "use: make_report_cases FOLDER\n";
    return 2;
  }
  try {
    MakeReports(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
