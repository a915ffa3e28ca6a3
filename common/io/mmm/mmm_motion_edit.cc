// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <unordered_set>
#include <utility>

#include "common/io/mmm/mmm_motion.h"
#include "common/io/mmm/mmm_motion_writer.h"
#include "common/io/xml/long_xml.h"
#include "common/io/xml/xml_document.h"
#include "common/io/xml/xml_scanner.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

/// A part of a text that is replaced.
struct Edit {
  std::uint64_t begin;
  std::uint64_t end;
  std::string before;  ///< new text
  /// The elements of its sensors follow the new text, and then `after`; null: none.
  const MmmMotionOutput* with_sensors = nullptr;
  std::string after = {};
};

void CopyBytes(const ByteSource& content, std::uint64_t begin, std::uint64_t end,
               PieceWriter* pieces) {
  constexpr std::uint64_t kMost = 1 << 16;
  while (begin < end) {
    const std::size_t count = std::min(end - begin, kMost);
    std::string& text = *pieces->text();
    text.resize(text.size() + count);
    content.read(begin, count, text.data() + text.size() - count);
    begin += count;
    pieces->EndPart();
  }
}

/// An element and the white space before it, from `from` on.
Edit Removal(const ByteSource& content, std::uint64_t from, const XmlRange& range) {
  std::string space(range.begin - from, '\0');
  content.read(from, space.size(), space.data());
  return {from + space.find_last_not_of(" \t\r\n") + 1, range.end, ""};
}

std::string NameOfMotion(const XmlElement& motion) {
  const std::string* name = motion.FindAttribute("name");
  return name != nullptr ? *name : "";
}

/// The index among the root's children of the only motion with that name.
std::size_t FindMotion(const XmlElement& root, const std::string& file, const std::string& name) {
  std::optional<std::size_t> found;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < root.children.size(); ++i) {
    const XmlElement& child = root.children[i];
    if (!child.Is("Motion")) continue;
    names.push_back(NameOfMotion(child));
    if (names.back() != name) continue;
    if (found) {
      throw Error(
          fmt::format("{}:{}: a second motion \"{}\"; motions to convert need names of "
                      "their own",
                      file, child.line, name));
    }
    found = i;
  }
  if (found) return *found;
  throw Error(fmt::format("{}: has no motion \"{}\"; its motions are: {}", file, name,
                          fmt::join(names, ", ")));
}

bool HasConvertedJoint(const XmlElement& sensor, const std::unordered_set<std::string>& joints) {
  const XmlElement* configuration = sensor.FindChild("Configuration");
  if (configuration == nullptr) return false;
  return std::any_of(configuration->children.begin(), configuration->children.end(),
                     [&](const XmlElement& joint) {
                       const std::string* name = joint.FindAttribute("name");
                       return name != nullptr && joints.count(std::string(Trim(*name))) > 0;
                     });
}

bool IsReplaced(const XmlElement& sensor, const MmmMotionOutput& output,
                const std::unordered_set<std::string>& joints) {
  const std::string* type = sensor.FindAttribute("type");
  if (!sensor.Is("Sensor") || type == nullptr) return false;
  if (EqualIgnoringCase(*type, "MoCapMarker")) return output.markers != nullptr;
  if (output.trajectory == nullptr) return false;
  if (EqualIgnoringCase(*type, "ModelPose")) return true;
  return EqualIgnoringCase(*type, "Kinematic") && HasConvertedJoint(sensor, joints);
}

void EditSensors(const XmlElement& element, const XmlRange& range, const ByteSource& content,
                 const MmmMotionOutput& output, std::vector<Edit>* edits) {
  if (range.inner_begin == range.end) {  // <Sensors/>
    edits->push_back({range.begin, range.end, "<Sensors>\n\t\t\t", &output, "\n\t\t</Sensors>"});
    return;
  }
  std::unordered_set<std::string> joints;
  if (output.trajectory != nullptr) {
    joints.insert(output.trajectory->joint_names.begin(), output.trajectory->joint_names.end());
  }
  const std::size_t first = edits->size();
  std::uint64_t before = range.inner_begin;
  for (std::size_t i = 0; i < element.children.size(); ++i) {
    const XmlRange& sensor = range.children[i];
    if (IsReplaced(element.children[i], output, joints)) {
      edits->push_back(edits->size() == first ? Edit{sensor.begin, sensor.end, "", &output}
                                              : Removal(content, before, sensor));
    }
    before = sensor.end;
  }
  if (edits->size() == first) {
    edits->push_back({range.inner_begin, range.inner_begin, "\n\t\t\t", &output});
  }
}

