// SPDX-License-Identifier: MIT
// Counts every allocation of the process: malloc is replaced by one that counts.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "common/motion/marker_synthesis.h"
#include "common/motion/synthetic_motion.h"
#include "plugins/jacobian/jacobian_converter.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/changed_markers.h"

#if !defined(__SANITIZE_ADDRESS__) && defined(__GLIBC__)

// glibc's own names.
extern "C" {
void* __libc_malloc(std::size_t size);                     // NOLINT(bugprone-reserved-identifier)
void* __libc_calloc(std::size_t count, std::size_t size);  // NOLINT(bugprone-reserved-identifier)
void* __libc_realloc(void* p, std::size_t size);           // NOLINT(bugprone-reserved-identifier)
// NOLINTNEXTLINE(bugprone-reserved-identifier)
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {
std::atomic<long> allocations{0};
}  // namespace

extern "C" {
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* p, std::size_t size) {
  ++allocations;
  return __libc_realloc(p, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
}

namespace mmm_converter::jacobian {
namespace {

TEST(AllocationTest, TrackAllocatesNothingAfterTheFirstFrame) {
  const KinematicModel model = s2kf::ScaledReferenceModel(1.8);
  const PoseTrajectory motion = MakeHandstand(model);
  MarkerSequence markers = SynthesizeMarkers(model, motion, MarkerErrors{}, 1).Slice(0, 150);
  markers = testing::OccludeShare(markers, 0.33, 30, 1);
  markers = testing::HideAllMarkers(markers, 100, 110);
  JacobianSettings pull;
  pull.previous_weight = 0.2;
  JacobianSettings gradient;
  gradient.method = Method::kGradient;
  int which = 0;
  for (const JacobianSettings& settings : {JacobianSettings(), pull, gradient}) {
    SCOPED_TRACE(which++);
    JacobianConverter converter(
        s2kf::SetupOf(model, s2kf::MotionJoints(model, 44), s2kf::AssignAll(model, markers)),
        settings);
    converter.Assemble(markers.frame(0));
    converter.Track(markers.frame(1), 0.01);
    const long before = allocations;
    ASSERT_GT(before, 0);
    for (int k = 2; k < markers.num_frames(); ++k) converter.Track(markers.frame(k), 0.01);
    EXPECT_EQ(allocations - before, 0);
  }
}

}  // namespace
}  // namespace mmm_converter::jacobian

#else

TEST(AllocationTest, NeedsTheSystemsOwnAllocator) {
  GTEST_SKIP() << "allocations are counted in builds without a sanitizer";
}

#endif
