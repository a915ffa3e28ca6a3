// SPDX-License-Identifier: MIT
#include "common/label/track/relabelled.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// A text for each point: label@place, then begin-end:from.
std::vector<std::string> Texts(const std::vector<RelabelledPoint>& points) {
  std::vector<std::string> texts;
  for (const RelabelledPoint& point : points) {
    std::string text = point.label + "@" + std::to_string(point.place);
    for (const PointStretch& one : point.stretches) {
      text += " " + std::to_string(one.begin) + "-" + std::to_string(one.end) + ":" +
              std::to_string(one.from);
    }
    texts.push_back(text);
  }
  return texts;
}

NamedPiece Piece(int point, int begin, int end, int name) {
  return {LabelIx(point), begin, end, name, 0.99};
}

std::vector<std::string> Texts(const std::vector<LabelChange>& changes) {
  std::vector<std::string> texts;
  texts.reserve(changes.size());
  for (const LabelChange& one : changes) {
    texts.push_back(std::to_string(one.point) + " " + std::to_string(one.begin) + "-" +
                    std::to_string(one.end) + " " + one.from + ">" + one.to);
  }
  return texts;
}

TEST(Relabelled, WhatChangesNothingGivesEachPointAllItsFrames) {
  const Labelling labelling{{"A", "B"}, {Piece(0, 2, 5, 0), Piece(1, 0, 4, 1), Piece(1, 6, 7, 1)}};
  const std::vector<std::string> labels = {"A", "B", "Ball", "*7"};
  EXPECT_THAT(Texts(RelabelledPoints(labelling, labels, 10)),
              ElementsAre("A@0 0-10:0", "B@1 0-10:1", "Ball@2 0-10:2", "*7@3 0-10:3"));
  EXPECT_THAT(ChangesOf(labelling, labels), IsEmpty());
}

TEST(Relabelled, BrokenTrajectoriesAreJoinedAndWhatHasNoNameStays) {
  // Two points are one marker one after the other; a third is nobody's; the second has a ghost.
  const Labelling labelling{
      {"A"}, {Piece(0, 0, 4, 0), Piece(1, 5, 8, 0), Piece(1, 8, 9, -1), Piece(2, 0, 10, -1)}};
  const std::vector<std::string> labels = {"*1", "*2", "*5"};
  EXPECT_THAT(Texts(RelabelledPoints(labelling, labels, 10)),
              ElementsAre("A@0 0-5:0 5-8:1 8-10:0", "*2@1 0-5:1 8-10:1", "*5@2 0-10:2"));
  EXPECT_THAT(Texts(ChangesOf(labelling, labels)), ElementsAre("0 0-4 *1>A", "1 5-8 *2>A"));
}

TEST(Relabelled, ExchangedLabelsAreExchangedBack) {
  const Labelling labelling{{"A", "B"},
                            {Piece(0, 0, 4, 0), Piece(0, 4, 6, 1), Piece(0, 6, 10, 0),
                             Piece(1, 0, 4, 1), Piece(1, 4, 6, 0), Piece(1, 6, 10, 1)}};
  EXPECT_THAT(Texts(RelabelledPoints(labelling, {"A", "B"}, 10)),
              ElementsAre("A@0 0-4:0 4-6:1 6-10:0", "B@1 0-4:1 4-6:0 6-10:1"));
  EXPECT_THAT(Texts(ChangesOf(labelling, {"A", "B"})), ElementsAre("0 4-6 A>B", "1 4-6 B>A"));
}

TEST(Relabelled, AWrongLabelIsTakenAwayAndTheLabelStays) {
  const Labelling labelling{{"A", "B"}, {Piece(0, 0, 10, -1), Piece(1, 0, 5, 1)}};
  const std::vector<std::string> labels = {"A", "B", "*1"};
  EXPECT_THAT(Texts(RelabelledPoints(labelling, labels, 10)),
              ElementsAre("A@0", "*2@0 0-10:0", "B@1 0-10:1", "*1@2 0-10:2"));
  EXPECT_THAT(Texts(ChangesOf(labelling, labels)), ElementsAre("0 0-10 A>"));
}

