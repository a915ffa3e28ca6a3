// SPDX-License-Identifier: MIT
#include "common/support/error.h"
#include "plugins/s2kf/lcd_samples_text.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

void ReadLcdSamplesBytes(std::string_view bytes) {
  const auto read = s2kf::ParseLcdSamples(bytes, 2, 7);
  // What is not a set of samples is computed anew.
  if (!read) throw Error(std::string(kInputName) + ": is no set of 7 samples");
  const std::string written = s2kf::FormatLcdSamples(*read);
  const auto again = s2kf::ParseLcdSamples(written, 2, 7);
  Require(again.has_value() && s2kf::FormatLcdSamples(*again) == written,
          "the same set when it is written and read again");
}

}  // namespace mmm_converter::testing
