// SPDX-License-Identifier: MIT
#include "common/io/mmm/mmm_model_subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "common/io/bytes/file_content.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_model_node.h"
#include "common/io/xml/xml_document.h"
#include "common/io/xml/xml_scanner.h"
#include "common/io/xml/xml_text.h"
#include "common/model/model_scaling.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr int kDepth = 5;  // Robot / RobotNode / Sensor / Transform / Matrix4x4 / row

struct LengthEdit {
  std::uint64_t begin;
  std::uint64_t end;
  std::string text;
};

/// How lengths below an element change: scaled, then moved [m].
struct Change {
  double scale = 1;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();

  bool IsNone() const { return scale == 1 && offset.isZero(0); }
};

std::string NumberText(double value) { return fmt::format("{:.10g}", value + 0.0); }

/// Where the value of an attribute, in any case, stands in a start tag.
std::pair<std::size_t, std::size_t> FindValue(std::string_view tag, std::string_view attribute) {
  std::size_t at = tag.find_first_of(" \t\r\n");
  while (at != std::string_view::npos) {
    const std::size_t name = tag.find_first_not_of(" \t\r\n", at);
    const std::size_t quote = tag.find_first_of("\"'", name);
    if (quote == std::string_view::npos) break;
    const std::size_t end = tag.find(tag[quote], quote + 1);
    const std::size_t name_end = tag.find_first_of(" \t\r\n=", name);
    if (EqualIgnoringCase(tag.substr(name, name_end - name), attribute)) return {quote + 1, end};
    at = end == std::string_view::npos ? end : end + 1;
  }
  return {0, 0};
}

class ModelEditor {
 public:
  ModelEditor(const std::string& content, const std::string& file, const Subject& subject)
      : content_(content), file_(file) {
    const KinematicModel model = ParseMmmModel(content, file);
    const WinterScaling person{subject.height, subject.mass, subject.hand_length};
    FitToSubject(model, subject);  // throws where a name is unknown
    for (const SegmentScale& scale : subject.scales) scales_[scale.segment] = scale.scale;
    const std::vector<double> lengths = WinterLengths(model, person);
    for (const MarkerOffset& offset : subject.offsets) {
      const int segment = model.markers()[model.FindMarker(offset.marker)].segment;
      offsets_[offset.marker] = offset.offset / lengths[segment];
    }
  }

  std::string Edited(const std::string& comment) {
    const XmlElement robot = ParseXml(content_, file_);
    const XmlRange range = FindXmlRanges(BytesOf(content_), file_, kDepth);
    edits_.push_back({range.begin, range.begin, comment});
    ForEachChild(robot, range, [this](const XmlElement& node, const XmlRange& place) {
      if (node.Is("RobotNode")) EditNode(node, place);
    });
    std::string edited;
    std::uint64_t done = 0;
    for (const LengthEdit& edit : edits_) {
      edited.append(content_, done, edit.begin - done).append(edit.text);
      done = edit.end;
    }
    return edited.append(content_, done);
  }

 private:
  template <typename Visit>
  void ForEachChild(const XmlElement& element, const XmlRange& range, Visit visit) {
    if (element.children.size() != range.children.size()) {
      throw Error(
          fmt::format("{}:{}: <{}> can't be changed in place", file_, element.line, element.name));
    }
    for (std::size_t i = 0; i < element.children.size(); ++i) {
      visit(element.children[i], range.children[i]);
    }
  }

  static std::string NameOf(const XmlElement& element) {
    const std::string* name = element.FindAttribute("name");
    return name == nullptr ? "" : std::string(Trim(*name));
  }

  static bool HasType(const XmlElement& element, std::string_view type) {
    const std::string* text = element.FindAttribute("type");
    return text != nullptr && EqualIgnoringCase(*text, type);
  }

  void EditNode(const XmlElement& node, const XmlRange& range) {
    Change change;
    const auto scale = scales_.find(NameOf(node));
    if (scale != scales_.end()) change.scale = scale->second;
    ForEachChild(node, range, [&](const XmlElement& part, const XmlRange& place) {
      if (part.Is("Transform")) {
        EditTransform(part, place, change);
      } else if (part.Is("Joint") && HasType(part, "prismatic")) {
        EditLimits(part, place, change);
      } else if (part.Is("Physics")) {
        EditPhysics(part, place, change);
      } else if (part.Is("Sensor") && HasType(part, "position")) {
        EditSensor(part, place, change);
      }
    });
  }

  void EditLimits(const XmlElement& joint, const XmlRange& range, const Change& change) {
    ForEachChild(joint, range, [&](const XmlElement& part, const XmlRange& place) {
      if (!part.Is("limits")) return;
      EditNumbers(place, {{"lo", change.scale, 0}, {"hi", change.scale, 0}}, part);
    });
  }

  void EditPhysics(const XmlElement& physics, const XmlRange& range, const Change& change) {
    ForEachChild(physics, range, [&](const XmlElement& part, const XmlRange& place) {
      if (part.Is("CoM")) EditVector(part, place, change);
      if (!part.Is("InertiaMatrix")) return;
      ForEachChild(part, place, [&](const XmlElement& row, const XmlRange& numbers) {
        const double factor = change.scale * change.scale;
        EditNumbers(numbers, {{"c1", factor, 0}, {"c2", factor, 0}, {"c3", factor, 0}}, row);
      });
    });
  }

