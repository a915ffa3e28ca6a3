// SPDX-License-Identifier: MIT
#include "common/io/mmm/mmm_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/io/bytes/file_content.h"
#include "common/io/mmm/mmm_model_node.h"
#include "common/io/xml/xml_document.h"
#include "common/support/diagnostics.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMostNodes = 32768;  // the reference model has some 150

constexpr double kLengthTolerance = 1e-5;  // [m]; model files have 6 digits
constexpr const char* kFloatingRoot = "root_joint";

class MmmModelBuilder {
 public:
  MmmModelBuilder(const XmlElement& robot, const std::string& file, Warnings* warnings)
      : robot_(robot), diagnostics_(file, warnings) {}

  KinematicModel Build();

 private:
  void ReadNodes();
  void LinkChildren();
  void LinkChild(std::size_t parent, const ModelNode::Child& child);
  int FindTop();
  int FindFloatingRoot();
  void CheckVirtualNodesAbove(int root, int top);
  void FindReachable(int root);
  void ReportUnreachable(int top);
  void CheckPrismaticLengths();
  void CheckFloatingRoot(int root);
  std::map<std::string, std::vector<std::string>> ReadNodeSets();
  ModelDescription Describe(int root);

  int Find(const std::string& name) const {
    const auto found = index_.find(name);
    return found == index_.end() ? -1 : found->second;
  }
  const std::string& NameOf(int node) const { return nodes_[node].segment.name; }
  void Fail(int line, const std::string& message) { diagnostics_.AddError(line, message); }
  void Warn(int line, const std::string& message) { diagnostics_.AddWarning(line, message); }

  const XmlElement& robot_;
  Diagnostics diagnostics_;
  std::vector<ModelNode> nodes_;
  std::map<std::string, int> index_;
  std::vector<int> parent_;
  std::vector<bool> reachable_;  ///< from the floating root
};

void MmmModelBuilder::ReadNodes() {
  std::map<std::string, int> marker_lines;
  const std::vector<const XmlElement*> elements = robot_.FindChildren("RobotNode");
  if (elements.size() > kMostNodes) {
    throw Error(fmt::format("{}: has {} nodes, more than the {} that are read", diagnostics_.file(),
                            elements.size(), kMostNodes));
  }
  for (const XmlElement* element : elements) {
    ModelNode node = ReadModelNode(*element, diagnostics_);
    const std::string& name = node.segment.name;
    const auto [first, is_new] = index_.emplace(name, static_cast<int>(nodes_.size()));
    if (!is_new && !name.empty()) {
      Fail(node.line, fmt::format("node '{}' is there twice; the first is in line {}", name,
                                  nodes_[first->second].line));
    }
    for (const ModelMarker& marker : node.markers) {
      const auto [other, is_new_marker] = marker_lines.emplace(marker.name, node.line);
      if (!is_new_marker && !marker.name.empty()) {
        Fail(node.line, fmt::format("node '{}': position sensor '{}' is there twice; the first is "
                                    "in the node of line {}",
                                    name, marker.name, other->second));
      }
    }
    nodes_.push_back(std::move(node));
  }
  if (nodes_.empty()) Fail(robot_.line, "the model has no <RobotNode>");
}

void MmmModelBuilder::LinkChild(std::size_t parent, const ModelNode::Child& child) {
  const int node = Find(child.name);
  const std::string& parent_name = nodes_[parent].segment.name;
  if (child.name.empty()) return;  // already reported
  if (node < 0) {
    Fail(child.line, fmt::format("node '{}' has a child '{}', but there is no such <RobotNode>",
                                 parent_name, child.name));
  } else if (parent_[node] >= 0) {
    Fail(child.line, fmt::format("node '{}' is a child of both '{}' and '{}'", child.name,
                                 NameOf(parent_[node]), parent_name));
  } else {
    parent_[node] = static_cast<int>(parent);
  }
}

void MmmModelBuilder::LinkChildren() {
  parent_.assign(nodes_.size(), -1);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    for (const ModelNode::Child& child : nodes_[i].children) LinkChild(i, child);
  }
}

