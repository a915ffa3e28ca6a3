// SPDX-License-Identifier: MIT
#include "common/io/mjcf/mjcf_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "common/support/error.h"
#include "common/support/error_of_file.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMaxFiles = 100;  // a model with its own actuators, assets, ... has some 5
constexpr std::size_t kMaxBytes = std::size_t{32} << 20;
constexpr int kMaxDepth = 400;
// Lines of file i are i kLinesOfFile + line: more lines than a file of so many bytes can have.
constexpr int kLinesOfFile = 1 << 24;
static_assert(kMaxFiles < (std::size_t{1} << 31) / kLinesOfFile);

void MoveLines(int offset, XmlElement* element) {
  element->line += offset;
  for (XmlElement& child : element->children) MoveLines(offset, &child);
}

std::string Normal(const std::filesystem::path& path) {
  return path.lexically_normal().generic_string();
}

}  // namespace

MjcfText::MjcfText(std::string_view content, const MjcfPartReader& read_part,
                   Diagnostics* diagnostics)
    : read_part_(read_part), diagnostics_(diagnostics) {
  root_ = Parse(content, "");
  if (!root_.Is("mujoco")) {
    throw Error(fmt::format("{}:{}: not an MJCF: expected <mujoco>, found <{}>",
                            diagnostics_->file(), root_.line, root_.name));
  }
  Expand(&root_, 0);
}

XmlElement MjcfText::Parse(std::string_view content, const std::string& path) {
  bytes_ += content.size();
  files_.push_back(path);
  if (bytes_ > kMaxBytes || content.size() >= kLinesOfFile || files_.size() > kMaxFiles) {
    throw Error(fmt::format("{}: includes more than {} files or {} MB, which no robot has",
                            diagnostics_->file(), kMaxFiles, kMaxBytes >> 20));
  }
  XmlElement parsed = ParseXml(content, path.empty() ? diagnostics_->file() : path);
  MoveLines(static_cast<int>(files_.size() - 1) * kLinesOfFile, &parsed);
  return parsed;
}

const std::string& MjcfText::FileOf(int line) const {
  return files_[static_cast<std::size_t>(line / kLinesOfFile)];
}

void MjcfText::Fail(int line, const std::string& text) {
  const std::string& file = FileOf(line);
  const int of_file = line % kLinesOfFile;
  file.empty() ? diagnostics_->AddError(of_file, text)
               : diagnostics_->AddError(0, fmt::format("{}:{}: {}", file, of_file, text));
}

void MjcfText::Warn(const XmlElement& element, const std::string& text) {
  const std::string& file = FileOf(element.line);
  const int line = element.line % kLinesOfFile;
  file.empty() ? diagnostics_->AddWarning(line, text, "remarks")
               : diagnostics_->AddWarning(0, fmt::format("{}:{}: {}", file, line, text), "remarks");
}

void MjcfText::Throw(const XmlElement& element, const std::string& text) {
  Fail(element, text);
  diagnostics_->ThrowIfErrors();
  throw Error(text);
}

/// Paths are relative to the model's folder, else to that of the file that includes.
XmlElement MjcfText::Include(const XmlElement& include) {
  const std::string* attribute = include.FindAttribute("file");
  const std::string name = attribute == nullptr ? "" : std::string(Trim(*attribute));
  if (name.empty()) Throw(include, "<include> without a file");
  const std::string includer = FileOf(include.line);
  for (const std::string& path :
       {Normal(name), Normal(std::filesystem::path(FileOf(include.line)).parent_path() / name)}) {
    const std::optional<std::string> content = read_part_ ? read_part_(path) : std::nullopt;
    if (!content) continue;
    const bool is_model =
        path == std::filesystem::path(diagnostics_->file()).filename().generic_string();
    if (is_model || std::find(files_.begin(), files_.end(), path) != files_.end()) {
      Throw(include, fmt::format("{} is included a second time, or includes itself; "
                                 "MJCF allows it once",
                                 name));
    }
    return NamedBy(fmt::format("{}:{}", includer.empty() ? diagnostics_->file() : includer,
                               include.line % kLinesOfFile),
                   [&] { return Parse(*content, path); });
  }
  Throw(include, fmt::format("includes {}, which is not there", name));
}

void MjcfText::Expand(XmlElement* element, int depth) {
  if (depth > kMaxDepth) {
    Throw(*element, fmt::format("nested more than {} deep", kMaxDepth));
  }
  std::vector<XmlElement> children;
  children.reserve(element->children.size());
  for (XmlElement& child : element->children) {
    if (!child.Is("include")) {
      Expand(&child, depth + 1);
      children.push_back(std::move(child));
      continue;
    }
    XmlElement included = Include(child);
    Expand(&included, depth + 1);
    std::move(included.children.begin(), included.children.end(), std::back_inserter(children));
  }
  element->children = std::move(children);
}

}  // namespace mmm_converter
