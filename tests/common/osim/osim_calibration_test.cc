// SPDX-License-Identifier: MIT
//
// Persons who are known: bodies of other sizes than the model's, with markers elsewhere.
#include "common/osim/osim_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "common/calibrate/body_fit.h"
#include "common/calibrate/body_kinematics.h"
#include "common/calibrate/offset_prior.h"
#include "common/io/bytes/file_content.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_scaling.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/model/kit_joints.h"
#include "common/motion/marker_synthesis.h"
#include "common/osim/osim_sizes.h"
#include "common/support/error.h"
#include "tests/support/all_indices.h"
#include "tests/support/osim_texts.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

OsimDocument DocumentOf(const std::string& text) {
  Diagnostics diagnostics("m.osim");
  return ParseOsim(text, {}, &diagnostics);
}

std::vector<int> AllJoints(const KinematicModel& model) {
  return testing::AllIndices<int>(model.num_joints());
}

Posture AnyPosture(const KinematicModel& model, std::mt19937* random) {
  std::uniform_real_distribution<double> share(-0.3, 0.3);
  Posture q = RestPosture(model);
  q.orientation =
      Eigen::Quaterniond(1, share(*random), share(*random), share(*random)).normalized();
  for (int j = 0; j < model.num_joints(); ++j) {
    q.joint_angles[j] += share(*random);
    const Segment& joint = model.joint(j);
    q.joint_angles[j] = std::min(std::max(q.joint_angles[j], joint.lower), joint.upper);
  }
  return q;
}

/// How far markers of one model are from those of another at some postures [m].
double FarthestMarkers(const KinematicModel& a, const KinematicModel& b) {
  std::mt19937 random(7);
  double most = 0;
  for (int i = 0; i < 20; ++i) {
    const Posture q = AnyPosture(a, &random);
    most = std::max(most, (MarkerPositions(a, q) - MarkerPositions(b, q)).cwiseAbs().maxCoeff());
  }
  return most;
}

/// By body, ground first: all different.
std::vector<Eigen::Vector3d> SomeFactors(const OsimDocument& document) {
  std::vector<Eigen::Vector3d> factors = {Eigen::Vector3d::Ones()};
  for (std::size_t i = 1; i < document.bodies.size(); ++i) {
    const double f = 0.8 + 0.37 * std::fmod(0.61803 * static_cast<double>(i), 1);
    factors.emplace_back(f, 1.05 * f, 0.9 * f);
  }
  return factors;
}

// What is scaled without its text moves as what is written and read again.
void ExpectTheWrittenModelMovesAsTheScaledOne(const std::string& text) {
  const OsimDocument document = DocumentOf(text);
  const std::vector<Eigen::Vector3d> factors = SomeFactors(document);
  OsimScaling scaling;
  for (std::size_t i = 1; i < factors.size(); ++i) {
    scaling.factors[document.bodies[i].name] = factors[i];
  }
  OsimDocument scaled = ScaleOsimDocument(document, factors);
  for (std::size_t m = 0; m < scaled.markers.size(); ++m) {
    scaled.markers[m].p_BM += Eigen::Vector3d(0.01, -0.02, 0.001 * static_cast<double>(m));
  }
  const std::string written = WriteOsimMarkers(ScaleOsim(text, "m.osim", scaling, nullptr),
                                               "m.osim", document, scaled.markers);
  Diagnostics diagnostics("m.osim");
  EXPECT_LT(FarthestMarkers(MakeOsimModel(scaled, &diagnostics), ParseOsimModel(written, "m.osim")),
            1e-12);
}

TEST(OsimCalibration, TheWrittenModelMovesAsTheScaledOne) {
  ExpectTheWrittenModelMovesAsTheScaledOne(testing::OsimOfAllKinds());
}

TEST(OsimCalibrationRealFiles, TheWrittenModelMovesAsTheScaledOne) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  ExpectTheWrittenModelMovesAsTheScaledOne(
      ReadFileContent(testing::SharedData("osim/subject01_simbody.osim")));
}

