// SPDX-License-Identifier: MIT
//
// Live use: frames come one at a time, and each gives a posture before the next one comes. The
// stream is played from a recording here; in a laboratory it is the motion capture system's.
//
//   live_tracking RECORDING HEIGHT_M

#include <chrono>
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "common/convert/plugin_loader.h"
#include "common/convert/tracking_setup.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/recording/recording.h"
#include "common/support/data_directory.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

// A motion capture system as a program sees it: its labels are known before the first frame, of its
// frames only the present one.
class Stream {
 public:
  explicit Stream(const std::string& recording) : played_(ReadRecording(recording, {}).markers) {}

  const std::vector<std::string>& labels() const { return played_.labels(); }
  // The next frame; false where the stream has ended.
  bool Next() { return ++present_ < played_.num_frames(); }
  auto frame() const { return played_.frame(present_); }  // 3 x labels [m]; NaN: not seen
  double time() const { return played_.time(present_); }  // [s]

 private:
  const MarkerSequence played_;
  int present_ = -1;
};

// What is tracked, from labels alone.
TrackingSetup MakeSetup(const Stream& stream, const ConverterConfig& config, double height) {
  const auto reference =
      std::make_shared<const KinematicModel>(ReadMmmModel(DataFile("models/mmm.xml")));
  return MakeTrackingSetup({.names = stream.labels(), .source = "the stream"}, reference, config,
                           {.size = WinterScaling{height, 70, {}}});
}

// Waits for a first frame in which the person is seen.
void WaitForPerson(const TrackingSetup& setup, Stream* stream) {
  constexpr int kFewestMarkers = 3;
  while (stream->Next()) {
    int seen = 0;
    for (const int label : LabelIndices(setup.assignments())) {
      seen += IsSeen(stream->frame().col(label)) ? 1 : 0;
    }
    if (seen >= kFewestMarkers) return;
  }
  throw Error("the stream has ended before a frame has shown three mapped markers");
}

void Run(const std::string& recording, double height) {
  Stream stream(recording);
  const LoadedPlugin plugin = LoadPluginByName("S2KFConverter");
  const ConverterConfig config =
      ParseConverterConfig(plugin.factory().config_template(), "default configuration");
  const TrackingSetup setup = MakeSetup(stream, config, height);
  const auto converter = plugin.factory().Create(setup, config);
  std::cout << setup.assignments().size() << " of " << stream.labels().size()
            << " labels are tracked\n";

  // The first posture is found from nothing, which may take a while.
  WaitForPerson(setup, &stream);
  converter->Assemble(stream.frame());

  // Each next one comes from the one before. dt is the time since then: frames may be left out.
  double last_time = stream.time();
  for (int tracked = 1; stream.Next(); ++tracked) {
    const auto start = std::chrono::steady_clock::now();
    const FrameEstimate& estimate = converter->Track(stream.frame(), stream.time() - last_time);
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - start;
    last_time = stream.time();
    if (tracked % 50 == 0) {
      std::cout << last_time << " s: root at " << estimate.posture.position.transpose() << " m, "
                << estimate.markers_seen << " markers seen, " << elapsed.count() << " ms\n";
    }
  }
}

}  // namespace
}  // namespace mmm_converter

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: live_tracking RECORDING HEIGHT_M\n";
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
