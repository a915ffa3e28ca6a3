// SPDX-License-Identifier: MIT
#include "common/io/bytes/foreign_content.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace mmm_converter {
namespace {

constexpr std::pair<std::string_view, const char*> kPacked[] = {
    {"\x1F\x8B", "gzip"},
    {"PK\x03\x04", "zip"},
    {"BZh", "bzip2"},
    {"\xFD"
     "7zXZ",
     "xz"},
    {"7z\xBC\xAF", "7-Zip"},
    {"\x28\xB5\x2F\xFD", "zstd"},
};

constexpr std::pair<std::string_view, const char*> kScenes[] = {
    {"Kaydara FBX Binary", "FBX"}, {"; FBX", "FBX"}, {"glTF", "glTF"}};

/// With a mark, or "<" or a letter beside a zero.
bool IsUtf16(std::string_view start) {
  if (start.starts_with("\xFF\xFE") || start.starts_with("\xFE\xFF")) return true;
  const auto is_text = [&](std::size_t at) { return at < start.size() && start[at] >= '\t'; };
  const auto is_zero = [&](std::size_t at) { return at < start.size() && start[at] == '\0'; };
  return (is_text(0) && is_zero(1) && is_text(2) && is_zero(3) && is_text(4) && is_zero(5)) ||
         (is_zero(0) && is_text(1) && is_zero(2) && is_text(3) && is_zero(4) && is_text(5));
}

}  // namespace

std::string NameForeignContent(std::string_view start) {
  if (start.starts_with("PK\x03\x04") && start.substr(0, 200).find("data.pkl") != start.npos) {
    return "is an archive of PyTorch, whose objects are not opened; save its joints as .npy or "
           ".npz "
           "(numpy.savez)";
  }
  if (start.starts_with("\x80") && start.size() > 1 && start[1] >= 2 && start[1] <= 5) {
    return "is a pickle of Python, whose objects are not opened; save its arrays as .npz "
           "(numpy.savez)";
  }
  for (const auto& [mark, name] : kPacked) {
    if (start.starts_with(mark)) return fmt::format("is packed ({}); unpack it first", name);
  }
  for (const auto& [mark, name] : kScenes) {
    if (!start.starts_with(mark)) continue;
    return fmt::format(
        "is a scene of characters ({}); export its motion as BVH (in Blender: File, "
        "Import, then File, Export, Motion Capture)",
        name);
  }
  if (IsUtf16(start)) return "is text in UTF-16; save it as UTF-8";
  if (!start.empty() && std::all_of(start.begin(), start.end(), [](char c) { return c == 0; })) {
    return fmt::format("begins with {} zeros, as files do that were not copied to their end",
                       start.size());
  }
  return {};
}

}  // namespace mmm_converter
