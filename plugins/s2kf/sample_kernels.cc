// SPDX-License-Identifier: MIT
#include "plugins/s2kf/sample_kernels.h"

#include "common/math/lanes.h"

namespace mmm_converter::s2kf::MMM_CONVERTER_VARIANT {
namespace {

using namespace mmm_converter::MMM_CONVERTER_VARIANT;  // NOLINT(google-build-using-namespace)

/// Rows of R0 Exp(w) for each lane, by Rodrigues' formula; w = 0 needs no case of its own.
void RotateByVectors(const double* R0, const Lanes* w, Lanes* rows) {
  // The smallest square keeps the quotients finite; they are 1 and 1/2 there to the last digit.
  constexpr double kSmallestSquare = 1e-300;
  const Lanes& x = w[0];
  const Lanes& y = w[1];
  const Lanes& z = w[2];
  const Lanes square = x * x + y * y + z * z + kSmallestSquare;
  Lanes half_angle;
  for (int i = 0; i < kLanes; ++i) half_angle[i] = 0.5 * __builtin_sqrt(square[i]);
  Lanes sine;
  Lanes cosine;
  SinCos(half_angle, &sine, &cosine);
  const Lanes quotient = sine / half_angle;
  const Lanes a = quotient * cosine;          // sin(w)/w
  const Lanes b = 0.5 * quotient * quotient;  // (1 - cos(w))/w^2
  const Lanes E[9] = {1 - b * (y * y + z * z), b * x * y - a * z,       b * x * z + a * y,
                      b * x * y + a * z,       1 - b * (x * x + z * z), b * y * z - a * x,
                      b * x * z - a * y,       b * y * z + a * x,       1 - b * (x * x + y * y)};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      rows[3 * r + c] = R0[3 * r] * E[c] + R0[3 * r + 1] * E[3 + c] + R0[3 * r + 2] * E[6 + c];
    }
  }
}

/// Rows of Rz(yaw) Ry(pitch) Rx(roll) for each lane.
void RotateByRpy(const Lanes* rpy, Lanes* rows) {
  Lanes sr;
  Lanes cr;
  Lanes sp;
  Lanes cp;
  Lanes sy;
  Lanes cy;
  SinCos(rpy[0], &sr, &cr);
  SinCos(rpy[1], &sp, &cp);
  SinCos(rpy[2], &sy, &cy);
  rows[0] = cy * cp;
  rows[1] = cy * sp * sr - sy * cr;
  rows[2] = cy * sp * cr + sy * sr;
  rows[3] = sy * cp;
  rows[4] = sy * sp * sr + cy * cr;
  rows[5] = sy * sp * cr - cy * sr;
  rows[6] = -sp;
  rows[7] = cp * sr;
  rows[8] = cp * cr;
}

void PlaceRoots(const RootPlacement& placement) {
  const std::ptrdiff_t rows = placement.rows;
  for (std::ptrdiff_t row = 0; row < rows; row += kLanes) {
    for (int half = 0; half < 2; ++half) {
      const std::ptrdiff_t target = half * rows + row;
      Lanes x[6];
      for (int i = 0; i < 6; ++i) {
        const Lanes offset = LoadLanes(placement.offsets + i * rows + row);
        x[i] = half == 0 ? placement.base[i] + offset : placement.base[i] - offset;
      }
      for (int i = 0; i < 3; ++i) StoreLanes(x[i], placement.position + i * 2 * rows + target);
      Lanes R[9];
      if (placement.is_rpy) {
        RotateByRpy(x + 3, R);
      } else {
        RotateByVectors(placement.R0, x + 3, R);
      }
      for (int i = 0; i < 9; ++i) StoreLanes(R[i], placement.rotation + i * 2 * rows + target);
    }
  }
}

void PlaceAngles(double middle, double a, double b, const double* offsets, double* plus,
                 double* minus, int rows) {
  for (int row = 0; row < rows; row += kLanes) {
    Lanes sine;
    Lanes cosine;
    SinCos(LoadLanes(offsets + row), &sine, &cosine);
    const Lanes even = middle + a * cosine;
    const Lanes odd = b * sine;
    StoreLanes(even + odd, plus + row);
    StoreLanes(even - odd, minus + row);
  }
}

PairSums Fold(double z0, double* plus, double* minus, int rows) {
  Lanes sum = {};
  Lanes squares = {};
  for (int row = 0; row < rows; row += kLanes) {
    const Lanes p = LoadLanes(plus + row);
    const Lanes q = LoadLanes(minus + row);
    const Lanes o = 0.5 * (p - q);
    const Lanes e = 0.5 * (p + q) - z0;
    StoreLanes(o, plus + row);
    StoreLanes(e, minus + row);
    sum += e;
    squares += o * o + e * e;
  }
  PairSums sums = {0, 0};
  for (int lane = 0; lane < kLanes; ++lane) {
    sums.even += sum[lane];
    sums.squares += squares[lane];
  }
  return sums;
}

}  // namespace

const SampleKernels& GetSampleKernels() {
  static constexpr SampleKernels kKernels = {PlaceRoots, PlaceAngles, Fold};
  return kKernels;
}

}  // namespace mmm_converter::s2kf::MMM_CONVERTER_VARIANT
