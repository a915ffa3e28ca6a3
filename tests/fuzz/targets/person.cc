// SPDX-License-Identifier: MIT
#include "common/io/mmm/processor_config.h"
#include "common/io/mmm/subject_file.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/stick_model.h"

namespace mmm_converter::testing {

void ReadPersonBytes(std::string_view bytes) {
  const std::string text(bytes);
  if (text.find("<ModelProcessorConfig") != std::string::npos) {
    ParseProcessorConfig(text, kInputName);
    return;
  }
  static const KinematicModel model = StickModel();
  const Subject read = ParseSubject(text, kInputName, model);
  FitToSubject(model, read);
  const std::string written = FormatSubject(read, "fuzz");
  Require(FormatSubject(ParseSubject(written, kInputName, model), "fuzz") == written,
          "the same bytes when it is read and written again");
}

}  // namespace mmm_converter::testing
