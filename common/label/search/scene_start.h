// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "common/label/search/body_match.h"
#include "common/label/search/label_body.h"

namespace mmm_converter {

/// Where bodies were found: their points are those of that frame.
struct SceneStart {
  int frame = 0;
  std::vector<BodyMatch> matches;  ///< by body
};

/// Looks for bodies among points without names: in frames that show many points, spread over the
/// recording. Several bodies are looked for in the parts that a frame's points fall into. frames:
/// 3 x points [m]. The frame in which all together match best is the first of the result.
/// between_frames is called before each of them; what it throws ends the search. May be empty.
/// @throws Error where no frame shows half of each body's markers, as CheckSize of a single one.
std::vector<SceneStart> FindScene(const std::vector<const LabelBody*>& bodies,
                                  const std::vector<Eigen::Matrix3Xd>& frames,
                                  const std::function<void()>& between_frames = {});

/// Where a body matches points badly, whether one of another size would match them well.
/// @throws Error where it does; the message tells the size.
void CheckSize(const LabelBody& body, const Eigen::Matrix3Xd& points, const BodyMatch& match);

}  // namespace mmm_converter
