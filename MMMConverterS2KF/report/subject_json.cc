// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/subject_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace mmm_converter {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMillimetres = 1000;  // in a metre

// Six decimals, as in subject files.
Json Number(double value) { return std::round(value * 1e6) / 1e6; }

Json Millimetres(const Eigen::Vector3d& v) {
  return {Number(kMillimetres * v.x()), Number(kMillimetres * v.y()), Number(kMillimetres * v.z())};
}

// null: the file does not say what was assumed.
Json ObservabilityJson(double deviation, double prior) {
  return prior > 0 ? Number(Observability(deviation, prior)) : Json(nullptr);
}

}  // namespace

std::string FormatSubjectJson(const Subject& subject) {
  Json segments = Json::array();
  for (const SegmentScale& scale : subject.scales) {
    segments.push_back(
        {{"name", scale.segment},
         {"scale", Number(scale.scale)},
         {"standard_deviation", Number(scale.standard_deviation)},
         {"prior_deviation", Number(scale.prior_deviation)},
         {"observability", ObservabilityJson(scale.standard_deviation, scale.prior_deviation)}});
  }
  Json markers = Json::array();
  for (const MarkerOffset& offset : subject.offsets) {
    markers.push_back(
        {{"name", offset.marker},
         {"offset_mm", Millimetres(offset.offset)},
         {"distance_mm", Number(kMillimetres * offset.offset.norm())},
         {"standard_deviation_mm", Millimetres(offset.standard_deviations)},
         {"prior_deviation_mm", Number(kMillimetres * offset.prior_deviation)},
         {"frames", offset.frames},
         {"observability", ObservabilityJson(Deviation(offset), offset.prior_deviation)}});
  }
  Json sources = Json::array();
  for (const SubjectSource& source : subject.sources) {
    sources.push_back({{"recording", source.recording}, {"frames", source.frames}});
  }
  Json json = {{"name", subject.name},
               {"model", subject.model},
               {"height_m", Number(subject.height)},
               {"mass_kg", Number(subject.mass)}};
  if (subject.hand_length) json["hand_length_m"] = Number(*subject.hand_length);
  json["segments"] = std::move(segments);
  json["markers"] = std::move(markers);
  json["sources"] = std::move(sources);
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace mmm_converter
