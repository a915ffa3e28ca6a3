// SPDX-License-Identifier: MIT
// In place of dynamics_check.cc where there is no Simbody.
#include "MMMConverterS2KF/dynamics/dynamics_check.h"
#include "common/support/error.h"

namespace mmm_converter {

DynamicsReport CheckDynamics(const InputRequest&, const DynamicsOptions&) {
  throw Error(
      "check-dynamics: this program was built without Simbody, which computes the forces; install "
      "it (Debian: libsimbody-dev) and build again, without -DMMM_CONVERTER_DYNAMICS=OFF");
}

}  // namespace mmm_converter
