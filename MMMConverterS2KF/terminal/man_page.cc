// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/terminal/man_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "common/support/text.h"

namespace mmm_converter {
namespace {

// Lines that stand together, all indented or none.
struct Block {
  std::vector<std::string> lines;
  bool is_indented = false;
  bool after_gap = false;  // an empty line stands before it
  bool is_title = false;   // of the indented lines that follow
};

std::string ToUpper(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return text;
}

// Text as roff shows it: what has a meaning there is escaped.
std::string Escape(std::string_view text) {
  static const std::map<char, const char*> escapes = {
      {'\\', "\\e"}, {'-', "\\-"}, {'\'', "\\(aq"}, {'`', "\\(ga"}, {'^', "\\(ha"}, {'~', "\\(ti"}};
  std::string escaped;
  for (const char c : text) {
    const auto found = escapes.find(c);
    found == escapes.end() ? escaped += c : escaped += found->second;
  }
  return escaped.starts_with('.') ? "\\&" + escaped : escaped;
}

std::size_t Indentation(const std::string& line) {
  return std::min(line.find_first_not_of(' '), line.size());
}

std::vector<Block> SplitBlocks(const std::string& text) {
  std::vector<Block> blocks;
  bool after_gap = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) {
      after_gap = true;
      continue;
    }
    const bool is_indented = line.front() == ' ';
    if (blocks.empty() || after_gap || is_indented != blocks.back().is_indented) {
      if (is_indented && !after_gap && !blocks.empty()) {
        blocks.back().is_title = blocks.back().after_gap && blocks.back().lines.size() == 1;
      }
      blocks.push_back({{}, is_indented, after_gap});
    }
    blocks.back().lines.push_back(line);
    after_gap = false;
  }
  return blocks;
}

// A list's line: its term ends where two spaces follow.
std::size_t EndOfTerm(const std::string& line) { return line.find("  ", Indentation(line)); }

bool IsList(const Block& block) {
  const std::string first(Trim(block.lines.front()));
  return !first.starts_with("MMMConverterS2KF") &&
         EndOfTerm(block.lines.front()) != std::string::npos;
}

std::string FormatList(const Block& block) {
  const std::size_t indentation = Indentation(block.lines.front());
  std::string page;
  for (const std::string& line : block.lines) {
    if (Indentation(line) > indentation) {
      page += Escape(Trim(line)) + '\n';
      continue;
    }
    const std::size_t end = std::min(EndOfTerm(line), line.size());
    page += fmt::format(".TP\n\\fB{}\\fR\n{}\n", Escape(Trim(line.substr(0, end))),
                        Escape(Trim(line.substr(end))));
  }
  return page;
}

std::string FormatBlock(const Block& block) {
  if (block.is_title) return fmt::format(".SH {}\n", Escape(ToUpper(block.lines.front())));
  if (block.is_indented && IsList(block)) return FormatList(block);
  std::string page = block.is_indented ? ".PP\n.EX\n" : ".PP\n";
  for (const std::string& line : block.lines) page += Escape(Trim(line)) + '\n';
  return block.is_indented ? page + ".EE\n" : page;
}

std::string FormatBlocks(const std::vector<Block>& blocks) {
  std::string page;
  for (const Block& block : blocks) page += FormatBlock(block);
  return page;
}

std::string FormatOption(const OptionSpec& option) {
  std::vector<std::string> names;
  for (const std::string& name : NamesOf(option)) names.push_back("\\fB" + Escape(name) + "\\fR");
  std::string page = ".TP\n" + JoinNames(names, ", ");
  if (!option.argument.empty()) page += " \\fI" + Escape(option.argument) + "\\fR";
  page += '\n' + Escape(option.help);
  if (!option.alias.empty()) page += "; also \\fB" + Escape("--" + option.alias) + "\\fR";
  return page + '\n';
}

std::string FormatOptionSections(const std::vector<OptionGroup>& groups) {
  std::string page = ".SH OPTIONS\n";
  for (const OptionGroup& group : groups) {
    if (group.title.empty()) continue;
    page += fmt::format(".SS {}\n", Escape(group.title));
    for (const OptionSpec& option : group.options) page += FormatOption(option);
  }
  return page;
}

}  // namespace

std::string FormatManPage(const ManPageTitle& title, const Manual& manual) {
  const std::size_t begin = std::min(manual.text.find('\n'), manual.text.size());
  const std::size_t place = manual.text.find(kPlaceOfOptions);
  std::string page = fmt::format(
      ".TH {} 1 \"\" \"MMMConverterS2KF " MMM_CONVERTER_VERSION
      "\" \"User Commands\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n\\fB{}\\fR\n.SH DESCRIPTION\n",
      Escape(title.name), Escape(title.name), Escape(title.summary),
      Escape(manual.text.substr(0, begin)));
  page += FormatBlocks(SplitBlocks(manual.text.substr(begin + 1, place - begin - 1)));
  if (place != std::string::npos) {
    page += FormatOptionSections(manual.options);
    const auto rest = SplitBlocks('\n' + manual.text.substr(place + 2));
    if (!rest.empty() && !rest.front().is_title) page += ".SH NOTES\n";
    page += FormatBlocks(rest);
  }
  page += ".SH SEE ALSO\n.nh\n";
  std::vector<std::string> pages;
  for (const std::string& name : title.see_also) pages.push_back("\\fB" + Escape(name) + "\\fR(1)");
  return page + JoinNames(pages, ", ") + '\n';
}

}  // namespace mmm_converter
