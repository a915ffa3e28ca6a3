// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/convert/motion_converter.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A plugin's shared library and the factory that it exports. Must outlive every converter that the
/// factory makes.
class LoadedPlugin {
 public:
  /// @throws Error where there is no such file, it is no shared library, does not export getVersion
  /// and getFactory, or was built against another kConverterInterfaceVersion.
  explicit LoadedPlugin(const std::string& path);
  LoadedPlugin(LoadedPlugin&& other) noexcept;
  ~LoadedPlugin();

  const std::string& path() const { return path_; }  ///< absolute
  const std::string& version() const { return version_; }
  /// The plugin's, WithChecks.
  const MotionConverterFactory& factory() const { return *factory_; }

 private:
  class Library;

  std::string path_;
  std::string version_;
  std::unique_ptr<Library> library_;  // before factory_: destroyed after it
  std::unique_ptr<MotionConverterFactory> factory_;
};

/// Where plugins are looked for, in this order: the folders of the environment variable
/// MMM_CONVERTER_PLUGIN_PATH (separated by colons), then lib/MMMConverterS2KF/plugins of the
/// installation or build tree.
std::vector<std::string> PluginFolders();

struct FoundPlugin {
  std::string path;
  std::string name;         ///< empty: can't be loaded
  std::string description;  ///< or why it can't be loaded
};

/// Every *.so in PluginFolders(), loaded for a moment and asked for its name.
std::vector<FoundPlugin> FindPlugins();

/// Loads the first plugin of that name in PluginFolders(); warns of those that can't be loaded.
/// @throws Error listing what there is and where it was looked for.
LoadedPlugin LoadPluginByName(const std::string& name, Warnings* warnings = nullptr);

}  // namespace mmm_converter
