// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/subject_json.h"

#include <nlohmann/json.hpp>

#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr int kDecimals = 6;  // as in subject files

Json Decimals(double value) { return Number(value, kDecimals); }

Json Millimetres(const Eigen::Vector3d& v) {
  return {Decimals(kMillimetres * v.x()), Decimals(kMillimetres * v.y()),
          Decimals(kMillimetres * v.z())};
}

// null: the file does not say what was assumed.
Json ObservabilityJson(double deviation, double prior) {
  return prior > 0 ? Decimals(Observability(deviation, prior)) : Json(nullptr);
}

}  // namespace

Json ToJson(const Subject& subject) {
  Json segments = Json::array();
  for (const SegmentScale& scale : subject.scales) {
    segments.push_back(
        {{"name", scale.segment},
         {"scale", Decimals(scale.scale)},
         {"standard_deviation", Decimals(scale.standard_deviation)},
         {"prior_deviation", Decimals(scale.prior_deviation)},
         {"observability", ObservabilityJson(scale.standard_deviation, scale.prior_deviation)}});
  }
  Json markers = Json::array();
  for (const MarkerOffset& offset : subject.offsets) {
    markers.push_back(
        {{"name", offset.marker},
         {"offset_mm", Millimetres(offset.offset)},
         {"distance_mm", Decimals(kMillimetres * offset.offset.norm())},
         {"standard_deviation_mm", Millimetres(offset.standard_deviations)},
         {"prior_deviation_mm", Decimals(kMillimetres * offset.prior_deviation)},
         {"skin_deviation_mm", offset.skin_deviation > 0
                                   ? Decimals(kMillimetres * offset.skin_deviation)
                                   : Json(nullptr)},
         {"frames", offset.frames},
         {"observability", ObservabilityJson(Deviation(offset), offset.prior_deviation)}});
  }
  Json joints = Json::array();
  for (const JointDoubt& doubt : subject.joints) {
    joints.push_back({{"name", doubt.joint},
                      {"deviation_deg", Decimals(kDegrees * doubt.deviation)},
                      {"with", doubt.partners}});
  }
  Json sources = Json::array();
  for (const SubjectSource& source : subject.sources) {
    sources.push_back({{"recording", source.recording}, {"frames", source.frames}});
  }
  Json json = {{"name", subject.name},
               {"model", subject.model},
               {"height_m", subject.height > 0 ? Json(Decimals(subject.height)) : Json(nullptr)},
               {"mass_kg", Decimals(subject.mass)}};
  if (subject.hand_length) json["hand_length_m"] = Decimals(*subject.hand_length);
  json["segments"] = std::move(segments);
  json["markers"] = std::move(markers);
  json["joints"] = std::move(joints);
  json["sources"] = std::move(sources);
  return json;
}

}  // namespace mmm_converter
