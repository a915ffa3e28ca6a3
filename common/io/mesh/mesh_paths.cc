// SPDX-License-Identifier: MIT
#include "common/io/mesh/mesh_paths.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

constexpr int kFoldersAbove = 2;        // in which a file that is elsewhere is looked for
constexpr std::size_t kMostParts = 64;  // of a path

bool IsFile(const fs::path& path) {
  std::error_code failure;
  return fs::is_regular_file(path, failure);
}

std::vector<fs::path> FoldersAbove(fs::path folder) {
  std::vector<fs::path> folders{folder};
  while (folder.has_relative_path() && folders.size() < kMostParts) {
    folders.push_back(folder = folder.parent_path());
  }
  return folders;
}

std::vector<std::string> FoldersOf(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? std::vector<std::string>() : Split(value, ':');
}

/// Where a package may be.
std::vector<fs::path> PackageFolders(const std::string& package, const fs::path& folder) {
  std::vector<fs::path> places;
  for (const fs::path& above : FoldersAbove(folder)) {
    if (above.filename() == package) places.push_back(above);
    places.push_back(above / package);
  }
  for (const std::string& path : FoldersOf("ROS_PACKAGE_PATH")) {
    if (path.empty()) continue;
    places.push_back(fs::path(path) / package);
    if (fs::path(path).filename() == package) places.emplace_back(path);
  }
  for (const std::string& path : FoldersOf("AMENT_PREFIX_PATH")) {
    if (!path.empty()) places.push_back(fs::path(path) / "share" / package);
  }
  return places;
}

std::optional<std::string> FindElsewhere(const fs::path& name, const fs::path& folder) {
  std::vector<fs::path> parts;
  for (const fs::path& part : name.relative_path()) {
    if (part != "." && part != ".." && !part.empty()) parts.push_back(part);
  }
  if (parts.empty() || parts.size() > kMostParts) return {};
  const std::vector<fs::path> folders = FoldersAbove(folder);
  for (std::size_t i = 0; i < folders.size() && i <= kFoldersAbove; ++i) {
    for (std::size_t first = 0; first < parts.size(); ++first) {
      fs::path path = folders[i];
      for (std::size_t k = first; k < parts.size(); ++k) path /= parts[k];
      if (IsFile(path)) return path.string();
    }
    const fs::path path = folders[i] / "meshes" / parts.back();
    if (IsFile(path)) return path.string();
  }
  return {};
}

}  // namespace

bool IsFarAway(const std::string& name) {
  const std::size_t colon = name.find("://");
  if (colon == std::string::npos) return false;
  const std::string scheme = ToLower(name.substr(0, colon));
  return scheme != "package" && scheme != "model" && scheme != "file";
}

std::optional<FoundMesh> FindMeshFile(const std::string& name, const std::string& robot_file) {
  if (IsFarAway(name)) return {};
  std::error_code failure;
  const fs::path folder = fs::absolute(robot_file, failure).lexically_normal().parent_path();
  std::string rest(Trim(name));
  std::replace(rest.begin(), rest.end(), '\\', '/');
  std::vector<fs::path> places;
  const std::size_t colon = rest.find("://");
  const bool is_file = colon != std::string::npos && ToLower(rest.substr(0, colon)) == "file";
  if (colon != std::string::npos) rest.erase(0, colon + 3);
  if (is_file) {
    if (rest.starts_with("localhost/")) rest.erase(0, std::string_view("localhost").size());
    places.push_back(folder / rest);
  } else if (colon != std::string::npos) {
    const std::size_t slash = rest.find('/');
    if (slash == std::string::npos) return {};
    const std::string package = rest.substr(0, slash);
    rest.erase(0, slash + 1);
    for (const fs::path& place : PackageFolders(package, folder)) places.push_back(place / rest);
  } else {
    places.push_back(folder / rest);
  }
  for (const fs::path& place : places) {
    if (IsFile(place)) return FoundMesh{place.lexically_normal().string(), false};
  }
  if (const auto elsewhere = FindElsewhere(rest, folder)) return FoundMesh{*elsewhere, true};
  return {};
}

}  // namespace mmm_converter
