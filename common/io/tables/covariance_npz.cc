// SPDX-License-Identifier: MIT
#include "common/io/tables/covariance_npz.h"

#include <memory>
#include <string>

#include "common/io/tables/npz_writer.h"

namespace mmm_converter {

TextPieces FormatCovarianceNpz(const PoseTrajectory& trajectory,
                               const std::vector<PoseCovariance>& covariances) {
  std::vector<std::string> names = {"root_x",       "root_y",       "root_z",
                                    "root_about_x", "root_about_y", "root_about_z"};
  names.insert(names.end(), trajectory.joint_names.begin(), trajectory.joint_names.end());
  const auto k = static_cast<std::int64_t>(covariances.size());
  const auto n = static_cast<std::int64_t>(names.size());
  NpyArray frames = {"frame", {k}, {}, {}};
  NpyArray times = {"time", {k}, {}, {}};
  NpyArray values = {"covariance", {k, n, n}, {}, {}};
  values.numbers.reserve(k * n * n);
  for (const PoseCovariance& one : covariances) {
    frames.numbers.push_back(one.frame);
    times.numbers.push_back(trajectory.time(one.frame));
    const double* const numbers = one.covariance.data();
    values.numbers.insert(values.numbers.end(), numbers, numbers + one.covariance.size());
  }
  const auto arrays = std::make_shared<const std::vector<NpyArray>>(
      std::vector<NpyArray>{{"names", {n}, {}, std::move(names)},
                            std::move(frames),
                            std::move(times),
                            std::move(values)});
  const TextPieces file = FormatNpz(*arrays);
  return [arrays, file](const TextSink& sink) { file(sink); };
}

}  // namespace mmm_converter
