// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

// Only for files that mmm_converter_kernels() compiles (cmake/InstructionSets.cmake).
namespace mmm_converter::MMM_CONVERTER_VARIANT {

/// As many doubles as one vector register of the instruction set holds, computed at once.
#if defined(__AVX512F__)
inline constexpr int kLanes = 8;
#elif defined(__AVX__)
inline constexpr int kLanes = 4;
#else
inline constexpr int kLanes = 2;
#endif
using Lanes [[gnu::vector_size(8 * kLanes)]] = double;
using LaneBits [[gnu::vector_size(8 * kLanes)]] = std::uint64_t;

inline Lanes Broadcast(double x) { return x - Lanes{}; }

inline Lanes LoadLanes(const double* source) {
  Lanes x;
  std::memcpy(&x, source, sizeof x);
  return x;
}

inline void StoreLanes(const Lanes& x, double* target) { std::memcpy(target, &x, sizeof x); }

/// sine and cosine of every lane for |x| < 1e4: x = k pi + r, then the Taylor series on |r| <=
/// pi/2, of which the first term left out is below 3e-16.
inline void SinCos(const Lanes& x, Lanes* sine, Lanes* cosine) {
  // Adding 1.5 * 2^52 rounds to an integer, which then stands in the low bits of the mantissa.
  constexpr double kRound = 6755399441055744.0;
  const Lanes shifted = x * 0.318309886183790671538 + kRound;
  const Lanes k = shifted - kRound;
  // pi in two parts, the first with 26 trailing zero bits: k * kPiHigh is exact.
  constexpr double kPiHigh = 0x1.921fb54p+1;
  constexpr double kPiLow = 1.984187159361081e-09;
  const Lanes r = (x - k * kPiHigh) - k * kPiLow;
  const Lanes r2 = r * r;

  Lanes s = Broadcast(-8.22063524662432972e-18);
  s = s * r2 + 2.81145725434552060e-15;
  s = s * r2 - 7.64716373181981641e-13;
  s = s * r2 + 1.60590438368216133e-10;
  s = s * r2 - 2.50521083854417202e-08;
  s = s * r2 + 2.75573192239858883e-06;
  s = s * r2 - 1.98412698412698413e-04;
  s = s * r2 + 8.33333333333333322e-03;
  s = s * r2 - 1.66666666666666657e-01;
  s = r + r * r2 * s;

  Lanes c = Broadcast(4.11031762331216484e-19);
  c = c * r2 - 1.56192069685862253e-16;
  c = c * r2 + 4.77947733238738525e-14;
  c = c * r2 - 1.14707455977297245e-11;
  c = c * r2 + 2.08767569878681002e-09;
  c = c * r2 - 2.75573192239858883e-07;
  c = c * r2 + 2.48015873015873016e-05;
  c = c * r2 - 1.38888888888888894e-03;
  c = c * r2 + 4.16666666666666644e-02;
  c = c * r2 - 0.5;
  c = c * r2 + 1.0;

  // Odd k turns both signs.
  LaneBits bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  const LaneBits sign = bits << 63;
  LaneBits s_bits;
  LaneBits c_bits;
  std::memcpy(&s_bits, &s, sizeof s_bits);
  std::memcpy(&c_bits, &c, sizeof c_bits);
  s_bits ^= sign;
  c_bits ^= sign;
  std::memcpy(sine, &s_bits, sizeof s_bits);
  std::memcpy(cosine, &c_bits, sizeof c_bits);
}

}  // namespace mmm_converter::MMM_CONVERTER_VARIANT
