// SPDX-License-Identifier: MIT
#include "common/label/track/labelling.h"

namespace mmm_converter {

std::vector<std::string> NamesNotFound(const Labelling& labelling) {
  std::vector<char> is_found(labelling.names.size(), 0);
  for (const NamedPiece& piece : labelling.pieces) {
    if (piece.name >= 0) is_found[piece.name] = 1;
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < is_found.size(); ++i) {
    if (is_found[i] == 0) names.push_back(labelling.names[i]);
  }
  return names;
}

}  // namespace mmm_converter
