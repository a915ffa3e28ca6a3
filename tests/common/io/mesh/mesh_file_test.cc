// SPDX-License-Identifier: MIT
#include "common/io/mesh/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "common/io/mesh/extreme_points.h"
#include "common/support/error.h"
#include "common/support/opened_files.h"
#include "tests/support/box_mesh.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using testing::BoxMesh;
using testing::ColladaText;
using ::testing::HasSubstr;

constexpr double kFloats = 1e-7;  // of numbers below 1

const BoxMesh kBox = {{-0.06, -0.04, -0.08}, {0.14, 0.05, 0.01}};

void WriteMesh(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

void ExpectBox(const Eigen::Matrix3Xd& points, const BoxMesh& box, const std::string& what) {
  EXPECT_EQ(points.cols(), 36) << what;
  EXPECT_LT((points.rowwise().minCoeff() - box.low).norm(), kFloats) << what;
  EXPECT_LT((points.rowwise().maxCoeff() - box.high).norm(), kFloats) << what;
  EXPECT_EQ(ExtremePoints(points).size(), 8U) << what;
}

std::string MeshRefusal(std::string_view content, const std::string& file) {
  try {
    ParseMesh(content, file);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(MeshFile, FormatsTellTheSame) {
  ExpectBox(ParseMesh(kBox.BinaryStl(), "a.stl").points, kBox, "binary");
  ExpectBox(ParseMesh(kBox.AsciiStl(), "a.STL").points, kBox, "ASCII");
  ExpectBox(ParseMesh(kBox.Obj(), "a.obj").points, kBox, "OBJ");
  const MeshPoints z_up = ParseMesh(kBox.Collada("Z_UP", 1), "a.dae");
  ExpectBox(z_up.points, kBox, "Collada");
  EXPECT_FALSE(z_up.is_y_up);
}

TEST(MeshFile, ColladaHasItsUnitAndItsNodes) {
  const BoxMesh centimetres = {100 * kBox.low, 100 * kBox.high};
  const MeshPoints read = ParseMesh(centimetres.Collada("Y_UP", 0.01), "a.dae");
  EXPECT_TRUE(read.is_y_up);
  ExpectBox(read.points, kBox, "cm");
  const std::string moved = ColladaText("0 0 0 1 0 0 0 1 0", "0 1 2", "Z_UP", 0.001,
                                        R"(<node><translate>10 20 30</translate>
<rotate>0 0 1 90</rotate><node><scale>2 1 1</scale><instance_geometry url="#g"/></node></node>)");
  const Eigen::Matrix3Xd points = ParseMesh(moved, "a.dae").points;
  ASSERT_EQ(points.cols(), 3);
  EXPECT_LT((points.col(0) - Eigen::Vector3d(0.01, 0.02, 0.03)).norm(), kFloats);
  EXPECT_LT((points.col(1) - Eigen::Vector3d(0.01, 0.022, 0.03)).norm(), kFloats);
  EXPECT_LT((points.col(2) - Eigen::Vector3d(0.009, 0.02, 0.03)).norm(), kFloats);
}

TEST(MeshFile, OpensNothingElse) {
  WriteMesh(testing::TestFolder() + "/box.mtl", "newmtl m\n");
  const std::string file = testing::TestFolder() + "/box.obj";
  WriteMesh(file, kBox.Obj());
  const OpenedFiles opened;
  ExpectBox(ReadMesh(file).points, kBox, "OBJ");
  EXPECT_EQ(opened.files(), std::set<std::string>{file});
}

TEST(MeshFile, HostileFilesAreRefused) {
  const std::string stl = kBox.BinaryStl();
  EXPECT_THAT(MeshRefusal(stl.substr(0, 300), "cut.stl"), HasSubstr("cut.stl: "));
  EXPECT_THAT(MeshRefusal(stl.substr(0, 40), "cut.stl"), HasSubstr("cut.stl: "));
  std::string huge = stl;
  huge.replace(80, 4, "\xff\xff\xff\xff");
  EXPECT_THAT(MeshRefusal(huge, "huge.stl"), HasSubstr("huge.stl: "));
  std::string nan = stl;
  nan.replace(96, 4, std::string("\0\0\xc0\x7f", 4));
  EXPECT_THAT(MeshRefusal(nan, "nan.stl"), HasSubstr("no numbers"));
  EXPECT_THAT(MeshRefusal("v 0 0 0\n", "none.obj"), HasSubstr("none.obj: "));
  EXPECT_THAT(MeshRefusal("f 1 2 3\n", "none.obj"), HasSubstr("none.obj: "));
  EXPECT_THAT(MeshRefusal(stl, "a.ply"), HasSubstr("STL, OBJ or Collada"));
  EXPECT_THAT(MeshRefusal(stl, "a.dae"), HasSubstr("a.dae:"));
  EXPECT_THAT(MeshRefusal("<robot/>", "a.dae"), HasSubstr("no Collada"));
  const auto collada = [](const std::string& scene) {
    return ColladaText("0 0 0 1 0 0 0 1 0", "0 1 2", "Z_UP", 1, scene);
  };
  EXPECT_THAT(MeshRefusal(collada(R"(<node id="n"><instance_node url="#n"/></node>)"), "a.dae"),
              HasSubstr("is in itself"));
  std::string doubled = R"(<node id="n30"><instance_geometry url="#g"/></node>)";
  for (int i = 0; i < 30; ++i) {
    doubled += "<node id='n" + std::to_string(i) + "'>";
    for (int k = 0; k < 2; ++k) {
      doubled += "<instance_node url='#n" + std::to_string(i + 1) + "'/>";
    }
    doubled += "</node>";
  }
  EXPECT_THAT(MeshRefusal(collada(doubled), "a.dae"), HasSubstr("so often"));
  std::string chain;
  for (int i = 0; i < 5000; ++i) {
    chain += "<node id='n" + std::to_string(i) + "'><instance_node url='#n" +
             std::to_string(i + 1) + "'/></node>";
  }
  EXPECT_THAT(MeshRefusal(collada(chain), "a.dae"), HasSubstr("nested"));
}

// A cut or changed file is refused, or read as something, and nothing else.
TEST(MeshFile, AnyChangedByteIsNoFault) {
  const std::pair<const char*, std::string> files[] = {{"a.stl", kBox.BinaryStl()},
                                                       {"b.stl", kBox.AsciiStl()},
                                                       {"c.obj", kBox.Obj()},
                                                       {"d.dae", kBox.Collada("Z_UP", 1)}};
  for (const auto& [name, content] : files) {
    const std::size_t step = content.size() / 12 + 1;
    for (std::size_t at = 0; at < content.size(); at += step) {
      std::string changed = content;
      changed[at] = static_cast<char>(changed[at] ^ 0x15);
      MeshRefusal(changed, name);
      MeshRefusal(content.substr(0, at), name);
    }
  }
}

TEST(ExtremePointsTest, ABallKeepsItsSize) {
  constexpr double kRadius = 0.1;
  Eigen::Matrix3Xd ball(3, 10'000);
  for (Eigen::Index i = 0; i < ball.cols(); ++i) {
    const double z = 1 - (2.0 * static_cast<double>(i) + 1) / static_cast<double>(ball.cols());
    const double turn = 2.4 * static_cast<double>(i), r = std::sqrt(1 - z * z);
    ball.col(i) = kRadius * Eigen::Vector3d(r * std::cos(turn), r * std::sin(turn), z);
  }
  const std::vector<Eigen::Vector3d> points = ExtremePoints(ball);
  EXPECT_LE(points.size(), 2000U);
  for (Eigen::Index i = 0; i < ball.cols(); i += 97) {
    const Eigen::Vector3d direction = ball.col(i).normalized();
    double most = 0;
    for (const Eigen::Vector3d& p : points) most = std::max(most, p.dot(direction));
    EXPECT_GT(most, kRadius - 0.0002);  // its header's thousandth
  }
}

// What the design notes measured: 70 mm. Collada is of another resolution of numbers.
TEST(MeshFileReal, StlAndColladaOfOneFootAreAlike) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string folder = testing::SharedData("robots/unitree_h1/meshes/");
  for (const std::string side : {"left", "right"}) {
    const MeshPoints stl = ReadMesh(folder + side + "_ankle_link.STL");
    const MeshPoints dae = ReadMesh(folder + side + "_ankle_link.dae");
    EXPECT_NEAR(stl.points.row(2).minCoeff(), -0.07, 1e-6);
    EXPECT_LT((stl.points.rowwise().minCoeff() - dae.points.rowwise().minCoeff()).norm(), 1e-6);
    EXPECT_LT((stl.points.rowwise().maxCoeff() - dae.points.rowwise().maxCoeff()).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace mmm_converter
