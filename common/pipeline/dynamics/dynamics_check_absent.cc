// SPDX-License-Identifier: MIT
#include "common/pipeline/dynamics/dynamics_check.h"

#include "common/support/error.h"

namespace mmm_converter {

DynamicsReport CheckDynamics(CheckedMotion, const DynamicsOptions&,
                             const std::function<void(int, int)>&) {
  throw Error(
      "check-dynamics: this program was built without Simbody, which computes the forces; install "
      "it (Debian: libsimbody-dev) and build again, without -DMMM_CONVERTER_DYNAMICS=OFF");
}

}  // namespace mmm_converter
