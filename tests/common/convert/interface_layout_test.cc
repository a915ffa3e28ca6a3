// SPDX-License-Identifier: MIT
//
// What a converter plugin and its host must agree on to the byte, compared with
// interface_layout.txt, whose first line is the version of the interface. Where a type has changed:
// another number in kConverterInterfaceText, then the text that this test prints, in the file.
#include "common/convert/interface_layout.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <sstream>
#include <typeinfo>

#include "common/convert/motion_converter.h"
#include "common/convert/plugin_loader.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string Number() {
  const std::string version = kConverterInterfaceVersion;
  return version.substr(0, version.find(':'));
}

template <typename Type>
std::string Whole(const char* name) {
  return fmt::format("{} {} bytes, aligned {}\n", name, sizeof(Type), alignof(Type));
}

template <typename Type, typename Member>
std::string Part(const char* name, const Type& object, Member Type::*member) {
  const auto* begin = reinterpret_cast<const char*>(&object);
  const auto* place = reinterpret_cast<const char*>(&(object.*member));
  return fmt::format("  {} at {}: {} bytes, {}\n", name, place - begin, sizeof(Member),
                     typeid(Member).name());
}

// Of a virtual function, its place in the table of its class (Itanium's ABI) and its signature.
template <typename Function>
std::string Virtual(const char* name, Function function) {
  std::size_t place = 0;
  static_assert(sizeof(function) >= sizeof(place));
  std::memcpy(&place, &function, sizeof(place));
  return fmt::format("  {} virtual {}: {}\n", name, (place - 1) / sizeof(void*),
                     typeid(function).name());
}

#define PART(type, name) Part(#name, object, &type::name)
#define VIRTUAL(type, name) Virtual(#name, &type::name)
// The names stand for nothing but their number: another number of members is an error.
#define MEMBERS(...) [[maybe_unused]] const auto& [__VA_ARGS__] = object

std::string DescribeEstimates() {
  std::string text;
  {
    const Posture object;
    MEMBERS(a, b, c);
    text += Whole<Posture>("Posture") + PART(Posture, position) + PART(Posture, orientation) +
            PART(Posture, joint_angles);
  }
  {
    const FrameEstimate object;
    MEMBERS(a, b, c, d, e, f, g, h, i, j);
    text += Whole<FrameEstimate>("FrameEstimate") + PART(FrameEstimate, posture) +
            PART(FrameEstimate, standard_deviations) + PART(FrameEstimate, residuals) +
            PART(FrameEstimate, verdicts) + PART(FrameEstimate, markers_seen) +
            PART(FrameEstimate, markers_downweighted) + PART(FrameEstimate, markers_wrong) +
            PART(FrameEstimate, nis) + PART(FrameEstimate, reassembled) +
            PART(FrameEstimate, converged);
  }
  const FrameDiagnostic object;
  MEMBERS(a, b, c, d, e, f, g);
  return text + Whole<FrameDiagnostic>("FrameDiagnostic") + PART(FrameDiagnostic, markers_seen) +
         PART(FrameDiagnostic, markers_downweighted) + PART(FrameDiagnostic, markers_wrong) +
         PART(FrameDiagnostic, nis) + PART(FrameDiagnostic, reassembled) +
         PART(FrameDiagnostic, converged) + PART(FrameDiagnostic, seconds);
}

std::string DescribeResults() {
  std::string text;
  {
    const PoseTrajectory object;
    MEMBERS(a, b, c, d, e, f, g, h);
    text += Whole<PoseTrajectory>("PoseTrajectory") + PART(PoseTrajectory, rate) +
            PART(PoseTrajectory, first_time) + PART(PoseTrajectory, joint_names) +
            PART(PoseTrajectory, postures) + PART(PoseTrajectory, standard_deviations) +
            PART(PoseTrajectory, correlations) + PART(PoseTrajectory, velocities) +
            PART(PoseTrajectory, accelerations);
  }
  {
    const PoseCorrelation object;
    MEMBERS(a, b);
    text += Whole<PoseCorrelation>("PoseCorrelation") + PART(PoseCorrelation, time) +
            PART(PoseCorrelation, correlation);
  }
  {
    const MarkerIncident object;
    MEMBERS(a, b, c, d, e);
    text += Whole<MarkerIncident>("MarkerIncident") + PART(MarkerIncident, kind) +
            PART(MarkerIncident, assignment) + PART(MarkerIncident, other) +
            PART(MarkerIncident, first_frame) + PART(MarkerIncident, last_frame);
  }
  {
    const PoseCovariance object;
    MEMBERS(a, b);
    text += Whole<PoseCovariance>("PoseCovariance") + PART(PoseCovariance, frame) +
            PART(PoseCovariance, covariance);
  }
  const ConversionResult object;
  MEMBERS(a, b, c, d, e, f);
  return text + Whole<ConversionResult>("ConversionResult") + PART(ConversionResult, trajectory) +
         PART(ConversionResult, residuals) + PART(ConversionResult, frames) +
         PART(ConversionResult, process_noise_scale) + PART(ConversionResult, incidents) +
         PART(ConversionResult, covariances);
}

std::string DescribeModel() {
  std::string text =
      Whole<KinematicModel>("KinematicModel") + Whole<MarkerSequence>("MarkerSequence");
  {
    const Segment object;
    MEMBERS(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o);
    text += Whole<Segment>("Segment") + PART(Segment, name) + PART(Segment, parent) +
            PART(Segment, X_PF) + PART(Segment, type) + PART(Segment, axis) + PART(Segment, lower) +
            PART(Segment, upper) + PART(Segment, joint) + PART(Segment, mass) +
            PART(Segment, p_SB) + PART(Segment, inertia) + PART(Segment, leader) +
            PART(Segment, function) + PART(Segment, rest) + PART(Segment, reach);
  }
  const ModelMarker object;
  MEMBERS(a, b, c, d, e);
  return text + Whole<ModelMarker>("ModelMarker") + PART(ModelMarker, name) +
         PART(ModelMarker, segment) + PART(ModelMarker, p_SM) + PART(ModelMarker, deviation) +
         PART(ModelMarker, skin_deviation);
}

