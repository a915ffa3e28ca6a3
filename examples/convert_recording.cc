// SPDX-License-Identifier: MIT
//
// A recording converted whole: what `MMMConverterS2KF convert` does, in the library's own words.
//
//   convert_recording RECORDING HEIGHT_M OUTPUT.xml

#include <exception>
#include <iostream>
#include <string>

#include "common/pipeline/conversion.h"

namespace mmm_converter {
namespace {

void Run(const std::string& input, double height, const std::string& output) {
  // What is not asked for has a default: the MMM model, the marker set that knows most labels,
  // S2KF.
  ConversionRequest request;
  request.input.file = input;
  request.input.person.size.height = height;
  request.output = output;

  // Reads, plans, tracks and judges; nothing is written before all of it is well.
  ConversionReport report = RunConversion(request, {}, {});
  WriteConversion(request, &report);

  std::cout << "marker set " << report.plan.setup.marker_set << ", "
            << report.plan.setup.assignments().size() << " markers, "
            << report.result.trajectory.num_frames() << " frames; mean marker distance "
            << 1e3 * report.figures.distance.mean << " mm; " << DescribeVerdict(report.verdict)
            << '\n';
}

}  // namespace
}  // namespace mmm_converter

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: convert_recording RECORDING HEIGHT_M OUTPUT.xml\n";
    return 2;
  }
  try {
    mmm_converter::Run(argv[1], std::stod(argv[2]), argv[3]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
