// SPDX-License-Identifier: MIT
#include "common/motion/synthetic_motion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numbers>

#include "common/math/rotation.h"
#include "common/model/forward_kinematics.h"
#include "common/model/kit_joints.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr double kRate = 100;
constexpr double kPi = std::numbers::pi;

constexpr double kHandOver = 0.3;  // [s], around the begin of a contact

/// 0 to 1 with minimum jerk.
double MinimumJerk(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * s * (10 + s * (6 * s - 15));
}

/// Slope at keyframe i that does not overshoot: 0 at a turning point, else the harmonic mean of the
/// slopes on both sides (Fritsch, Butland 1984).
double SlopeAt(const std::vector<double>& times, const std::vector<double>& values, std::size_t i) {
  if (i == 0 || i + 1 == times.size()) return 0;
  const double before = (values[i] - values[i - 1]) / (times[i] - times[i - 1]);
  const double after = (values[i + 1] - values[i]) / (times[i + 1] - times[i]);
  return before * after <= 0 ? 0 : 2 * before * after / (before + after);
}

/// The curve of least jerk between neighbouring keyframes, given their values and slopes and no
/// acceleration in them.
double Interpolate(const std::vector<double>& times, const std::vector<double>& values, double t) {
  assert(times.size() == values.size() && t >= times.front());
  if (t >= times.back()) return values.back();
  const std::size_t i = std::upper_bound(times.begin(), times.end(), t) - times.begin() - 1;
  const double span = times[i + 1] - times[i];
  const double s = (t - times[i]) / span;
  const double v0 = SlopeAt(times, values, i) * span;
  const double v1 = SlopeAt(times, values, i + 1) * span;
  const double rest = values[i + 1] - values[i] - v0;
  const double turn = v1 - v0;
  return values[i] + v0 * s +
         s * s * s *
             (10 * rest - 4 * turn + s * (7 * turn - 15 * rest + s * (6 * rest - 3 * turn)));
}

/// Values of joints that are not in a script, and a slow sway that no joint is without.
double RelaxedAngle(const std::string& joint) {
  static const std::map<std::string, double> kAngles = {{"LEx_joint", 0.2},  {"REx_joint", 0.2},
                                                        {"LKx_joint", -0.1}, {"RKx_joint", -0.1},
                                                        {"LSy_joint", 0.15}, {"RSy_joint", -0.15}};
  const auto found = kAngles.find(joint);
  return found == kAngles.end() ? 0 : found->second;
}

double Sway(std::size_t joint, double t) {
  const double frequency = 0.25 + 0.05 * static_cast<double>(joint % 7);  // [Hz]
  return 0.02 * std::sin(2 * kPi * frequency * t + 2.4 * static_cast<double>(joint));
}

int NodeIndex(const KinematicModel& model, const std::string& name) {
  const int index = model.FindSegment(name);
  if (index < 0) {
    throw Error("model '" + model.name() + "' has no node '" + name +
                "'; synthetic motions need MMM's reference model");
  }
  return index;
}

/// A scripted motion on one model.
class Choreography {
 public:
  Choreography(const KinematicModel& model, MotionScript script)
      : model_(model), script_(std::move(script)), rest_(ZeroPosture(model)) {
    for (const std::string& name : KitJointNames()) {
      NodeIndex(model, name);
      joints_.push_back(model.FindJoint(name));
      if (joints_.back() < 0) throw Error("node '" + name + "' of the model is not a joint");
    }
    const auto X_WS = SegmentPoses(model, rest_);
    const double sole = X_WS[NodeIndex(model, "LeftFootHeight_joint")].translation().z();
    heights_[MotionScript::Support::kToes] =
        X_WS[NodeIndex(model, "LFx_joint")].translation().z() - sole;
    heights_[MotionScript::Support::kFingertips] =
        -0.2 * sole;  // the wrist above the tips of a straight hand
    heights_[MotionScript::Support::kPalms] =
        -0.055 * sole;  // the wrist above a hand that lies on the floor
    PlaceContacts();
  }

