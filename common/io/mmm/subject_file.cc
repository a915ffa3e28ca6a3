// SPDX-License-Identifier: MIT
#include "common/io/mmm/subject_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <sstream>

#include "common/io/bytes/file_content.h"
#include "common/io/xml/xml_document.h"
#include "common/io/xml/xml_text.h"
#include "common/model/model_scaling.h"
#include "common/support/diagnostics.h"
#include "common/support/error.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMaxSubjectBytes = std::size_t{8} << 20;
constexpr double kMillimetre = 1e-3;
constexpr int kDecimals = 6;
constexpr double kLargestDeviation = 1;
constexpr double kMostTurn = 180 / kDegrees;  // [rad]

/// What an attribute may be, in SI units, and the factor from its own unit.
struct NumberRange {
  double least = 0;
  double most = 0;
  double unit = 1;
};

class SubjectReader {
 public:
  SubjectReader(const XmlElement& root, const std::string& file, const KinematicModel& model,
                bool leaves_others)
      : root_(root), model_(model), leaves_others_(leaves_others), diagnostics_(file) {
    for (const Segment& segment : model.segments()) segments_.push_back(segment.name);
    for (const ModelMarker& marker : model.markers()) markers_.push_back(marker.name);
    for (int j = 0; j < model.num_joints(); ++j) joints_.push_back(model.joint(j).name);
  }

  Subject Read() {
    if (root_.name != "Subject") {
      throw Error(
          fmt::format("{}:{}: this is a <{}> file; a subject file starts with <Subject "
                      "model=\"...\" height_m=\"...\" mass_kg=\"...\">",
                      diagnostics_.file(), root_.line, root_.name));
    }
    ReadPerson();
    std::map<std::string, int> lines;
    for (const XmlElement& child : root_.children) {
      CheckUnique(child, child.name, &lines);
      if (child.name == "Segments") {
        ForEach(child, "Segment", [this](const XmlElement& one) { ReadScale(one); });
      } else if (child.name == "Markers") {
        ForEach(child, "Marker", [this](const XmlElement& one) { ReadOffset(one); });
      } else if (child.name == "Joints") {
        ForEach(child, "Joint", [this](const XmlElement& one) { ReadDoubt(one); });
      } else if (child.name == "Provenance") {
        AllowAttributes(child, {"program"});
        ForEach(child, "Recording", [this](const XmlElement& one) { ReadSource(one); });
      } else {
        Fail(child, "use Segments, Markers, Joints or Provenance; there is no such element");
      }
    }
    diagnostics_.ThrowIfErrors();
    return std::move(subject_);
  }

 private:
  void Fail(const XmlElement& at, const std::string& message, Remedy remedy = Remedy::kNone) {
    diagnostics_.AddError(at.line, fmt::format("<{}>: {}", at.name, message), remedy);
  }

  void ReadPerson() {
    AllowAttributes(root_, {"name", "model", "height_m", "mass_kg", "hand_length_mm"});
    if (const std::string* name = root_.FindAttribute("name")) subject_.name = *name;
    if (const std::string* name = root_.FindAttribute("model")) subject_.model = *name;
    if (subject_.model != model_.name()) {
      Fail(root_,
           fmt::format("is a subject of the model \"{}\", this model is \"{}\"; give the "
                       "model of the subject",
                       subject_.model, model_.name()),
           Remedy::kModel);
    }
    subject_.height = Needed(root_, "height_m", {kLeastHeight, kLargestHeight});
    subject_.mass = Needed(root_, "mass_kg", {kLeastMass, kLargestMass});
    subject_.hand_length =
        Number(root_, "hand_length_mm", {kLeastHandLength, kLargestHandLength, kMillimetre});
  }

  void ReadScale(const XmlElement& element) {
    AllowAttributes(element,
                    {"name", "scale", "standardDeviation", "priorDeviation", "observability"});
    SegmentScale scale;
    scale.segment = KnownName(element, segments_, &segment_lines_);
    scale.scale = Needed(element, "scale", {kLeastSegmentScale, kLargestSegmentScale});
    const NumberRange deviation{0, kLargestDeviation};
    scale.standard_deviation = Number(element, "standardDeviation", deviation).value_or(0);
    scale.prior_deviation = Number(element, "priorDeviation", deviation).value_or(0);
    subject_.scales.push_back(std::move(scale));
  }

