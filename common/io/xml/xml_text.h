// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace mmm_converter {

/// Text for an attribute value or an element: markup escaped, bytes that are not UTF-8 taken as
/// Latin-1, control characters (which XML can't hold) as blanks.
std::string EscapeXml(std::string_view text);

/// `<!-- text -->`, with what XML can hold there of the text.
std::string FormatXmlComment(std::string_view text);

/// Appends a number rounded to so many decimals (at most 12), without trailing zeros and never as
/// "-0". value must be finite.
void AppendDecimal(double value, int decimals, std::string* out);

/// The name of the root of a text that starts like XML; empty: it does not.
std::string_view RootName(std::string_view content);

}  // namespace mmm_converter
