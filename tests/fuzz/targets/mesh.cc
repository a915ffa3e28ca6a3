// SPDX-License-Identifier: MIT
#include "common/io/mesh/mesh_file.h"

#include "common/io/mesh/extreme_points.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

/// XML is Collada, what begins with a mark of OBJ is that, all else STL.
void ReadMeshBytes(std::string_view bytes) {
  const char first = bytes.empty() ? ' ' : bytes.front();
  const bool is_obj = first == 'v' || first == 'f' || first == 'o' || first == '#';
  const char* ending = first == '<' ? ".dae" : is_obj ? ".obj" : ".stl";
  const MeshPoints mesh = ParseMesh(bytes, std::string(kInputName) + ending);
  Require(mesh.points.cols() > 0 && mesh.points.allFinite(), "corners");
  Require(!ExtremePoints(mesh.points).empty(), "corners that are farthest");
}

}  // namespace mmm_converter::testing
