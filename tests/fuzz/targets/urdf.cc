// SPDX-License-Identifier: MIT
#include "common/io/urdf/urdf_model_reader.h"
#include "common/io/urdf/urdf_model_writer.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

void ReadUrdfBytes(std::string_view bytes) {
  Warnings warnings;
  const UrdfModel read = ParseUrdfModel(bytes, kInputName, &warnings);
  const UrdfModel again = ParseUrdfModel(FormatUrdf(read.model, "").xml, kInputName);
  Require(again.model.num_joints() == read.model.num_joints(), "the joints that were written");
  Require(again.model.markers().size() == read.model.markers().size(),
          "the markers that were written");
}

}  // namespace mmm_converter::testing
