// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/io/c3d/c3d_layout.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// An open C3D file: its header, its parameters, and where its data are. It may hold no point and
/// no frame.
class C3dFile {
 public:
  /// @throws Error (not a C3D file, cut in header or parameters).
  explicit C3dFile(const std::string& path, Warnings* warnings = nullptr);

  const std::string& path() const { return path_; }
  std::span<const unsigned char, 512> header_bytes() const { return header_bytes_; }
  const C3dHeader& header() const { return header_; }
  const C3dParameters& parameters() const { return parameters_; }
  const C3dLayout& layout() const { return layout_; }
  std::uint64_t data_bytes() const { return data_bytes_; }  ///< from layout().data_start on
  std::uint64_t leading_zeros() const { return base_; }     ///< bytes before the header
  std::uint64_t section_start() const { return (header_bytes_[0] - 1) * kBlock; }

  /// Bytes that must be there, counted from the header on. @throws Error as ReadFrames.
  std::vector<unsigned char> ReadBytes(std::uint64_t begin, std::uint64_t count);

  /// The stored bytes of whole frames, which must be there.
  /// @throws Error where the file has become shorter meanwhile.
  void ReadFrames(int first, int count, std::vector<unsigned char>* bytes);

  /// The same of all frames, as many at a time as a buffer holds.
  using TakeFrames = std::function<void(int first, int count, const unsigned char* stored)>;
  void ReadAllFrames(const TakeFrames& take);

 private:
  std::string path_;
  std::ifstream stream_;
  std::uint64_t base_ = 0;  // zero bytes before the file proper
  std::array<unsigned char, 512> header_bytes_ = {};
  std::vector<unsigned char> section_;  // parameters_ point into it
  C3dHeader header_;
  C3dParameters parameters_;
  C3dLayout layout_;
  std::uint64_t data_bytes_ = 0;
};

/// One name for each point, no two equal: as POINT:LABELS lists it, `*` and its number where the
/// list says nothing.
std::vector<std::string> C3dPointNames(const C3dFile& file, Warnings* warnings);

/// Names of points that the file lists as angles, forces, powers, ... rather than markers.
std::vector<std::string> C3dOutputNames(const C3dFile& file);

}  // namespace mmm_converter
