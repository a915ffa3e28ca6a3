// SPDX-License-Identifier: MIT
#include "common/convert/checked_converter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "common/convert/plugin_loader.h"
#include "common/support/error.h"
#include "tests/support/scoped_environment.h"
#include "tests/support/stick_model.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::ScopedEnvironment;
using ::testing::StartsWith;
using testing::TestPlugin;

const std::string kFaulty = TestPlugin("faulty_converter");

TrackingSetup StickSetup() {
  TrackingSetup setup{std::make_shared<const KinematicModel>(testing::StickModel()), {1, 0}, {}};
  for (int i = 0; i < 3; ++i) setup.mapping.assignments.push_back({LabelIx(i), MarkerIx(i), 1});
  return setup;
}

/// What a conversion of three frames by the faulty plugin says.
std::string MessageOfFault(const std::string& fault) {
  const ScopedEnvironment environment("MMM_CONVERTER_TEST_FAULT", fault);
  MarkerSequence recording({"A", "B", "C"}, 3, 100, 2.0);
  for (int k = 0; k < 3; ++k) recording.frame(k).setZero();
  try {
    const LoadedPlugin plugin(kFaulty);
    plugin.factory().Create(StickSetup(), {})->Convert(recording, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(CheckedConverter, NamesThePluginThatGivesWhatCannotBe) {
  EXPECT_EQ(MessageOfFault("none"), "no error");
  for (const char* fault : {"null",
                            "joint",
                            "marker",
                            "model",
                            "int",
                            "exception",
                            "angles",
                            "NaN",
                            "orientation",
                            "residuals",
                            "infinite residual",
                            "deviations",
                            "verdicts",
                            "verdict",
                            "count",
                            "postures",
                            "joint names",
                            "result angles",
                            "rate",
                            "velocities",
                            "result residuals",
                            "frames",
                            "incident",
                            "kind",
                            "noise"}) {
    EXPECT_THAT(MessageOfFault(fault), StartsWith(kFaulty + ": the plugin is faulty: ")) << fault;
  }
  EXPECT_THAT(MessageOfFault("null"), HasSubstr("it gave no converter"));
  EXPECT_THAT(MessageOfFault("exception"), HasSubstr("an iterator went astray"));
  EXPECT_THAT(MessageOfFault("residuals"), HasSubstr("it gave 4 residuals, not 3"));
  EXPECT_THAT(MessageOfFault("factory"), HasSubstr("getFactory threw an exception"));
}

TEST(CheckedConverter, ChecksSingleStepsToo) {
  const LoadedPlugin plugin(kFaulty);
  const auto converter = plugin.factory().Create(StickSetup(), {});
  const Eigen::Matrix3Xd frame = Eigen::Matrix3Xd::Zero(3, 3);
  EXPECT_EQ(converter->Assemble(frame).residuals.size(), 3);
  const ScopedEnvironment environment("MMM_CONVERTER_TEST_FAULT", "verdict");
  EXPECT_THROW(converter->Assemble(frame), Error);
  EXPECT_THROW(converter->Track(frame, 0.01), Error);
}

TEST(LoadPluginByName, LeavesOutABrokenPluginOfThePath) {
  const auto folder = [](const char* plugin) {
    return std::filesystem::path(TestPlugin(plugin)).parent_path().string();
  };
  const ScopedEnvironment path(
      "MMM_CONVERTER_PLUGIN_PATH",
      folder("faulty_converter") + ":" + folder("old_version") + ":" + folder("test_converter"));
  const ScopedEnvironment fault("MMM_CONVERTER_TEST_FAULT", "name");
  Warnings warnings;
  EXPECT_EQ(LoadPluginByName("TestConverter", &warnings).path(), TestPlugin("test_converter"));
  EXPECT_THAT(warnings.texts(),
              ElementsAre(AllOf(StartsWith(kFaulty), HasSubstr("it has forgotten its name"),
                                HasSubstr("; it is left out")),
                          HasSubstr("MMMConverterS2KF-0")));
}

}  // namespace
}  // namespace mmm_converter
