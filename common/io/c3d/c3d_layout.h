// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/io/c3d/c3d_numbers.h"
#include "common/io/c3d/c3d_parameters.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// The words of a C3D header that say where and how points are stored.
struct C3dHeader {
  int points = 0;
  int analog_words = 0;  ///< analog samples of a frame, all channels
  int first_frame = 0;
  int last_frame = 0;
  float scale = 0;
  int data_block = 0;
  int analog_samples = 0;  ///< of each channel in a frame
  float rate = 0;          ///< [Hz]
};

/// header: the first 512 bytes.
C3dHeader ReadC3dHeader(std::span<const unsigned char> header, C3dProcessor processor);

/// Where and how points are stored, contradictions between header, parameters and file size
/// resolved.
struct C3dLayout {
  C3dProcessor processor = C3dProcessor::kIntel;
  bool floats = true;  ///< else 16 bit integers
  double scale = 1;    ///< > 0; of integer coordinates and of residuals
  int points = 0;
  int analog_words = 0;      ///< analog samples of a frame, all channels
  int frames = 0;            ///< whole frames that the file holds
  long declared_frames = 0;  ///< that it says it holds
  long first_frame = 1;      ///< in the capture
  double rate = 0;           ///< [Hz]; 0: the file does not say

  /// Of the first frame [s]: a capture begins with frame 1 at 0 s.
  double first_time(double at_rate) const {
    return first_frame > 1 ? static_cast<double>(first_frame - 1) / at_rate : 0;
  }
  std::uint64_t data_start = 0;   ///< byte of the first frame
  std::uint64_t frame_bytes = 0;  ///< points and analog samples
};

/// Byte where the data start, by the header alone; 0 where the header can't be right.
std::uint64_t C3dDataStartOfHeader(const C3dHeader& header, std::uint64_t section_start,
                                   int section_blocks, std::uint64_t file_size);

/// section_start, file_size: bytes. Leaves frames or points 0 where none can be made out.
C3dLayout ResolveC3dLayout(const C3dHeader& header, const C3dParameters& parameters,
                           C3dProcessor processor, std::uint64_t section_start, int section_blocks,
                           std::uint64_t file_size, Warnings* warnings);

}  // namespace mmm_converter
