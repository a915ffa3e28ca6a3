// SPDX-License-Identifier: MIT
//
// Live use: frames come one at a time, and each gives a posture before the next one comes. The
// stream is played from a recording here; in a laboratory it is the motion capture system's.
//
//   live_tracking RECORDING HEIGHT_M

#include <chrono>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "common/convert/marker_mapping.h"
#include "common/convert/plugin_loader.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/recording/recording.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "common/support/data_directory.h"

namespace mmm_converter {
namespace {

int NumSeen(const Eigen::Ref<const Eigen::Matrix3Xd>& frame,
            const std::vector<MarkerAssignment>& assignments) {
  int seen = 0;
  for (const MarkerAssignment& assignment : assignments)
    seen += IsSeen(frame.col(assignment.label));
  return seen;
}

void Run(const std::string& input, double height) {
  // Before the stream starts: labels, model and converter.
  const MarkerSequence stream = ReadRecording(input, {}).markers;
  const KinematicModel model = ScaleWinter(ReadMmmModel(DataFile("models/mmm.xml")),
                                           {.height = height, .mass = 70, .hand_length = {}});
  const LoadedPlugin plugin = LoadPluginByName("S2KFConverter");
  const ConverterConfig config =
      ParseConverterConfig(plugin.factory().config_template(), "default configuration");
  std::string set;
  const MarkerMapping mapping =
      ResolveMarkerMapping(ResolveMarkerPairs(config, stream, model, &set), stream, model);
  const auto converter = plugin.factory().Create(model, mapping.assignments, config);

  // A first frame in which the person is seen, from nothing: this may take a while.
  int k = 0;
  while (k < stream.num_frames() && NumSeen(stream.frame(k), mapping.assignments) < 3) ++k;
  converter->Assemble(stream.frame(k));

  // Then each next one, from the one before. dt is the time since then: frames may be left out.
  double last_time = stream.time(k);
  for (++k; k < stream.num_frames(); ++k) {
    const auto start = std::chrono::steady_clock::now();
    const FrameEstimate& estimate = converter->Track(stream.frame(k), stream.time(k) - last_time);
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - start;
    last_time = stream.time(k);
    if (k % 50 == 0) {
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
