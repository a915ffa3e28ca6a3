// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "common/io/bytes/file_content.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/recording/recording.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "tests/support/osim_texts.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using testing::SharedData;

// Markers that OpenSim has placed by these coordinates, with 5 digits.
TEST(OsimRealFiles, MarkersAreWhereOpenSimHasThem) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const KinematicModel model = ReadOsimModel(SharedData("osim/subject01_simbody.osim"));
  const Eigen::MatrixXd values = testing::OsimCoordinates(
      ReadFileContent(SharedData("osim/std_subject01_walk1_ik.mot")), *model.coordinates());
  const Recording recording =
      ReadRecording(SharedData("osim/subject01_synthetic_marker_data.trc"), {}, nullptr);
  ASSERT_EQ(values.cols(), recording.markers.num_frames());
  double squares = 0;
  int count = 0;
  for (int k = 0; k < recording.markers.num_frames(); ++k) {
    const Eigen::Matrix3Xd p_WM = MarkerPositions(model, PostureOf(model, values.col(k)));
    for (int label = 0; label < recording.markers.num_labels(); ++label) {
      const int marker = model.FindMarker(recording.markers.labels()[label]);
      ASSERT_GE(marker, 0);
      squares += (recording.markers.frame(k).col(label) - p_WM.col(marker)).squaredNorm();
      ++count;
    }
  }
  EXPECT_EQ(count, 73 * 31);
  EXPECT_LT(std::sqrt(squares / count), 5e-5);  // [m]
}

TEST(OsimRealFiles, RajagopalsModelIsReadWhole) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Warnings warnings;
  const KinematicModel model = ReadOsimModel(SharedData("osim/Rajagopal_2015.osim"), "", &warnings);
  EXPECT_TRUE(warnings.empty());
  const std::vector<ModelCoordinate>& all = model.coordinates()->coordinates();
  EXPECT_EQ(all.size(), 39U);
  EXPECT_EQ(std::count_if(all.begin(), all.end(), [](const auto& one) { return one.is_locked; }),
            8);
  EXPECT_EQ(model.num_joints(), 39 - 6 - 8 - 2);  // of the root, locked, coupled
  EXPECT_FALSE(model.is_root_fixed());
  EXPECT_NEAR(model.total_mass(), 75.337, 1e-9);
}

}  // namespace
}  // namespace mmm_converter
