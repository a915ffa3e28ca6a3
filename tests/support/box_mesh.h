// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

namespace mmm_converter::testing {

/// A box as a mesh of 12 triangles.
struct BoxMesh {
  Eigen::Vector3d low, high;

  std::string BinaryStl() const;
  std::string AsciiStl() const;
  std::string Obj() const;
  /// up: "Y_UP"; metres: of the file's unit.
  std::string Collada(const std::string& up, double metres) const;
};

/// Its corners have numbers in these places, as text.
std::string ColladaText(const std::string& corners, const std::string& triangles,
                        const std::string& up, double metres, const std::string& scene);

}  // namespace mmm_converter::testing
