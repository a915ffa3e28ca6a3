// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_subject.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <vector>

#include "common/io/osim/osim_xml.h"
#include "common/io/xml/xml_document.h"
#include "common/io/xml/xml_text.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr std::string_view kBegin =
    "<!-- Calibration by MMMConverterS2KF: how well places of markers [m] and the zeros of joints "
    "are known.\n";
constexpr std::string_view kEnd = "-->\n";
constexpr std::string_view kHyphens = "--";  // no comment may have them
constexpr double kSamePlace = 1e-7;          // [m]; places have 9 digits
constexpr double kMostDeviation = 1;         // [m], [rad]

/// Where the comment begins; npos: there is none.
std::size_t FindComment(std::string_view content) {
  return content.find(kBegin, FirstElement(content).size());
}

std::string VectorText(const Eigen::Vector3d& v) {
  return fmt::format("{:.9g} {:.9g} {:.9g}", v.x(), v.y(), v.z());
}

std::string Attribute(const XmlElement& element, const char* name) {
  const std::string* text = element.FindAttribute(name);
  return text == nullptr ? "" : *text;
}

std::optional<Eigen::Vector3d> ReadVector(const XmlElement& element, const char* name) {
  std::vector<double> numbers;
  const std::string text = Attribute(element, name);
  if (!AppendDoubles(text, &numbers) || numbers.size() != 3) return std::nullopt;
  return Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
}

bool IsDeviation(double value) { return value >= 0 && value <= kMostDeviation; }

void ReadMarker(const XmlElement& element, const KinematicModel& model, Subject* subject) {
  MarkerOffset offset;
  offset.marker = Attribute(element, "name");
  const int marker = model.FindMarker(offset.marker);
  const auto place = ReadVector(element, "place");
  const auto deviations = ReadVector(element, "deviations");
  if (marker < 0 || !place || !deviations) return;
  if (!((model.markers()[marker].p_SM - *place).norm() <= kSamePlace)) return;
  if (!std::all_of(deviations->begin(), deviations->end(), IsDeviation)) return;
  offset.standard_deviations = *deviations;
  const double skin = ParseDouble(Attribute(element, "skin_deviation")).value_or(0);
  if (IsDeviation(skin)) offset.skin_deviation = skin;
  offset.frames = static_cast<int>(
      std::clamp(ParseLong(Attribute(element, "frames")).value_or(0), 0L, 1'000'000L));
  subject->offsets.push_back(std::move(offset));
}

void ReadJoint(const XmlElement& element, const KinematicModel& model, Subject* subject) {
  JointDoubt doubt;
  doubt.joint = Attribute(element, "name");
  doubt.deviation = ParseDouble(Attribute(element, "deviation_deg")).value_or(0) / kDegrees;
  if (model.FindJoint(doubt.joint) < 0 || !IsDeviation(doubt.deviation)) return;
  std::istringstream words(Attribute(element, "with"));
  for (std::string word; words >> word;) doubt.partners.push_back(word);
  subject->joints.push_back(std::move(doubt));
}

}  // namespace

std::string WithoutOsimSubject(std::string_view content) {
  const std::size_t begin = FindComment(content);
  if (begin == std::string_view::npos) return std::string(content);
  const std::size_t end = content.find(kEnd, begin);
  std::string text(content.substr(0, begin));
  if (end != std::string_view::npos) text += content.substr(end + kEnd.size());
  return text;
}

std::string WithOsimSubject(std::string_view content, const KinematicModel& model,
                            const Subject& subject, const std::string& program) {
  std::string xml = fmt::format("<Calibration subject=\"{}\" program=\"{}\">\n",
                                EscapeXml(subject.name), EscapeXml(program));
  for (const MarkerOffset& offset : subject.offsets) {
    const int marker = model.FindMarker(offset.marker);
    if (marker < 0) continue;
    xml += fmt::format(
        "  <Marker name=\"{}\" place=\"{}\" deviations=\"{}\" skin_deviation=\"{:.9g}\" "
        "frames=\"{}\"/>\n",
        EscapeXml(offset.marker), VectorText(model.markers()[marker].p_SM),
        VectorText(offset.standard_deviations), offset.skin_deviation, offset.frames);
  }
  for (const JointDoubt& doubt : subject.joints) {
    xml += fmt::format("  <Joint name=\"{}\" deviation_deg=\"{:.9g}\" with=\"{}\"/>\n",
                       EscapeXml(doubt.joint), kDegrees * doubt.deviation,
                       EscapeXml(fmt::format("{}", fmt::join(doubt.partners, " "))));
  }
  xml += "</Calibration>\n";
  for (std::size_t at = 0; (at = xml.find(kHyphens, at)) != std::string::npos;) {
    xml.replace(at, 1, "&#45;");
  }
  std::string text = WithoutOsimSubject(content);
  if (!text.ends_with('\n')) text += '\n';
  return text.append(kBegin).append(xml).append(kEnd);
}

std::shared_ptr<const Subject> ParseOsimSubject(std::string_view content, const std::string& file,
                                                const KinematicModel& model, Warnings* warnings) {
  std::size_t begin = FindComment(content);
  if (begin == std::string_view::npos) return nullptr;
  begin += kBegin.size();
  const std::string_view xml = content.substr(begin);
  auto subject = std::make_shared<Subject>();
  try {
    const XmlElement root = ParseXml(xml.substr(0, xml.find(kEnd)), file);
    subject->name = Attribute(root, "subject");
    subject->model = model.name();
    subject->mass = model.total_mass();
    for (const XmlElement& child : root.children) {
      if (child.Is("Marker")) ReadMarker(child, model, subject.get());
      if (child.Is("Joint")) ReadJoint(child, model, subject.get());
    }
  } catch (const Error&) {
    Warn(warnings, file + ": the comment about its calibration can't be read and is left out");
    return nullptr;
  }
  return subject->offsets.empty() ? nullptr : subject;
}

}  // namespace mmm_converter
