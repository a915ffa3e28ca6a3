// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "common/io/tables/npz_writer.h"

namespace mmm_converter {

/// A value that Python's pickle reads back: a number, a text, a NumPy array, a list of texts, or a
/// dict of such values by texts.
struct PickleValue {
  struct Item;
  using Dict = std::vector<Item>;
  std::variant<double, std::int64_t, std::string, NpyArray, std::vector<std::string>, Dict> value;
};

struct PickleValue::Item {
  std::string key;
  PickleValue value;
};

/// A pickle of protocol 3 (Python 3.0 and later) whose arrays are NumPy's own (numpy.ndarray of
/// float64), as pickle.load and joblib.load read them with NumPy 1 and 2. An array's name is not
/// written.
/// @throws Error where an array has 4 GiB or more.
std::string FormatPickle(const PickleValue& value);

}  // namespace mmm_converter
