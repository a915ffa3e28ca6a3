// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/entry_result.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/batch/result_files.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

BatchEntry Entry(const std::string& id) {
  BatchEntry entry;
  entry.id = id;
  entry.group = "g";
  entry.request.input.file = id + ".c3d";
  entry.metadata = {{"day", "1, \"2\""}};
  return entry;
}

// What a journal has of a converted entry, in its order.
constexpr const char* kConverted =
    R"({"state":"converted","reason":null,"verdict":{"level":"check","reasons":["why"]},"frames":200,"rate_hz":100.0,"height_m":1.8,)"
    R"("height_source":"given","mass_kg":70.0,"mass_source":"assumed","subject":"Anna",)"
    R"("converter":"S2KFConverter","configuration":"s2kf_default","markers_used":50,)"
    R"("markers_absent":2,"markers_ignored":1,"distance_mm":{"mean":26.5,"p95":40.0,"max":61.25},)"
    R"("worst_marker":"LIFD","worst_marker_mm":51.0,"frames_with_missing_markers":3,)"
    R"("frames_not_converged":4,"frames_reassembled":5,"wrong_markers":6,"process_noise_scale":0.5,)"
    R"("nis_over_degrees_of_freedom":1.1,"ms_per_frame":{"median":0.3,"p99":0.5},"seconds":0.5,)"
    R"("warnings":["one","two"]})";

// A conversion of three frames with two markers, the second of which is 2 mm off.
ConversionReport Report() {
  ConversionReport report;
  report.plan.input.recording.markers = MarkerSequence({"A", "B"}, 3, 100, 0);
  report.plan.setup.mapping.assignments = {{LabelIx(0), MarkerIx(0)}, {LabelIx(1), MarkerIx(1)}};
  report.result.frames.resize(3);
  report.result.residuals.resize(2, 3);
  report.result.residuals << 0.001, 0.001, 0.001, 0.002, 0.002, 0.002;
  report.figures = MeasureConversion(report.result);
  return report;
}

TEST(EntryResult, AJournalGivesBackWhatWasWritten) {
  std::string on_robot = kConverted;
  on_robot.insert(
      on_robot.find("\"seconds\""),
      R"("robot":{"name":"g1","slide":0.01,"toe_slide_30_hz":null,"penetration_mm":0.5,)"
      R"("floating_mm":0.25,"direction_deg":2.5,"direction_p95_deg":7.0,)"
      R"("position_limits_broken":0,"velocity_limits_broken":1,"acceleration_rad_s2":8.5},)");
  for (const std::string& text :
       {std::string(kConverted), on_robot,
        std::string(R"({"state":"failed","reason":"why","seconds":0.25})")}) {
    EXPECT_EQ(FormatJsonLine(ToJson(ParseEntryResult(Json::parse(text)))), text);
  }
  EXPECT_THROW(ParseEntryResult(Json::parse(R"({"state":"converted"})")),
               nlohmann::json::exception);
}

TEST(EntryResult, TheWorstMarkerIsTheOneFarthestOff) {
  const EntryResult result = Converted(Report(), nullptr, 0.25);
  ASSERT_TRUE(result.converted());
  EXPECT_EQ(result.figures->worst_marker, "B");
  EXPECT_DOUBLE_EQ(result.figures->worst_marker_mm, 2);
  EXPECT_DOUBLE_EQ(result.figures->mean_mm, 1.5);
}

TEST(EntryResult, AnObjectHasNoHeight) {
  ConversionReport report = Report();
  report.plan.object = ObjectModel();
  const Json json = ToJson(Converted(report, nullptr, 0));
  for (const char* key : {"height_m", "height_source", "mass_kg", "mass_source", "subject"}) {
    EXPECT_TRUE(json.at(key).is_null()) << key;
  }
  EXPECT_EQ(ToJson(ParseEntryResult(json)), json);
}

TEST(EntryResult, NothingSeenHasNoDistance) {
  ConversionReport report = Report();
  report.result.residuals.setConstant(kNaN);
  report.figures = MeasureConversion(report.result);
  const Json json = ToJson(Converted(report, nullptr, 0));
  EXPECT_TRUE(json.at("worst_marker").is_null());
  EXPECT_TRUE(json.at("distance_mm").at("mean").is_null());
  EXPECT_EQ(ToJson(ParseEntryResult(json)), json);
}

