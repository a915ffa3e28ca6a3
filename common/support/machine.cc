// SPDX-License-Identifier: MIT
#include "common/support/machine.h"

#include <fmt/format.h>
#include <oneapi/tbb/info.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr double kKibi = 1024;
constexpr std::array kMemoryUnits = {'K', 'M', 'G', 'T'};

std::string ReadWord(std::istream& stream) {
  std::string word;
  stream >> word;
  return word;
}

template <typename Number>
void TakeSmaller(std::optional<Number>* least, std::optional<Number> value) {
  if (value && (!*least || *value < **least)) *least = value;
}

std::optional<double> PositiveNumber(std::istream& stream) {
  const auto number = ParseDouble(ReadWord(stream));
  return number && *number > 0 ? number : std::nullopt;
}

std::optional<double> ReadNumber(const std::string& file) {
  std::ifstream stream(file);
  return PositiveNumber(stream);
}

// "max 100000" or "150000 100000": microseconds of processor time in each period.
std::optional<double> ReadCpuMax(const std::string& file) {
  std::ifstream stream(file);
  const auto quota = PositiveNumber(stream);
  const auto period = PositiveNumber(stream);
  return quota && period ? std::optional(*quota / *period) : std::nullopt;
}

std::optional<double> ReadQuota(const std::string& folder) {
  const auto quota = ReadNumber(folder + "/cpu.cfs_quota_us");
  const auto period = ReadNumber(folder + "/cpu.cfs_period_us");
  return quota && period ? std::optional(*quota / *period) : std::nullopt;
}

void TakeMemory(const std::string& file, ControlGroupLimits* limits) {
  constexpr double kNoLimit = 1e18;  // version 1 has the largest number there is
  const auto bytes = ReadNumber(file);
  if (!bytes || *bytes > kNoLimit) return;
  TakeSmaller(&limits->memory, std::optional(static_cast<std::uint64_t>(*bytes)));
}

// A limit of any group above holds too.
template <typename Visit>
void ForGroupAndAbove(const std::string& mount, std::string group, Visit visit) {
  visit(mount + "/" + group);
  while (!group.empty()) {
    const std::size_t slash = group.rfind('/');
    group.resize(slash == std::string::npos ? 0 : slash);
    visit(mount + "/" + group);
  }
}

}  // namespace

ControlGroupLimits ReadControlGroupLimits(const std::string& root) {
  ControlGroupLimits limits;
  const std::string mount = root + "/sys/fs/cgroup";
  std::ifstream groups(root + "/proc/self/cgroup");
  std::string line;  // "0::/user.slice", or "4:cpu,cpuacct:/user.slice" of version 1
  while (std::getline(groups, line)) {
    std::istringstream parts(line);
    std::string number;
    std::string controllers;
    std::string group;
    std::getline(parts, number, ':');
    std::getline(parts, controllers, ':');
    std::getline(parts, group);
    const std::string padded = "," + controllers + ",";
    if (controllers.empty()) {
      ForGroupAndAbove(mount, group, [&](const std::string& folder) {
        TakeSmaller(&limits.cores, ReadCpuMax(folder + "/cpu.max"));
        TakeMemory(folder + "/memory.max", &limits);
      });
    } else if (padded.find(",cpu,") != std::string::npos) {
      ForGroupAndAbove(mount + "/cpu", group, [&](const std::string& folder) {
        TakeSmaller(&limits.cores, ReadQuota(folder));
      });
    } else if (padded.find(",memory,") != std::string::npos) {
      ForGroupAndAbove(mount + "/memory", group, [&](const std::string& folder) {
        TakeMemory(folder + "/memory.limit_in_bytes", &limits);
      });
    }
  }
  return limits;
}

int AvailableCores() {
  int cores = oneapi::tbb::info::default_concurrency();
  if (const auto limit = ReadControlGroupLimits().cores) {
    cores = std::min(cores, static_cast<int>(std::ceil(*limit)));
  }
  if (const char* slurm = std::getenv("SLURM_CPUS_PER_TASK")) {
    const auto count = ParseLong(slurm);
    if (count && *count > 0) cores = static_cast<int>(std::min<long>(cores, *count));
  }
  return std::max(cores, 1);
}

std::uint64_t AvailableMemory() {
  std::uint64_t available = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                            static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  std::ifstream memory("/proc/meminfo");
  std::string line;
  while (std::getline(memory, line)) {
    std::istringstream parts(line);
    if (ReadWord(parts) != "MemAvailable:") continue;
    const auto kibibytes = PositiveNumber(parts);
    if (kibibytes) available = static_cast<std::uint64_t>(kKibi * *kibibytes);
  }
  const auto limit = ReadControlGroupLimits().memory;
  return limit ? std::min(available, *limit) : available;
}

std::optional<std::uint64_t> ParseByteSize(const std::string& text) {
  std::string number(Trim(text));
  double factor = 1;
  if (!number.empty()) {
    const auto unit =
        std::find(kMemoryUnits.begin(), kMemoryUnits.end(), ToLower(number).back() - 'a' + 'A');
    if (unit != kMemoryUnits.end()) {
      factor = std::pow(kKibi, static_cast<double>(unit - kMemoryUnits.begin() + 1));
      number.pop_back();
    }
  }
  constexpr double kMost = 1e18;
  const auto value = ParseDouble(number);
  if (!value || !(*value * factor >= 1) || *value * factor > kMost) return std::nullopt;
  return static_cast<std::uint64_t>(*value * factor);
}

std::string FormatByteSize(std::uint64_t bytes) {
  double value = static_cast<double>(bytes) / kKibi;
  std::size_t unit = 0;
  while (value >= kKibi && unit + 1 < kMemoryUnits.size()) {
    value /= kKibi;
    ++unit;
  }
  return fmt::format("{:.3g} {}iB", value, kMemoryUnits[unit]);
}

}  // namespace mmm_converter
