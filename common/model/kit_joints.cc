// SPDX-License-Identifier: MIT
#include "common/model/kit_joints.h"

namespace mmm_converter {

const std::vector<std::string>& KitJointNames() {
  static const std::vector<std::string> kNames = {
      "BLNx_joint", "BLNy_joint", "BLNz_joint", "BPx_joint",   "BPy_joint",  "BPz_joint",
      "BTx_joint",  "BTy_joint",  "BTz_joint",  "BUNx_joint",  "BUNy_joint", "BUNz_joint",
      "LAx_joint",  "LAy_joint",  "LAz_joint",  "LEx_joint",   "LEz_joint",  "LHx_joint",
      "LHy_joint",  "LHz_joint",  "LKx_joint",  "LSx_joint",   "LSy_joint",  "LSz_joint",
      "LWx_joint",  "LWy_joint",  "LFx_joint",  "LMrot_joint", "RAx_joint",  "RAy_joint",
      "RAz_joint",  "REx_joint",  "REz_joint",  "RHx_joint",   "RHy_joint",  "RHz_joint",
      "RKx_joint",  "RSx_joint",  "RSy_joint",  "RSz_joint",   "RWx_joint",  "RWy_joint",
      "RFx_joint",  "RMrot_joint"};
  return kNames;
}

}  // namespace mmm_converter
