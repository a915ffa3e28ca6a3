// SPDX-License-Identifier: MIT
// Motions of skeletons become motions of a body.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "common/io/tables/bvh_writer.h"
#include "common/model/forward_kinematics.h"
#include "common/model/subject.h"
#include "common/motion/marker_synthesis.h"
#include "common/pipeline/conversion.h"
#include "tests/support/made_skeleton.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using testing::SkeletonStyle;

/// Someone other than the model: longer legs, shorter arms, broader.
KinematicModel Person(double collar = 1.08) {
  Subject subject;
  for (const std::string side : {"L", "R"}) {
    subject.scales.push_back({side + "Ksegment_joint", 1.06, 0, 0});
    subject.scales.push_back({side + "Asegment_joint", 1.03, 0, 0});
    subject.scales.push_back({side + "Esegment_joint", 0.94, 0, 0});
    subject.scales.push_back({side + "Wsegment_joint", 0.97, 0, 0});
    subject.scales.push_back({side + "SCsegment_joint", collar, 0, 0});
  }
  return FitToSubject(testing::ScaledReferenceModel(1.7), subject);
}

ConversionReport Convert(const std::string& text) {
  ConversionRequest request;
  request.input.file = testing::TestFolder() + "/walk.bvh";
  request.output = testing::TestFolder() + "/motion.xml";
  std::ofstream(request.input.file, std::ios::binary) << text;
  return RunConversion(request, {}, {});
}

constexpr std::pair<const char*, const char*> kLimbs[] = {{"Hsegment_joint", "Ksegment_joint"},
                                                          {"Ksegment_joint", "Asegment_joint"},
                                                          {"Ssegment_joint", "Esegment_joint"},
                                                          {"Esegment_joint", "Wsegment_joint"}};

/// Mean angle between limbs of two motions [degrees].
double LimbError(const KinematicModel& person, const PoseTrajectory& truth,
                 const ConversionReport& report) {
  double sum = 0;
  int count = 0;
  const KinematicModel& model = *report.plan.setup.model;
  for (int k = 0; k < truth.num_frames(); ++k) {
    const auto X = SegmentPoses(person, ModelPosture(person, truth, k));
    const auto Y = SegmentPoses(model, ModelPosture(model, report.result.trajectory, k));
    for (const std::string side : {"L", "R"}) {
      for (const auto& limb : kLimbs) {
        const auto along = [&](const KinematicModel& of, const auto& poses) {
          const auto at = [&](const char* name) {
            return poses[static_cast<std::size_t>(of.FindSegment(side + name))].translation();
          };
          return Eigen::Vector3d((at(limb.second) - at(limb.first)).normalized());
        };
        sum += std::acos(std::clamp(along(person, X).dot(along(model, Y)), -1.0, 1.0));
        ++count;
      }
    }
  }
  return 180 / EIGEN_PI * sum / count;
}

TEST(SkeletonConversion, HasTheLimbsOfTheSkeleton) {
  const KinematicModel person = Person();
  const PoseTrajectory motion = testing::RangeOfMotion(person, 1, 0.5, 4);
  const SkeletonStyle kStyles[] = {
      {"ZYX", SkeletonStyle::Zero::kAllAlongX, SkeletonStyle::Names::kLafan, 0.01, true, false},
      {"YXZ", SkeletonStyle::Zero::kT, SkeletonStyle::Names::kXsens, 1, true, true},
      {"XYZ", SkeletonStyle::Zero::kA, SkeletonStyle::Names::kSmpl, 0.01, false, false}};
  for (const SkeletonStyle& style : kStyles) {
    const ConversionReport report = Convert(testing::MakeSkeleton(person, motion, style).bvh);
    EXPECT_LT(LimbError(person, motion, report), 2) << style.order;
    EXPECT_EQ(report.verdict.level, Verdict::Level::kGood)
        << style.order << ": " << ::testing::PrintToString(report.verdict.reasons);
    EXPECT_NEAR(report.plan.person.height.value, 1.73, 0.05);
  }
}

TEST(SkeletonConversion, NarrowShouldersAreNoFaultOfTheArms) {
  const KinematicModel person = Person(0.5);
  const PoseTrajectory motion = testing::RangeOfMotion(person, 1, 0.5, 4);
  EXPECT_LT(LimbError(person, motion, Convert(testing::MakeSkeleton(person, motion, {}).bvh)), 2);
}

TEST(SkeletonConversion, WhatIsExportedIsConvertedToTheSameMotion) {
  const KinematicModel person = Person();
  const PoseTrajectory motion = testing::RangeOfMotion(person, 1, 0.5, 5);
  const ConversionReport report = Convert(Join(FormatBvh(person, motion)));
  EXPECT_LT(LimbError(person, motion, report), 2);
}

TEST(RealSkeletonConversion, IsOfTheSamePose) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  ConversionRequest request;
  request.input.file = testing::SharedData("motions/bvh-toolbox__walk01.bvh");
  request.output = testing::TestFolder() + "/motion.xml";
  const ConversionReport report = RunConversion(request, {}, {});
  EXPECT_LT(report.figures.distance.mean, 0.02);
  EXPECT_EQ(report.plan.person.height.source, "by the lengths of the skeleton");
  EXPECT_EQ(report.verdict.level, Verdict::Level::kGood)
      << ::testing::PrintToString(report.verdict.reasons);
}

}  // namespace
}  // namespace mmm_converter
