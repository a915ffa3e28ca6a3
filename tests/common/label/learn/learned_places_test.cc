// SPDX-License-Identifier: MIT
#include "common/label/learn/learned_places.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/label/learn/learn_doubts.h"
#include "tests/common/label/made_person.h"

namespace mmm_converter::testing {
namespace {

/// All labels of a made person, places learnt from a posture that is right.
class LearnedPlacesTest : public ::testing::Test {
 protected:
  LearnedPlacesTest()
      : made_(61, 6),
        sites_(made_.model, made_.setup.joints),
        frames_(ChooseLearnFrames({&made_.recording}, FindCommonLabels({&made_.recording}))),
        deviations_(DistanceDeviations(frames_)),
        named_(static_cast<std::size_t>(made_.recording.num_labels())) {}

  LearnedPlaces Learn() const {
    LearnedPlaces learned(sites_, frames_, deviations_, named_);
    learned.Start(0, PostureOfFirst());
    learned.Iterate(3, 5);
    learned.Iterate(3, 15);
    return learned;
  }

  // The recording's frame that is the first of those chosen.
  Posture PostureOfFirst() const {
    for (int k = 0; k < made_.recording.num_frames(); ++k) {
      if (made_.recording.frame(k) == frames_[0].z) return made_.PostureAt(k);
    }
    ADD_FAILURE() << "no such frame";
    return {};
  }

  // Of each label, by the model.
  int TrueSite(int label) const {
    for (std::size_t s = 0; s < sites_.sites().size(); ++s) {
      const auto& markers = sites_.sites()[s].markers;
      const MarkerIx marker = made_.setup.assignments()[label].marker;
      if (std::count(markers.begin(), markers.end(), marker) > 0) return static_cast<int>(s);
    }
    return -1;
  }

  MadePerson made_;
  BodySites sites_;
  std::vector<LearnFrame> frames_;
  Eigen::MatrixXd deviations_;
  std::vector<NamedPlace> named_;
};

TEST_F(LearnedPlacesTest, LabelsAreOnTheSitesThatTheyMoveWith) {
  const LearnedPlaces learned = Learn();
  int right = 0;
  for (int l = 0; l < made_.recording.num_labels(); ++l) {
    right += learned.places()[l].site == TrueSite(l) ? 1 : 0;
  }
  EXPECT_GE(right, made_.recording.num_labels() - 4);
  EXPECT_LT(learned.mean_distance(), 0.01);
}

TEST_F(LearnedPlacesTest, TheCostIsTheSumOverTheLabels) {
  const LearnedPlaces learned = Learn();
  double sum = 0;
  for (std::size_t l = 0; l < learned.places().size(); ++l) {
    const WornPlace& worn = learned.places()[l];
    ASSERT_GE(worn.site, 0);
    const auto costs = learned.costs().row(static_cast<Eigen::Index>(l));
    sum += costs[worn.site];
    EXPECT_EQ(costs.minCoeff(), costs[worn.site]);
    EXPECT_GE(worn.lead, 0);
  }
  EXPECT_NEAR(learned.cost(), sum, 1e-6);
}

TEST_F(LearnedPlacesTest, ALabelOnAnotherSiteCostsMore) {
  const LearnedPlaces learned = Learn();
  const int site = learned.places()[0].site;
  const double stays = learned.Moved({}, -1, 2)->cost();
  for (const int other : sites_.Neighbours(site)) {
    EXPECT_GT(learned.Moved({0}, other, 2)->cost(), stays);
  }
}

TEST_F(LearnedPlacesTest, WhatANameContradictsCostsMore) {
  const double before = Learn().cost();
  const int site = Learn().places()[0].site;
  named_[0].site = site;
  EXPECT_EQ(Learn().cost(), before);
  named_[0].site = site == 0 ? 1 : 0;
  EXPECT_GT(Learn().cost(), before + 1);
}

// No posture is given.
TEST_F(LearnedPlacesTest, PlacesTellHowTheBodyStands) {
  std::vector<WornPlace> places;
  for (int l = 0; l < made_.recording.num_labels(); ++l) {
    const ModelMarker& marker = made_.model.markers()[made_.setup.assignments()[l].marker];
    const auto [site, p_SM] = sites_.OnSite(marker.segment, marker.p_SM);
    places.push_back({site, p_SM, 0.028, 0});
  }
  LearnedPlaces learned(sites_, frames_, deviations_, named_);
  learned.Start(places);
  for (int l = 0; l < made_.recording.num_labels(); ++l) {
    EXPECT_EQ(learned.places()[static_cast<std::size_t>(l)].site, TrueSite(l)) << l;
  }
  EXPECT_LT(learned.mean_distance(), 0.012);
}

TEST_F(LearnedPlacesTest, LabelsOfTheOtherSideAreDoubted) {
  const LearnedPlaces learned = Learn();
  std::vector<std::string> names = made_.recording.labels();
  const auto left = std::find(names.begin(), names.end(), "LELB") != names.end()
                        ? std::find(names.begin(), names.end(), "LELB")
                        : std::find(names.begin(), names.end(), "LANK");
  const auto right = std::find(names.begin(), names.end(), "R" + left->substr(1));
  ASSERT_NE(right, names.end());
  const auto exchanged = static_cast<std::size_t>(left - names.begin());
  std::swap(*left, *right);
  LearnedMarkers markers;
  for (const std::string& name : names) {
    LearnedMarker marker;
    marker.label = name;
    marker.segment = "somewhere";
    marker.probability = 1;
    markers.markers.push_back(marker);
  }
  LeaveOutDoubtful({sites_, learned, deviations_, names, named_}, &markers);
  EXPECT_NE(markers.markers[exchanged].left_out, "");
  int used = 0;
  for (const LearnedMarker& marker : markers.markers) used += marker.left_out.empty() ? 1 : 0;
  EXPECT_GE(used, made_.recording.num_labels() - 10);
}

TEST_F(LearnedPlacesTest, WhatIsNotProbableIsLeftOut) {
  const LearnedPlaces learned = Learn();
  LearnedMarkers markers;
  for (const std::string& name : made_.recording.labels()) {
    LearnedMarker marker;
    marker.label = name;
    marker.probability = 0.89;
    markers.markers.push_back(marker);
  }
  LeaveOutDoubtful({sites_, learned, deviations_, made_.recording.labels(), named_}, &markers);
  for (const LearnedMarker& marker : markers.markers) EXPECT_NE(marker.left_out, "");
}

}  // namespace
}  // namespace mmm_converter::testing
