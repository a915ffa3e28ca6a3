// SPDX-License-Identifier: MIT
#include "common/label/learn/computed_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/motion/marker_synthesis.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::testing {
namespace {

using ::testing::HasSubstr;

struct Made {
  std::vector<std::string> labels;
  std::vector<LearnFrame> frames;

  Eigen::Index ColumnOf(const std::string& label) const {
    return std::find(labels.begin(), labels.end(), label) - labels.begin();
  }
  /// place(z): of the point in a frame.
  template <typename Place>
  void Add(const std::string& label, Place place) {
    for (LearnFrame& frame : frames) {
      const Eigen::Vector3d p = place(frame.z);
      frame.z.conservativeResize(3, frame.z.cols() + 1);
      frame.z.rightCols<1>() = p;
    }
    labels.push_back(label);
  }
};

// A person whose skin moves by 4 mm; rigid: as generated from a model.
Made MakePerson(bool is_rigid = false) {
  const KinematicModel model = ScaledReferenceModel(1.75);
  MarkerErrors errors;
  errors.offset = 0;
  if (is_rigid) errors.wobble = errors.noise = 0;
  const MarkerSequence recorded =
      SynthesizeMarkers(model, RangeOfMotion(model, 6, 0.5, 3), errors, 3);
  Made made;
  const CommonLabels labels = FindCommonLabels({&recorded});
  made.labels = labels.names;
  made.frames = ChooseLearnFrames({&recorded}, labels);
  return made;
}

TEST(ComputedPointsTest, MarkersAreMarkers) {
  for (const bool is_rigid : {false, true}) {
    const Made made = MakePerson(is_rigid);
    for (const std::string& why : WhyNoMarkers(made.labels, made.frames)) EXPECT_EQ(why, "");
  }
}

TEST(ComputedPointsTest, EachKindIsFoundWithItsReasonAndNothingElse) {
  Made made = MakePerson();
  const auto markers = made.labels.size();
  const auto at = [&](const Eigen::Matrix3Xd& z, const char* label) -> Eigen::Vector3d {
    return z.col(made.ColumnOf(label));
  };
  made.Add("LHipAngles", [](const auto&) { return Eigen::Vector3d(0.01, 0.02, 0.03); });
  made.Add("pelvis front", [&](const auto& z) -> Eigen::Vector3d {
    return 0.4 * at(z, "LASI") + 0.6 * at(z, "RASI");
  });
  made.Add("HC", [&](const auto& z) -> Eigen::Vector3d {
    const Eigen::Vector3d a = at(z, "LASI"), b = at(z, "RASI"), c = at(z, "LPSI");
    Eigen::Matrix3d R;
    R.col(1) = (a - b).normalized();
    R.col(2) = (a - c).cross(R.col(1)).normalized();
    R.col(0) = R.col(1).cross(R.col(2));
    return (a + b) / 2 + R * Eigen::Vector3d(-0.05, 0.08, -0.09);
  });
  made.Add("plate", [](const auto&) { return Eigen::Vector3d(0.4, 0.2, 0); });
  made.Add("copy", [&](const auto& z) { return at(z, "C7"); });
  made.Add("force", [&](const auto& z) -> Eigen::Vector3d { return 800 * at(z, "C7"); });
  made.labels.back() = "f";
  const std::vector<std::string> why = WhyNoMarkers(made.labels, made.frames);
  const std::vector<std::string> expected = {"by its name",  "always between",  "in axes of",
                                             "stands still", "always where C7", "away from"};
  for (std::size_t l = 0; l < why.size(); ++l) {
    if (l < markers) {
      EXPECT_EQ(why[l], "") << made.labels[l];
    } else {
      EXPECT_THAT(why[l], HasSubstr(expected[l - markers])) << made.labels[l];
    }
  }
}

TEST(ComputedPointsTest, PointsThatAreHardlySeenAreNotJudged) {
  Made made = MakePerson();
  for (std::size_t k = 5; k < made.frames.size(); ++k) made.frames[k].z.setConstant(std::nan(""));
  for (const std::string& why : WhyNoMarkers(made.labels, made.frames)) EXPECT_EQ(why, "");
}

}  // namespace
}  // namespace mmm_converter::testing
