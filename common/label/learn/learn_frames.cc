// SPDX-License-Identifier: MIT
#include "common/label/learn/learn_frames.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/label/tuning.h"
#include "common/math/statistics.h"
#include "common/support/units.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;

CommonLabels FindCommonLabels(const std::vector<const MarkerSequence*>& recordings) {
  CommonLabels labels;
  std::map<std::string, int> index;
  for (const MarkerSequence* recording : recordings) {
    for (const std::string& name : recording->labels()) {
      if (index.emplace(name, static_cast<int>(labels.names.size())).second) {
        labels.names.push_back(name);
      }
    }
  }
  for (const MarkerSequence* recording : recordings) {
    std::vector<int>& columns = labels.columns.emplace_back(labels.names.size(), -1);
    for (int c = 0; c < recording->num_labels(); ++c) columns[index[recording->labels()[c]]] = c;
  }
  return labels;
}

/// Evenly spread over all recordings, those of a part that show most.
std::vector<LearnFrame> ChooseLearnFrames(const std::vector<const MarkerSequence*>& recordings,
                                          const CommonLabels& labels) {
  double all = 0;
  for (const MarkerSequence* recording : recordings)
    all += recording->num_frames() / recording->rate();
  std::vector<LearnFrame> frames;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const MarkerSequence& recording = *recordings[r];
    const double share = recording.num_frames() / recording.rate() / all;
    const int count =
        std::min(recording.num_frames(),
                 std::max(1, static_cast<int>(std::lround(LearnFrameTuning::kFrames * share))));
    for (int i = 0; i < count; ++i) {
      const int begin = static_cast<int>(static_cast<long>(i) * recording.num_frames() / count);
      const int end = std::max(
          begin + 1, static_cast<int>(static_cast<long>(i + 1) * recording.num_frames() / count));
      int best = begin;
      Eigen::Index most = -1;
      const int middle = (begin + end) / 2;
      for (int j = 0; j < end - begin; ++j) {
        const int k = begin + (middle - begin + j) % (end - begin);
        const auto seen = recording.frame(k).row(0).array().isFinite().count();
        if (seen > most) {
          most = seen;
          best = k;
        }
      }
      LearnFrame frame;
      frame.recording = static_cast<int>(r);

      frame.z.setConstant(3, static_cast<Eigen::Index>(labels.names.size()), kNaN);
      for (std::size_t l = 0; l < labels.names.size(); ++l) {
        const int column = labels.columns[r][l];
        if (column >= 0)
          frame.z.col(static_cast<Eigen::Index>(l)) = recording.frame(best).col(column);
      }
      frames.push_back(std::move(frame));
    }
  }
  return frames;
}

Matrix3Xd SeenPoints(const LearnFrame& frame) {
  Matrix3Xd points(3, frame.z.cols());
  Eigen::Index count = 0;
  for (Eigen::Index l = 0; l < frame.z.cols(); ++l) {
    if (frame.z.col(l).allFinite()) points.col(count++) = frame.z.col(l);
  }
  return points.leftCols(count);
}

Eigen::MatrixXd DistanceDeviations(const std::vector<LearnFrame>& frames) {
  const Eigen::Index labels = frames.front().z.cols();
  Eigen::MatrixXd deviations =
      Eigen::MatrixXd::Constant(labels, labels, LearnFrameTuning::kUnknown);
  std::vector<double> distances;
  for (Eigen::Index i = 0; i < labels; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      distances.clear();
      for (const LearnFrame& frame : frames) {
        const double distance = (frame.z.col(i) - frame.z.col(j)).norm();
        if (std::isfinite(distance)) distances.push_back(distance);
      }
      if (distances.size() < LearnFrameTuning::kFewest) continue;
      const double spread = Percentile(distances, 95) - Percentile(distances, 5);
      deviations(i, j) = deviations(j, i) = spread / 3.3;
    }
  }
  return deviations;
}

std::optional<double> DeviationFrom(int site, int label, const std::vector<int>& sites,
                                    const Eigen::MatrixXd& deviations) {
  std::vector<double> of_site;
  for (std::size_t other = 0; other < sites.size(); ++other) {
    if (static_cast<int>(other) == label || sites[other] != site) continue;
    of_site.push_back(deviations(label, static_cast<Eigen::Index>(other)));
  }
  if (of_site.empty()) return std::nullopt;
  std::sort(of_site.begin(), of_site.end());
  return of_site.size() > 1 ? (of_site[0] + of_site[1]) / 2 : of_site[0];
}

std::vector<std::vector<int>> RigidGroups(const std::vector<int>& sites,
                                          const Eigen::MatrixXd& deviations) {
  std::vector<std::vector<int>> groups;
  std::vector<char> is_done(sites.size(), 0);
  for (std::size_t l = 0; l < sites.size(); ++l) {
    if (is_done[l] || sites[l] < 0) continue;
    std::vector<int> group = {static_cast<int>(l)};
    is_done[l] = 1;
    for (std::size_t g = 0; g < group.size(); ++g) {
      for (std::size_t o = 0; o < sites.size(); ++o) {
        if (is_done[o] || sites[o] != sites[l] ||
            deviations(group[g], static_cast<Eigen::Index>(o)) > LearnFrameTuning::kRigid) {
          continue;
        }
        is_done[o] = 1;
        group.push_back(static_cast<int>(o));
      }
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace mmm_converter
