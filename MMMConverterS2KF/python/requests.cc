// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/python/requests.h"

#include <pybind11/stl.h>

#include <cmath>
#include <utility>

#include "common/math/up_axis.h"
#include "common/support/error.h"

namespace mmm_converter::python {

namespace py = pybind11;

namespace {

std::optional<double> NumberOf(const py::dict& options, const char* key) {
  if (!options.contains(key) || options[key].is_none()) return std::nullopt;
  const auto value = options[key].cast<double>();
  if (!std::isfinite(value)) throw Error(std::string(key) + ": is no finite number");
  return value;
}

}  // namespace

std::string TextOf(const py::dict& options, const char* key) {
  if (!options.contains(key) || options[key].is_none()) return "";
  return py::module_::import("os").attr("fspath")(options[key]).cast<std::string>();
}

bool IsSet(const py::dict& options, const char* key) {
  return options.contains(key) && py::bool_(options[key]);
}

InputRequest InputRequestOf(const py::dict& options) {
  InputRequest request;
  request.file = TextOf(options, "file");
  if (const std::string unit = TextOf(options, "unit"); !unit.empty()) request.reading.unit = unit;
  if (const std::string up = TextOf(options, "up"); !up.empty()) {
    request.reading.up_axis = ParseUpAxis(up);
  }
  request.reading.rate = NumberOf(options, "rate");
  if (request.reading.rate && !IsFrameRate(*request.reading.rate)) {
    throw Error("rate: must be from 1 to 100000 frames a second");
  }
  request.reading.ignore_residuals = IsSet(options, "ignore_residuals");
  request.reading.subject = TextOf(options, "prefix");
  request.reading.motion = TextOf(options, "motion");
  if (options.contains("frames") && !options["frames"].is_none()) {
    const auto frames = options["frames"].cast<std::pair<std::optional<int>, std::optional<int>>>();
    std::tie(request.first_frame, request.end_frame) = frames;
    if (frames.first.value_or(0) < 0 || frames.second.value_or(0) < 0) {
      throw Error("frames: (A, B) are the frames A to B-1, counted from 0");
    }
  }
  request.model_file = TextOf(options, "model");
  request.marker_set = TextOf(options, "marker_set");
  request.person.size.height = NumberOf(options, "height");
  request.person.size.mass = NumberOf(options, "mass");
  request.person.size.hand_length = NumberOf(options, "hand_length");
  request.person.processor_file = TextOf(options, "person");
  request.person.subject_file = TextOf(options, "subject_file");
  return request;
}

ConverterRequest ConverterRequestOf(const py::dict& options) {
  return {TextOf(options, "config"), TextOf(options, "converter"), TextOf(options, "plugin")};
}

}  // namespace mmm_converter::python
