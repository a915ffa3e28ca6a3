// SPDX-License-Identifier: MIT
// Makes a sample set to ship: make_lcd_samples 46 301 plugins/s2kf/samples/lcd_46_301.txt
// Then name it in plugins/s2kf/CMakeLists.txt and ShippedLcdSamples.
#include <fmt/core.h>

#include <exception>

#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "plugins/s2kf/lcd_distance.h"
#include "plugins/s2kf/lcd_samples_text.h"
#include "plugins/s2kf/lcd_sampling.h"

namespace mmm_converter::s2kf {
namespace {

int ParseCount(const char* text) {
  const auto value = ParseLong(text);
  if (!value || *value < 1 || *value > 10000) {
    throw Error(fmt::format("'{}' is not a number from 1 to 10000", text));
  }
  return static_cast<int>(*value);
}

void Make(int dimension, int num_samples, const char* file) {
  const Eigen::MatrixXd half_samples = ComputeLcdHalfSamples(dimension, num_samples);
  WriteFileAtomically(file, FormatLcdSamples(half_samples));
  fmt::print("{}: D = {:.7f}\n", file, LcdDistance(dimension).Evaluate(half_samples, nullptr));
}

}  // namespace
}  // namespace mmm_converter::s2kf

int main(int argc, char** argv) {
  using namespace mmm_converter::s2kf;
  if (argc != 4) {
    fmt::print(stderr, "use: make_lcd_samples DIMENSION SAMPLES FILE\n");
    return 2;
  }
  try {
    Make(ParseCount(argv[1]), ParseCount(argv[2]), argv[3]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