TEST(ResultFiles, LinesHaveEntryAndFigures) {
  const BatchEntry entry = Entry("a/b");
  const ResultRow row = {&entry, ParseEntryResult(Json::parse(kConverted)), "motions/a/b.xml", ""};
  const Json line = ToJson(row);
  EXPECT_EQ(line["id"], "a/b");
  EXPECT_EQ(line["state"], "converted");
  EXPECT_EQ(line["recording"], "a/b.c3d");
  EXPECT_EQ(line["metadata"]["day"], "1, \"2\"");
  EXPECT_EQ(line["motion"], "motions/a/b.xml");
  EXPECT_TRUE(line["report"].is_null());
  EXPECT_EQ(line["distance_mm"]["mean"], 26.5);
}

TEST(ResultFiles, SumsAreOverTheEntries) {
  const BatchEntry entry = Entry("a");
  EntryResult other = ParseEntryResult(Json::parse(kConverted));
  other.figures->frames = 600;
  other.figures->mean_mm = 30.5;
  const BatchResults sum = Summarize({{&entry, ParseEntryResult(Json::parse(kConverted)), "", ""},
                                      {&entry, other, "", ""},
                                      {&entry, Failed("why", 0.25), "", ""},
                                      {&entry, std::nullopt, "", ""}});
  EXPECT_EQ(sum.converted, 2);
  EXPECT_EQ(sum.to_check, 2);
  EXPECT_EQ(sum.failed, 1);
  EXPECT_EQ(sum.missing, 1);
  EXPECT_EQ(sum.frames, 800);
  EXPECT_EQ(sum.recorded_seconds, 8);
  EXPECT_EQ(sum.seconds, 1.25);
  EXPECT_EQ(sum.mean_distance_mm, 29.5);
}

TEST(ResultFiles, TheWorstVerdictsComeFirst) {
  const BatchEntry entry = Entry("a");
  const auto judged = [](Verdict::Level level) {
    EntryResult result = ParseEntryResult(Json::parse(kConverted));
    result.figures->verdict.level = level;
    return result;
  };
  std::vector<ResultRow> rows = {{&entry, judged(Verdict::Level::kGood), "", ""},
                                 {&entry, judged(Verdict::Level::kCheck), "1", ""},
                                 {&entry, judged(Verdict::Level::kFailed), "", ""},
                                 {&entry, judged(Verdict::Level::kCheck), "2", ""},
                                 {&entry, std::nullopt, "", ""}};
  SortByVerdict(&rows);
  EXPECT_FALSE(rows[0].result.has_value());
  EXPECT_EQ(rows[1].result->figures->verdict.level, Verdict::Level::kFailed);
  EXPECT_EQ(rows[2].motion, "1");
  EXPECT_EQ(rows[3].motion, "2");
  EXPECT_EQ(rows[4].result->figures->verdict.level, Verdict::Level::kGood);
}

TEST(ResultFiles, WhatFailedOrIsMissingSaysSo) {
  const BatchEntry entry = Entry("a");
  const Json failed = ToJson(ResultRow{&entry, Failed("why", 0.25), "", ""});
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_EQ(failed["reason"], "why");
  EXPECT_EQ(failed["seconds"], 0.25);
  EXPECT_EQ(ToJson(ResultRow{&entry, std::nullopt, "", ""})["state"], "missing");
}

TEST(ResultFiles, TheTableIsRfc4180) {
  const BatchEntry a = Entry("a");
  const std::string failed =
      FormatResultsCsv({ToJson(ResultRow{&a, Failed("line 1\nline 2", 0), "", ""})});
  EXPECT_EQ(failed,
            "id,state,reason,recording,group,motion,report,seconds,metadata.day\n"
            "a,failed,\"line 1\nline 2\",a.c3d,g,,,0.0,\"1, \"\"2\"\"\"\n");
  const Json first = {{"id", "a"}, {"metadata", {{"x", 1}}}};
  const Json second = {{"id", "b"},
                       {"distance_mm", {{"mean", 26.5}, {"max", nullptr}}},
                       {"warnings", {"one", "two"}}};
  EXPECT_EQ(FormatResultsCsv({first, second}),
            "id,distance_mm.mean,distance_mm.max,warnings,metadata.x\n"
            "a,,,,1\n"
            "b,26.5,,one; two,\n");
}

}  // namespace
}  // namespace mmm_converter
