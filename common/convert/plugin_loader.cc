// SPDX-License-Identifier: MIT
#include "common/convert/plugin_loader.h"

#include <elf.h>
#include <fmt/format.h>

#include <algorithm>
#include <boost/dll/shared_library.hpp>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "common/convert/checked_converter.h"
#include "common/support/data_directory.h"
#include "common/support/error.h"
#include "common/support/folder.h"
#include "common/support/line_file.h"
#include "common/support/opened_files.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

std::string DescribeSearch(const std::vector<FoundPlugin>& plugins) {
  std::string text = "looked in " + JoinNames(PluginFolders(), " and ");
  for (const FoundPlugin& plugin : plugins) {
    if (plugin.name.empty()) text += "; could not load " + plugin.description;
  }
  return text;
}

// The system maps a library's segments without a look at the file's size, and a program that
// touches what a half-copied file lacks is ended (SIGBUS).
void CheckIsWhole(const std::string& path) {
  constexpr std::size_t kHeads = 1 << 16;  // of the file and its segments
  const std::string bytes = FirstBytes(path, kHeads);
  Elf64_Ehdr head{};
  std::memcpy(&head, bytes.data(), std::min(bytes.size(), sizeof(head)));
  if (std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 || head.e_ident[EI_CLASS] != ELFCLASS64) {
    return;  // of another kind: the system says which
  }
  std::error_code failure;
  const std::uint64_t size = fs::file_size(path, failure);
  std::uint64_t end = head.e_shoff + std::uint64_t{head.e_shnum} * head.e_shentsize;
  for (std::uint64_t i = 0; i < head.e_phnum; ++i) {
    const std::uint64_t at = head.e_phoff + i * sizeof(Elf64_Phdr);
    if (at > kHeads - sizeof(Elf64_Phdr)) break;
    Elf64_Phdr segment{};
    if (at + sizeof(segment) <= bytes.size()) {
      std::memcpy(&segment, bytes.data() + at, sizeof(segment));
    }
    end = std::max({end, at + sizeof(segment), segment.p_offset + segment.p_filesz});
  }
  if (end <= size) return;
  throw Error(fmt::format("{}: is a part of a shared library, {} bytes of {}; copy it again", path,
                          size, end));
}

// Of an interface version: what stands before the layout.
std::string NumberOf(const std::string& version) { return version.substr(0, version.find(':')); }

}  // namespace

class LoadedPlugin::Library {
 public:
  explicit Library(const std::string& path) try : library_(path, boost::dll::load_mode::rtld_now) {
  } catch (const boost::system::system_error& failure) {
    throw Error(fmt::format("{}: can't be loaded as a shared library: {}", path, failure.what()));
  }

  template <typename Function>
  Function* Find(const char* name) const {
    if (!library_.has(name)) {
      throw Error(
          fmt::format("{}: is a shared library, but no converter plugin: it does not export {}",
                      library_.location().string(), name));
    }
    return &library_.get<Function>(name);
  }

 private:
  boost::dll::shared_library library_;
};

LoadedPlugin::LoadedPlugin(LoadedPlugin&& other) noexcept = default;
LoadedPlugin::~LoadedPlugin() = default;

LoadedPlugin::LoadedPlugin(const std::string& path) : path_(fs::absolute(path).string()) {
  std::error_code failure;
  if (!fs::is_regular_file(path_, failure)) {
    throw Error(fmt::format("{}: no such plugin file", path));
  }
  CheckIsWhole(path_);
  OpenedFiles::Note(path_);
  library_ = std::make_unique<Library>(path_);
  auto* get_version = library_->Find<GetVersionFunction>("getVersion");
  auto* get_factory = library_->Find<GetFactoryFunction>("getFactory");
  const char* version = nullptr;
  try {
    version = get_version();
  } catch (...) {
    throw Error(fmt::format("{}: getVersion threw an exception", path));
  }
  version_ = version == nullptr ? "" : version;
  if (version_ != kConverterInterfaceVersion) {
    const std::string number = NumberOf(kConverterInterfaceVersion);
    throw Error(fmt::format(
        "{}: was built against interface version \"{}\", this program has \"{}\"; rebuild the "
        "plugin{}",
        path, version_, kConverterInterfaceVersion,
        NumberOf(version_) == number
            ? ", without options such as -march that change how the compiler lays out its types"
            : ""));
  }
  std::unique_ptr<MotionConverterFactory> factory;
  try {
    factory.reset(get_factory());
  } catch (...) {
    throw Error(fmt::format("{}: getFactory threw an exception", path));
  }
  if (factory == nullptr) throw Error(fmt::format("{}: getFactory gave no factory", path));
  factory_ = WithChecks(std::move(factory), path);
}

std::vector<std::string> PluginFolders() {
  std::vector<std::string> folders;
  if (const char* list = std::getenv("MMM_CONVERTER_PLUGIN_PATH")) {
    const std::string text = list;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(':', begin), text.size());
      if (end > begin) folders.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  folders.push_back((fs::path(LibraryDirectory()) / "MMMConverterS2KF" / "plugins").string());
  return folders;
}

std::vector<FoundPlugin> FindPlugins() {
  std::vector<FoundPlugin> plugins;
  for (const std::string& folder : PluginFolders()) {
    for (const std::string& path : FilesIn(folder, ".so")) {
      try {
        const LoadedPlugin plugin(path);
        plugins.push_back({path, plugin.factory().name(), plugin.factory().description()});
      } catch (const Error& error) {
        plugins.push_back({path, "", error.what()});
      }
    }
  }
  return plugins;
}

LoadedPlugin LoadPluginByName(const std::string& name, Warnings* warnings) {
  const std::vector<FoundPlugin> plugins = FindPlugins();
  std::vector<std::string> names;
  for (const FoundPlugin& plugin : plugins) {
    if (!plugin.name.empty()) names.push_back(plugin.name);
  }
  const auto found = std::find_if(plugins.begin(), plugins.end(),
                                  [&](const FoundPlugin& plugin) { return plugin.name == name; });
  if (found != plugins.end()) {
    for (const FoundPlugin& plugin : plugins) {
      if (plugin.name.empty()) Warn(warnings, plugin.description + "; it is left out");
    }
    return LoadedPlugin(found->path);
  }
  const std::string closest = ClosestName(name, names);
  throw Error(fmt::format("there is no converter \"{}\"{}; found {}; {}", name,
                          closest.empty() ? "" : " (did you mean " + closest + "?)",
                          names.empty() ? "none" : JoinNames(names, " and "),
                          DescribeSearch(plugins)));
}

}  // namespace mmm_converter
