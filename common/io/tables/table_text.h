// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

namespace mmm_converter {

/// The lines of a text, one after the other, without their ends: "\n", "\r\n" or "\r".
class LineReader {
 public:
  /// A byte order mark is passed over.
  explicit LineReader(std::string_view text);
  bool Next(std::string_view* line);
  int number() const { return number_; }  ///< of the line that was read last, from 1

 private:
  std::string_view rest_;
  int number_ = 0;
};

/// Cells by position, without the blanks and quotation marks around them; a blank cell stays one.
/// Cells that blanks separate (separator ' ') are never blank, but that of a blank line.
void SplitCells(std::string_view line, char separator, std::vector<std::string_view>* cells);

/// Tab, semicolon, comma or blank: the first of these that the line has.
char SeparatorOf(std::string_view line);

/// As SeparatorOf, of a line of numbers, whose commas can be decimal ones.
char SeparatorOfNumbers(std::string_view line);

/// NaN for what is no number. A decimal comma is understood where commas do not separate.
double CellNumber(std::string_view cell, char separator);

/// Whether a cell that is no number says that there is none: blank, "NaN", "null", ...
bool SaysNothing(std::string_view cell);

/// Blanks before the text do not count.
bool StartsWithIgnoringCase(std::string_view text, std::string_view start);

}  // namespace mmm_converter
