// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/batch_result.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace mmm_converter {
namespace {

using Json = nlohmann::json;

BatchEntry Entry(const std::string& id) {
  BatchEntry entry;
  entry.id = id;
  entry.group = "g";
  entry.request.input.file = id + ".c3d";
  entry.metadata = {{"day", "1, \"2\""}};
  return entry;
}

constexpr const char* kConverted =
    R"({"state":"converted","reason":null,"frames":200,"rate_hz":100.0,"distance_mm":{"mean":26.5,"p95":40.0},)"
    R"("seconds":0.5,"warnings":["one","two"]})";

TEST(BatchResult, LinesHaveEntryAndFigures) {
  const Json line = Json::parse(FormatResultLine(Entry("a/b"), kConverted, "motions/a/b.xml", ""));
  EXPECT_EQ(line["id"], "a/b");
  EXPECT_EQ(line["state"], "converted");
  EXPECT_EQ(line["recording"], "a/b.c3d");
  EXPECT_EQ(line["metadata"]["day"], "1, \"2\"");
  EXPECT_EQ(line["motion"], "motions/a/b.xml");
  EXPECT_TRUE(line["report"].is_null());
  EXPECT_EQ(line["distance_mm"]["mean"], 26.5);
  const ResultFigures figures = ReadFigures(line.dump());
  EXPECT_EQ(figures.frames, 200);
  EXPECT_EQ(figures.recorded_seconds, 2);
  EXPECT_EQ(figures.mean_distance_mm, 26.5);
  EXPECT_EQ(figures.warnings, 2);
}

TEST(BatchResult, WhatFailedOrIsMissingSaysSo) {
  const Json failed = Json::parse(FormatResultLine(Entry("a"), FormatFailure("why", 0.25), "", ""));
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_EQ(failed["reason"], "why");
  EXPECT_EQ(ReadFigures(failed.dump()).seconds, 0.25);
  EXPECT_EQ(ReadFigures(FormatResultLine(Entry("a"), "", "", "")).state, "missing");
}

TEST(BatchResult, TheTableIsRfc4180) {
  const std::string csv =
      FormatResultsCsv({FormatResultLine(Entry("a"), FormatFailure("line 1\nline 2", 0), "", ""),
                        FormatResultLine(Entry("b"), kConverted, "motions/b.xml", "")});
  EXPECT_EQ(
      csv,
      "id,state,reason,recording,group,motion,report,seconds,frames,rate_hz,distance_mm.mean,"
      "distance_mm.p95,warnings,metadata.day\n"
      "a,failed,\"line 1\nline 2\",a.c3d,g,,,0.0,,,,,,\"1, \"\"2\"\"\"\n"
      "b,converted,,b.c3d,g,motions/b.xml,,0.5,200,100.0,26.5,40.0,one; two,\"1, \"\"2\"\"\"\n");
}

}  // namespace
}  // namespace mmm_converter
