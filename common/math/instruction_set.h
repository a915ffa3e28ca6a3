// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mmm_converter {

/// The hot kernels are compiled once for each of these; the program chooses when it runs.
enum class InstructionSet {
  kBaseline,  ///< every processor of the architecture (x86-64: SSE2)
  kAvx2,      ///< x86-64-v3: AVX2 and FMA
  kAvx512,    ///< x86-64-v4: AVX-512 F, BW, CD, DQ, VL
};

std::string ToString(InstructionSet set);

/// What this processor has and this build contains, the baseline first, the fastest last.
std::vector<InstructionSet> SupportedInstructionSets();

/// The fastest that is supported, or what the environment variable MMM_CONVERTER_INSTRUCTION_SET
/// says (baseline, avx2, avx512); chosen at the first call.
/// @throws Error where the variable names an unknown or unsupported one.
InstructionSet ActiveInstructionSet();

/// The same table of kernels for each instruction set: = MMM_CONVERTER_KERNEL_TABLES(Kernels),
/// where MMM_CONVERTER_DECLARE_KERNELS(Kernels) has declared them.
template <typename Kernels>
struct KernelTables {
  const Kernels& (*baseline)();
  const Kernels& (*avx2)();
  const Kernels& (*avx512)();

  /// set: a supported one.
  const Kernels& For(InstructionSet set) const {
    return set == InstructionSet::kAvx512 ? avx512()
           : set == InstructionSet::kAvx2 ? avx2()
                                          : baseline();
  }
};

}  // namespace mmm_converter

#if defined(__x86_64__)
#define MMM_CONVERTER_KERNEL_TABLES(Kernels) \
  { baseline::Get##Kernels, avx2::Get##Kernels, avx512::Get##Kernels }
#else
#define MMM_CONVERTER_KERNEL_TABLES(Kernels) \
  { baseline::Get##Kernels, nullptr, nullptr }
#endif
