// SPDX-License-Identifier: MIT
//
// A program outside the project: converts a piece of a recording with the installed library, and
// shows that an Error crosses the border of the library as what it is.
//
//   consumer RECORDING MOTION

#include <iostream>

#include "common/mmm_converter.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  mmm::Conversion result = mmm::Convert(argv[1], {{"height", 1.8}, {"frames", ":40"}});
  result.Save(argv[2]);
  std::cout << result.markers().size() << " markers, " << result.motion().num_frames()
            << " frames\n";
  try {
    mmm::Read("/no/such/recording.c3d");
  } catch (const mmm::Error& error) {
    std::cout << "as expected: " << error.what() << '\n';
    return 0;
  }
  std::cerr << "no Error for a recording that does not exist\n";
  return 1;
}
