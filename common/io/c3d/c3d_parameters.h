// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/io/c3d/c3d_numbers.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A parameter of a C3D file. Its data are a part of the bytes that it was parsed from.
struct C3dParameter {
  std::string group;  ///< upper case, trimmed; empty: the file does not define the group
  std::string name;   ///< upper case, trimmed
  int type = 0;       ///< -1 text, 1 byte, 2 word, 4 float
  std::uint32_t begin = 0, end = 0;  ///< bytes of its record in the section
  std::vector<int> dimensions;
  std::span<const unsigned char> data;  ///< at most what dimensions ask for
  C3dProcessor processor = C3dProcessor::kIntel;

  std::size_t size() const;                                ///< numbers that are there
  std::optional<double> Number(std::size_t index) const;   ///< words unsigned
  std::size_t num_texts() const;                           ///< 0 for a parameter of numbers
  std::vector<std::string> Texts(std::size_t most) const;  ///< trimmed, the first ones
  std::string Text() const;                                ///< the first text, or empty
};

/// The parameters of a C3D file, as far as they can be made out.
class C3dParameters {
 public:
  C3dParameters() = default;  ///< none
  /// section: from the first byte of the parameter section to where it ends at the latest (data or
  /// end of file). Never reads beyond; whatever is broken is left out and named in warnings.
  C3dParameters(std::span<const unsigned char> section, C3dProcessor processor, Warnings* warnings);

  const std::vector<C3dParameter>& all() const { return parameters_; }  ///< in the file's order
  const std::vector<std::string>& groups() const { return groups_; }    ///< in the file's order

  /// Names in upper case. nullptr: there is none. The first of equal ones.
  const C3dParameter* Find(std::string_view group, std::string_view name) const;
  std::optional<double> Number(std::string_view group, std::string_view name) const;
  std::string Text(std::string_view group, std::string_view name) const;
  /// Texts of NAME, NAME2, NAME3, ... as one list, the first ones; a text takes far more memory
  /// than its bytes. there: how many the file has; may be null.
  std::vector<std::string> TextList(std::string_view group, const std::string& name,
                                    std::size_t most, std::size_t* there = nullptr) const;

  std::size_t end() const { return end_; }  ///< byte of the section behind the last record

 private:
  std::vector<C3dParameter> parameters_;
  std::vector<std::string> groups_;
  std::map<std::pair<std::string, std::string>, std::size_t> places_;  // by group and name
  std::size_t end_ = 0;
};

}  // namespace mmm_converter
