// SPDX-License-Identifier: MIT
#include "tests/support/box_mesh.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <sstream>

namespace mmm_converter::testing {
namespace {

// Bit i of a corner's number: at the high end of axis i.
constexpr std::array<std::array<int, 3>, 12> kTriangles = {{{0, 2, 1},
                                                            {1, 2, 3},
                                                            {4, 5, 6},
                                                            {5, 7, 6},
                                                            {0, 1, 4},
                                                            {1, 5, 4},
                                                            {2, 6, 3},
                                                            {3, 6, 7},
                                                            {0, 4, 2},
                                                            {2, 4, 6},
                                                            {1, 3, 5},
                                                            {3, 7, 5}}};

Eigen::Vector3d CornerOf(const BoxMesh& box, int number) {
  Eigen::Vector3d corner;
  for (int i = 0; i < 3; ++i) corner[i] = (number >> i & 1) != 0 ? box.high[i] : box.low[i];
  return corner;
}

long WordsIn(const std::string& text) {
  std::istringstream words(text);
  return std::distance(std::istream_iterator<std::string>(words), {});
}

template <typename Number>
void Append(Number number, std::string* bytes) {
  std::array<char, sizeof(Number)> raw = {};
  std::memcpy(raw.data(), &number, sizeof(Number));
  bytes->append(raw.data(), raw.size());
}

}  // namespace

std::string BoxMesh::BinaryStl() const {
  std::string bytes(80, ' ');
  Append<std::uint32_t>(kTriangles.size(), &bytes);
  for (const auto& triangle : kTriangles) {
    for (int i = 0; i < 3; ++i) Append(0.0F, &bytes);
    for (const int number : triangle) {
      for (const double x : CornerOf(*this, number)) Append(static_cast<float>(x), &bytes);
    }
    Append<std::uint16_t>(0, &bytes);
  }
  return bytes;
}

std::string BoxMesh::AsciiStl() const {
  std::string text = "solid box\n";
  for (const auto& triangle : kTriangles) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const int number : triangle) {
      const Eigen::Vector3d p = CornerOf(*this, number);
      text += fmt::format("  vertex {} {} {}\n", p.x(), p.y(), p.z());
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid box\n";
}

std::string BoxMesh::Obj() const {
  std::string text = "mtllib box.mtl\no box\n";
  for (int number = 0; number < 8; ++number) {
    const Eigen::Vector3d p = CornerOf(*this, number);
    text += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
  }
  for (const auto& [a, b, c] : kTriangles) text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  return text;
}

std::string BoxMesh::Collada(const std::string& up, double metres) const {
  std::string corners, triangles;
  for (int number = 0; number < 8; ++number) {
    const Eigen::Vector3d p = CornerOf(*this, number);
    corners += fmt::format("{} {} {} ", p.x(), p.y(), p.z());
  }
  for (const auto& [a, b, c] : kTriangles) triangles += fmt::format("{} {} {} ", a, b, c);
  return ColladaText(corners, triangles, up, metres,
                     R"(<node id="n"><instance_geometry url="#g"/></node>)");
}

std::string ColladaText(const std::string& corners, const std::string& triangles,
                        const std::string& up, double metres, const std::string& scene) {
  return fmt::format(
      R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="own" meter="{0}"/><up_axis>{1}</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="{5}">{2}</float_array><technique_common>
<accessor source="#a" count="{6}" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{7}"><input semantic="VERTEX" source="#v" offset="0"/><p>{3}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">{4}</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)",
      metres, up, corners, triangles, scene, WordsIn(corners), WordsIn(corners) / 3,
      WordsIn(triangles) / 3);
}

}  // namespace mmm_converter::testing
