// SPDX-License-Identifier: MIT
#include "common/io/osim/ik_tasks.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/tool_setup.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

void ReadOsimBytes(std::string_view bytes) {
  Warnings warnings;
  Diagnostics diagnostics(kInputName, &warnings);
  const KinematicModel model = MakeOsimModel(ParseOsim(bytes, {}, &diagnostics), &diagnostics);
  CoordinateSeries series(model);
  const Eigen::VectorXd values = series.Next(ZeroPosture(model));
  const Posture posture = PostureOf(model, values);
  Require(posture.joint_angles.size() == model.num_joints(), "an angle of each joint");
  Require(
      MarkerPositions(model, posture).cols() == static_cast<Eigen::Index>(model.markers().size()),
      "a place of each marker");
}

/// Of the files that it names none is looked for; tasks are read as of a marker set.
void ReadOsimSetupBytes(std::string_view bytes) {
  const bool is_told = IsOsimToolSetup(bytes);
  const OsimToolSetup setup = ParseOsimToolSetup(bytes, kInputName);
  Require(is_told, "a set-up that is told as one");
  Require(!setup.time_range || (*setup.time_range)[0] <= (*setup.time_range)[1], "ordered times");
  if (setup.has_tasks) ParseIkTasks(bytes, kInputName);
}

}  // namespace mmm_converter::testing
