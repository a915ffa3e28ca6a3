// SPDX-License-Identifier: MIT
#include "common/fit/posture_search.h"
#include "common/pipeline/recording_labels.h"
#include "common/support/units.h"

namespace mmm_converter {

double LabelDistance(const FoundLabels& found, const MarkerSequence& markers) {
  constexpr int kFrames = 24, kFewestPoints = 10, kAttempts = 4;
  const std::vector<MarkerAssignment>& assignments = found.setup.assignments();
  const MarkerSequence named = Relabelled(PointsOfPerson(found), markers);
  std::vector<int> columns;
  columns.reserve(assignments.size());
  for (const MarkerAssignment& one : assignments) {
    const std::string& name = found.labelling.names[one.label];
    columns.push_back(named.FindLabel(name.substr(found.prefix.size())));
  }
  const MarkerKinematics kinematics(*found.setup.model, found.setup.joints,
                                    MarkerIndices(assignments));
  PostureSearch search(kinematics);
  PostureFitOptions options;
  options.robust_distance = 0.1;
  double sum = 0;
  int count = 0;
  for (int i = 0; i < kFrames; ++i) {
    const int k = (2 * i + 1) * named.num_frames() / (2 * kFrames);
    Eigen::Matrix3Xd z =
        Eigen::Matrix3Xd::Constant(3, static_cast<Eigen::Index>(columns.size()), kNaN);
    for (std::size_t m = 0; m < columns.size(); ++m) {
      if (columns[m] >= 0) z.col(static_cast<Eigen::Index>(m)) = named.frame(k).col(columns[m]);
    }
    if (z.row(0).array().isFinite().count() < kFewestPoints) continue;
    Posture posture;
    sum += search.Assemble(z, NoiseScales(assignments), options, kAttempts, &posture).mean_distance;
    ++count;
  }
  return count > 0 ? sum / count : kNaN;
}

}  // namespace mmm_converter
