// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter {

/// Text that becomes text of an element or of an attribute in double quotes.
std::string EscapeHtml(std::string_view text);

/// JSON as a script element of a class: data for the page's script. No content can end it.
std::string DataBlock(std::string_view name, std::string_view json);

/// A page with its places {{name}} filled; what is filled in is not looked at again. Each place
/// must be among the texts.
std::string FillPage(std::string_view page,
                     const std::map<std::string_view, std::string_view>& texts);

/// A script that a page may run.
struct Script {
  std::string_view text;
  std::string_view sha256;  ///< of the text, 32 bytes
};

/// What one page has of its own.
struct Page {
  std::string_view title;         ///< not escaped
  std::string_view styles;        ///< CSS
  std::string_view content;       ///< HTML below the heading
  std::string_view data;          ///< DataBlocks
  std::vector<Script> libraries;  ///< scripts of others, whose licences the page then has
  Script script;
  std::string_view policy = {};  ///< what the page may do beyond: "connect-src 'self'; "
};

/// The whole text of a page; it loads nothing from elsewhere, and its policy lets no other script
/// run than these.
std::string FormatPage(const Page& page);

}  // namespace mmm_converter
