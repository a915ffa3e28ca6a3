// SPDX-License-Identifier: MIT
#include "common/forces/emg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "tests/support/c3d_bytes.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using testing::C3dBytes;
using testing::C3dSection;
using ::testing::HasSubstr;

TEST(Emg, SidesOfLabels) {
  const auto of = [](const std::vector<std::string>& labels) {
    std::string text;
    for (const EmgChannel& one : EmgChannelsOf(labels)) text += one.side + ":" + one.muscle + " ";
    return text;
  };
  EXPECT_EQ(of({"L TA", "R_TA", "Left gastrocnemius", "soleus.right"}),
            "left:TA right:TA left:gastrocnemius right:soleus ");
  EXPECT_EQ(of({"LTA", "RTA", "Lat", "rectus", "EMG1"}), "left:TA right:TA :Lat :rectus :EMG1 ");
  EXPECT_EQ(of({"L", "R ", "L_"}), ":L :R  :L_ ");
}

constexpr int kEmgSamples = 10;
constexpr int kEmgFrames = 300;
constexpr double kEmgRate = 100;
constexpr double kEmgStep = 1e-3;  // [s] of a sample

/// A muscle that is active in [1, 2) s with 0.2 mV at 113 Hz on a drift of 5 mV, in volts.
double EmgVoltage(double t) {
  const double drift = 5e-3 * std::sin(2 * std::numbers::pi * 0.3 * t);
  return drift + (t >= 1 && t < 2 ? 2e-4 * std::sin(2 * std::numbers::pi * 113 * t) : 0);
}

std::string EmgRecording(const std::string& unit) {
  C3dSection section;
  section.Group(1, "POINT").Word(1, "USED", {1}).Word(1, "DATA_START", {3});
  section.Texts(1, "LABELS", 4, "A   ").Float(1, "RATE", kEmgRate);
  section.Group(2, "ANALOG").Word(2, "USED", {1}).Float(2, "RATE", kEmgRate * kEmgSamples);
  section.Texts(2, "LABELS", 4, "L TA").Texts(2, "UNITS", static_cast<int>(unit.size()), unit);
  section.Texts(2, "DESCRIPTIONS", 3, "emg").Float(2, "GEN_SCALE", 1).Float(2, "SCALE", 1);
  C3dBytes bytes{.points = 1, .analog_words = kEmgSamples, .analog_samples = kEmgSamples};
  for (int k = 0; k < kEmgFrames; ++k) {
    std::vector<float> frame = {1, 2, 3, 0};
    for (int i = 0; i < kEmgSamples; ++i) {
      frame.push_back(static_cast<float>(EmgVoltage((k * kEmgSamples + i) * kEmgStep)));
    }
    bytes.frames.push_back(frame);
  }
  std::string path = testing::TestFolder() + "/emg.c3d";
  WriteFileAtomically(path, bytes.File(section));
  return path;
}

TEST(Emg, TheEnvelopeIsTheMeanOfTheRectifiedMuscle) {
  for (const char* labels : {"all", "l ta"}) {
    const Emg emg = ReadEmg(EmgRecording("V   "), labels, nullptr);
    ASSERT_EQ(emg.envelopes.rows(), 1);
    ASSERT_EQ(emg.envelopes.cols(), kEmgFrames);
    EXPECT_NEAR(emg.rate, kEmgRate, 1e-9);
    EXPECT_EQ(emg.channels[0].side, "left");
    const double mean = 0.2 * 2 / std::numbers::pi;  // [mV] of a rectified sine
    EXPECT_NEAR(emg.envelopes(0, 150), mean, 0.01 * mean);
    EXPECT_LT(emg.envelopes(0, 50), 0.02 * mean);
    EXPECT_LT(emg.envelopes(0, 250), 0.02 * mean);
    EXPECT_NEAR(emg.envelopes(0, 100), mean / 2, 0.1 * mean);
  }
}

TEST(Emg, WhatIsNoMuscleIsRefused) {
  const auto error = [](const std::string& unit, const char* labels) -> std::string {
    try {
      ReadEmg(EmgRecording(unit), labels, nullptr);
    } catch (const Error& refused) {
      return refused.what();
    }
    return "";
  };
  EXPECT_THAT(error("V   ", "L TB"),
              HasSubstr("has no analog channel L TB; its analog channels are L TA"));
  EXPECT_THAT(error("N   ", "all"), HasSubstr("channel L TA is in N, and EMG is a voltage"));
  Warnings warnings;
  ReadEmg(EmgRecording("    "), "all", &warnings);
  ASSERT_EQ(warnings.texts().size(), 1);
  EXPECT_THAT(warnings.texts()[0], HasSubstr("taken as volts"));
}

}  // namespace
}  // namespace mmm_converter
