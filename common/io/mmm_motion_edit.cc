// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <unordered_set>

#include "common/io/mmm_motion.h"
#include "common/io/mmm_motion_writer.h"
#include "common/io/xml_document.h"
#include "common/io/xml_text.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

/// Replacements in a text, in the order of their places.
class Edits {
 public:
  explicit Edits(std::string_view content) : content_(content) {}

  void Replace(std::size_t begin, std::size_t end, std::string_view replacement) {
    edited_ += content_.substr(done_, begin - done_);
    edited_ += replacement;
    done_ = end;
  }
  /// Removes the element and the white space before it.
  void Remove(const XmlRange& range) {
    const std::size_t last = content_.find_last_not_of(" \t\r\n", range.begin - 1);
    Replace(std::max(last + 1, done_), range.end, "");
  }
  std::string Finish() {
    Replace(content_.size(), content_.size(), "");
    return std::move(edited_);
  }

 private:
  std::string_view content_;
  std::string edited_;
  std::size_t done_ = 0;
};

std::string NameOf(const XmlElement& motion) {
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
    names.push_back(NameOf(child));
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
  if (EqualIgnoringCase(*type, "ModelPose")) return true;
  if (EqualIgnoringCase(*type, "MoCapMarker")) return output.markers != nullptr;
  return EqualIgnoringCase(*type, "Kinematic") && HasConvertedJoint(sensor, joints);
}

void EditSensors(const XmlElement& element, const XmlRange& range, const MmmMotionOutput& output,
                 Edits* edits) {
  const std::string sensors = FormatSensorElements(output);
  if (range.inner_begin == range.end) {  // <Sensors/>
    edits->Replace(range.begin, range.end, "<Sensors>\n" + sensors + "\t\t</Sensors>");
    return;
  }
  std::string_view text = sensors;  // without the first indentation and the last new line
  text.remove_prefix(text.find('<'));
  text.remove_suffix(1);
  const std::unordered_set<std::string> joints(output.trajectory->joint_names.begin(),
                                               output.trajectory->joint_names.end());
  std::vector<const XmlRange*> replaced;
  for (std::size_t i = 0; i < element.children.size(); ++i) {
    if (IsReplaced(element.children[i], output, joints)) replaced.push_back(&range.children[i]);
  }
  if (replaced.empty()) {
    edits->Replace(range.inner_begin, range.inner_begin, "\n\t\t\t" + std::string(text));
  }
  for (const XmlRange* old : replaced) {
    if (old == replaced.front()) {
      edits->Replace(old->begin, old->end, text);
    } else {
      edits->Remove(*old);
    }
  }
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

std::string WithConvertedMotion(std::string_view content, const std::string& file,
                                const MmmMotionOutput& output) {
  constexpr int kDepth = 3;  // MMM / Motion / Sensors / Sensor
  const XmlElement root = ParseXml(content, file);
  if (!root.Is("MMM")) {
    throw Error(fmt::format("{}:{}: the root is <{}>; an MMM motion has <MMM>", file, root.line,
                            root.name));
  }
  const XmlRange root_range = FindXmlRanges(content, kDepth);
  CheckSameTree(root, root_range, kDepth, file);
  const std::size_t index = FindMotion(root, file, output.motion_name);
  const XmlElement& motion = root.children[index];
  const XmlRange& range = root_range.children[index];
  const XmlElement* sensors = motion.FindChild("Sensors");
  if (sensors == nullptr) {
    throw Error(
        fmt::format("{}:{}: motion \"{}\" has no <Sensors>; only MMM 2.0 motions can be "
                    "converted in place",
                    file, motion.line, output.motion_name));
  }
  const XmlElement* model = motion.FindChild("Model");
  Edits edits(content);
  for (std::size_t i = 0; i < motion.children.size(); ++i) {
    const XmlElement& child = motion.children[i];
    if (&child == model) {
      edits.Replace(range.children[i].begin, range.children[i].end, FormatModelElement(output));
    } else if (&child == sensors) {
      if (model == nullptr) {
        edits.Replace(range.children[i].begin, range.children[i].begin,
                      FormatModelElement(output) + "\n\t\t");
      }
      EditSensors(child, range.children[i], output, &edits);
    } else if (child.Is("ModelProcessorConfig")) {  // as in 1.0; 2.0 has it in the model
      edits.Remove(range.children[i]);
    }
  }
  return edits.Finish();
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
