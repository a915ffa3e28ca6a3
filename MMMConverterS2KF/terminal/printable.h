// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <streambuf>
#include <string>
#include <string_view>

namespace mmm_converter {

/// Control characters other than line ends and tabs as \x1B and the like: what a file holds must
/// not move the cursor or rename the window of a terminal.
std::string Printable(std::string_view text);

/// While it lives, all that std::cout is given leaves as Printable, line by line.
class PrintableOutput {
 public:
  PrintableOutput();
  ~PrintableOutput();
  PrintableOutput(const PrintableOutput&) = delete;
  PrintableOutput& operator=(const PrintableOutput&) = delete;

 private:
  std::streambuf* old_;
  std::unique_ptr<std::streambuf> buffer_;
};

}  // namespace mmm_converter