  PoseTrajectory Play() const {
    PoseTrajectory motion;
    motion.rate = kRate;
    motion.joint_names = KitJointNames();
    for (int k = 0; k < script_.num_frames; ++k) {
      const double t = k / kRate;
      Posture posture = PostureWithoutPosition(t);
      Vector3d position = Vector3d::Zero();
      for (std::size_t c = 0; c < script_.contacts.size(); ++c) {
        const double weight = Weight(c, t);
        if (weight > 0) position += weight * (places_[c] - ContactInRoot(c, posture));
      }
      posture.position = position;
      Eigen::VectorXd angles(static_cast<Eigen::Index>(joints_.size()));
      for (std::size_t j = 0; j < joints_.size(); ++j) {
        angles[static_cast<Eigen::Index>(j)] = posture.joint_angles[joints_[j]];
      }
      posture.joint_angles = angles;
      motion.postures.push_back(posture);
    }
    return motion;
  }

 private:
  double Channel(const std::string& name, double otherwise, double t) const {
    const auto found = script_.keyframes.find(name);
    return found == script_.keyframes.end() ? otherwise
                                            : Interpolate(script_.times, found->second, t);
  }

  Posture PostureWithoutPosition(double t) const {
    Posture posture = rest_;
    const Vector3d rpy(Channel("roll", 0, t), Channel("pitch", 0, t), Channel("yaw", 0, t));
    posture.orientation = RotationFromRpy(rpy);
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const std::string& name = KitJointNames()[j];
      posture.joint_angles[joints_[j]] = Channel(name, RelaxedAngle(name), t) + Sway(j, t);
    }
    return posture;
  }

  Vector3d ContactInRoot(std::size_t contact, const Posture& posture) const {
    const auto X_WS = SegmentPoses(model_, posture);
    Vector3d sum = Vector3d::Zero();
    for (const std::string& node : script_.contacts[contact].nodes) {
      sum += X_WS[NodeIndex(model_, node)].translation();
    }
    return sum / static_cast<double>(script_.contacts[contact].nodes.size());
  }

  /// Where each contact stands: where it is when it takes over, brought onto the floor.
  void PlaceContacts() {
    for (std::size_t c = 0; c < script_.contacts.size(); ++c) {
      const Posture posture = PostureWithoutPosition(script_.contacts[c].begin);
      Vector3d place = ContactInRoot(c, posture);
      if (c > 0) place += places_[c - 1] - ContactInRoot(c - 1, posture);
      place.z() = heights_.at(script_.contacts[c].support);
      places_.push_back(place);
    }
  }

  double Weight(std::size_t contact, double t) const {
    const auto begun = [&](std::size_t c) {
      return MinimumJerk((t - script_.contacts[c].begin) / kHandOver + 0.5);
    };
    const double own = contact == 0 ? 1 : begun(contact);
    return contact + 1 < script_.contacts.size() ? own - begun(contact + 1) : own;
  }

  const KinematicModel& model_;
  MotionScript script_;
  Posture rest_;
  std::vector<int> joints_;
  std::map<MotionScript::Support, double> heights_;  // of a contact's nodes above the floor [m]
  std::vector<Vector3d> places_;
};

const std::vector<std::string> kLeftFoot = {"LFx_joint"};
const std::vector<std::string> kRightFoot = {"RFx_joint"};
const std::vector<std::string> kHands = {"LWx_joint", "RWx_joint"};

/// Values on the way up, then those of the way down from its end to its start.
std::vector<double> UpAndDown(std::vector<double> up, const std::vector<double>& down) {
  assert(up.back() == down.back());
  up.insert(up.end(), down.rbegin() + 1, down.rend());
  return up;
}

std::vector<double> Negated(std::vector<double> values) {
  for (double& value : values) value = -value;
  return values;
}

}  // namespace

PoseTrajectory PlayScript(const KinematicModel& model, MotionScript script) {
  return Choreography(model, std::move(script)).Play();
}

