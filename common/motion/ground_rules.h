// SPDX-License-Identifier: MIT
#pragma once

namespace mmm_converter {

// When a part of a body is on the ground: the only place of these numbers. A height is that of an
// end of a foot above where this end is when the foot stands, on the floor or on a step; a speed is
// against the ground, which may be a belt.

// A foot comes to the ground below the first speed and leaves it above the second one [m/s]: where
// heels and toes of recorded walks are when force plates say so. Slow persons: SlowestSwing.
inline constexpr double kComesBelow = 0.8;
inline constexpr double kLeavesAbove = 1.0;
/// What is higher is not on the ground, but on another level [m]: soles of tracked persons are off
/// by up to 40 mm while they stand, and steps are higher.
inline constexpr double kLowHeight = 0.06;
/// Of a contact, and of a gap between two [s]: a runner's foot stands for 0.1 s.
inline constexpr double kShortestContact = 0.05;

/// A foot that is not seen for so long before it strikes, and after it lifts, strikes and lifts at
/// no known time [s].
inline constexpr double kSeenBeside = 0.08;

// An end of a foot rests on the ground from below the first height and speed until it is above
// kLowHeight or the last speed. A robot's foot is held where its person's rests: where it is held
// sooner or longer it slides, where it is held less it floats.
inline constexpr double kRestHeight = 0.04;     // [m]
inline constexpr double kRestSpeed = 0.3;       // [m/s]
inline constexpr double kEndOfRestSpeed = 0.5;  // [m/s]
inline constexpr double kRestGap = 0.08;        // [s] a low end that moves for less rests on

/// What is slower stands still, and tells how high the ground is [m/s].
inline constexpr double kStillSpeed = 0.1;

// A foot that is level and so slow for so long above the floor stands on something there: feet on
// stairs are, feet that swing are not.
inline constexpr double kStepSpeed = 0.2;     // [m/s] of both ends
inline constexpr double kStepTime = 0.1;      // [s]
inline constexpr double kLevelFoot = 0.08;    // [m] of one end above the other
inline constexpr double kUprightFoot = 0.7;   // of its up axis along the world's
inline constexpr double kLandingTime = 0.03;  // [s] on what is below all else: it moves on at once

// Hands and other parts are on the ground while they are lower than kRestHeight and slower than
// kComesBelow. What rests higher, where nothing is near the ground, stands on something: a part
// that falls is so slow, from its highest point on, for 0.08 s.
inline constexpr double kBodyRestSpeed = 0.4;  // [m/s]
inline constexpr double kBodyRestTime = 0.2;   // [s]

}  // namespace mmm_converter
