// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/forces/plate_checks.h"
#include "common/forces/plate_forces.h"
#include "common/io/c3d/c3d_file.h"
#include "common/io/recording/recording_axes.h"
#include "common/support/parallel.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr double kLoadedBaseline = 15;  // [N] above the unloaded level: somebody is on the plate

/// A row for each channel of the plate.
Eigen::MatrixXd ChannelsOf(const ForcePlate& plate, const Eigen::MatrixXd& samples) {
  Eigen::MatrixXd channels(static_cast<Eigen::Index>(plate.channels.size()), samples.cols());
  for (std::size_t i = 0; i < plate.channels.size(); ++i) {
    channels.row(static_cast<Eigen::Index>(i)) = samples.row(plate.channels[i]);
  }
  return channels;
}

/// Subtracts the mean of the frames in which the file says that nobody is on the plate.
void SubtractBaseline(const ForcePlate& plate, const C3dZeroFrames& zero, int samples_per_frame,
                      Eigen::MatrixXd* channels, Warnings* warnings) {
  const Eigen::Index begin = Eigen::Index{zero.first - 1} * samples_per_frame;
  const Eigen::Index end = std::min(Eigen::Index{zero.last} * samples_per_frame, channels->cols());
  if (begin >= end) return;
  const Eigen::VectorXd vertical = VerticalForce(ForcesOfPlate(plate, *channels));
  const auto level = UnloadedLevel(vertical);
  const double there = vertical.segment(begin, end - begin).mean();
  if (level && std::abs(there - *level) > kLoadedBaseline) {
    Warn(warnings, fmt::format("force plate {}: FORCE_PLATFORM:ZERO says that nobody is on it in "
                               "frames {} to {}, but {:.0f} N are; no baseline is subtracted",
                               plate.number, zero.first, zero.last, there - *level));
    return;
  }
  const Eigen::VectorXd baseline = channels->middleCols(begin, end - begin).rowwise().mean();
  if (baseline.allFinite()) channels->colwise() -= baseline;
}

PlateForces ReadPlate(ForcePlate plate, const Eigen::MatrixXd& samples, const RecordedForces& all,
                      const std::optional<C3dZeroFrames>& zero, Warnings* warnings) {
  Eigen::MatrixXd channels = ChannelsOf(plate, samples);
  const std::vector<int> still = StillShears(plate, channels);
  LeaveOutStopped(all.rate, all.first_time, plate, &channels, warnings);
  if (zero) SubtractBaseline(plate, *zero, all.samples_per_frame, &channels, warnings);
  SubtractUnloaded(all.rate, plate, &channels, warnings);
  CorrectUnits(channels, &plate, warnings);
  CorrectOrigin(channels, &plate, warnings);
  PlateForces forces = ForcesOfPlate(plate, channels);
  JudgeLoads(all.rate, &forces, warnings);
  LeaveOutSaturated(channels, &forces, warnings);
  LeaveOutStill(still, &forces, warnings);
  forces.channels = std::move(channels);
  FindClipped(all.rate, all.first_time, &forces, warnings);
  return forces;
}

/// Says so where force channels are there and no plates are described.
void WarnOfUndescribed(const C3dAnalog& analog, Warnings* warnings) {
  std::vector<std::string> found;
  for (const C3dAnalogChannel& channel : analog.channels) {
    std::string letters;
    for (const char c : ToLower(channel.label)) {
      if (c >= 'a' && c <= 'z') letters += c;
    }
    const auto is_force = [&](const char* name) {
      return letters == name || letters == std::string("force") + name;
    };
    if (is_force("fx") || is_force("fy") || is_force("fz")) found.push_back(channel.label);
  }
  if (found.size() < 3) return;
  Warn(warnings,
       fmt::format("the file has force channels ({}, {}, {}{}), but does not describe the "
                   "plates (no FORCE_PLATFORM group that names corners): no forces are "
                   "read",
                   found[0], found[1], found[2], found.size() > 3 ? " ..." : ""));
}

}  // namespace

RecordedForces ReadForces(const std::string& path, Warnings* warnings, std::optional<double> unit) {
  C3dFile file(path, nullptr);  // what there is to say of its points, their reader says
  const WarningContext context(warnings, path);
  RecordedForces forces;
  const C3dAnalog analog = ReadC3dAnalog(file, nullptr);
  if (!unit) {
    unit = DecideUnit(MarkerSequence(), file.parameters().Text("POINT", "UNITS")).metres;
  }
  std::vector<ForcePlate> plates = ReadForcePlates(file, analog, *unit, warnings);
  forces.rate = analog.rate;
  forces.samples_per_frame = std::max(analog.samples_per_frame, 1);
  forces.first_time =
      IsFrameRate(file.layout().rate) ? file.layout().first_time(file.layout().rate) : 0;
  if (plates.empty()) {
    if (ReadC3dForcePlates(file.parameters(), nullptr).empty()) WarnOfUndescribed(analog, warnings);
    return forces;
  }
  const Eigen::MatrixXd samples = ReadC3dAnalogSamples(&file, analog);
  const auto zero = ReadC3dZeroFrames(file.parameters());
  forces.plates.resize(plates.size());
  std::vector<Warnings> of_plates(plates.size());
  ParallelFor(static_cast<int>(plates.size()), 0, [&](int i) {
    const WarningContext of_file(&of_plates[i], path);
    forces.plates[i] = ReadPlate(std::move(plates[i]), samples, forces, zero, &of_plates[i]);
  });
  for (const Warnings& one : of_plates) {
    if (warnings != nullptr) warnings->Append(one);
  }
  forces.first_time = 0;
  return forces;
}

}  // namespace mmm_converter
