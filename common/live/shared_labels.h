// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/io/recording/marker_labels.h"

namespace mmm_converter {

/// An object by the names that its labels may have.
struct LabelledObject {
  std::string name;
  std::vector<std::string> labels;
};

/// Of each object its labels, in their order. @throws Error where an object has none or labels of
/// several subjects, or two have the same.
std::vector<LabelSelection> ShareLabels(const std::vector<std::string>& labels,
                                        const std::vector<LabelledObject>& objects,
                                        const std::string& source);

}  // namespace mmm_converter
