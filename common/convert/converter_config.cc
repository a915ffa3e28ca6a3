// SPDX-License-Identifier: MIT
#include "common/convert/converter_config.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <set>

#include "common/io/bytes/file_content.h"
#include "common/model/kinematic_model.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMaxConfigBytes = std::size_t{16} << 20;
constexpr double kSmallestNoiseScale = 0.01;
constexpr double kLargestNoiseScale = 100;

// Reads one file. KIT's configurations for its own converter have settings that are not known here:
// there, what is unknown is a warning.
class ConfigReader {
 public:
  ConfigReader(const XmlElement& root, const std::string& file, Warnings* warnings)
      : root_(root), diagnostics_(file, warnings) {}

  ConverterConfig Read() {
    if (root_.name != "ConverterConfig") {
      throw Error(
          fmt::format("{}:{}: this is a <{}> file; a configuration starts with "
                      "<ConverterConfig type=\"S2KFConverter\">",
                      diagnostics_.file(), root_.line, root_.name));
    }
    config_.file = diagnostics_.file();
    ReadType();
    const XmlElement* model = nullptr;
    const XmlElement* output = nullptr;
    for (const XmlElement& child : root_.children) {
      if (child.name == "Model") {
        CheckOnlyOne(child, &model);
        if (model == &child) ReadModel(child);
      } else if (child.name == "Output") {
        CheckOnlyOne(child, &output);
        if (output == &child) ReadOutput(child);
      } else {
        config_.plugin_elements.push_back(child);
      }
    }
    if (is_foreign_) LeaveOutForeignSettings();
    diagnostics_.ThrowIfErrors();
    return std::move(config_);
  }

 private:
  void ReadType() {
    AllowAttributes(root_, {"type"});
    const std::string* type = root_.FindAttribute("type");
    if (type == nullptr || type->empty()) {
      diagnostics_.AddError(root_.line,
                            "<ConverterConfig> needs the name of a converter, such as "
                            "type=\"S2KFConverter\"");
      return;
    }
    is_foreign_ = *type == "NloptConverter";
    if (!is_foreign_) config_.type = *type;
  }

  void ReadModel(const XmlElement& model) {
    AllowAttributes(model, {"name"});
    if (const std::string* name = model.FindAttribute("name")) {
      if (*name != "Winter" && *name != "None") {
        diagnostics_.AddError(model.line, fmt::format("<Model>: name=\"{}\" is not allowed; use "
                                                      "Winter (scales the model by height and "
                                                      "mass) or None (leaves it as it is)",
                                                      *name));
      }
      config_.model_processor = *name;
    }
    const XmlElement* subject = nullptr;
    const XmlElement* mapping = nullptr;
    const XmlElement* joints = nullptr;
    for (const XmlElement& child : model.children) {
      if (child.name == "Subject") {
        CheckOnlyOne(child, &subject);
        ReadSubject(child);
      } else if (child.name == "MarkerMapping") {
        CheckOnlyOne(child, &mapping);
        ReadMarkerMapping(child);
      } else if (child.name == "Joints") {
        CheckOnlyOne(child, &joints);
        ReadJoints(child);
      } else {
        ReportUnknown(child.line,
                      fmt::format("unknown element <{}> in <Model>; use Subject, MarkerMapping or "
                                  "Joints",
                                  child.name));
      }
    }
  }

  // Relative to the configuration.
  void ReadSubject(const XmlElement& subject) {
    AllowAttributes(subject, {"file"});
    const std::filesystem::path folder = std::filesystem::path(config_.file).parent_path();
    const std::string file = NeededAttribute(subject, "file");
    if (!file.empty()) config_.subject_file = (folder / file).string();
    if (config_.model_processor != "Winter") {
      diagnostics_.AddError(subject.line,
                            "<Subject> needs <Model name=\"Winter\">: its lengths are relative to "
                            "the model scaled by height");
    }
  }

  void ReadOutput(const XmlElement& output) {
    AllowAttributes(output, {"format"});
    const std::string* format = output.FindAttribute("format");
    if (format == nullptr) return;
    if (*format != "2.0" && *format != "1.0") {
      ReportUnknown(output.line,
                    fmt::format("<Output>: format=\"{}\" is not allowed; use 2.0 or 1.0", *format));
      return;
    }
    config_.output_format = *format;
  }

  void ReadMarkerMapping(const XmlElement& mapping) {
    AllowAttributes(mapping, {"set"});
    for (const XmlElement& child : mapping.children) {
      if (child.name == "Mapping") {
        ReadMapping(child);
      } else {
        ReportUnknown(child.line, fmt::format("unknown element <{}> in <MarkerMapping>; use "
                                              "<Mapping source=\"\" target=\"\"/>",
                                              child.name));
      }
    }
    ReadSet(mapping, mapping.children.empty(), "<Mapping source=\"C7\" target=\"MARKER_C7\"/>",
            &config_.marker_set);
    config_.marker_set_line = mapping.line;
  }

