// SPDX-License-Identifier: MIT
#pragma once

#include "common/live/natnet/natnet_frame.h"
#include "common/live/natnet/natnet_model.h"

namespace mmm_converter::testing {

/// Every version whose layout differs from the one before, and 4.0.
inline constexpr NatNetVersion kNatNetVersions[] = {{2, 5}, {2, 6}, {2, 7}, {2, 8}, {2, 9}, {2, 11},
                                                    {3, 0}, {3, 1}, {4, 0}, {4, 1}, {4, 2}};

/// A model with one of each description.
inline NatNetModel SampleNatNetModel() {
  NatNetModel model;
  model.marker_sets = {{"Anna", {"LFHD", "RFHD"}}, {"Ball", {"M1", "M2"}}, {"all", {"a", "b"}}};
  model.bodies = {{"Ball", 3, -1, {1, 2, 3}, {0, 0, 0, 1}, {{{1, 0, 0}, 7, "M1"}, {{}, 8, "M2"}}}};
  model.skeletons = {{"Anna", 2, {{"Hips", 1, 0, {0, 1, 0}, {0, 0, 0, 1}, {}}}}};
  NatNetForcePlate plate;
  plate.id = 9;
  plate.serial = "FP1";
  plate.size = {0.4F, 0.6F};
  plate.corners[11] = 5;
  plate.channels = {"Fx", "Fy"};
  model.force_plates = {plate};
  model.devices = {{11, "NI", "123", 1, 2, {"EMG"}}};
  model.cameras = {{"Prime 13", {1, 2, 3}, {0, 0, 0, 1}}};
  model.assets = {{"Glove", 1, 5, {}, {{"G2", 0x50002, {}, 0.01F, 0}, {"G1", 0x50001, {}, 0, 0}}}};
  return model;
}

inline std::int32_t MarkerId(int asset, int member) { return asset << 16 | member; }

/// A frame with something in every section, of the sample model.
inline NatNetFrame SampleNatNetFrame() {
  NatNetFrame frame;
  frame.number = 4711;
  frame.marker_sets = {{"Anna", {{1, 2, 3}, {0, 0, 0}}}, {"Ball", {{4, 5, 6}, {7, 8, 9}}}};
  frame.other_markers = {{9, 9, 9}};
  frame.bodies = {{3, {1, 2, 3}, {0, 0, 0, 1}, {{{4, 5, 6}, 1, 0.02F}}, 0.001F, 1}};
  frame.skeletons = {{2, {{MarkerId(2, 1), {0, 1, 0}, {0, 0, 0, 1}, {}, 0.002F, 1}}}};
  frame.assets = {{5,
                   {{1, {1, 1, 1}, {0, 0, 0, 1}, {}, 0, 1}},
                   {{MarkerId(5, 1), {0.5F, 0.5F, 0.5F}, 0.01F, 10, 0.1F}}}};
  frame.markers = {{MarkerId(2, 1), {1, 2, 3}, 0.014F, 10, 0.0001F},
                   {MarkerId(2, 2), {1, 2, 4}, 0.014F, 11, 0},
                   {MarkerId(3, 1), {4, 5, 6}, 0.014F, 12, 0},
                   {MarkerId(3, 2), {7, 8, 9}, 0.014F, 14, 0},
                   {50007, {8, 8, 8}, 0.01F, 0x12, 0}};
  frame.force_plates = {{9, {{1, 2}, {3}}}};
  frame.devices = {{11, {{}, {4, 5}}}};
  frame.latency = 0.25F;
  frame.timecode = 12;
  frame.timecode_subframe = 3;
  frame.time = 39.25;
  frame.exposed = 1;
  frame.received = 2;
  frame.sent = std::uint64_t{1} << 40;
  frame.precise_seconds = 5;
  frame.precise_fraction = 6;
  frame.parameters = kNatNetModelChanged;
  return frame;
}

}  // namespace mmm_converter::testing