TEST(OsimSizes, BodiesThatNothingTellsApartHaveOne) {
  using testing::OsimBodyText;
  using testing::OsimCoordinateText;
  using testing::OsimJointText;
  const auto pin = [](const std::string& name, const std::string& parent, const std::string& child,
                      const std::string& more = "") {
    return OsimJointText(
        "PinJoint", name, parent, child,
        "<coordinates>" + OsimCoordinateText(name + "_angle", more) + "</coordinates>");
  };
  std::string bodies, joints = OsimJointText("WeldJoint", "root", "ground", "pelvis");
  for (const char* body :
       {"pelvis", "femur_r", "patella_r", "talus_r", "calcn_r", "toes_r", "femur_l", "nose"}) {
    bodies += OsimBodyText(body);
  }
  joints += pin("hip_r", "pelvis", "femur_r") + pin("patellofemoral_r", "femur_r", "patella_r") +
            pin("ankle_r", "femur_r", "talus_r") + pin("subtalar_r", "talus_r", "calcn_r") +
            pin("mtp_r", "calcn_r", "toes_r", "<locked>true</locked>") +
            pin("hip_l", "pelvis", "femur_l") +
            OsimJointText("WeldJoint", "face", "pelvis", "nose");
  const OsimDocument document = DocumentOf(testing::OsimText(bodies, joints));
  //                                    ground pelvis femur  patella talus calcn toes  left  nose
  const OsimSizes sizes =
      FindOsimSizes(document, {false, true, true, false, false, true, true, true, true});
  EXPECT_THAT(sizes.size_of, ElementsAre(-1, 0, 1, 1, 2, 2, 2, 3, 0));
  EXPECT_THAT(sizes.bodies, ElementsAre(1, 2, 5, 7));
  EXPECT_THAT(sizes.mirror, ElementsAre(::testing::Pair(1, 3)));
}

TEST(OsimSizes, NamesHaveSides) {
  EXPECT_EQ(MirroredOsimName("femur_r"), "femur_l");
  EXPECT_EQ(MirroredOsimName("l_hand"), "r_hand");
  EXPECT_EQ(MirroredOsimName("LeftFoot"), "RightFoot");
  EXPECT_EQ(MirroredOsimName("torso"), "");
}

// Positions are linear in scales: rounding is left, 1e-16 / 1e-3.
TEST(OsimCalibration, SlopesBySizesAreThoseOfDifferences) {
  const OsimDocument document = DocumentOf(testing::OsimOfAllKinds());
  const auto rescale = [&](const Eigen::VectorXd& scales) {
    Diagnostics diagnostics("m.osim");
    std::vector<Eigen::Vector3d> factors(document.bodies.size(), Eigen::Vector3d::Ones());
    for (Eigen::Index i = 0; i < scales.size(); ++i) factors[i + 1].setConstant(scales[i]);
    return MakeOsimModel(ScaleOsimDocument(document, factors), &diagnostics);
  };
  const auto n = static_cast<Eigen::Index>(document.bodies.size()) - 1;
  const KinematicModel model = rescale(Eigen::VectorXd::Ones(n));
  BodySizes sizes;
  sizes.lengths.segments.assign(n, 0);
  sizes.rescale = rescale;
  BodyKinematics kinematics(model, AllJoints(model),
                            testing::AllIndices<MarkerIx>(model.markers().size()), sizes);
  std::mt19937 random(3);
  const Posture q = AnyPosture(model, &random);
  Body body = kinematics.ModelBody();
  for (Eigen::Index i = 0; i < n; ++i) body.scales[i] = 0.9 + 0.05 * static_cast<double>(i % 5);
  body.offsets.setConstant(0.02);
  const auto place = [&](const Body& one) -> Eigen::VectorXd {
    kinematics.SetBody(one);
    BodyJacobian at = kinematics.MakeJacobian();
    kinematics.Compute(q, &at);
    return at.posture.p_WM.reshaped();
  };
  kinematics.SetBody(body);
  BodyJacobian at = kinematics.MakeJacobian();
  kinematics.Compute(q, &at);
  for (Eigen::Index i = 0; i < n; ++i) {
    Body more = body, less = body;
    more.scales[i] += 1e-3;
    less.scales[i] -= 1e-3;
    const Eigen::VectorXd slope = (place(more) - place(less)) / 2e-3;
    EXPECT_LT((slope - at.J_scales.col(i)).cwiseAbs().maxCoeff(), 1e-10) << i;
  }
  EXPECT_GT(at.J_scales.cwiseAbs().maxCoeff(), 0.1);
}

