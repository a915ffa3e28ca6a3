// SPDX-License-Identifier: MIT
#include "common/support/machine.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/scoped_environment.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

class ControlGroupTest : public ::testing::Test {
 protected:
  void Write(const std::string& file, const std::string& text) {
    const fs::path path = fs::path(root_) / file;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }

  const std::string root_ = testing::TestFolder();
};

TEST_F(ControlGroupTest, NoneIsNoLimit) {
  const ControlGroupLimits limits = ReadControlGroupLimits(root_);
  EXPECT_FALSE(limits.cores);
  EXPECT_FALSE(limits.memory);
}

TEST_F(ControlGroupTest, Version2TakesTheSmallestOfAllAbove) {
  Write("proc/self/cgroup", "0::/jobs/42\n");
  Write("sys/fs/cgroup/jobs/42/cpu.max", "max 100000\n");
  Write("sys/fs/cgroup/jobs/cpu.max", "150000 100000\n");
  Write("sys/fs/cgroup/cpu.max", "400000 100000\n");
  Write("sys/fs/cgroup/jobs/42/memory.max", "1073741824\n");
  Write("sys/fs/cgroup/memory.max", "max\n");
  const ControlGroupLimits limits = ReadControlGroupLimits(root_);
  EXPECT_EQ(limits.cores, 1.5);
  EXPECT_EQ(limits.memory, 1073741824U);
}

TEST_F(ControlGroupTest, Version1) {
  Write("proc/self/cgroup", "4:memory:/a\n3:cpu,cpuacct:/a\n2:cpuset:/\n");
  Write("sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "-1\n");
  Write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "200000\n");
  Write("sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
  Write("sys/fs/cgroup/memory/a/memory.limit_in_bytes", "9223372036854771712\n");
  const ControlGroupLimits limits = ReadControlGroupLimits(root_);
  EXPECT_EQ(limits.cores, 2);
  EXPECT_FALSE(limits.memory);
}

TEST(Machine, SlurmsShareIsObeyed) {
  const testing::ScopedEnvironment one("SLURM_CPUS_PER_TASK", "1");
  EXPECT_EQ(AvailableCores(), 1);
  const testing::ScopedEnvironment nonsense("SLURM_CPUS_PER_TASK", "many");
  EXPECT_GE(AvailableCores(), 1);
  EXPECT_GT(AvailableMemory(), 0U);
}

TEST(Machine, Sizes) {
  EXPECT_EQ(ParseByteSize("1000"), 1000U);
  EXPECT_EQ(ParseByteSize("2k"), 2048U);
  EXPECT_EQ(ParseByteSize(" 1.5G "), 1610612736U);
  for (const char* text : {"", "G", "0", "-1G", "1 GB", "nan", "1e40", "inf"}) {
    EXPECT_FALSE(ParseByteSize(text)) << text;
  }
  EXPECT_EQ(FormatByteSize(1610612736), "1.5 GiB");
  EXPECT_EQ(FormatByteSize(512), "0.5 KiB");
}

}  // namespace
}  // namespace mmm_converter
