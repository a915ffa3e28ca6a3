// SPDX-License-Identifier: MIT
//
// A program outside the project: converts a piece of a recording with the installed library, and
// shows that an Error crosses the border of the library as what it is.
//
//   consumer RECORDING MOTION

#include <iostream>

#include "common/pipeline/conversion.h"
#include "common/support/error.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  mmm_converter::ConversionRequest request;
  request.input.file = argv[1];
  request.input.end_frame = 40;
  request.input.person.size.height = 1.8;
  request.output = argv[2];
  mmm_converter::ConversionReport report = mmm_converter::RunConversion(request, {}, {});
  mmm_converter::WriteConversion(request, &report);
  std::cout << report.plan.setup.assignments().size() << " markers, "
            << report.result.trajectory.num_frames() << " frames\n";
  try {
    request.input.file = "/no/such/recording.c3d";
    mmm_converter::RunConversion(request, {}, {});
  } catch (const mmm_converter::Error& error) {
    std::cout << "as expected: " << error.what() << '\n';
    return 0;
  }
  std::cerr << "no Error for a recording that does not exist\n";
  return 1;
}
