// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

BatchManifest Parse(const std::string& xml) { return ParseManifest(xml, "/data/night.xml"); }

std::string ErrorOf(const std::string& xml) {
  try {
    Parse(xml);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Manifest, TheInnermostHolds) {
  const BatchManifest manifest = Parse(R"(
    <Batch name="kit" config="s2kf_offline" height_m="1.75" csv="true" mot="true" markerSet="kit53">
      <Recording file="a.c3d"/>
      <Group name="1723" height_m="1.68" mass_kg="62">
        <Recording file="1723/Cut.c3d" mass_kg="63" csv="false" markerSet="own.xml" frames="10:"/>
        <Group name="late" subjectFile="../anna.xml">
          <Recording file="1723/Peel.c3d" handLength_mm="180"/>
        </Group>
      </Group>
    </Batch>)");
  EXPECT_EQ(manifest.name, "kit");
  ASSERT_EQ(manifest.entries.size(), 3U);
  const auto& [first, cut, peel] =
      std::tie(manifest.entries[0], manifest.entries[1], manifest.entries[2]);
  EXPECT_EQ(first.id, "a");
  EXPECT_EQ(first.group, "");
  EXPECT_EQ(first.request.input.file, "/data/a.c3d");
  EXPECT_EQ(first.request.input.person.size.height, 1.75);
  EXPECT_FALSE(first.request.input.person.size.mass);
  EXPECT_EQ(first.exports, (std::set<std::string>{"csv", "mot"}));
  EXPECT_EQ(first.request.input.marker_set, "kit53");
  EXPECT_EQ(cut.id, "1723/Cut");
  EXPECT_EQ(cut.group, "1723");
  EXPECT_EQ(cut.request.input.person.size.height, 1.68);
  EXPECT_EQ(cut.request.input.person.size.mass, 63);
  EXPECT_EQ(cut.request.input.first_frame, 10);
  EXPECT_EQ(cut.exports, std::set<std::string>{"mot"});
  EXPECT_EQ(cut.request.input.marker_set, "/data/own.xml");
  EXPECT_EQ(peel.group, "1723 / late");
  EXPECT_EQ(peel.request.input.person.size.mass, 62);
  EXPECT_DOUBLE_EQ(peel.request.input.person.size.hand_length.value(), 0.18);
  EXPECT_EQ(peel.request.input.person.subject_file, "/anna.xml");
  EXPECT_EQ(peel.request.converter.config, "s2kf_offline");
}

TEST(Manifest, MetadataHoldInside) {
  const BatchManifest manifest = Parse(R"(
    <Batch>
      <Recording file="a.c3d"/>
      <Group><Recording file="b.c3d"><Metadata name="trial" value="7"/></Recording>
        <Metadata name="day" value="2"/></Group>
      <Metadata name="day" value="1"/>
    </Batch>)");
  EXPECT_EQ(manifest.name, "night");
  EXPECT_THAT(manifest.entries[0].metadata, ElementsAre(Pair("day", "1")));
  EXPECT_THAT(manifest.entries[1].metadata, ElementsAre(Pair("day", "2"), Pair("trial", "7")));
}

TEST(Manifest, RecordingsMayStartElsewhere) {
  const BatchManifest manifest = Parse(R"(
    <Batch folder="/archive"><Recording file="1723/Cut.c3d"/><Recording file="../x/walk.trc"/>
      <Recording file="/other/run.c3d" id="own/name"/></Batch>)");
  EXPECT_EQ(manifest.entries[0].request.input.file, "/archive/1723/Cut.c3d");
  EXPECT_EQ(manifest.entries[0].id, "1723/Cut");
  EXPECT_EQ(manifest.entries[1].request.input.file, "/x/walk.trc");
  EXPECT_EQ(manifest.entries[1].id, "walk");
  EXPECT_EQ(manifest.entries[2].request.input.file, "/other/run.c3d");
  EXPECT_EQ(manifest.entries[2].id, "own/name");
}

TEST(Manifest, OfAGivenAndAnEstimatedPersonTheInnermostHolds) {
  const BatchManifest manifest = Parse(R"(
    <Batch selfCalibrate="true"><Recording file="a.c3d"/>
      <Group subjectFile="anna.xml"><Recording file="b.c3d"/>
        <Recording file="c.c3d" selfCalibrate="true"/></Group></Batch>)");
  EXPECT_TRUE(manifest.entries[0].request.self_calibrate);
  EXPECT_FALSE(manifest.entries[1].request.self_calibrate);
  EXPECT_EQ(manifest.entries[1].request.input.person.subject_file, "/data/anna.xml");
  EXPECT_TRUE(manifest.entries[2].request.self_calibrate);
  EXPECT_EQ(manifest.entries[2].request.input.person.subject_file, "");
}

TEST(Manifest, LabelsAreFoundWhereTheInnermostSaysSo) {
  const BatchManifest manifest = Parse(R"(
    <Batch labelLike="standing.c3d"><Recording file="a.c3d"/>
      <Group label="true"><Recording file="b.c3d"/><Recording file="c.c3d" label="false"/>
        <Recording file="d.c3d" label="repair" labelLike="/other.c3d"/>
        <Recording file="e.c3d" labelAndSubjectFiles="ben.xml; /cleo.xml" labelObjectModels="cups"/>
      </Group></Batch>)");
  EXPECT_FALSE(manifest.entries[0].request.label);
  EXPECT_TRUE(manifest.entries[1].request.label);
  EXPECT_FALSE(manifest.entries[1].request.label_hints.repair);
  EXPECT_EQ(manifest.entries[1].request.label_hints.like, "/data/standing.c3d");
  EXPECT_FALSE(manifest.entries[2].request.label);
  EXPECT_TRUE(manifest.entries[3].request.label);
  EXPECT_TRUE(manifest.entries[3].request.label_hints.repair);
  EXPECT_EQ(manifest.entries[3].request.label_hints.like, "/other.c3d");
  EXPECT_FALSE(manifest.entries[3].request.label_hints.has_others());
  EXPECT_THAT(manifest.entries[4].request.label_hints.other_persons,
              ElementsAre("/data/ben.xml", "/cleo.xml"));
  EXPECT_EQ(manifest.entries[4].request.label_hints.object_models, "/data/cups");
}

TEST(Manifest, SaysAllThatIsWrongWithItsLine) {
  EXPECT_THAT(
      ErrorOf("<Batch height_m='175'>\n<Recording file='a.c3d' hieght_m='1.7'/>\n<Recording/>\n"
              "<Recrding file='b.c3d'/>\n<Recording file='a.trc' frames='5'/>\n"
              "<Recording file='c.c3d' up='w'/>\n</Batch>"),
      AllOf(HasSubstr(
                "/data/night.xml:1: <Batch>: height_m=\"175\" is not allowed; give metres from 0.5 "
                "to 2.5"),
            HasSubstr(":2: <Recording>: unknown attribute hieght_m; did you mean height_m?"),
            HasSubstr(":3: <Recording> needs file=\"...\""),
            HasSubstr(":4: unknown element <Recrding> in <Batch>"),
            HasSubstr(":5: <Recording>: frames"),
            HasSubstr(":5: id=\"a\" is that of the recording in line 2 too"),
            HasSubstr(":6: <Recording>: up=\"w\" is not allowed")));
  EXPECT_THAT(ErrorOf("<Batch/>"), HasSubstr("has no <Recording"));
  EXPECT_THAT(ErrorOf("<Batch lafan1='true'>\n<Recording file='a.c3d'/>\n"
                      "<Recording file='b.c3d' robot='g1.urdf' beyondmimic='true'/>\n</Batch>"),
              AllOf(HasSubstr(":2: <Recording>: lafan1=\"true\" needs robot=\"FILE\""),
                    HasSubstr(":3: <Recording>: beyondmimic=\"true\" needs robotOrder")));
  EXPECT_THAT(ErrorOf("<ConverterConfig type='S2KFConverter'/>"),
              HasSubstr("a manifest starts with <Batch>"));
  EXPECT_THAT(ErrorOf("<Batch><Recording file='a' selfCalibrate='true' subjectFile='b'/></Batch>"),
              HasSubstr("use one"));
  EXPECT_THAT(ErrorOf("<Batch><Recording"), HasSubstr("/data/night.xml:1"));
}

TEST(Manifest, WhatGroupsSayIsNotMultipliedWithoutBound) {
  const std::string text(100'000, 'x');
  std::string recordings;
  for (int i = 0; i < 2000; ++i) recordings += "<Recording file='" + std::to_string(i) + "'/>";
  EXPECT_THAT(ErrorOf("<Batch><Metadata name='a' value='" + text + "'/>" + recordings + "</Batch>"),
              AllOf(HasSubstr("/data/night.xml: its 2000 recordings"), HasSubstr("say less in")));
  EXPECT_THAT(ErrorOf("<Batch config='" + text + "'>" + recordings + "</Batch>"),
              HasSubstr("say less in its groups"));
  std::string groups;
  const std::string group = "<Group name='" + text + text + "'>";
  for (int i = 0; i < 90; ++i) groups += group;
  for (int i = 0; i < 90; ++i) recordings += "</Group>";
  EXPECT_THAT(ErrorOf("<Batch>" + groups + "<Recording file='a'/>" + recordings + "</Batch>"),
              HasSubstr("its 2001 recordings"));
}

TEST(Manifest, AnIdStaysInsideTheFolder) {
  for (const std::string id :
       {"", "/etc/passwd", "../up", "a/../../b", "a//b", "./a", "a/", ".", "a\\b", "\xE9"}) {
    EXPECT_THAT(ErrorOf("<Batch><Recording file='a.c3d' id='" + id + "'/></Batch>"),
                HasSubstr("must be a relative path"))
        << id;
  }
}

TEST(Manifest, APersonHasWhatCalibratingAsksFor) {
  const BatchManifest manifest = Parse(R"(
    <Batch folder="/archive" height_m="1.8" csv="true" plugin="own.so" subjectFile="other.xml">
      <Recording file="a.c3d" person="anna"/>
      <Group person="ben"><Person id="anna" recordings="static.c3d  ../range.c3d" unit="cm"/>
        <Recording file="b.c3d"/><Recording file="c.c3d" selfCalibrate="true"/>
        <Recording file="d.c3d" subjectFile="cleo.xml"/><Recording file="e.c3d" person="size.xml"/>
      </Group>
      <Person id="ben" recordings="my walk.c3d; run.c3d" height_m="1.7"/></Batch>)");
  ASSERT_EQ(manifest.persons.size(), 2U);
  const BatchPerson& anna = manifest.persons.at("anna");
  const BatchPerson& ben = manifest.persons.at("ben");
  EXPECT_THAT(anna.recordings, ElementsAre("/archive/static.c3d", "/range.c3d"));
  EXPECT_THAT(ben.recordings, ElementsAre("/archive/my walk.c3d", "/archive/run.c3d"));
  EXPECT_EQ(anna.settings.request.input.reading.unit, "cm");
  EXPECT_FALSE(anna.settings.request.input.person.size.height);  // the group is of another
  EXPECT_EQ(ben.settings.request.input.person.size.height, 1.7);
  EXPECT_EQ(ben.settings.request.input.person.subject_file, "");
  EXPECT_EQ(ben.settings.request.converter.plugin_file, "/data/own.so");
  EXPECT_EQ(ben.settings.settings.count("csv"), 0U);
  const std::vector<BatchEntry>& entries = manifest.entries;
  EXPECT_EQ(entries[0].person, "anna");
  EXPECT_FALSE(entries[0].request.input.person.size.height);
  EXPECT_EQ(entries[0].request.input.person.subject_file, "");
  EXPECT_EQ(entries[0].request.input.person.processor_file, "");
  EXPECT_EQ(entries[1].person, "ben");
  EXPECT_EQ(entries[2].person, "");
  EXPECT_TRUE(entries[2].request.self_calibrate);
  EXPECT_EQ(entries[3].person, "");
  EXPECT_EQ(entries[3].request.input.person.subject_file, "/data/cleo.xml");
  EXPECT_EQ(entries[4].person, "");
  EXPECT_EQ(entries[4].request.input.person.processor_file, "/data/size.xml");
}

TEST(Manifest, SaysWhatIsWrongWithPersonsAndItsLine) {
  EXPECT_THAT(
      ErrorOf("<Batch>\n<Person id='anna' recordings='a.c3d' height='1.7'/>\n"
              "<Recording file='a.c3d' person='ana'/>\n<Person id='anna' recordings='b.c3d'/>\n"
              "<Person id='ben' recordings=' ; '/>\n<Person recordings='b.c3d'/>\n"
              "<Recording file='b.c3d' person='anna' mass_kg='70'/>\n"
              "<Recording file='c.c3d' person='anna' subjectFile='s.xml'/>\n"
              "<Person id='../c' recordings='a'><Metadata name='a' value='b'/></Person>\n</Batch>"),
      AllOf(
          HasSubstr("/data/night.xml:2: <Person>: unknown attribute height; did you mean height_m"),
          HasSubstr(":3: <Recording>: person=\"ana\" is neither the id of a <Person> nor a file; "
                    "did you mean anna?"),
          HasSubstr(":4: id=\"anna\" is that of the person in line 2 too"),
          HasSubstr(":5: <Person> needs id"), HasSubstr(":6: <Person> needs id"),
          HasSubstr(":7: <Recording>: mass_kg is to be said of <Person id=\"anna\">"),
          HasSubstr(":8: person=\"anna\" says who it is"),
          HasSubstr(":9: id=\"../c\" names the outputs"), HasSubstr(":9: <Person> has no")));
}

TEST(Manifest, TheTemplateIsAManifestAndNamesEveryAttribute) {
  const BatchManifest manifest = Parse(ManifestTemplate());
  EXPECT_EQ(manifest.entries.size(), 4U);
  EXPECT_THAT(ManifestTemplate(), AllOf(HasSubstr("  height_m "), HasSubstr("  csv ")));
}

TEST(Manifest, ShardsAreAPartition) {
  std::string xml = "<Batch>";
  for (int i = 0; i < 11; ++i) xml += "<Recording file='" + std::to_string(i) + ".c3d'/>";
  const BatchManifest manifest = Parse(xml + "</Batch>");
  std::multiset<std::string> ids;
  for (int shard = 1; shard <= 4; ++shard) {
    const std::vector<const BatchEntry*> part = ShardOf(manifest.entries, shard, 4);
    EXPECT_GE(part.size(), 2U);
    EXPECT_LE(part.size(), 3U);
    for (const BatchEntry* entry : part) ids.insert(entry->id);
  }
  EXPECT_EQ(ids.size(), 11U);
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), 11U);
  EXPECT_EQ(ShardOf(manifest.entries, 1, 1).size(), 11U);
  EXPECT_TRUE(ShardOf(manifest.entries, 20, 20).empty());
}

}  // namespace
}  // namespace mmm_converter