/// The node that the file calls RootNode, or the only one that is nobody's child.
int MmmModelBuilder::FindTop() {
  if (const std::string* name = robot_.FindAttribute("RootNode")) {
    const int top = Find(*name);
    if (top < 0) Fail(robot_.line, fmt::format("there is no node '{}', the RootNode", *name));
    return top;
  }
  const auto top = std::find(parent_.begin(), parent_.end(), -1);
  if (top == parent_.end()) {
    Fail(robot_.line, "the nodes form a circle: each of them is a child of another one");
    return -1;
  }
  if (std::count(parent_.begin(), parent_.end(), -1) > 1) {
    Fail(robot_.line, "several nodes are nobody's child; name the root in <Robot RootNode=\"..\">");
    return -1;
  }
  return static_cast<int>(top - parent_.begin());
}

void MmmModelBuilder::CheckVirtualNodesAbove(int root, int top) {
  std::size_t steps = 0;
  for (int node = root; node != top;) {
    node = parent_[node];
    if (node < 0 || ++steps > nodes_.size()) {
      Fail(nodes_[root].line, fmt::format("node '{}' is not connected with the RootNode '{}'",
                                          NameOf(root), NameOf(top)));
      return;
    }
    const ModelNode& above = nodes_[node];
    const bool moves =
        above.segment.type == JointType::kRevolute && above.segment.lower < above.segment.upper;
    if (moves || above.children.size() > 1 || !above.markers.empty() || above.segment.mass > 0 ||
        !above.segment.X_PF.isApprox(Eigen::Isometry3d::Identity())) {
      Fail(above.line,
           fmt::format("node '{}' stands above the floating root '{}'; only virtual nodes without "
                       "rotation, transform, marker, mass and further children may stand there",
                       NameOf(node), NameOf(root)));
    }
  }
}

int MmmModelBuilder::FindFloatingRoot() {
  const int top = FindTop();
  if (top < 0) return -1;
  int root = Find(kFloatingRoot);
  if (root < 0) root = top;
  CheckVirtualNodesAbove(root, top);
  CheckFloatingRoot(root);
  FindReachable(root);
  ReportUnreachable(top);
  return root;
}

void MmmModelBuilder::CheckFloatingRoot(int root) {
  ModelNode& node = nodes_[root];
  if (node.segment.type == JointType::kRevolute && node.segment.lower < node.segment.upper) {
    Fail(node.line, fmt::format("node '{}' is the floating root and can't be a joint as well; give "
                                "it the limits 0 and 0",
                                NameOf(root)));
  }
  if (!node.segment.X_PF.isApprox(Eigen::Isometry3d::Identity())) {
    Warn(node.line, fmt::format("the <Transform> of the floating root '{}' is not used: the root "
                                "pose of a motion replaces it",
                                NameOf(root)));
    node.segment.X_PF.setIdentity();
  }
}

void MmmModelBuilder::FindReachable(int root) {
  reachable_.assign(nodes_.size(), false);
  std::vector<int> open{root};
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    if (reachable_[node]) continue;
    reachable_[node] = true;
    for (const ModelNode::Child& child : nodes_[node].children) {
      const int index = Find(child.name);
      if (index >= 0) open.push_back(index);
    }
  }
}

/// Loose nodes are left out with a warning; circles are errors.
void MmmModelBuilder::ReportUnreachable(int top) {
  std::vector<char> state(nodes_.size(), 0);  // 1: on the way up now, 2: seen before
  for (int start = 0; start < static_cast<int>(nodes_.size()); ++start) {
    std::vector<int> way;
    int node = start;
    while (node >= 0 && state[node] == 0) {
      state[node] = 1;
      way.push_back(node);
      node = parent_[node];
    }
    if (node >= 0 && state[node] == 1) {
      Fail(nodes_[node].line,
           fmt::format("node '{}' is its own ancestor: the children form a circle", NameOf(node)));
    }
    if (node < 0 && !way.empty() && way.back() != top && !reachable_[way.back()]) {
      Warn(nodes_[way.back()].line,
           fmt::format("node '{}' is not connected with the root '{}'; it is left out with all "
                       "nodes below it",
                       NameOf(way.back()), NameOf(top)));
    }
    for (const int seen : way) state[seen] = 2;
  }
}

