// SPDX-License-Identifier: MIT
#include "common/io/mesh/mesh_file.h"

#include <assimp/BaseImporter.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/io/bytes/file_content.h"
#include "common/io/xml/xml_document.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

struct ColladaFacts {
  bool is_y_up = true;
};

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

/// What assimp does not look at: that parts which are used again and again stay few, and none is in
/// itself.
/// @throws Error with the file, and as ParseXml.
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

/// Has one file, of bytes that are in memory.
class OneFile : public Assimp::IOSystem {
 public:
  OneFile(std::string_view content, std::string name) : content_(content), name_(std::move(name)) {}

  bool Exists(const char* file) const override { return name_ == file; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* /*mode*/) override {
    if (!Exists(file)) return nullptr;
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(content_.data()),
                                      content_.size());
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::string_view content_;
  std::string name_;
};

bool Reads(const aiImporterDesc& importer, const std::string& ending) {
  for (const std::string& one : Split(importer.mFileExtensions, ' ')) {
    if (one == ending) return true;
  }
  return false;
}

void KeepOnly(const std::string& ending, Assimp::Importer* importer) {
  for (std::size_t i = importer->GetImporterCount(); i-- > 0;) {
    if (Reads(*importer->GetImporterInfo(i), ending)) continue;
    const std::unique_ptr<Assimp::BaseImporter> unused(importer->GetImporter(i));
    importer->UnregisterLoader(unused.get());
  }
}

Eigen::Matrix4d ToEigen(const aiMatrix4x4& m) {
  Eigen::Matrix4d matrix;
  matrix << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return matrix;
}

/// A node of a scene and how it lies there.
struct PlacedNode {
  const aiNode* node;
  Eigen::Matrix4d X;
};

std::vector<PlacedNode> NodesOf(const aiScene& scene) {
  std::vector<PlacedNode> nodes, open;
  if (scene.mRootNode != nullptr) open.push_back({scene.mRootNode, Eigen::Matrix4d::Identity()});
  while (!open.empty()) {
    const PlacedNode at = open.back();
    open.pop_back();
    const Eigen::Matrix4d X = at.X * ToEigen(at.node->mTransformation);
    nodes.push_back({at.node, X});
    for (unsigned i = 0; i < at.node->mNumChildren; ++i) {
      open.push_back({at.node->mChildren[i], X});
    }
  }
  return nodes;
}

Eigen::Matrix3Xd PointsOf(const aiScene& scene, const std::string& file) {
  const std::vector<PlacedNode> nodes = NodesOf(scene);
  Eigen::Index count = 0;
  for (const PlacedNode& at : nodes) {
    for (unsigned i = 0; i < at.node->mNumMeshes; ++i) {
      count += scene.mMeshes[at.node->mMeshes[i]]->mNumVertices;
    }
    if (count > kMaxMeshPoints) {
      throw Error(
          fmt::format("{}: has more than the {} corners of triangles that are read at most; a "
                      "coarser mesh is enough",
                      file, kMaxMeshPoints));
    }
  }
  if (count == 0) throw Error(fmt::format("{}: has no triangles", file));
  Eigen::Matrix3Xd points(3, count);
  Eigen::Index next = 0;
  for (const PlacedNode& at : nodes) {
    for (unsigned i = 0; i < at.node->mNumMeshes; ++i) {
      const aiMesh& mesh = *scene.mMeshes[at.node->mMeshes[i]];
      for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
        const aiVector3D& v = mesh.mVertices[k];
        points.col(next++) = at.X.topLeftCorner<3, 3>() * Eigen::Vector3d(v.x, v.y, v.z) +
                             at.X.topRightCorner<3, 1>();
      }
    }
  }
  if (!points.allFinite()) throw Error(fmt::format("{}: has corners that are no numbers", file));
  return points;
}

}  // namespace

MeshPoints ParseMesh(std::string_view content, const std::string& file) {
  std::string ending = ToLower(std::filesystem::path(file).extension().string());
  ending.erase(0, ending.empty() ? 0 : 1);
  if (ending != "stl" && ending != "obj" && ending != "dae") {
    throw Error(
        fmt::format("{}: is not read; meshes are STL, OBJ or Collada (.stl, .obj, .dae)", file));
  }
  MeshPoints mesh;
  if (ending == "dae") mesh.is_y_up = CheckCollada(content, file).is_y_up;
  Assimp::Importer importer;
  KeepOnly(ending, &importer);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const std::string name = "mesh." + ending;
  importer.SetIOHandler(new OneFile(content, name));  // which it deletes
  const aiScene* scene = importer.ReadFile(name, 0);
  if (scene == nullptr) {
    throw Error(
        fmt::format("{}: is no mesh that assimp reads: {}", file, Trim(importer.GetErrorString())));
  }
  mesh.points = PointsOf(*scene, file);
  return mesh;
}

MeshPoints ReadMesh(const std::string& path) {
  return ParseMesh(ReadFileContent(path, kMaxMeshBytes), path);
}

}  // namespace mmm_converter
