// SPDX-License-Identifier: MIT
#include "common/io/osim/ik_tasks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr const char* kTasks = R"(<IKTaskSet name="walk"><objects>
  <IKMarkerTask name="Sternum"><apply> true </apply><weight> 4 </weight></IKMarkerTask>
  <IKMarkerTask name="Offset"><apply>false</apply><weight>1</weight></IKMarkerTask>
  <IKCoordinateTask name="knee"><weight>10</weight><value_type>manual_value</value_type>
    <value>0.5</value></IKCoordinateTask>
</objects></IKTaskSet>)";

// Files of OpenSim's own models have the set as their root, and the end of another one behind it.
TEST(IkTasks, AreReadAsTheRootAndInOpenSimsRoot) {
  const std::string bare =
      std::string("<?xml version=\"1.0\"?>\n") + kTasks + "\n</OpenSimDocument>";
  const std::string inside =
      std::string("<OpenSimDocument Version=\"20302\">") + kTasks + "</OpenSimDocument>";
  for (const std::string& text : {bare, inside}) {
    const IkTasks tasks = ParseIkTasks(text, "tasks.xml");
    ASSERT_EQ(tasks.markers.size(), 1U);
    EXPECT_EQ(tasks.markers[0].name, "Sternum");
    EXPECT_EQ(tasks.markers[0].weight, 4);
    ASSERT_EQ(tasks.coordinates.size(), 1U);
    EXPECT_EQ(tasks.coordinates[0].name, "knee");
    EXPECT_EQ(tasks.coordinates[0].value, 0.5);
  }
}

TEST(IkTasks, AreReadInSetUpsOfTools) {
  const std::string tasks = kTasks;
  for (const std::string& text :
       {"<OpenSimDocument Version=\"40000\"><InverseKinematicsTool><model_file/>" + tasks +
            "</InverseKinematicsTool></OpenSimDocument>",
        "<OpenSimDocument Version=\"20302\"><ScaleTool><MarkerPlacer>" + tasks +
            "</MarkerPlacer></ScaleTool></OpenSimDocument>"}) {
    EXPECT_EQ(ParseIkTasks(text, "setup.xml").markers.size(), 1U) << text;
  }
}

TEST(IkTasks, OfAnotherFileAreRefused) {
  EXPECT_THROW(ParseIkTasks("<OpenSimDocument Version=\"20302\"/>", "tasks.xml"), Error);
  EXPECT_THROW(ParseIkTasks("<ScaleTool/>", "tasks.xml"), Error);
}

}  // namespace
}  // namespace mmm_converter
