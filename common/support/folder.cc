// SPDX-License-Identifier: MIT
#include "common/support/folder.h"

#include <dirent.h>

#include <algorithm>
#include <cerrno>
#include <memory>

namespace mmm_converter {

std::vector<std::string> NamesIn(const std::string& folder, std::error_code* failure) {
  std::vector<std::string> names;
  const std::unique_ptr<DIR, int (*)(DIR*)> stream(::opendir(folder.c_str()), ::closedir);
  errno = stream ? 0 : errno;
  while (stream) {
    errno = 0;
    const dirent* const entry = ::readdir(stream.get());  // of a stream of this thread's own
    if (entry == nullptr) break;
    const std::string_view name = entry->d_name;
    if (name != "." && name != "..") names.emplace_back(name);
  }
  if (failure != nullptr) failure->assign(errno, std::generic_category());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> StemsIn(const std::string& folder, std::string_view ending) {
  std::vector<std::string> stems;
  for (const std::string& name : NamesIn(folder)) {
    if (name.size() > ending.size() && name.ends_with(ending)) {
      stems.push_back(name.substr(0, name.size() - ending.size()));
    }
  }
  std::sort(stems.begin(), stems.end());
  return stems;
}

std::vector<std::string> FilesIn(const std::string& folder, std::string_view ending) {
  std::string begin = folder;
  if (!begin.ends_with('/')) begin += '/';
  std::vector<std::string> files = StemsIn(folder, ending);
  for (std::string& file : files) file.insert(0, begin).append(ending);
  return files;
}

}  // namespace mmm_converter
