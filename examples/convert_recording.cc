// SPDX-License-Identifier: MIT
//
// A recording converted whole: what `MMMConverterS2KF convert` does, in the library's own words.
//
//   convert_recording RECORDING HEIGHT_M OUTPUT.xml

#include <iostream>
#include <string>

#include "common/mmm_converter.h"

int main(int argc, char** argv) try {
  if (argc != 4) {
    std::cerr << "usage: convert_recording RECORDING HEIGHT_M OUTPUT.xml\n";
    return 2;
  }
  // What is not asked for has a default: the MMM model, the marker set that knows most labels,
  // S2KF.
  mmm::Conversion result = mmm::Convert(argv[1], {{"height", std::stod(argv[2])}});
  result.Save(argv[3]);
  std::cout << "marker set " << result.marker_set() << ", " << result.markers().size()
            << " markers, " << result.motion().num_frames() << " frames; mean marker distance "
            << 1e3 * result.mean_distance() << " mm; " << DescribeVerdict(result.verdict()) << '\n';
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
