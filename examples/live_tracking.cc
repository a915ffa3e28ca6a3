// SPDX-License-Identifier: MIT
//
// Live use: each frame of a motion capture system gives a posture before the next one comes.
//
//   live_tracking SOURCE HEIGHT_M        SOURCE: qtm://HOST, natnet://HOST, replay:FILE[@SPEED]

#include <iostream>
#include <optional>
#include <string>

#include "common/live/source_address.h"
#include "common/mmm_converter.h"

namespace mmm_converter {
namespace {

// The labels of a stream are known before its first frame; they are all that a tracker needs.
mmm::Tracker MakeTracker(const StreamLayout& layout, double height) {
  mmm::Tracker tracker(layout.labels, layout.rate, {{"height", height}});
  std::cout << tracker.markers().size() << " of " << layout.labels.size()
            << " labels are tracked\n";
  return tracker;
}

void Run(const std::string& address, double height) {
  const std::unique_ptr<FrameSource> source = OpenSource(address);
  std::optional<mmm::Tracker> tracker;
  StreamFrame frame;
  while (true) {
    const StreamEvent event = source->Next(std::chrono::milliseconds(100), &frame);
    if (event == StreamEvent::kEnd) return;
    if (event == StreamEvent::kLost) std::cerr << source->message() << '\n';
    if (event == StreamEvent::kLayout) tracker = MakeTracker(source->layout(), height);
    if (event != StreamEvent::kFrame) continue;
    // Null until somebody is seen, and again when they have been away for two seconds.
    const mmm::TrackedFrame* tracked = tracker->Track(frame.points, frame.time);
    if (tracked == nullptr || frame.number % 50 != 0) continue;
    std::cout << "frame " << frame.number << ": root at " << tracked->posture.position.transpose()
              << " m, " << tracked->markers_seen << " markers seen\n";
  }
}

}  // namespace
}  // namespace mmm_converter

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: live_tracking SOURCE HEIGHT_M\n";
    return 2;
  }
  try {
    mmm_converter::Run(argv[1], std::stod(argv[2]));
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
