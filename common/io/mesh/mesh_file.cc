// SPDX-License-Identifier: MIT
#include "common/io/mesh/mesh_file.h"

#include <assimp/BaseImporter.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "common/io/bytes/file_content.h"
#include "common/io/mesh/collada_check.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

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
