// SPDX-License-Identifier: MIT
#pragma once

#include "common/pipeline/comparison/comparison.h"

namespace mmm_converter::testing {

/// Markup that must not become any: a page in which it does sets window.hacked.
inline constexpr const char* kHostileText =
    "</script><script>window.hacked=1</script><!-- <img src=x onerror=\"window.hacked=2\"> 'a' & "
    "{{data}} \\";

/// A stick whose labels, markers, joints, warnings, converters and configurations are all hostile;
/// the second converter failed.
Comparison HostileComparison();

/// All converters failed.
Comparison FailedComparison();

/// 60 s at 100 Hz, 53 markers, 44 joints with standard deviations, one converter; the true motion
/// as its result.
Comparison LongComparison();

/// The comparison with every recording so many times as long: back and forth, and all figures of
/// frames with it; those of the whole stay.
Comparison Repeated(Comparison comparison, int times);

/// A stick over 13,000 frames, of which only frame 6502 is 50 mm off.
Comparison ThinnedComparison();

}  // namespace mmm_converter::testing
