// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace mmm_converter {

/// What this process may use, by the control groups it is in (versions 1 and 2; a container, a
/// systemd unit or a job of a cluster sets them).
struct ControlGroupLimits {
  std::optional<double> cores;          ///< processor time in a time
  std::optional<std::uint64_t> memory;  ///< [bytes]
};

/// root: where proc/ and sys/ are.
ControlGroupLimits ReadControlGroupLimits(const std::string& root = "/");

/// Cores for this process: those it may run on, no more than its control group has processor time
/// for, and no more than SLURM_CPUS_PER_TASK says. At least 1.
int AvailableCores();

/// Memory for this process [bytes]: what the machine has free, no more than its control group's
/// limit.
std::uint64_t AvailableMemory();

/// "512M", "2G", "1.5G": a number with K, M, G or T (1024 each), or bytes. Nothing where it is
/// anything else or no positive number.
std::optional<std::uint64_t> ParseByteSize(const std::string& text);

/// "1.5 GiB"
std::string FormatByteSize(std::uint64_t bytes);

}  // namespace mmm_converter
