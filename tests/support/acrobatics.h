// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>
#include <utility>
#include <vector>

#include "common/motion/synthetic_motion.h"

namespace mmm_converter::testing {

/// 675 frames: step, hands to the floor, kick up to a handstand (root roll to -183 degrees), and
/// back to standing; without regard to balance.
inline PoseTrajectory MakeKickedHandstand(const KinematicModel& model) {
  MotionScript script;
  script.num_frames = 675;
  // stand, arms up, step, lunge, hands down, kick, nearly up, up, hold, tilt, legs down, foot down,
  // lunge, step back, stand
  script.times = {0, 1.0, 1.4, 1.8, 2.4, 2.75, 3.1, 3.45, 4.0, 4.35, 4.75, 5.1, 5.65, 6.1, 6.55};
  const double up = -183 * std::numbers::pi / 180;
  const std::vector<double> arms = {0,    2.7,  2.75, 2.7, 2.0, 2.3, 2.95, 3.12,
                                    3.12, 2.95, 2.3,  2.0, 2.5, 1.6, 0};
  const std::vector<double> elbows = {.2, .15, .15, .15, .1,  .1, .1, .1,
                                      .1, .1,  .1,  .1,  .15, .3, .2};
  script.keyframes = {
      {"roll", {0, .03, .03, -.15, -1.15, -2.0, -2.85, -3.15, up, -3.0, -2.1, -1.15, -.15, 0, 0}},
      {"pitch", {0, 0, .03, 0, 0, .02, .04, .02, 0, -.03, -.03, 0, 0, -.03, 0}},
      {"yaw", {0, 0, .05, .05, 0, -.05, -.03, 0, .05, .05, 0, 0, -.05, -.03, 0}},
      {"BPx_joint", {0, .05, .05, -.05, -.35, -.2, -.05, 0, .05, 0, -.2, -.35, -.1, 0, 0}},
      {"BTx_joint", {0, .05, .05, -.05, -.3, -.15, -.05, 0, .05, 0, -.15, -.3, -.1, 0, 0}},
      {"BLNx_joint", {0, .1, .1, 0, .1, .15, .15, .15, .15, .15, .15, .1, 0, 0, 0}},
      {"BUNx_joint", {0, .05, .05, 0, .2, .3, .35, .35, .35, .35, .3, .2, 0, 0, 0}},
      {"LSx_joint", arms},
      {"RSx_joint", arms},
      {"LEx_joint", elbows},
      {"REx_joint", elbows},
      {"LHx_joint",
       {0.05, -.03, -.1, -.3, -.35, -.6, -.35, -.02, .05, -.2, -.5, -.35, -.3, -.05, .05}},
      {"LKx_joint", {-.1, -.1, -.1, -.2, -.3, -.3, -.15, -.1, -.1, -.15, -.3, -.3, -.2, -.15, -.1}},
      {"LAx_joint", {.05, .1, .15, .1, -.3, -.55, -.6, -.6, -.6, -.6, -.55, -.3, .1, .15, .05}},
      {"RHx_joint", {0.05, 0, .9, .7, 1.6, 1.4, .7, .1, 0, .7, 1.4, 1.6, .7, .8, .05}},
      {"RKx_joint", {-.1, -.1, -.9, -.5, -.95, -.7, -.4, -.1, -.1, -.3, -.6, -.95, -.5, -.9, -.1}},
      {"RAx_joint", {.05, .07, .1, -.05, .48, -.3, -.6, -.6, -.6, -.6, -.3, .48, -.05, .1, .05}},
  };
  script.contacts = {{0, {"LFx_joint"}, MotionScript::Support::kToes},
                     {1.85, {"RFx_joint"}, MotionScript::Support::kToes},
                     {2.4, {"LWx_joint", "RWx_joint"}, MotionScript::Support::kFingertips},
                     {5.05, {"RFx_joint"}, MotionScript::Support::kToes},
                     {5.6, {"LFx_joint"}, MotionScript::Support::kToes}};
  return PlayScript(model, std::move(script));
}

/// 400 frames: a cartwheel to the right (root pitch from 0 through 90 to 360 degrees).
inline PoseTrajectory MakeCartwheel(const KinematicModel& model) {
  MotionScript script;
  script.num_frames = 400;
  // stand, arms and legs apart, hand down, upside down, foot down, upright, stand
  script.times = {0, 0.9, 1.6, 2.15, 2.7, 3.4, 3.95};
  const double quarter = 1.33;
  script.keyframes = {
      {"pitch",
       {0, .1, quarter, std::numbers::pi, 2 * std::numbers::pi - quarter, 2 * std::numbers::pi - .1,
        2 * std::numbers::pi}},
      {"BPy_joint", {0, 0, .25, 0, -.25, 0, 0}},
      {"BTy_joint", {0, 0, .2, 0, -.2, 0, 0}},
      {"LSy_joint", {.15, 2.4, 2.65, 2.7, 2.65, 2.4, .15}},
      {"RSy_joint", {-.15, -2.4, -2.65, -2.7, -2.65, -2.4, -.15}},
      {"LEx_joint", {.2, .15, .1, .1, .1, .15, .2}},
      {"REx_joint", {.2, .15, .1, .1, .1, .15, .2}},
      {"LHy_joint", {0, .4, .6, .7, .6, .4, 0}},
      {"RHy_joint", {0, -.4, -.6, -.7, -.6, -.4, 0}},
      {"LAx_joint", {0, 0, -.4, -.5, -.3, 0, 0}},
      {"RAx_joint", {0, 0, -.3, -.5, -.4, 0, 0}},
  };
  script.contacts = {{0, {"RFx_joint"}, MotionScript::Support::kToes},
                     {1.6, {"RWx_joint"}, MotionScript::Support::kFingertips},
                     {2.15, {"LWx_joint"}, MotionScript::Support::kFingertips},
                     {2.7, {"LFx_joint"}, MotionScript::Support::kToes}};
  return PlayScript(model, std::move(script));
}

}  // namespace mmm_converter::testing
