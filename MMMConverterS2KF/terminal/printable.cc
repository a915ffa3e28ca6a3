// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/terminal/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "common/support/text.h"

namespace mmm_converter {
namespace {

// U+0080 to U+009F, where a terminal knows some, are C2 80 to 9F.
constexpr char kLeadOfC1 = '\xC2';

class PrintableBuffer final : public std::streambuf {
 public:
  explicit PrintableBuffer(std::streambuf* target) : target_(target) {}

 protected:
  int_type overflow(int_type c) override {
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    const char one = traits_type::to_char_type(c);
    return xsputn(&one, 1) == 1 ? c : traits_type::eof();
  }

  std::streamsize xsputn(const char* text, std::streamsize size) override {
    text_.append(text, static_cast<std::size_t>(size));
    return Pass(text_.rfind('\n') + 1) ? size : 0;
  }

  int sync() override { return Pass(text_.size()) ? target_->pubsync() : -1; }

 private:
  bool Pass(std::size_t count) {
    if (count == 0) return true;
    const std::string out = Printable(std::string_view(text_).substr(0, count));
    text_.erase(0, count);
    const auto size = static_cast<std::streamsize>(out.size());
    return target_->sputn(out.data(), size) == size;
  }

  std::streambuf* target_;
  std::string text_;
};

}  // namespace

std::string Printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = Utf8Length(text);
    const auto first = static_cast<unsigned char>(text.front());
    const auto last = static_cast<unsigned char>(text[std::max<std::size_t>(length, 1) - 1]);
    const bool is_c0 = first < 0x20 && first != '\n' && first != '\t';
    const bool is_c1 = length <= 2 && (length == 0 || text.front() == kLeadOfC1) && last >= 0x80 &&
                       last < 0xA0;  // a terminal may take a single byte as one
    if (is_c0 || first == 0x7F || is_c1) {
      out += fmt::format("\\x{:02X}", last);
    } else {
      out += text.substr(0, std::max<std::size_t>(length, 1));
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

PrintableOutput::PrintableOutput()
    : old_(std::cout.rdbuf()), buffer_(std::make_unique<PrintableBuffer>(old_)) {
  std::cout.rdbuf(buffer_.get());
}

PrintableOutput::~PrintableOutput() {
  const std::ios_base::iostate state = std::cout.rdstate();
  std::cout.flush();
  std::cout.rdbuf(old_);  // forgets what failed
  std::cout.clear(state);
}

}  // namespace mmm_converter
