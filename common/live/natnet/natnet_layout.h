// SPDX-License-Identifier: MIT
#pragma once

#include "common/live/natnet/natnet_message.h"

namespace mmm_converter {

// Since which version NatNet messages have what.

inline constexpr NatNetVersion kNatNetWithBodyParameters{2, 6};  ///< also of markers and frames
inline constexpr NatNetVersion kNatNetWithExactTime{2, 7};       ///< f64; f32 at 2.6, none before
inline constexpr NatNetVersion kNatNetWithMemberIds{2, 8};       ///< of labelled markers
inline constexpr NatNetVersion kNatNetWithForcePlates{2, 9};
inline constexpr NatNetVersion kNatNetWithDevices{2, 11};
inline constexpr NatNetVersion kNatNet3{3, 0};
inline constexpr NatNetVersion kNatNet4{4, 0};
inline constexpr NatNetVersion kNatNetWithSizes{4, 1};  ///< of sections, and assets
inline constexpr NatNetVersion kNatNetWithBodyRotation{4, 2};

}  // namespace mmm_converter
