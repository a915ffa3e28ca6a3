// SPDX-License-Identifier: MIT
#include "common/convert/plugin_loader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "common/support/data_directory.h"
#include "common/support/error.h"
#include "tests/support/scoped_environment.h"
#include "tests/support/shared_data.h"
#include "tests/support/stick_model.h"
#include "tests/support/test_folder.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using testing::ScopedEnvironment;
using testing::TestPlugin;

std::string ErrorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string LoadError(const std::string& path) {
  return ErrorOf([&] { const LoadedPlugin plugin(path); });
}

std::string FolderOf(const std::string& plugin) {
  return std::filesystem::path(TestPlugin(plugin)).parent_path().string();
}

TEST(LoadedPlugin, GivesTheFactoryAndItsConverters) {
  const LoadedPlugin plugin(TestPlugin("test_converter"));
  EXPECT_EQ(plugin.factory().name(), "TestConverter");
  EXPECT_EQ(plugin.version(), kConverterInterfaceVersion);
  TrackingSetup setup{std::make_shared<const KinematicModel>(testing::StickModel()), {0, 1}, {}};
  for (int i = 0; i < 3; ++i) setup.mapping.assignments.push_back({LabelIx(i), MarkerIx(i), 1});
  const auto converter = plugin.factory().Create(setup, {});
  const Eigen::Matrix3Xd frame = Eigen::Matrix3Xd::Constant(3, 3, 2.0);
  EXPECT_EQ(converter->Assemble(frame).posture.position, Eigen::Vector3d(2, 2, 2));
}

TEST(LoadedPlugin, ErrorsOfAPluginArriveAsOurs) {
  const LoadedPlugin plugin(TestPlugin("test_converter"));
  ConverterConfig config;
  config.file = "walk.xml";
  config.plugin_elements = ParseXml("<C>\n<Tset/></C>", "walk.xml").children;
  const TrackingSetup setup{std::make_shared<const KinematicModel>(testing::StickModel()), {}, {}};
  EXPECT_THAT(ErrorOf([&] { plugin.factory().Create(setup, config); }),
              HasSubstr("walk.xml:2: unknown element <Tset> (did you mean Test?)"));
}

TEST(LoadedPlugin, RefusesWhatIsNoPlugin) {
  EXPECT_THAT(LoadError("/no/such/plugin.so"), HasSubstr("no such plugin file"));
  EXPECT_THAT(LoadError("/"), HasSubstr("no such plugin file"));
  EXPECT_THAT(LoadError(testing::SourcePath("LICENSE")),
              HasSubstr("LICENSE: can't be loaded as a shared library"));
  const std::string empty = testing::TestFolder() + "/empty_plugin.so";
  std::ofstream(empty).close();
  EXPECT_THAT(LoadError(empty), HasSubstr("can't be loaded as a shared library"));
  const std::string library = LibraryDirectory() + "/libmmm_converter_common.so";
  EXPECT_THAT(LoadError(library), HasSubstr("is a shared library, but no converter plugin"));
}

TEST(LoadedPlugin, RefusesFaultyPlugins) {
  EXPECT_THAT(LoadError(TestPlugin("old_version")),
              AllOf(HasSubstr("\"MMMConverterS2KF-0\""), HasSubstr(kConverterInterfaceVersion)));
  EXPECT_THAT(LoadError(TestPlugin("no_factory")), EndsWith("does not export getFactory"));
  EXPECT_THAT(LoadError(TestPlugin("null_factory")), EndsWith("getFactory gave no factory"));
}

// To touch what is not there of a mapped file ends a program.
TEST(LoadedPlugin, RefusesPartsOfAFile) {
  std::ifstream whole(TestPlugin("test_converter"), std::ios::binary);
  std::stringstream bytes;
  bytes << whole.rdbuf();
  const std::string part = testing::TestFolder() + "/part.so";
  for (const std::size_t size :
       {std::size_t{100}, bytes.str().size() / 2, bytes.str().size() - 1}) {
    std::ofstream(part, std::ios::binary) << bytes.str().substr(0, size);
    EXPECT_THAT(LoadError(part), HasSubstr("is a part of a shared library")) << size;
  }
}

TEST(LoadPluginByName, FindsPluginsInTheFoldersOfTheEnvironment) {
  const ScopedEnvironment path("MMM_CONVERTER_PLUGIN_PATH",
                               "/no/such/folder::" + FolderOf("test_converter"));
  EXPECT_EQ(LoadPluginByName("TestConverter").path(), TestPlugin("test_converter"));
}

TEST(LoadPluginByName, SaysWhatThereIsAndWhereItLooked) {
  const ScopedEnvironment path(
      "MMM_CONVERTER_PLUGIN_PATH",
      FolderOf("old_version") + ":" + FolderOf("test_converter") + ":/no/such/folder");
  EXPECT_THAT(ErrorOf([] { LoadPluginByName("TestConvertor"); }),
              AllOf(HasSubstr("there is no converter \"TestConvertor\" (did you mean "
                              "TestConverter?)"),
                    HasSubstr("/no/such/folder"), HasSubstr("lib/MMMConverterS2KF/plugins"),
                    HasSubstr("could not load"), HasSubstr("\"MMMConverterS2KF-0\"")));
}

TEST(DataDirectory, IsTheEnvironmentsOrTheBuildTrees) {
  EXPECT_THAT(DataDirectory(), EndsWith("share/MMMConverterS2KF"));
  const ScopedEnvironment data("MMM_CONVERTER_DATA", "/no/such/data");
  EXPECT_EQ(DataDirectory(), "/no/such/data");
  EXPECT_THAT(ErrorOf([] { DataFile("models/mmm.xml"); }),
              AllOf(HasSubstr("/no/such/data/models/mmm.xml: no such file"),
                    HasSubstr("MMM_CONVERTER_DATA")));
}

}  // namespace
}  // namespace mmm_converter
