// SPDX-License-Identifier: MIT
#include "common/io/model_file.h"

#include <fmt/format.h>

#include <utility>

#include "common/io/mmm/mmm_model.h"
#include "common/support/error.h"

namespace mmm_converter {

LoadedModel ReadModelFile(const std::string& path, Warnings* warnings,
                          const std::string& marker_file) {
  for (ModelReader* const read : PartModelReaders()) {
    if (std::optional<LoadedModel> model = read(path, marker_file, warnings)) {
      return std::move(*model);
    }
  }
  if (!marker_file.empty()) {
    throw Error(fmt::format("{}: is a set of markers for a model of OpenSim, and {} is none",
                            marker_file, path));
  }
  return {ReadMmmModel(path, warnings), true, {}};
}

}  // namespace mmm_converter
