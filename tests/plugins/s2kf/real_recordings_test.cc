// SPDX-License-Identifier: MIT
// The default configuration on real recordings.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/convert/marker_set.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/recording.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::s2kf {
namespace {

struct KitRecording {
  const char* file;
  const char* motion;
};

class RealKitBimanualTest : public ::testing::TestWithParam<KitRecording> {};

// KIT's own solution is in the same file, for the same markers; both are measured on the same
// model.
TEST_P(RealKitBimanualTest, IsNearerToTheMarkersThanKitsOwnSolution) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const MmmMotionFile file = ReadMmmMotionFile(
      testing::SharedData(std::string("mmm/kit_bimanual_10hz/") + GetParam().file));
  const MmmMotion* recorded = file.Find(GetParam().motion);
  ASSERT_NE(recorded, nullptr);
  const KinematicModel model = ScaledReferenceModel(recorded->size.height.value());
  const std::vector<MarkerAssignment> assignments = AssignAll(model, recorded->markers);
  ASSERT_EQ(assignments.size(), 53u);

  double stored = 0;
  int seen = 0;
  for (int k = 0; k < recorded->markers.num_frames(); ++k) {
    const Eigen::Matrix3Xd p_WM =
        MarkerPositions(model, ModelPosture(model, recorded->trajectory, k));
    for (const MarkerAssignment& a : assignments) {
      const double r = (recorded->markers.frame(k).col(a.label) - p_WM.col(a.marker)).norm();
      if (!std::isfinite(r)) continue;
      stored += r;
      ++seen;
    }
  }
  stored /= seen;

  const TrackedRun run = RunTracker(model, MotionJoints(model, 44), S2kfSettings{},
                                    recorded->markers, recorded->markers, nullptr, assignments);
  const int n = static_cast<int>(run.distance.size());
  std::printf("[ measured ] %s: mean %.2f mm, KIT's own solution %.2f, optimum %.2f\n",
              GetParam().motion, 1e3 * run.MeanDistance(0, n), 1e3 * stored,
              1e3 * run.MeanOptimum(0, n));
  EXPECT_LT(run.MeanDistance(0, n), stored);
  EXPECT_TRUE(run.inside_limits);
}

INSTANTIATE_TEST_SUITE_P(
    Recordings, RealKitBimanualTest,
    ::testing::Values(KitRecording{"Close_files_motions_3072_Close1_aj_180_30h_08.xml",
                                   "true_1723"},
                      KitRecording{"Cut_files_motions_3021_Cut1_c_0_05cm_03.xml", "true_1723"},
                      KitRecording{"Peel_files_motions_3109_Peel1_cucumber_cb_07.xml", "true_1723"},
                      KitRecording{"Pour_files_motions_2967_Pour1_cs_ms_0_20l_04.xml", "true_1480"},
                      KitRecording{"Stir_files_motions_2941_Stir1_bc_s_right_03.xml", "true_1723"}),
    [](const auto& test) {
      const std::string file = test.param.file;
      return file.substr(0, file.find('_'));
    });

struct PluginGaitRecording {
  const char* file;
  double bad_share;  ///< of frames that may be beyond 10 % + 1 mm of their optimum
};

class RealPluginGaitTest : public ::testing::TestWithParam<PluginGaitRecording> {};

TEST_P(RealPluginGaitTest, FollowsTheOptimum) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const Recording recording = ReadRecording(
      testing::SharedData(std::string("recordings/whole_body/") + GetParam().file + ".c3d"), {});
  const KinematicModel model = ScaledReferenceModel(1.7);
  const std::vector<MarkerSet> sets = ReadMarkerSets(testing::SourcePath("xml_config/marker_sets"));
  const MarkerSet& set = ChooseMarkerSet(sets, LabelsOf(recording.markers));
  const MarkerMapping mapping =
      ResolveMarkerMapping(PairsInModel(set, model), LabelsOf(recording.markers), model);
  const TrackedRun run =
      RunTracker(model, MotionJoints(model, 44), S2kfSettings{}, recording.markers,
                 recording.markers, nullptr, mapping.assignments);
  const int n = static_cast<int>(run.distance.size());
  std::printf("[ measured ] %s: mean %.2f mm, optimum %.2f, %d of %d frames beyond 10 %% + 1 mm\n",
              GetParam().file, 1e3 * run.MeanDistance(0, n), 1e3 * run.MeanOptimum(0, n),
              run.BadFrames(0, n), n);
  EXPECT_LE(run.BadFrames(0, n), GetParam().bad_share * n);
  EXPECT_TRUE(run.inside_limits);
}

// In the serve, at 50 Hz, the straight arm passes the shoulder's singularity: the filter keeps to
// its branch until recovery finds the better one.
INSTANTIATE_TEST_SUITE_P(Recordings, RealPluginGaitTest,
                         ::testing::Values(PluginGaitRecording{"85_02", 0.01},
                                           PluginGaitRecording{"cmu_02_05", 0.01},
                                           PluginGaitRecording{"pycgm_movement_trial", 0.01},
                                           PluginGaitRecording{"kinematics_tennis_serve", 0.05}),
                         [](const auto& test) { return "File" + std::string(test.param.file); });

}  // namespace
}  // namespace mmm_converter::s2kf
