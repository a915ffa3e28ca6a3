// SPDX-License-Identifier: MIT
#include "common/io/mmm/mmm_object_model.h"

#include <fmt/format.h>

#include <cassert>

#include "common/io/xml/xml_text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

void AppendMillimetres(const char* attribute, double metres, std::string* text) {
  *text += fmt::format(" {}=\"", attribute);
  AppendDecimal(metres * kMillimetres, kMillimetreDecimals, text);
  *text += '"';
}

}  // namespace

std::string FormatObjectModel(const KinematicModel& model, const std::string& comment) {
  assert(model.segments().size() == 1);
  const std::string root = EscapeXml(model.segments().front().name);
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  if (!comment.empty()) text += FormatXmlComment(comment) + "\n";
  text += fmt::format("<Robot Type=\"{}\" RootNode=\"{}\">\n  <RobotNode name=\"{}\">\n",
                      EscapeXml(model.name()), root, root);
  for (const ModelMarker& marker : model.markers()) {
    text += fmt::format("    <Sensor type=\"position\" name=\"{}\"><Transform><Translation",
                        EscapeXml(marker.name));
    AppendMillimetres("x", marker.p_SM.x(), &text);
    AppendMillimetres("y", marker.p_SM.y(), &text);
    AppendMillimetres("z", marker.p_SM.z(), &text);
    text += " units=\"mm\"/></Transform></Sensor>\n";
  }
  return text + "  </RobotNode>\n</Robot>\n";
}

}  // namespace mmm_converter
