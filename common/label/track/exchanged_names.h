// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/fit/normal_equations.h"
#include "common/label/search/label_body.h"
#include "common/label/track/point_tracks.h"
#include "common/label/track/track_names.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// Tries the names of a calibrated person's recording against each other: two markers exchange
/// their names where the frames are cheaper so, all together. What a single frame can't tell, as
/// where feet stand beside each other, many can: where a marker is worn is the same in all of them.
class ExchangedNames {
 public:
  /// The first of these markers is number first_marker of the names. All must outlive it.
  ExchangedNames(const LabelBody& body, const PointTracks& tracks, int first_marker);

  /// A frame that counts, with a posture that is about right; frames ascending, far enough from
  /// each other that skin has moved on.
  void AddFrame(int frame, const Posture& posture);

  /// Exchanges names of tracks.
  void Improve(TrackNames* names);

 private:
  struct Frame {
    int k = 0;
    Posture posture;
    Eigen::Matrix3Xd z;         ///< by marker [m], NaN: not seen
    Eigen::Matrix3Xd places;    ///< the model's [m]
    Eigen::Matrix3Xd residual;  ///< from the model's places, axes of the links [m]
  };
  using Frames = std::vector<const Frame*>;
  /// The names of two markers are exchanged in these frames.
  struct Trial {
    int a = 0, b = 0;
    int begin = 0, end = 0;
  };

  void Read(const TrackNames& names);
  std::vector<Trial> Trials(const TrackNames& names) const;
  /// Only two whose places are near each other are exchanged.
  bool AreNear(int a, int b) const;
  /// True: it is cheaper, and done.
  bool Try(const Trial& trial);
  void FitAll();
  /// Steps of the posture towards the markers, at the places where they are believed to be worn.
  void Fit(Frame* frame);
  void Look(Frame* frame);
  /// Where the markers are worn, by the frames and by what is known of the person.
  void PlaceMarkers(const Frames& frames);
  double Cost(const Frames& frames) const;

  const LabelBody& body_;
  const PointTracks& tracks_;
  int first_marker_;
  NormalEquations equations_;
  MarkerJacobian at_;
  Eigen::VectorXd scatter_;  ///< of each marker about its place, each coordinate [m]
  std::vector<Frame> frames_;
  Eigen::Matrix3Xd offset_;  ///< of the markers from the model's places, axes of their links [m]
  Eigen::Matrix3Xd offset_W_, targets_;
  double cost_ = 0;
};

}  // namespace mmm_converter