void MmmModelBuilder::CheckPrismaticLengths() {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Segment& segment = nodes_[i].segment;
    const bool slides = segment.lower < 0 && segment.upper > 0;
    if (!reachable_[i] || segment.type != JointType::kPrismatic || slides) continue;
    const double recorded = std::max(std::abs(segment.lower), std::abs(segment.upper));
    const double offset = segment.X_PF.translation().norm();
    if (std::abs(offset - recorded) <= kLengthTolerance) continue;
    Warn(
        nodes_[i].line,
        fmt::format("node '{}': its offset is {:.6g} mm long, but its limit records {:.6g} mm; the "
                    "file is probably a damaged copy: compare this length with the original model",
                    segment.name, 1e3 * offset, 1e3 * recorded));
  }
}

std::map<std::string, std::vector<std::string>> MmmModelBuilder::ReadNodeSets() {
  std::map<std::string, std::vector<std::string>> sets;
  for (const XmlElement* element : robot_.FindChildren("RobotNodeSet")) {
    const std::string* set_name = element->FindAttribute("name");
    if (set_name == nullptr || !sets.emplace(*set_name, std::vector<std::string>()).second) {
      Warn(element->line, "a <RobotNodeSet> without a name of its own is left out");
      continue;
    }
    std::vector<std::string>& set = sets[*set_name];
    for (const XmlElement* entry : element->FindChildren("Node")) {
      const std::string* name = entry->FindAttribute("name");
      const int node = name == nullptr ? -1 : Find(*name);
      if (node < 0) {
        Warn(entry->line, fmt::format("node set '{}': '{}' is not a node of the model", *set_name,
                                      name == nullptr ? "" : *name));
      } else if (reachable_[node]) {
        set.push_back(*name);
      }
    }
  }
  return sets;
}

ModelDescription MmmModelBuilder::Describe(int root) {
  ModelDescription description;
  const std::string* name = robot_.FindAttribute("name");
  if (name == nullptr) name = robot_.FindAttribute("Type");
  if (name != nullptr) description.name = *name;
  std::vector<int> kept(nodes_.size(), -1);
  int num_kept = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (reachable_[i]) kept[i] = num_kept++;
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!reachable_[i]) continue;
    Segment& segment = description.segments.emplace_back(nodes_[i].segment);
    segment.parent = static_cast<int>(i) == root ? -1 : kept[parent_[i]];
    for (ModelMarker marker : nodes_[i].markers) {
      marker.segment = kept[i];
      description.markers.push_back(std::move(marker));
    }
  }
  description.node_sets = ReadNodeSets();
  return description;
}

KinematicModel MmmModelBuilder::Build() {
  ReadNodes();
  LinkChildren();
  const int root = nodes_.empty() ? -1 : FindFloatingRoot();
  diagnostics_.ThrowIfErrors();
  CheckPrismaticLengths();
  return KinematicModel(Describe(root));
}

}  // namespace

KinematicModel ParseMmmModel(std::string_view content, const std::string& file,
                             Warnings* warnings) {
  const XmlElement robot = ParseXml(content, file);
  if (!robot.Is("Robot")) {
    throw Error(fmt::format("{}:{}: not a model: expected <Robot>, found <{}>{}", file, robot.line,
                            robot.name,
                            robot.Is("MMM") ? "; this is a motion, give the model file" : ""));
  }
  return MmmModelBuilder(robot, file, warnings).Build();
}

KinematicModel ReadMmmModel(const std::string& path, Warnings* warnings) {
  return ParseMmmModel(ReadFileContent(path, kMaxModelBytes), path, warnings);
}

}  // namespace mmm_converter
