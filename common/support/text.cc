// SPDX-License-Identifier: MIT
#include "common/support/text.h"

#include <algorithm>
#include <charconv>

namespace mmm_converter {
namespace {

constexpr std::string_view kTextBlanks("\0 \t\r\n\v\f", 7);

char LowerCase(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

template <typename Number>
std::optional<Number> Parse(std::string_view text) {
  text = Trim(text);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string_view Trim(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kTextBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kTextBlanks) - begin + 1);
}

std::string ToLower(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(), LowerCase);
  return lower;
}

bool EqualIgnoringCase(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return LowerCase(x) == LowerCase(y); });
}

std::optional<double> ParseDouble(std::string_view text) { return Parse<double>(text); }

std::optional<long> ParseLong(std::string_view text) { return Parse<long>(text); }

bool AppendDoubles(std::string_view text, std::vector<double>* numbers) {
  for (text = Trim(text); !text.empty();) {
    const std::string_view word = text.substr(0, text.find_first_of(kTextBlanks));
    const std::optional<double> number = ParseDouble(word);
    if (!number) return false;
    numbers->push_back(*number);
    text.remove_prefix(word.size());
    text.remove_prefix(std::min(text.find_first_not_of(kTextBlanks), text.size()));
  }
  return true;
}

std::string JoinNames(const std::vector<std::string>& names, std::string_view last) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? last : std::string_view(", ");
    text += names[i];
  }
  return text;
}

std::string FirstNames(const std::vector<std::string>& names, std::size_t most) {
  if (names.size() <= most) return JoinNames(names, ", ");
  return JoinNames({names.begin(), names.begin() + static_cast<std::ptrdiff_t>(most)}, ", ") +
         ", ...";
}

}  // namespace mmm_converter