PoseTrajectory MakeHandstand(const KinematicModel& model) {
  // The way up; down is the same way back with left and right exchanged. The values put the centre
  // of pressure between what touches the floor, as if the body had to keep its balance.
  // stand, arms up, bend, hands down, left leg up, right leg off, legs nearly up, upside down
  const std::vector<double> times = {0, 0.8, 1.4, 1.9, 2.25, 2.6, 2.95, 3.37};
  constexpr double kHandsDown = 2.2;  // the hands take over from the right foot [s]
  const double end = 2 * times.back();
  MotionScript script;
  script.num_frames = 675;
  script.times = times;
  for (std::size_t i = times.size() - 1; i-- > 0;) script.times.push_back(end - times[i]);
  const auto both = [](const std::vector<double>& values) { return UpAndDown(values, values); };

  const auto arms = both({0, 2.26, 2.31, 2.67, 2.19, 2.42, 3.02, 3.02});
  const auto elbows = both({.2, .1, .08, .28, .13, .07, .08, .09});
  const auto forearms = both({0, .5, 1.2, 1.5, 1.5, 1.5, 1.5, 1.5});
  const auto wrists = both({0, 0, -.84, -.97, -1.4, -1.53, -1.4, -1.28});
  const std::vector<double> first_hip = {.05, .06, 1.03, 1.62, .22, -.26, -.27, .12};
  const std::vector<double> first_knee = {-.1, -.13, -.16, -.11, -.11, -.31, -.29, -.05};
  const std::vector<double> first_ankle = {.05, .17, -.13, .08, .47, -.51, -.59, -.6};
  const std::vector<double> last_hip = {.05, 0, .99, 1.6, 1.6, 1.62, 1.27, .12};
  const std::vector<double> last_knee = {-.1, -.05, -.15, -.11, -.43, -.04, -.31, -.05};
  const std::vector<double> last_ankle = {.05, .14, -.11, .04, .3, -.65, -.59, -.6};
  script.keyframes = {
      {"roll", both({0, -.07, -.78, -1.56, -1.64, -2.13, -2.95, -183 * kPi / 180})},
      {"BPx_joint", both({0, .12, -.31, -.53, -.3, -.37, -.13, .02})},
      {"BTx_joint", both({0, -.06, -.29, -.41, -.45, -.24, -.08, .05})},
      {"BLNx_joint", both({0, .05, 0, -.1, 0, .1, .15, .15})},
      {"BUNx_joint", both({0, .05, 0, 0, .1, .25, .35, .35})},
      {"LSx_joint", arms},
      {"RSx_joint", arms},
      {"LEx_joint", elbows},
      {"REx_joint", elbows},
      {"LEz_joint", Negated(forearms)},
      {"REz_joint", forearms},
      {"LWy_joint", Negated(wrists)},
      {"RWy_joint", wrists},
      {"LHx_joint", UpAndDown(first_hip, last_hip)},
      {"LKx_joint", UpAndDown(first_knee, last_knee)},
      {"LAx_joint", UpAndDown(first_ankle, last_ankle)},
      {"RHx_joint", UpAndDown(last_hip, first_hip)},
      {"RKx_joint", UpAndDown(last_knee, first_knee)},
      {"RAx_joint", UpAndDown(last_ankle, first_ankle)},
  };
  script.contacts = {{0, kRightFoot, MotionScript::Support::kToes},
                     {kHandsDown, kHands, MotionScript::Support::kPalms},
                     {end - kHandsDown, kLeftFoot, MotionScript::Support::kToes}};
  return PlayScript(model, std::move(script));
}

PoseTrajectory MakeRaisedKnee(const KinematicModel& model) {
  MotionScript script;
  script.num_frames = 200;
  script.times = {0, 0.8, 1.2, 2};
  script.keyframes = {
      {"LSx_joint", {0, 1.4, 1.4, 0}},       {"REx_joint", {.2, 1.6, 1.6, .2}},
      {"RHx_joint", {0, 1.2, 1.2, 0}},       {"RKx_joint", {-.1, -1.4, -1.4, -.1}},
      {"RSy_joint", {-.15, -.4, -.4, -.15}},
  };
  script.contacts = {{0, kLeftFoot, MotionScript::Support::kToes}};
  return PlayScript(model, std::move(script));
}

}  // namespace mmm_converter