  void EditSensor(const XmlElement& sensor, const XmlRange& range, Change change) {
    const auto offset = offsets_.find(NameOf(sensor));
    if (offset != offsets_.end()) change.offset = offset->second;
    bool is_found = false;
    ForEachChild(sensor, range, [&](const XmlElement& part, const XmlRange& place) {
      if (!part.Is("Transform")) return;
      EditTransform(part, place, change);
      is_found = true;
    });
    if (!is_found && !change.offset.isZero(0)) {
      InsertInto(sensor, range, "<Transform>" + TranslationOf(change) + "</Transform>");
    }
  }

  void EditTransform(const XmlElement& transform, const XmlRange& range, const Change& change) {
    if (change.IsNone()) return;
    bool has_place = false;
    for (const XmlElement& part : transform.children) {
      has_place |= part.Is("Translation") || part.Is("Matrix4x4");
    }
    if (!has_place && !change.offset.isZero(0)) {
      InsertInto(transform, range, TranslationOf(change));
    }
    ForEachChild(transform, range, [&](const XmlElement& part, const XmlRange& place) {
      if (part.Is("Translation")) EditVector(part, place, change);
      if (!part.Is("Matrix4x4")) return;
      const double unit = LengthUnit(part);
      ForEachChild(part, place, [&](const XmlElement& row, const XmlRange& numbers) {
        for (int i = 0; i < 3; ++i) {
          if (!row.Is(fmt::format("row{}", i + 1))) continue;
          EditNumbers(numbers, {{"c4", change.scale, change.offset[i] / unit}}, row);
        }
      });
    });
  }

  void EditVector(const XmlElement& vector, const XmlRange& range, const Change& change) {
    const Eigen::Vector3d offset = change.offset / LengthUnit(vector);
    EditNumbers(range,
                {{"x", change.scale, offset.x()},
                 {"y", change.scale, offset.y()},
                 {"z", change.scale, offset.z()}},
                vector);
  }

  struct NumberChange {
    const char* attribute;
    double factor;
    double offset;
  };

  /// Attributes of a start tag; what does not change keeps its text.
  void EditNumbers(const XmlRange& range, const std::vector<NumberChange>& changes,
                   const XmlElement& element) {
    const std::string_view tag =
        std::string_view(content_).substr(range.begin, range.inner_begin - range.begin);
    std::vector<LengthEdit> edits;
    for (const NumberChange& change : changes) {
      const std::string* text = element.FindAttribute(change.attribute);
      if (text == nullptr || (change.factor == 1 && change.offset == 0)) continue;
      const auto number = ParseDouble(*text);
      if (!number) continue;
      const auto [begin, end] = FindValue(tag, change.attribute);
      edits.push_back({range.begin + begin, range.begin + end,
                       NumberText(*number * change.factor + change.offset)});
    }
    std::sort(edits.begin(), edits.end(),
              [](const LengthEdit& a, const LengthEdit& b) { return a.begin < b.begin; });
    edits_.insert(edits_.end(), edits.begin(), edits.end());
  }

  static std::string TranslationOf(const Change& change) {
    const Eigen::Vector3d place = change.offset * kMillimetres;
    return fmt::format("<Translation x=\"{}\" y=\"{}\" z=\"{}\" units=\"mm\"/>",
                       NumberText(place.x()), NumberText(place.y()), NumberText(place.z()));
  }

  /// Puts text first into an element, which may be empty (<a/>).
  void InsertInto(const XmlElement& element, const XmlRange& range, const std::string& text) {
    if (range.inner_begin == range.end) {
      edits_.push_back({range.end - 2, range.end, fmt::format(">{}</{}>", text, element.name)});
    } else {
      edits_.push_back({range.inner_begin, range.inner_begin, text});
    }
  }

  const std::string& content_;
  const std::string& file_;
  std::map<std::string, double> scales_;
  std::map<std::string, Eigen::Vector3d> offsets_;  // for a person of 1 m [m]
  std::vector<LengthEdit> edits_;
};

}  // namespace

std::string FormatSubjectModel(const std::string& model_xml, const std::string& file,
                               const Subject& subject) {
  const std::string hand = subject.hand_length ? fmt::format(", HandLength {} (cm)",
                                                             NumberText(100 * *subject.hand_length))
                                               : "";
  const std::string comment = fmt::format(
      "Lengths, markers and inertia of the subject {}, for 1 m and 1 kg: this person with the\n"
      "     ModelProcessorConfig Winter of Height {} (m), Mass {} (kg){}.",
      subject.name, NumberText(subject.height), NumberText(subject.mass), hand);
  return ModelEditor(model_xml, file, subject).Edited(FormatXmlComment(comment) + "\n");
}

std::string ReadModelForSubject(const std::string& model_file, const Subject& subject) {
  return FormatSubjectModel(ReadFileContent(model_file, kMaxModelBytes), model_file, subject);
}

}  // namespace mmm_converter