std::string DescribeSetup() {
  std::string text;
  {
    const MarkerAssignment object;
    MEMBERS(a, b, c);
    text += Whole<MarkerAssignment>("MarkerAssignment") + PART(MarkerAssignment, label) +
            PART(MarkerAssignment, marker) + PART(MarkerAssignment, noise_scale);
  }
  {
    const MarkerMapping object;
    MEMBERS(a, b, c);
    text += Whole<MarkerMapping>("MarkerMapping") + PART(MarkerMapping, assignments) +
            PART(MarkerMapping, ignored_labels) + PART(MarkerMapping, absent_markers);
  }
  const TrackingSetup object;
  MEMBERS(a, b, c, d, e);
  return text + Whole<TrackingSetup>("TrackingSetup") + PART(TrackingSetup, model) +
         PART(TrackingSetup, joints) + PART(TrackingSetup, mapping) +
         PART(TrackingSetup, marker_set) + PART(TrackingSetup, joint_tasks);
}

std::string DescribeConfig() {
  std::string text;
  {
    const XmlElement object;
    MEMBERS(a, b, c, d, e);
    text += Whole<XmlElement>("XmlElement") + PART(XmlElement, name) +
            PART(XmlElement, attributes) + PART(XmlElement, children) + PART(XmlElement, text) +
            PART(XmlElement, line);
  }
  {
    const ConfigJoint object;
    MEMBERS(a, b);
    text += Whole<ConfigJoint>("ConfigJoint") + PART(ConfigJoint, name) + PART(ConfigJoint, line);
  }
  {
    const MarkerPair object;
    MEMBERS(a, b, c, d);
    text += Whole<MarkerPair>("MarkerPair") + PART(MarkerPair, source) + PART(MarkerPair, target) +
            PART(MarkerPair, noise_scale) + PART(MarkerPair, warning);
  }
  const ConverterConfig object;
  MEMBERS(a, b, c, d, e, f, g, h, i, j, k, l);
  return text + Whole<ConverterConfig>("ConverterConfig") + PART(ConverterConfig, file) +
         PART(ConverterConfig, type) + PART(ConverterConfig, model_processor) +
         PART(ConverterConfig, subject_file) + PART(ConverterConfig, marker_pairs) +
         PART(ConverterConfig, marker_set) + PART(ConverterConfig, marker_set_line) +
         PART(ConverterConfig, joints) + PART(ConverterConfig, joint_set) +
         PART(ConverterConfig, joint_set_line) + PART(ConverterConfig, output_format) +
         PART(ConverterConfig, plugin_elements);
}

std::string DescribeClasses() {
  return Whole<Error>("Error") + Whole<MotionConverter>("MotionConverter") +
         VIRTUAL(MotionConverter, Assemble) + VIRTUAL(MotionConverter, Track) +
         VIRTUAL(MotionConverter, Prepare) + VIRTUAL(MotionConverter, Convert) +
         VIRTUAL(MotionConverter, KeepCovariances) +
         Whole<MotionConverterFactory>("MotionConverterFactory") +
         VIRTUAL(MotionConverterFactory, name) + VIRTUAL(MotionConverterFactory, description) +
         VIRTUAL(MotionConverterFactory, config_template) + VIRTUAL(MotionConverterFactory, Create);
}

TEST(InterfaceLayout, ChangesOnlyWithTheVersion) {
#if !defined(__x86_64__) || !defined(__GLIBCXX__)
  GTEST_SKIP() << "recorded for x86-64 with libstdc++";
#endif
  const std::string layout = Number() + "\n" + DescribeClasses() + DescribeEstimates() +
                             DescribeResults() + DescribeModel() + DescribeSetup() +
                             DescribeConfig();
  std::stringstream recorded;
  recorded
      << std::ifstream(testing::SourcePath("tests/common/convert/interface_layout.txt")).rdbuf();
  EXPECT_EQ(recorded.str(), layout) << "a type that plugins share with their host has changed: "
                                       "change the version too, then record this layout";
}

TEST(InterfaceLayout, IsInTheVersion) {
  EXPECT_THAT(kConverterInterfaceVersion,
              ::testing::MatchesRegex("MMMConverterS2KF-[0-9]+:[0-9a-f]+"));
  struct Small {
    int a;
  };
  struct alignas(16) Aligned {
    int a;
  };
  EXPECT_NE(LayoutHash<Small>(), LayoutHash<Aligned>());
  EXPECT_NE((LayoutHash<Small, Aligned>()), (LayoutHash<Aligned, Small>()));
  EXPECT_STREQ(InterfaceText("name", 0x0123abcdU).data(), "name:0123abcd");
}

// Eigen aligns for the instructions that the compiler may use; a host of other alignment would read
// the plugin's models at wrong places.
TEST(InterfaceLayout, RefusesAPluginOfOtherAlignment) {
#if !defined(__x86_64__)
  GTEST_SKIP() << "made for x86-64";
#endif
  try {
    const LoadedPlugin plugin(testing::TestPlugin("other_alignment"));
    FAIL() << "loaded, with version " << plugin.version();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("was built against interface version \"" + Number()),
                                    HasSubstr("without options such as -march")));
  }
}

}  // namespace
}  // namespace mmm_converter
