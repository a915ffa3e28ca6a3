// SPDX-License-Identifier: MIT
#include "common/io/mesh/collada_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "common/io/xml/xml_document.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr int kMaxNesting = 100;       // as of XML
constexpr double kMaxExpanded = 64e6;  // bytes of text, of all that is used as often as it is

std::string Attribute(const XmlElement& element, const char* name) {
  const std::string* value = element.FindAttribute(name);
  return value == nullptr ? "" : *value;
}

class ColladaCheck {
 public:
  ColladaCheck(const XmlElement& root, const std::string& file) : file_(file) { Index(root); }

  void Check() {
    for (const XmlElement* node : nodes_) Expand(*node, 0);
  }

 private:
  struct Expanded {
    double bytes = 0;
    int nesting = -1;  // -1: not known yet
  };

  /// Bytes of text.
  double Index(const XmlElement& element) {
    double bytes = 64 + static_cast<double>(element.text.size());
    for (const XmlElement& child : element.children) bytes += Index(child);
    if (element.Is("node") || element.Is("visual_scene")) {
      nodes_.push_back(&element);
      for (const char* name : {"id", "name", "sid"}) {
        const std::string key = Attribute(element, name);
        if (!key.empty()) nodes_by_name_.emplace(key, &element);
      }
    }
    if (element.Is("geometry") || element.Is("controller")) {
      double& largest = shapes_by_id_[Attribute(element, "id")];
      largest = std::max(largest, bytes);
      all_shapes_ += bytes;
    }
    return bytes;
  }

  [[noreturn]] void Fail(const XmlElement& element, const char* what) const {
    throw Error(fmt::format("{}:{}: <{}> {}", file_, element.line, element.name, what));
  }

  Expanded Expand(const XmlElement& node, int depth) {
    if (depth > kMaxNesting) Fail(node, "is nested too deeply, or in itself");
    const auto [known, is_new] = expanded_.try_emplace(&node);
    if (!is_new) {
      if (known->second.nesting < 0) Fail(node, "is in itself");
      return known->second;
    }
    Expanded sum{64, 0};
    const auto add = [&](const XmlElement& inside) {
      const Expanded one = Expand(inside, depth + 1);
      sum.bytes += one.bytes;
      sum.nesting = std::max(sum.nesting, one.nesting + 1);
    };
    for (const XmlElement& child : node.children) {
      std::string target = Attribute(child, "url");
      target.erase(0, target.starts_with('#') ? 1 : 0);
      if (child.Is("node")) {
        add(child);
      } else if (child.Is("instance_node")) {
        const auto [begin, end] = nodes_by_name_.equal_range(target);
        for (auto one = begin; one != end; ++one) add(*one->second);
      } else if (child.Is("instance_geometry")) {
        const auto shape = shapes_by_id_.find(target);
        sum.bytes += shape == shapes_by_id_.end() ? 0 : shape->second;
      } else if (child.Is("instance_controller")) {
        sum.bytes += all_shapes_;
      }
    }
    if (sum.nesting > kMaxNesting) Fail(node, "is nested too deeply");
    if (sum.bytes > kMaxExpanded) Fail(node, "uses its parts so often that they are too many");
    expanded_[&node] = sum;
    return sum;
  }

  const std::string& file_;
  std::vector<const XmlElement*> nodes_;
  std::multimap<std::string, const XmlElement*> nodes_by_name_;
  std::map<std::string, double> shapes_by_id_;
  double all_shapes_ = 0;
  std::map<const XmlElement*, Expanded> expanded_;
};

}  // namespace

ColladaFacts CheckCollada(std::string_view content, const std::string& file) {
  const XmlElement root = ParseXml(content, file);
  if (!root.Is("COLLADA")) {
    throw Error(fmt::format("{}:{}: no Collada: expected <COLLADA>, found <{}>", file, root.line,
                            root.name));
  }
  ColladaCheck(root, file).Check();
  const XmlElement* asset = root.FindChild("asset");
  const XmlElement* up = asset == nullptr ? nullptr : asset->FindChild("up_axis");
  return {up == nullptr || Trim(up->text) == "Y_UP"};
}

}  // namespace mmm_converter