// Central differences: 1e-16 / 1e-6 of a cost of some tens.
TEST(OsimCalibration, OffsetsOfBothSidesAreAssumedAlike) {
  const KinematicModel model = ParseOsimModel(testing::OsimOfAllKinds(), "m.osim");
  BodySizes sizes;
  sizes.lengths.segments.assign(3, 0);
  sizes.rescale = [&](const Eigen::VectorXd& /*scales*/) {
    return KinematicModel(DescriptionOf(model));
  };
  const Eigen::Vector3d across(0, 0, 1);
  sizes.lines = across.replicate(1, 1);
  sizes.mirrors = {{0, 1, Eigen::Matrix3d::Identity() - 2 * across * across.transpose()}};
  const BodyKinematics kinematics(model, AllJoints(model),
                                  testing::AllIndices<MarkerIx>(model.markers().size()), sizes);
  CalibrationOptions options;
  options.side_correlation = 0.5;
  const OffsetPrior prior(
      kinematics, options,
      PlaceDeviations(options,
                      Eigen::VectorXd::Ones(static_cast<Eigen::Index>(model.markers().size()))));
  Eigen::Matrix3Xd offsets = 0.05 * Eigen::Matrix3Xd::Random(3, model.markers().size());
  BodyEquations body(kinematics);
  body.SetZero();
  prior.Add(offsets, &body);
  for (Eigen::Index i = 0; i < offsets.size(); ++i) {
    Eigen::Matrix3Xd more = offsets, less = offsets;
    more.reshaped()[i] += 1e-6;
    less.reshaped()[i] -= 1e-6;
    EXPECT_NEAR(body.g[i], -(prior.Cost(more) - prior.Cost(less)) / 4e-6, 1e-6) << i;
  }
  const Eigen::MatrixXd known = Eigen::MatrixXd::Zero(body.size(), body.size());
  offsets.col(0) << 0.03, -0.02, 0.04;
  offsets.col(1) = sizes.mirrors.front().R_ba * offsets.col(0);
  const double alike = prior.Cost(offsets);
  EXPECT_GT(prior.LikelyCorrelation(offsets, known), options.side_correlation);
  offsets.col(1) = -offsets.col(1);
  EXPECT_GT(prior.Cost(offsets), alike);
  EXPECT_LT(prior.LikelyCorrelation(offsets, known), options.side_correlation);
}

// ------------------------------------------------------------------------- a person who is known

const std::map<std::string, double> kSizes = {
    {"torso", 1.1},    {"pelvis", 1.02},  {"femur_r", 1.15}, {"femur_l", 1.15},
    {"tibia_r", 1.04}, {"tibia_l", 1.04}, {"foot_r", 1.08},  {"foot_l", 1.08}};

struct KnownPerson {
  std::string generic;
  KinematicModel model;
  MarkerSequence markers;
  std::vector<CalibrationRecording> recordings;
};

/// Every joint swings for 6 s by up to 0.5 rad, at a frequency of its own.
PoseTrajectory Swinging(const KinematicModel& model, double reach) {
  PoseTrajectory motion;
  motion.rate = 50;
  for (int j = 0; j < model.num_joints(); ++j) motion.joint_names.push_back(model.joint(j).name);
  for (int k = 0; k < 300; ++k) {
    Posture& q = motion.postures.emplace_back(RestPosture(model));
    for (int j = 0; j < model.num_joints(); ++j) {
      const Segment& joint = model.joint(j);
      const bool is_limited = !HasNoLimits(joint);
      const double mean = is_limited ? 0.5 * (joint.lower + joint.upper) : joint.rest;
      const double swing = is_limited ? std::min(reach, 0.45 * (joint.upper - joint.lower)) : reach;
      q.joint_angles[j] = mean + swing * std::sin((1 + 0.23 * j) * k / motion.rate + j);
    }
  }
  return motion;
}

KnownPerson MakeKnownPerson(const MarkerErrors& errors, double reach, int seed) {
  const std::string generic = ReadFileContent(testing::SourcePath("examples/opensim/generic.osim"));
  OsimScaling scaling;
  for (const auto& [body, size] : kSizes) scaling.factors[body].setConstant(size);
  KinematicModel model = ParseOsimModel(ScaleOsim(generic, "m.osim", scaling, nullptr), "m.osim");
  MarkerSequence markers = SynthesizeMarkers(model, Swinging(model, reach), errors, seed);
  return {generic, std::move(model), std::move(markers), {}};
}

/// more: another recording of the person, or null.
CalibratedOsim Calibrate(const KnownPerson& person, std::optional<double> mass, Warnings* warnings,
                         const MarkerSequence* more = nullptr) {
  const KinematicModel reference = ParseOsimModel(person.generic, "m.osim");
  std::vector<CalibrationRecording> recordings;
  for (const MarkerSequence* markers : {&person.markers, more}) {
    if (markers == nullptr) continue;
    CalibrationRecording& recording = recordings.emplace_back();
    recording.markers = markers;
    for (int label = 0; label < markers->num_labels(); ++label) {
      MarkerAssignment& one = recording.assignments.emplace_back();
      one.label = LabelIx(label);
      one.marker = MarkerIx(reference.FindMarker(markers->labels()[label]));
    }
  }
  return CalibrateOsim({person.generic, "m.osim"}, DocumentOf(person.generic), reference,
                       AllJoints(reference), recordings, {"Anna", mass, {}, "test"},
                       OsimCalibrationOptions(), warnings);
}

