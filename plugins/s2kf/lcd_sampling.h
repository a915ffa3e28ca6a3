// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace mmm_converter::s2kf {

// Point-symmetric samples of the standard normal in n dimensions, all of weight 1/N, N = 2K + 1:
// the origin, the K columns of the returned n x K matrix, and their negatives. Mean 0 by symmetry;
// the covariance (2/N) sum s s^T is I up to rounding.

/// Samples of the S2KF: a minimum of the LcdDistance, then the linear map that makes the covariance
/// I. A set that is neither shipped nor in the cache folder ($XDG_CACHE_HOME or ~/.cache, below it
/// MMMConverterS2KF) takes seconds and is cached for the next time; the result is the same.
/// @throws Error unless 1 <= dimension <= 1000 and num_samples is odd and in
/// [2 dimension + 1, 5001].
Eigen::MatrixXd LcdHalfSamples(int dimension, int num_samples);

/// Seeded normals with the same linear map: a stand-in at no cost.
/// @throws Error as LcdHalfSamples.
Eigen::MatrixXd RandomHalfSamples(int dimension, int num_samples, std::uint64_t seed);

/// The points of the UKF, 2n+1 of equal weight, in a seeded random rotation: along the axes of a
/// Cholesky root they lose the track. @throws Error unless 1 <= dimension <= 1000.
Eigen::MatrixXd RotatedUkfHalfSamples(int dimension, std::uint64_t seed);

/// What LcdHalfSamples computes, before the covariance map, in multiples of 1e-6: the content of
/// shipped and cached files. Deterministic. @throws Error as LcdHalfSamples.
Eigen::MatrixXd ComputeLcdHalfSamples(int dimension, int num_samples);

}  // namespace mmm_converter::s2kf
