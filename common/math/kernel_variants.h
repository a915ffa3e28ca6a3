// SPDX-License-Identifier: MIT
#pragma once

// Declares `const Kernels& GetKernels();` for a struct of that name, in the namespace of every
// instruction set that files of mmm_converter_kernels() are compiled for.
#define MMM_CONVERTER_DECLARE_KERNELS(Kernels) \
  namespace baseline {                         \
  const Kernels& Get##Kernels();               \
  }                                            \
  namespace avx2 {                             \
  const Kernels& Get##Kernels();               \
  }                                            \
  namespace avx512 {                           \
  const Kernels& Get##Kernels();               \
  }
