// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

namespace mmm_converter {

/// The names of KIT's markers, "L" and "R" being "%" where there are sides, in a vocabulary; a
/// marker that it does not have is not worn.
struct Vocabulary {
  const char* name;
  const char* left;
  const char* right;
  std::map<std::string, std::string> labels;
};

const std::vector<Vocabulary>& Vocabularies();

}  // namespace mmm_converter