  void ReadMapping(const XmlElement& element) {
    AllowAttributes(element, {"source", "target", "noiseScale", "warning"});
    MarkerPair pair;
    pair.source = NeededAttribute(element, "source");
    pair.target = NeededAttribute(element, "target");
    if (const std::string* text = element.FindAttribute("warning")) pair.warning = *text;
    if (const std::string* text = element.FindAttribute("noiseScale")) {
      const auto scale = ParseDouble(*text);
      if (!scale || !(*scale >= kSmallestNoiseScale && *scale <= kLargestNoiseScale)) {
        diagnostics_.AddError(element.line,
                              fmt::format("<Mapping>: noiseScale=\"{}\" is not allowed; use a "
                                          "number from {} to {}",
                                          *text, kSmallestNoiseScale, kLargestNoiseScale));
      }
      pair.noise_scale = scale.value_or(1);
    }
    CheckUnique(element, "source", pair.source, &source_lines_);
    config_.marker_pairs.push_back(pair);
  }

  void ReadJoints(const XmlElement& joints) {
    AllowAttributes(joints, {"set"});
    for (const XmlElement& child : joints.children) {
      if (child.name != "Joint") {
        ReportUnknown(child.line, fmt::format("unknown element <{}> in <Joints>; use <Joint "
                                              "name=\"\"/>",
                                              child.name));
        continue;
      }
      AllowAttributes(child, {"name"});
      const std::string name = NeededAttribute(child, "name");
      CheckUnique(child, "name", name, &joint_lines_);
      config_.joints.push_back({name, child.line});
    }
    ReadSet(joints, joints.children.empty(), "<Joint name=\"LKx_joint\"/>", &config_.joint_set);
    config_.joint_set_line = joints.line;
  }

  // An element either names a set or lists its members.
  void ReadSet(const XmlElement& element, bool is_empty, const char* member, std::string* set) {
    const std::string* name = element.FindAttribute("set");
    if (name != nullptr && !is_empty) {
      diagnostics_.AddError(element.line, fmt::format("<{}>: set=\"{}\" and a list exclude each "
                                                      "other; keep one of them",
                                                      element.name, *name));
    } else if (name == nullptr && is_empty) {
      diagnostics_.AddError(element.line,
                            fmt::format("<{}> is empty; name a set (set=\"auto\") or list members: "
                                        "{}",
                                        element.name, member));
    } else if (name != nullptr) {
      *set = *name;
    }
  }

  std::string NeededAttribute(const XmlElement& element, const char* name) {
    const std::string* value = element.FindAttribute(name);
    if (value != nullptr && !Trim(*value).empty()) return std::string(Trim(*value));
    diagnostics_.AddError(element.line, fmt::format("<{}> needs {}=\"...\"", element.name, name));
    return "";
  }

  void CheckUnique(const XmlElement& element, const char* attribute, const std::string& name,
                   std::map<std::string, int>* lines) {
    if (name.empty()) return;
    const auto [first, is_new] = lines->emplace(name, element.line);
    if (is_new) return;
    diagnostics_.AddError(element.line,
                          fmt::format("<{}>: {}=\"{}\" is already in line {}; keep one of them",
                                      element.name, attribute, name, first->second));
  }

  void CheckOnlyOne(const XmlElement& element, const XmlElement** first) {
    if (*first == nullptr) {
      *first = &element;
    } else {
      diagnostics_.AddError(
          element.line, fmt::format("<{}> is already in line {}", element.name, (*first)->line));
    }
  }

  void AllowAttributes(const XmlElement& element, const std::vector<std::string>& names) {
    for (const std::string& attribute : element.AttributesBeside(names)) {
      ReportUnknown(element.line, fmt::format("<{}>: unknown attribute {}; use {}", element.name,
                                              attribute, JoinNames(names)));
    }
  }

  void ReportUnknown(int line, const std::string& message) {
    if (is_foreign_) {
      diagnostics_.AddWarning(line, message + "; left out");
    } else {
      diagnostics_.AddError(line, message);
    }
  }

  void LeaveOutForeignSettings() {
    std::vector<std::string> names;
    for (const XmlElement& element : config_.plugin_elements) names.push_back(element.name);
    config_.plugin_elements.clear();
    diagnostics_.AddWarning(
        root_.line,
        fmt::format("is a configuration for NloptConverter: its marker mapping is "
                    "used{}",
                    names.empty() ? "" : ", left out are " + JoinNames(names, " and ")));
  }

  const XmlElement& root_;
  Diagnostics diagnostics_;
  ConverterConfig config_;
  bool is_foreign_ = false;
  std::map<std::string, int> source_lines_, joint_lines_;
};

}  // namespace

ConverterConfig ParseConverterConfig(const std::string& xml, const std::string& file,
                                     Warnings* warnings) {
  return ConfigReader(ParseXml(xml, file), file, warnings).Read();
}

ConverterConfig ReadConverterConfig(const std::string& path, Warnings* warnings) {
  return ParseConverterConfig(ReadFileContent(path, kMaxConfigBytes), path, warnings);
}

}  // namespace mmm_converter
