// SPDX-License-Identifier: MIT
#include "common/convert/motion_converter.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "common/convert/checked_converter.h"
#include "common/convert/tracking_start.h"
#include "common/model/posture.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

// Where tracking begins.
struct FirstFrames {
  int seen = -1;       // shows three markers
  int assembled = -1;  // TrackingStart; where there is none, that which shows most
};

FirstFrames FindFirstFrames(const MarkerSequence& recording, const TrackingSetup& setup) {
  TrackingStart start(setup);
  FirstFrames first;
  int most = 0;
  for (int k = 0; k < recording.num_frames(); ++k) {
    const int seen = CountSeen(recording.frame(k), setup);
    if (first.seen < 0 && seen >= kFewestMarkers) first.seen = k;
    const bool is_there = start.IsAt(k / recording.rate(), seen);
    if (is_there || seen > most) first.assembled = k;
    if (is_there) break;
    most = std::max(most, seen);
  }
  if (first.seen >= 0) return first;
  throw Error(
      fmt::format("no frame shows {} mapped markers (at most {} of {} are seen); check the "
                  "marker mapping",
                  kFewestMarkers, most, setup.assignments().size()));
}

}  // namespace

MotionConverter::MotionConverter(TrackingSetup setup) : setup_(std::move(setup)) {}
MotionConverter::~MotionConverter() = default;
void MotionConverter::Prepare(double /*dt*/) {}
bool MotionConverter::KeepCovariances() { return false; }
MotionConverterFactory::~MotionConverterFactory() = default;

ConversionResult MotionConverter::Convert(const MarkerSequence& recording,
                                          const std::function<bool(int)>& progress) {
  using Clock = std::chrono::steady_clock;
  const FirstFrames first = FindFirstFrames(recording, setup_);
  const int frames = recording.num_frames();
  const double dt = 1 / recording.rate();
  ConversionResult result;
  Eigen::MatrixXi verdicts;
  ResultWriter writer(recording, setup_, &verdicts, &result);
  writer.Clear();
  const auto write = [&](int k, const FrameEstimate& estimate, double seconds) {
    CheckEstimate(estimate, setup_);
    writer.Write(k, estimate, seconds);
  };
  const auto show = [&](int done) {
    if (progress && !progress(done)) {
      throw Error(fmt::format("cancelled after {} of {} frames", done, frames));
    }
  };
  for (int k = first.assembled; k < frames; ++k) {
    const Clock::time_point start = Clock::now();
    const FrameEstimate& estimate =
        k == first.assembled ? Assemble(recording.frame(k)) : Track(recording.frame(k), dt);
    write(k, estimate, std::chrono::duration<double>(Clock::now() - start).count());
    show(k + 1);
  }
  writer.WriteEarlier(TrackBackward(recording, first.assembled, first.seen, this,
                                    [&](int k, const FrameEstimate& estimate, double seconds) {
                                      write(k, estimate, seconds);
                                      show(0);
                                    }));
  writer.FindIncidents();
  return result;
}

}  // namespace mmm_converter
