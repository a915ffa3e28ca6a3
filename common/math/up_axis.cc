// SPDX-License-Identifier: MIT
#include "common/math/up_axis.h"

#include <fmt/format.h>

#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr const char* kAxisNames[] = {"+x", "+y", "+z", "-x", "-y", "-z"};

}  // namespace

const char* Name(UpAxis axis) { return kAxisNames[static_cast<int>(axis)]; }

std::optional<UpAxis> StatedUpAxis(const std::string& text) {
  const std::string name = ToLower(Trim(text));
  for (int i = 0; i < 6; ++i) {
    if (name == kAxisNames[i] || (i < 3 && name == kAxisNames[i] + 1))
      return static_cast<UpAxis>(i);
  }
  return std::nullopt;
}

UpAxis ParseUpAxis(const std::string& text) {
  if (const auto axis = StatedUpAxis(text)) return *axis;
  throw Error(fmt::format("unknown up axis \"{}\"; use x, y, z, -x, -y or -z", text));
}

Eigen::Matrix3d RotationToZUp(UpAxis axis) {
  Eigen::Matrix3d rotation;
  switch (axis) {
    case UpAxis::kX:
      rotation << 0, 1, 0, 0, 0, 1, 1, 0, 0;
      break;
    case UpAxis::kY:
      rotation << 1, 0, 0, 0, 0, -1, 0, 1, 0;
      break;
    case UpAxis::kZ:
      rotation.setIdentity();
      break;
    case UpAxis::kMinusX:
      rotation << 0, 0, 1, 0, 1, 0, -1, 0, 0;
      break;
    case UpAxis::kMinusY:
      rotation << 1, 0, 0, 0, 0, 1, 0, -1, 0;
      break;
    case UpAxis::kMinusZ:
      rotation << 1, 0, 0, 0, -1, 0, 0, 0, -1;
      break;
  }
  return rotation;
}

}  // namespace mmm_converter