  void ReadOffset(const XmlElement& element) {
    AllowAttributes(
        element, {"name", "x_mm", "y_mm", "z_mm", "xDeviation_mm", "yDeviation_mm", "zDeviation_mm",
                  "priorDeviation_mm", "skinDeviation_mm", "frames", "observability"});
    const std::string* name = element.FindAttribute("name");
    if (leaves_others_ && name != nullptr && model_.FindMarker(*name) < 0) return;
    MarkerOffset offset;
    offset.marker = KnownName(element, markers_, &marker_lines_);
    const NumberRange place{-kLargestMarkerOffset, kLargestMarkerOffset, kMillimetre};
    const NumberRange deviation{0, kLargestDeviation, kMillimetre};
    for (int i = 0; i < 3; ++i) {
      const char axis = "xyz"[i];
      offset.offset[i] = Needed(element, fmt::format("{}_mm", axis), place);
      offset.standard_deviations[i] =
          Number(element, fmt::format("{}Deviation_mm", axis), deviation).value_or(0);
    }
    offset.prior_deviation = Number(element, "priorDeviation_mm", deviation).value_or(0);
    offset.skin_deviation = Number(element, "skinDeviation_mm", deviation).value_or(0);
    offset.frames = Frames(element);
    subject_.offsets.push_back(std::move(offset));
  }

  void ReadDoubt(const XmlElement& element) {
    AllowAttributes(element, {"name", "deviation_deg", "with"});
    JointDoubt doubt;
    doubt.joint = KnownName(element, joints_, &joint_lines_);
    doubt.deviation = Needed(element, "deviation_deg", {0, kMostTurn, 1 / kDegrees});
    if (const std::string* with = element.FindAttribute("with")) {
      std::istringstream words(*with);
      for (std::string word; words >> word;) doubt.partners.push_back(word);
    }
    subject_.joints.push_back(std::move(doubt));
  }

  void ReadSource(const XmlElement& element) {
    AllowAttributes(element, {"name", "frames"});
    SubjectSource source;
    if (const std::string* name = element.FindAttribute("name")) source.recording = *name;
    source.frames = Frames(element);
    subject_.sources.push_back(std::move(source));
  }

  template <typename Read>
  void ForEach(const XmlElement& list, const char* member, Read read) {
    if (list.name != "Provenance") AllowAttributes(list, {});
    for (const XmlElement& child : list.children) {
      if (child.name == member) {
        read(child);
      } else {
        Fail(child, fmt::format("<{}> has only <{}>", list.name, member));
      }
    }
  }

  std::string KnownName(const XmlElement& element, const std::vector<std::string>& known,
                        std::map<std::string, int>* lines) {
    const std::string* name = element.FindAttribute("name");
    if (name == nullptr || name->empty()) {
      Fail(element, "needs name=\"...\"");
      return "";
    }
    if (std::find(known.begin(), known.end(), *name) == known.end()) {
      const std::string closest = diagnostics_.is_full() ? "" : ClosestName(*name, known);
      Fail(element, fmt::format("the model {} has no \"{}\"{}", model_.name(), *name,
                                closest.empty() ? "" : " (did you mean " + closest + "?)"));
    }
    CheckUnique(element, *name, lines);
    return *name;
  }

  std::optional<double> Number(const XmlElement& element, const std::string& attribute,
                               const NumberRange& range) {
    const std::string* text = element.FindAttribute(attribute);
    if (text == nullptr) return std::nullopt;
    const auto number = ParseDouble(*text);
    if (number && *number * range.unit >= range.least && *number * range.unit <= range.most) {
      return *number * range.unit;
    }
    Fail(element, fmt::format("{}=\"{}\" is not allowed; use a number from {:g} to {:g}", attribute,
                              *text, range.least / range.unit, range.most / range.unit));
    return std::nullopt;
  }

  double Needed(const XmlElement& element, const std::string& attribute, const NumberRange& range) {
    if (element.FindAttribute(attribute) == nullptr) {
      Fail(element, fmt::format("needs {}=\"...\"", attribute));
    }
    return Number(element, attribute, range).value_or(1);
  }

  int Frames(const XmlElement& element) {
    const std::string* text = element.FindAttribute("frames");
    if (text == nullptr) return 0;
    const auto number = ParseLong(*text);
    if (number && *number >= 0 && *number <= std::numeric_limits<int>::max()) {
      return static_cast<int>(*number);
    }
    Fail(element, fmt::format("frames=\"{}\" is not allowed; use a whole number from 0", *text));
    return 0;
  }

  void CheckUnique(const XmlElement& element, const std::string& name,
                   std::map<std::string, int>* lines) {
    const auto [first, is_new] = lines->emplace(name, element.line);
    if (is_new) return;
    Fail(element, fmt::format("{} is already in line {}; keep one of them", name, first->second));
  }

  void AllowAttributes(const XmlElement& element, const std::vector<std::string>& names) {
    for (const std::string& attribute : element.AttributesBeside(names)) {
      Fail(element, fmt::format("unknown attribute {}{}", attribute,
                                names.empty() ? "" : "; use " + JoinNames(names)));
    }
  }

