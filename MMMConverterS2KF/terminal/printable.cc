// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/terminal/printable.h"

#include <fmt/format.h>

#include <iostream>

namespace mmm_converter {
namespace {

constexpr char kLeadOfC1 =
    '\xC2';  // U+0080 to U+009F, where a terminal knows some, are C2 80 to 9F

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
    const std::string_view added(text, static_cast<std::size_t>(size));
    text_ += added;
    return added.find('\n') == std::string_view::npos || Pass() ? size : 0;
  }

  int sync() override { return Pass() ? target_->pubsync() : -1; }

 private:
  bool Pass() {
    const std::size_t count = text_.size() - (text_.ends_with(kLeadOfC1) ? 1 : 0);
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
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    if ((byte < 0x20 && text[i] != '\n' && text[i] != '\t') || byte == 0x7F) {
      out += fmt::format("\\x{:02X}", byte);
    } else if (text[i] == kLeadOfC1 && next >= 0x80 && next < 0xA0) {
      out += fmt::format("\\x{:02X}", next);
      ++i;
    } else {
      out += text[i];
    }
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
