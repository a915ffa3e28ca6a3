// SPDX-License-Identifier: MIT
#include "common/support/text_pieces.h"

namespace mmm_converter {

std::string Join(const TextPieces& pieces) {
  std::string text;
  pieces([&](std::string_view piece) { text += piece; });
  return text;
}

PieceWriter::PieceWriter(const TextSink& sink) : sink_(sink) { text_.reserve(2 * kPieceBytes); }

void PieceWriter::Flush() {
  sink_(text_);
  text_.clear();
}

}  // namespace mmm_converter
