// SPDX-License-Identifier: MIT
#include "plugins/s2kf/lcd_sampling.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "common/io/bytes/file_content.h"
#include "common/math/seeded_random.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "plugins/s2kf/lbfgs.h"
#include "plugins/s2kf/lcd_distance.h"
#include "plugins/s2kf/lcd_samples_text.h"

namespace mmm_converter::s2kf {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMaxDimension = 1000;
constexpr int kMaxSamples = 5001;

void CheckDimension(int dimension) {
  if (dimension >= 1 && dimension <= kMaxDimension) return;
  throw Error(fmt::format("samples in {} dimensions: the dimension must be 1 to {}", dimension,
                          kMaxDimension));
}

void CheckSize(int dimension, int num_samples) {
  CheckDimension(dimension);
  const int fewest = 2 * dimension + 1;
  if (num_samples % 2 == 1 && num_samples >= fewest && num_samples <= kMaxSamples) return;
  throw Error(fmt::format(
      "<Filter samples=\"{}\"/>: {} samples are too few or too many for the {} dimensions of this "
      "model, 6 of its root and one of each joint that is tracked; give an odd number from {} to "
      "{}, "
      "or track fewer joints (<Joints>)",
      num_samples, num_samples, dimension, fewest, kMaxSamples));
}

MatrixXd NormalMatrix(int rows, int columns, std::uint64_t seed) {
  SeededRandom random(seed);
  MatrixXd normals(rows, columns);
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < rows; ++i) normals(i, j) = random.Normal();
  }
  return normals;
}

/// Nothing where the covariance is singular.
std::optional<MatrixXd> WithUnitCovariance(MatrixXd half_samples) {
  const double total = 2 * static_cast<double>(half_samples.cols()) + 1;
  for (int pass = 0; pass < 2; ++pass) {  // the second removes the rounding of the first
    const MatrixXd covariance = 2 / total * half_samples * half_samples.transpose();
    const Eigen::LLT<MatrixXd> root(covariance);
    if (root.info() != Eigen::Success) return std::nullopt;
    half_samples = root.matrixL().solve(half_samples).eval();
  }
  if (!half_samples.allFinite()) return std::nullopt;
  return half_samples;
}

/// Empty where there is no cache folder.
std::filesystem::path CacheFile(int dimension, int num_samples) {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  std::filesystem::path folder;
  if (cache != nullptr && *cache == '/') {
    folder = cache;
  } else if (home != nullptr && *home == '/') {
    folder = std::filesystem::path(home) / ".cache";
  } else {
    return {};
  }
  return folder / "MMMConverterS2KF" / fmt::format("lcd_{}_{}.txt", dimension, num_samples);
}

/// Nothing where there is no such file or it is damaged: the set is then computed.
std::optional<MatrixXd> ReadCached(const std::filesystem::path& file, int dimension,
                                   int num_samples) {
  constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
  std::error_code ignored;
  if (file.empty() || !std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
  try {
    // A look at the start: a cache is none of the inputs that no output replaces.
    return ParseLcdSamples(ReadFileStart(file.string(), kMaxBytes), dimension, num_samples);
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// A cache that can't be written only costs time.
void WriteCached(const std::filesystem::path& file, const MatrixXd& half_samples) {
  std::error_code ignored;
  const bool exists = std::filesystem::exists(file, ignored);
  // Writing to a pipe would wait for a reader.
  if (file.empty() || (exists && !std::filesystem::is_regular_file(file, ignored))) return;
  std::filesystem::create_directories(file.parent_path(), ignored);
  try {
    WriteFileAtomically(file.string(), FormatLcdSamples(half_samples));
  } catch (const Error&) {
  }
}

}  // namespace

MatrixXd LcdHalfSamples(int dimension, int num_samples) {
  CheckSize(dimension, num_samples);
  std::optional<MatrixXd> stored =
      ParseLcdSamples(ShippedLcdSamples(dimension, num_samples), dimension, num_samples);
  const std::filesystem::path file = CacheFile(dimension, num_samples);
  if (!stored) stored = ReadCached(file, dimension, num_samples);
  if (stored) {
    if (std::optional<MatrixXd> samples = WithUnitCovariance(*stored)) return *samples;
  }
  const MatrixXd computed = ComputeLcdHalfSamples(dimension, num_samples);
  WriteCached(file, computed);
  return WithUnitCovariance(computed).value();
}

MatrixXd RandomHalfSamples(int dimension, int num_samples, std::uint64_t seed) {
  CheckSize(dimension, num_samples);
  return WithUnitCovariance(NormalMatrix(dimension, num_samples / 2, seed)).value();
}

MatrixXd RotatedUkfHalfSamples(int dimension, std::uint64_t seed) {
  CheckDimension(dimension);
  const Eigen::HouseholderQR<MatrixXd> qr(NormalMatrix(dimension, dimension, seed));
  const MatrixXd rotation = qr.householderQ();
  return std::sqrt(dimension + 0.5) * rotation;
}

MatrixXd ComputeLcdHalfSamples(int dimension, int num_samples) {
  CheckSize(dimension, num_samples);
  constexpr std::uint64_t kSeed = 1;  // other seeds reach the same distance to 1e-6
  const int num_half = num_samples / 2;
  const LcdDistance distance(dimension);
  MatrixXd half_samples;
  MatrixXd slope;
  const auto function = [&](const VectorXd& x, VectorXd& gradient) {
    half_samples = x.reshaped(dimension, num_half);
    const double value = distance.Evaluate(half_samples, &slope);
    gradient = slope.reshaped();
    return value;
  };
  const VectorXd best =
      MinimizeLbfgs(function, NormalMatrix(dimension, num_half, kSeed).reshaped(), {});
  return ((best * 1e6).array().round() / 1e6).matrix().reshaped(dimension, num_half);
}

}  // namespace mmm_converter::s2kf
