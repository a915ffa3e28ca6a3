// SPDX-License-Identifier: MIT
#include "common/convert/marker_set_text.h"

#include <fmt/format.h>

#include <set>

#include "common/io/xml/xml_text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

/// To a micrometre, where that is needed: a set is tracked as what it was made of. Without "-0.0".
std::string FormatMillimetres(double metres) {
  std::string text = fmt::format("{:.3f}", kMillimetres * metres);
  while (text.ends_with('0') && text[text.size() - 2] != '.') text.pop_back();
  return text == "-0.0" ? "0.0" : text;
}

std::string FormatPair(const MarkerPair& pair) {
  std::string text = fmt::format("  <Mapping source=\"{}\" target=\"{}\"", EscapeXml(pair.source),
                                 EscapeXml(pair.target));
  if (pair.noise_scale != 1) text += fmt::format(" noiseScale=\"{:g}\"", pair.noise_scale);
  if (!pair.warning.empty()) text += fmt::format(" warning=\"{}\"", EscapeXml(pair.warning));
  return text + "/>\n";
}

}  // namespace

std::string FormatMarkerSet(const MarkerSet& set, const std::string& head,
                            const std::vector<std::string>& remarks,
                            const std::vector<std::string>& tail) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  if (!head.empty()) text += FormatXmlComment(head) + "\n";
  text += fmt::format("<MarkerSet name=\"{}\"", EscapeXml(set.name));
  if (!set.description.empty()) {
    text += fmt::format(" description=\"{}\"", EscapeXml(set.description));
  }
  text += ">\n";
  std::set<std::string> placed;
  for (std::size_t i = 0; i < set.places.size(); ++i) {
    const MarkerPlace& place = set.places[i];
    placed.insert(place.marker);
    text += fmt::format(
        "  <Marker name=\"{}\" segment=\"{}\" x_mm=\"{}\" y_mm=\"{}\" z_mm=\"{}\"/>",
        EscapeXml(place.marker), EscapeXml(place.segment), FormatMillimetres(place.p_SM.x()),
        FormatMillimetres(place.p_SM.y()), FormatMillimetres(place.p_SM.z()));
    if (i < remarks.size() && !remarks[i].empty()) text += "  " + FormatXmlComment(remarks[i]);
    text += "\n";
  }
  for (const MarkerPair& pair : set.pairs) {
    const bool is_implied = pair.source == pair.target && placed.contains(pair.target) &&
                            pair.noise_scale == 1 && pair.warning.empty();
    if (!is_implied) text += FormatPair(pair);
  }
  for (const std::string& comment : tail) text += "  " + FormatXmlComment(comment) + "\n";
  return text + "</MarkerSet>\n";
}

}  // namespace mmm_converter