TEST(Relabelled, LabelsAreComparedAsLabelsAre) {
  const Labelling labelling{{"LFHD"}, {Piece(0, 0, 3, 0)}};
  EXPECT_THAT(Texts(RelabelledPoints(labelling, {"l.fhd"}, 3)), ElementsAre("LFHD@0 0-3:0"));
  EXPECT_THAT(ChangesOf(labelling, {"l.fhd"}), IsEmpty());
}

TEST(Relabelled, APointWithoutALabelGoesWhereAllOfItHasAName) {
  const Labelling labelling{{"A"}, {Piece(0, 0, 2, 0), Piece(1, 2, 9, 0)}};
  EXPECT_THAT(Texts(RelabelledPoints(labelling, {"*1", ""}, 9)), ElementsAre("A@1 0-2:0 2-9:1"));
}

TEST(Relabelled, PiecesOfOneNameAreOneChange) {
  const Labelling labelling{
      {"A", "B"}, {Piece(0, 7, 9, 1), Piece(0, 0, 2, 0), Piece(0, 3, 4, 0), Piece(0, 5, 6, 1)}};
  EXPECT_THAT(Texts(ChangesOf(labelling, {"*1"})), ElementsAre("0 0-4 *1>A", "0 5-9 *1>B"));
}

TEST(Relabelled, EveryMeasuredPositionIsThereOnce) {
  MarkerSequence recording({"A", "*1", "*2"}, 4, 100, 0.5);
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i < 3; ++i) recording.frame(k).col(i).setConstant(10 * k + i);
  }
  const Labelling labelling{{"A", "B"},
                            {Piece(0, 0, 2, 0), Piece(0, 2, 4, -1), Piece(1, 0, 4, 1),
                             Piece(2, 2, 4, 0), Piece(2, 0, 2, -1)}};
  const auto points = RelabelledPoints(labelling, recording.labels(), 4);
  const MarkerSequence out = Relabelled(points, recording);
  EXPECT_THAT(out.labels(), ElementsAre("A", "*3", "B", "*2"));
  EXPECT_EQ(out.first_time(), 0.5);
  for (int k = 0; k < 4; ++k) {
    std::vector<double> there;
    for (int i = 0; i < out.num_labels(); ++i) {
      if (IsSeen(out.frame(k).col(i))) there.push_back(out.frame(k)(0, i));
    }
    EXPECT_THAT(there, ::testing::UnorderedElementsAre(10 * k, 10 * k + 1, 10 * k + 2));
  }
}

// Two that are exchanged all along keep their labels, and so does one without a name; two that are
// exchanged for a while do not, nor one whose name another point has.
TEST(KeepLabelsOfAllFrames, AsFarAsTheNamesAreFree) {
  const std::vector<std::string> labels = {"a", "b", "c", "d", "e", "f", "g"};
  Labelling labelling = {
      labels,
      {Piece(0, 0, 9, 1), Piece(1, 0, 9, 0), Piece(2, 0, 4, 2), Piece(2, 4, 9, 3),
       Piece(3, 0, 4, 3), Piece(3, 4, 9, 2), Piece(4, 0, 9, -1), Piece(5, 0, 9, -1),
       Piece(6, 0, 4, 6), Piece(6, 4, 9, 5)}};
  const auto names_keeping = [&](const std::set<std::string>& kept) {
    Labelling own = labelling;
    KeepLabelsOfAllFrames(labels, kept, &own);
    std::vector<int> names;
    for (const NamedPiece& piece : own.pieces) names.push_back(piece.name);
    return names;
  };
  EXPECT_EQ(names_keeping({labels.begin(), labels.end()}),
            (std::vector<int>{0, 1, 2, 3, 3, 2, 4, -1, 6, 5}));
  EXPECT_EQ(names_keeping({"a", "e"}), (std::vector<int>{1, 0, 2, 3, 3, 2, 4, -1, 6, 5}))
      << "the name of a is another point's";
}

}  // namespace
}  // namespace mmm_converter