std::vector<Edit> EditsOf(const XmlElement& motion, const XmlRange& range,
                          const ByteSource& content, const std::string& file,
                          const MmmMotionOutput& output) {
  const XmlElement* model = motion.FindChild("Model");
  const XmlElement* sensors = motion.FindChild("Sensors");
  if (sensors == nullptr) {
    throw Error(
        fmt::format("{}:{}: motion \"{}\" has no <Sensors>; only MMM 2.0 motions can be "
                    "converted in place",
                    file, motion.line, output.motion_name));
  }
  const bool has_motion = output.trajectory != nullptr;
  std::vector<Edit> edits;
  std::uint64_t before = range.inner_begin;
  for (std::size_t i = 0; i < motion.children.size(); ++i) {
    const XmlElement& child = motion.children[i];
    const XmlRange& place = range.children[i];
    if (has_motion && &child == model) {
      edits.push_back({place.begin, place.end, FormatModelElement(output)});
    } else if (&child == sensors) {
      if (has_motion && model == nullptr) {
        edits.push_back({place.begin, place.begin, FormatModelElement(output) + "\n\t\t"});
      }
      EditSensors(child, place, content, output, &edits);
    } else if (has_motion &&
               child.Is("ModelProcessorConfig")) {  // as in 1.0; 2.0 has it in the model
      edits.push_back(Removal(content, before, place));
    }
    before = place.end;
  }
  return edits;
}

void CheckSameTree(const XmlElement& element, const XmlRange& range, int depth,
                   const std::string& file) {
  bool same = element.Is(range.name);
  if (depth > 0) same = same && element.children.size() == range.children.size();
  if (!same) {
    throw Error(fmt::format("{}:{}: <{}> can't be changed in place; write another file", file,
                            element.line, element.name));
  }
  for (std::size_t i = 0; depth > 0 && i < element.children.size(); ++i) {
    CheckSameTree(element.children[i], range.children[i], depth - 1, file);
  }
}

}  // namespace

TextPieces WithConvertedMotions(const ByteSource& content, const std::string& file,
                                const std::vector<MmmMotionOutput>& outputs) {
  constexpr int kSensorDepth = 3;  // MMM / Motion / Sensors / Sensor
  LongXml xml(content, file, {"Measurement"}, kSensorDepth + 1);
  xml.CheckTheRest();
  const XmlElement& root = xml.root();
  if (!root.Is("MMM")) {
    throw Error(fmt::format("{}:{}: the root is <{}>; an MMM motion has <MMM>", file, root.line,
                            root.name));
  }
  const XmlRange range = FindXmlRanges(content, file, kSensorDepth);
  CheckSameTree(root, range, kSensorDepth, file);
  // The edits point to them.
  const auto kept = std::make_shared<const std::vector<MmmMotionOutput>>(outputs);
  std::vector<Edit> edits;
  for (const MmmMotionOutput& output : *kept) {
    const std::size_t index = FindMotion(root, file, output.motion_name);
    CheckWritable(output);
    std::vector<Edit> more =
        EditsOf(root.children[index], range.children[index], content, file, output);
    std::move(more.begin(), more.end(), std::back_inserter(edits));
  }
  std::stable_sort(edits.begin(), edits.end(),
                   [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
  return [content, kept, edits = std::move(edits)](const TextSink& sink) {
    PieceWriter pieces(sink);
    std::uint64_t done = 0;
    for (const Edit& edit : edits) {
      CopyBytes(content, done, edit.begin, &pieces);
      *pieces.text() += edit.before;
      if (edit.with_sensors != nullptr) AppendSensorElements(*edit.with_sensors, &pieces);
      *pieces.text() += edit.after;
      done = edit.end;
    }
    CopyBytes(content, done, content.size, &pieces);
    pieces.Flush();
  };
}

std::string ModelPathFor(const std::string& model_file, const std::string& output_file) {
  namespace fs = std::filesystem;
  const auto canonical_folder = [](const std::string& file) {
    return fs::weakly_canonical(fs::absolute(file).parent_path());
  };
  const fs::path folder = canonical_folder(output_file);
  const fs::path model = canonical_folder(model_file) / fs::path(model_file).filename();
  const auto second = [](const fs::path& path) {
    auto part = path.begin();
    return ++part == path.end() ? fs::path() : *part;
  };
  // Two paths that share only the root are better off with an absolute one: it survives moving the
  // output.
  if (second(folder) != second(model)) return model.generic_string();
  return model.lexically_relative(folder).generic_string();
}

}  // namespace mmm_converter
