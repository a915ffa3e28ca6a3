// SPDX-License-Identifier: MIT
//
// Live use: each frame of a motion capture system gives a posture before the next one comes.
//
//   live_tracking SOURCE HEIGHT_M        SOURCE: qtm://HOST, natnet://HOST, replay:FILE[@SPEED]

#include <iostream>
#include <memory>
#include <string>

#include "common/convert/plugin_loader.h"
#include "common/io/mmm/mmm_model.h"
#include "common/live/live_tracker.h"
#include "common/live/source_address.h"
#include "common/support/data_directory.h"

namespace mmm_converter {
namespace {

// The labels of a stream are known before its first frame; they are all that a setup needs.
std::unique_ptr<LiveTracker> MakeTracker(const StreamLayout& layout, const LoadedPlugin& plugin,
                                         double height) {
  const ConverterConfig config =
      ParseConverterConfig(plugin.factory().config_template(), "default configuration");
  const auto model =
      std::make_shared<const KinematicModel>(ReadMmmModel(DataFile("models/mmm.xml")));
  const TrackingSetup setup =
      MakeTrackingSetup({.names = layout.labels, .source = layout.source}, model, config,
                        {.size = WinterScaling{height, 70, {}}});
  std::cout << setup.assignments().size() << " of " << layout.labels.size()
            << " labels are tracked\n";
  return std::make_unique<LiveTracker>(plugin.factory().Create(setup, config), layout.rate);
}

void Run(const std::string& address, double height) {
  const LoadedPlugin plugin = LoadPluginByName("S2KFConverter");
  const std::unique_ptr<FrameSource> source = OpenSource(address);
  std::unique_ptr<LiveTracker> tracker;
  StreamFrame frame;
  while (true) {
    const StreamEvent event = source->Next(std::chrono::milliseconds(100), &frame);
    if (event == StreamEvent::kEnd) return;
    if (event == StreamEvent::kLost) std::cerr << source->message() << '\n';
    if (event == StreamEvent::kLayout) tracker = MakeTracker(source->layout(), plugin, height);
    if (event != StreamEvent::kFrame) continue;
    // Null until somebody is seen, and again when they have been away for two seconds.
    const FrameEstimate* estimate = tracker->Track(frame);
    if (estimate == nullptr || frame.number % 50 != 0) continue;
    std::cout << "frame " << frame.number << ": root at " << estimate->posture.position.transpose()
              << " m, " << estimate->markers_seen << " markers seen\n";
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
