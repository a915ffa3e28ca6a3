// SPDX-License-Identifier: MIT
// Counts every allocation of the process: malloc is replaced by one that counts.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "common/motion/marker_synthesis.h"
#include "common/motion/synthetic_motion.h"
#include "plugins/s2kf/s2kf_converter.h"
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

namespace mmm_converter::s2kf {
namespace {

class AllocationTest : public ::testing::TestWithParam<FilterType> {};

TEST_P(AllocationTest, TrackAllocatesNothingAfterTheFirstFrame) {
  const KinematicModel model = ScaledReferenceModel(1.8);
  const PoseTrajectory motion = MakeHandstand(model);
  // With gaps, a lost track and wrong markers, so that recovery and the gate are counted too.
  MarkerSequence markers = SynthesizeMarkers(model, motion, MarkerErrors{}, 1).Slice(0, 250);
  markers = testing::OccludeShare(markers, 0.33, 30, 1);
  markers = testing::HideAllMarkers(markers, 100, 150);
  markers = testing::SwapMarkers(markers, "RWTS", "LWTS", 60, 90);
  for (int k = 180; k < 210; ++k) markers.frame(k).leftCols(5).array() += 0.3;
  for (const UpdateForm update : {UpdateForm::kRegression, UpdateForm::kExact}) {
    S2kfSettings settings;
    settings.filter = GetParam();
    settings.update = update;
    settings.iterations = update == UpdateForm::kExact ? 1 : 3;
    S2kfConverter converter(SetupOf(model, MotionJoints(model, 44), AssignAll(model, markers)),
                            settings);
    converter.Assemble(markers.frame(0));
    converter.Track(markers.frame(1), 0.01);
    const long before = allocations;
    ASSERT_GT(before, 0);
    for (int k = 2; k < markers.num_frames(); ++k) converter.Track(markers.frame(k), 0.01);
    EXPECT_EQ(allocations - before, 0) << "update form " << static_cast<int>(update);
  }
}

INSTANTIATE_TEST_SUITE_P(Filters, AllocationTest,
                         ::testing::Values(FilterType::kS2kf, FilterType::kUkf, FilterType::kEkf));

}  // namespace
}  // namespace mmm_converter::s2kf

#else

TEST(AllocationTest, NeedsTheSystemsOwnAllocator) {
  GTEST_SKIP() << "allocations are counted in builds without a sanitizer";
}

#endif
