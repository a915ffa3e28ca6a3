// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace mmm_converter {

/// Takes the next piece of a text.
using TextSink = std::function<void(std::string_view)>;

/// A text that is made piece by piece, so that it is never in memory as a whole: gives one piece
/// after the other to a sink.
using TextPieces = std::function<void(const TextSink&)>;

/// The whole text.
std::string Join(const TextPieces& pieces);

/// Makes large pieces of what is appended bit by bit.
class PieceWriter {
 public:
  explicit PieceWriter(const TextSink& sink);  ///< must outlive this

  /// What is not yet with the sink; append to it.
  std::string* text() { return &text_; }
  /// Gives the text to the sink if it has become large; for after every few hundred bytes.
  void EndPart() {
    if (text_.size() >= kPieceBytes) Flush();
  }
  void Flush();  ///< last of all

 private:
  static constexpr std::size_t kPieceBytes = 1 << 18;

  const TextSink& sink_;
  std::string text_;
};

}  // namespace mmm_converter
