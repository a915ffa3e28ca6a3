// SPDX-License-Identifier: MIT
// Makes a long recording of a short one, played back and forth:
//
//   lengthen_recording examples/handstand.c3d 60000 long.c3d
#include <exception>
#include <iostream>
#include <string>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/recording/recording.h"
#include "tests/support/long_recording.h"

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "use: lengthen_recording RECORDING FRAMES OUTPUT.c3d\n";
    return 2;
  }
  try {
    using mmm_converter::Lengthen;
    const mmm_converter::Recording recording = mmm_converter::ReadRecording(argv[1], {});
    mmm_converter::WriteC3d(argv[3], Lengthen(recording.markers, std::stoi(argv[2])),
                            {.comment = recording.comment});
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