// Without errors, what was assumed beforehand draws lengths by less than a part in two hundred. The
// size of pelvis and feet moves little but markers, and these may sit elsewhere.
TEST(OsimCalibration, SizesOfAPersonWithoutErrorsAreFound) {
  const KnownPerson person = MakeKnownPerson({0, 0, 1, 0}, 0.5, 1);
  const CalibratedOsim found = Calibrate(person, 61.5, nullptr);
  for (const auto& [body, size] : kSizes) {
    const bool is_length = body[0] == 'f' ? body[1] == 'e' : body[0] == 't';
    EXPECT_NEAR(found.scaled.factors.at(body).y() / size, 1, is_length ? 0.005 : 0.04) << body;
  }
  EXPECT_NEAR(found.scaled.mass, 61.5, 1e-9);
  EXPECT_LT(found.result.distance_after, 1e-3);
  EXPECT_EQ(found.scaled.placed_markers, 25);
}

TEST(OsimCalibration, LengthsAndJointsOfPersonsAreFound) {
  double squares = 0;
  int count = 0;
  for (const int seed : {11, 12, 13}) {
    const KnownPerson person = MakeKnownPerson({0.01, 0.003, 0.3, 0.0005}, 0.5, seed);
    const CalibratedOsim found = Calibrate(person, {}, nullptr);
    for (const char* body : {"femur_r", "femur_l", "tibia_r", "tibia_l", "torso"}) {
      const double error = found.scaled.factors.at(body).y() / kSizes.at(body) - 1;
      std::printf("[ measured ] %d %s: %.2f %%\n", seed, body, 100 * error);
      EXPECT_LT(std::abs(error), 0.04) << body << " " << seed;
      squares += error * error;
      ++count;
      const SegmentScale* scale = nullptr;
      for (const SegmentScale& one : found.result.subject.scales) {
        if (one.segment == std::string(body) + " y") scale = &one;
      }
      ASSERT_NE(scale, nullptr);
      EXPECT_LT(scale->standard_deviation, scale->prior_deviation);
      EXPECT_LT(std::abs(error), 4 * scale->standard_deviation);
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.02);
}

// Of standing alone lengths are told by where markers are usually worn, which is not exact.
TEST(OsimCalibration, APersonWhoStandsIsSizedByTheMarkers) {
  for (const int seed : {1, 2, 3}) {
    const KnownPerson person = MakeKnownPerson({0.01, 0.003, 0.3, 0.0005}, 0.02, seed);
    Warnings warnings;
    const CalibratedOsim found = Calibrate(person, {}, &warnings);
    for (const SegmentScale& one : found.result.subject.scales) {
      const std::string body = one.segment.substr(0, one.segment.find(' '));
      const int axis = one.segment.back() - 'x';
      const double error = found.scaled.factors.at(body)[axis] / kSizes.at(body) - 1;
      std::printf("[ measured ] %d %s: %.2f %%, deviation %.2f\n", seed, one.segment.c_str(),
                  100 * error, 100 * one.standard_deviation);
      EXPECT_LT(std::abs(error), 0.1) << one.segment << " " << seed;
      EXPECT_LT(std::abs(error), 3 * one.standard_deviation) << one.segment << " " << seed;
    }
    EXPECT_LT(found.result.distance_after, 5e-3);
    ASSERT_FALSE(warnings.empty());
    EXPECT_THAT(warnings.texts().front(), HasSubstr("the person only stands"));
  }
}

// Who stands fits better than any movement: what fits worse is no worse recording.
TEST(OsimCalibration, AShortMovementBesideLongStandingIsTaken) {
  const MarkerErrors errors{0.02, 0.0003, 0.3, 0.0003};
  const KnownPerson standing = MakeKnownPerson(errors, 0.01, 4);
  const KnownPerson moving = MakeKnownPerson(errors, 0.5, 4);
  const MarkerSequence moves = moving.markers.Slice(0, 75);
  const CalibratedOsim alone = Calibrate(standing, {}, nullptr);
  const CalibratedOsim both = Calibrate(standing, {}, nullptr, &moves);
  EXPECT_TRUE(alone.result.stands);
  EXPECT_FALSE(both.result.stands);
  const Subject& subject = both.result.subject;
  ASSERT_EQ(subject.sources.size(), 2);
  EXPECT_EQ(subject.sources[1].frames, 15);
  const auto error = [](const CalibratedOsim& found) {
    double sum = 0;
    for (const char* body : {"femur_r", "femur_l", "tibia_r", "tibia_l"}) {
      sum += std::abs(found.scaled.factors.at(body).y() / kSizes.at(body) - 1) / 4;
    }
    return sum;
  };
  std::printf("[ measured ] lengths %.2f %%, by standing %.2f\n", 100 * error(both),
              100 * error(alone));
  EXPECT_LT(error(both), 0.02);
  EXPECT_LT(error(both), error(alone));
}

}  // namespace
}  // namespace mmm_converter