  const XmlElement& root_;
  const KinematicModel& model_;
  const bool leaves_others_;
  Diagnostics diagnostics_;
  std::vector<std::string> segments_, markers_, joints_;
  std::map<std::string, int> segment_lines_, marker_lines_, joint_lines_;
  Subject subject_;
};

std::string Attribute(const char* name, double value, int decimals = kDecimals) {
  std::string text = fmt::format(" {}=\"", name);
  AppendDecimal(value, decimals, &text);
  return text + '"';
}

std::string Millimetres(const char* name, double metres) {
  return Attribute(name, metres / kMillimetre, kMillimetreDecimals);
}

std::string Name(const std::string& name) { return fmt::format(" name=\"{}\"", EscapeXml(name)); }

// Two decimals: a share, for people.
std::string ObservabilityAttribute(double deviation, double prior) {
  return prior > 0 ? Attribute("observability", Observability(deviation, prior), 2) : "";
}

std::string FormatScale(const SegmentScale& scale) {
  return "    <Segment" + Name(scale.segment) + Attribute("scale", scale.scale) +
         Attribute("standardDeviation", scale.standard_deviation) +
         Attribute("priorDeviation", scale.prior_deviation) +
         ObservabilityAttribute(scale.standard_deviation, scale.prior_deviation) + "/>\n";
}

std::string FormatOffset(const MarkerOffset& offset) {
  const Eigen::Vector3d& p = offset.offset;
  const Eigen::Vector3d& deviations = offset.standard_deviations;
  return "    <Marker" + Name(offset.marker) + Millimetres("x_mm", p.x()) +
         Millimetres("y_mm", p.y()) + Millimetres("z_mm", p.z()) +
         Millimetres("xDeviation_mm", deviations.x()) +
         Millimetres("yDeviation_mm", deviations.y()) +
         Millimetres("zDeviation_mm", deviations.z()) +
         Millimetres("priorDeviation_mm", offset.prior_deviation) +
         (offset.skin_deviation > 0 ? Millimetres("skinDeviation_mm", offset.skin_deviation) : "") +
         fmt::format(" frames=\"{}\"", offset.frames) +
         ObservabilityAttribute(Deviation(offset), offset.prior_deviation) + "/>\n";
}

std::string FormatDoubt(const JointDoubt& doubt) {
  return "    <Joint" + Name(doubt.joint) +
         Attribute("deviation_deg", kDegrees * doubt.deviation, 2) +
         (doubt.partners.empty()
              ? ""
              : fmt::format(" with=\"{}\"",
                            EscapeXml(fmt::format("{}", fmt::join(doubt.partners, " "))))) +
         "/>\n";
}

}  // namespace

std::string FormatSubject(const Subject& subject, const std::string& program) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<!-- A person beyond height and mass. scale: length of a segment relative to the model "
      "scaled "
      "by height.\n     x_mm, y_mm, z_mm: where a marker sits, from the scaled model's place, in "
      "axes of its segment.\n     observability: the share of what was assumed beforehand that the "
      "recordings replaced.\n     Joints: the deviation of an error that is the same in all "
      "frames, "
      "and what errs with it. -->\n"
      "<Subject{} model=\"{}\"",
      Name(subject.name), EscapeXml(subject.model));
  text += Attribute("height_m", subject.height) + Attribute("mass_kg", subject.mass);
  if (subject.hand_length) text += Millimetres("hand_length_mm", *subject.hand_length);
  text += ">\n  <Segments>\n";
  for (const SegmentScale& scale : subject.scales) text += FormatScale(scale);
  text += "  </Segments>\n  <Markers>\n";
  for (const MarkerOffset& offset : subject.offsets) text += FormatOffset(offset);
  text += "  </Markers>\n";
  if (!subject.joints.empty()) {
    text += "  <Joints>\n";
    for (const JointDoubt& doubt : subject.joints) text += FormatDoubt(doubt);
    text += "  </Joints>\n";
  }
  text += fmt::format("  <Provenance program=\"{}\">\n", EscapeXml(program));
  for (const SubjectSource& source : subject.sources) {
    text +=
        fmt::format("    <Recording{} frames=\"{}\"/>\n", Name(source.recording), source.frames);
  }
  return text + "  </Provenance>\n</Subject>\n";
}

Subject ParseSubject(const std::string& xml, const std::string& file,
                     const KinematicModel& reference, bool leaves_others) {
  return SubjectReader(ParseXml(xml, file), file, reference, leaves_others).Read();
}

Subject ReadSubject(const std::string& path, const KinematicModel& reference, bool leaves_others) {
  return ParseSubject(ReadFileContent(path, kMaxSubjectBytes), path, reference, leaves_others);
}

}  // namespace mmm_converter
