// SPDX-License-Identifier: MIT
#include "tests/plugins/s2kf/session_motions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "common/io/mmm/mmm_motion.h"
#include "common/math/rotation.h"
#include "common/math/seeded_random.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/acrobatics.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::s2kf {

namespace {

constexpr double kRate = 100;  // [Hz]
constexpr double kPi = std::numbers::pi;
constexpr double kSway = 0.04;  // of joints that have no other part [rad]
/// A made angle stays off its limits by this part of the range: people do not rest on them.
constexpr double kMargin = 0.02;

/// mean + first cos(p - first_at) + second cos(2 p - second_at) [rad] at phase p of the stride,
/// which begins as the left heel strikes. The right side is half a stride later; on it, angles
/// about y and z have the other sign.
struct Swing {
  double mean;
  double first;
  double first_at;
  double second;
  double second_at;
};

struct Gait {
  double strides;                      // a second, of the person with seed-independent mean
  double speed;                        // [m/s]
  double lean;                         // forward [rad]
  double bob;                          // of the root, twice a stride [m]
  double begin;                        // standing until then [s]
  double gathering;                    // until full swing [s]
  std::map<std::string, Swing> limbs;  // by joint without its side
  std::map<std::string, Swing> trunk;  // by joint
};

const Gait& Walking() {
  static const Gait gait = {0.95,
                            1.2,
                            0.04,
                            0.02,
                            -1,
                            0.5,
                            {{"Hx_joint", {0.18, 0.38, -0.5, 0.04, 1.0}},
                             {"Hz_joint", {0.15, 0.12, 1.0, 0, 0}},
                             {"Hy_joint", {0.08, 0.05, 1.6, 0, 0}},
                             {"Kx_joint", {-0.42, -0.33, 4.5, -0.22, 9.4}},
                             {"Ax_joint", {0.08, 0.16, 2.4, 0.12, 5.4}},
                             {"Az_joint", {-0.05, 0.08, 2.0, 0, 0}},
                             {"Ay_joint", {0.02, 0.1, 0.6, 0, 0}},
                             {"Fx_joint", {0.15, 0.15, 3.6, 0.08, 0.5}},
                             {"Sx_joint", {0.0, 0.25, 2.6, 0, 0}},
                             {"Sy_joint", {0.2, 0.03, 0.4, 0, 0}},
                             {"Sz_joint", {-0.2, 0.1, 2.0, 0, 0}},
                             {"Ex_joint", {0.4, 0.15, 2.9, 0, 0}},
                             {"Ez_joint", {-0.4, 0.08, 1.0, 0, 0}}},
                            {{"BPx_joint", {0.1, 0, 0, 0.04, 0.5}},
                             {"BPz_joint", {0, 0.1, 0.4, 0, 0}},
                             {"BPy_joint", {0, 0.06, 1.8, 0, 0}},
                             {"BTx_joint", {-0.15, 0, 0, 0.04, 1.5}},
                             {"BTz_joint", {0, 0.12, 0.6, 0, 0}},
                             {"BTy_joint", {0, 0.05, 5.0, 0, 0}},
                             {"BLNx_joint", {-0.2, 0, 0, 0.07, 2.5}},
                             {"BLNy_joint", {0, 0.06, 1.2, 0.03, 0.3}},
                             {"BLNz_joint", {0, 0.12, 3.7, 0, 0}},
                             {"BUNx_joint", {0.15, 0, 0, 0.06, 5.5}},
                             {"BUNy_joint", {0, 0.06, 4.2, 0.03, 1.3}},
                             {"BUNz_joint", {0, 0.12, 3.2, 0.03, 2}}}};
  return gait;
}

const Gait& Running() {
  static const Gait gait = {1.4,
                            2.9,
                            0.15,
                            0.045,
                            0.5,
                            0.7,
                            {{"Hx_joint", {0.45, 0.6, -0.8, 0.08, 1.0}},
                             {"Hz_joint", {0.12, 0.15, 1.0, 0, 0}},
                             {"Hy_joint", {0.05, 0.08, 1.6, 0, 0}},
                             {"Kx_joint", {-0.85, -0.5, 4.3, -0.2, 8.9}},
                             {"Ax_joint", {0.02, 0.3, 1.9, 0.14, 4.6}},
                             {"Az_joint", {0.05, 0.15, 2.0, 0, 0}},
                             {"Ay_joint", {-0.1, 0.14, 0.6, 0, 0}},
                             {"Fx_joint", {0.2, 0.25, 3.2, 0.1, 0.5}},
                             {"Sx_joint", {-0.2, 0.45, 2.4, 0, 0}},
                             {"Sy_joint", {0.45, 0.12, 0.4, 0, 0}},
                             {"Sz_joint", {-0.3, 0.3, 2.0, 0, 0}},
                             {"Ex_joint", {1.35, 0.4, 2.7, 0, 0}},
                             {"Ez_joint", {0.1, 0.15, 1.0, 0, 0}},
                             {"Wx_joint", {-0.1, 0.15, 0.7, 0.08, 0}},
                             {"Wy_joint", {-0.3, 0.15, 1.7, 0.05, 0}}},
                            {{"BPx_joint", {0.2, 0, 0, 0.06, 0.5}},
                             {"BPz_joint", {0, 0.22, 0.4, 0, 0}},
                             {"BPy_joint", {0, 0.12, 1.8, 0, 0}},
                             {"BTx_joint", {-0.35, 0, 0, 0.06, 1.5}},
                             {"BTz_joint", {0, 0.28, 0.6, 0, 0}},
                             {"BTy_joint", {0, 0.1, 5.0, 0, 0}},
                             {"BLNx_joint", {-0.2, 0, 0, 0.15, 2.5}},
                             {"BLNy_joint", {0, 0.1, 1.2, 0.05, 0.3}},
                             {"BLNz_joint", {0, 0.15, 3.7, 0, 0}},
                             {"BUNx_joint", {0.2, 0, 0, 0.14, 5.5}},
                             {"BUNy_joint", {0, 0.1, 4.2, 0.05, 1.3}},
                             {"BUNz_joint", {0, 0.18, 3.2, 0.05, 2}}}};
  return gait;
}

/// What a person makes of a gait.
class Walker {
 public:
  Walker(const KinematicModel& model, const Gait& gait, std::uint64_t seed)
      : gait_(gait), random_(seed) {
    strides_ = gait.strides * Between(0.9, 1.1);
    heading_ = Between(-kPi, kPi);
    start_ = Between(0, 2 * kPi);
    for (const int joint : testing::TrackedJoints(model)) channels_.push_back(Draw(model, joint));
  }

  PoseTrajectory Go(int frames) const {
    PoseTrajectory motion;
    motion.rate = kRate;
    for (const Channel& channel : channels_) motion.joint_names.push_back(channel.name);
    Eigen::Vector3d place(0.2, -0.1, 0.95);
    const Eigen::Vector3d ahead(-std::sin(heading_), std::cos(heading_), 0);
    for (int k = 0; k < frames; ++k) {
      const double t = k / kRate;
      const double share = Share(t);
      const double p = Phase(t);
      place += gait_.speed * share / kRate * ahead;
      Posture q;
      q.position = place + share * gait_.bob * std::sin(2 * p) * Eigen::Vector3d::UnitZ();
      q.orientation = Exp(Eigen::Vector3d(0, 0, heading_)) *
                      Exp(Eigen::Vector3d(-gait_.lean * share, 0.03 * share * std::sin(p),
                                          0.08 * share * std::cos(p)));
      q.joint_angles.resize(static_cast<Eigen::Index>(channels_.size()));
      for (std::size_t j = 0; j < channels_.size(); ++j) {
        q.joint_angles[static_cast<Eigen::Index>(j)] = channels_[j].At(t, p, share);
      }
      motion.postures.push_back(q);
    }
    return motion;
  }

 private:
  struct Channel {
    std::string name;
    double lower;
    double upper;
    Swing swing;
    double late;     // of the phase
    double sway_at;  // phase of the sway

    double At(double t, double phase, double share) const {
      const double p = phase - late;
      const double angle = swing.mean +
                           share * (swing.first * std::cos(p - swing.first_at) +
                                    swing.second * std::cos(2 * p - swing.second_at)) +
                           kSway * std::sin(2 * kPi * 0.35 * t + sway_at);
      return std::clamp(angle, lower, upper);
    }
  };

  double Between(double a, double b) { return a + (b - a) * random_.Uniform(); }

  Channel Draw(const KinematicModel& model, int index) {
    const Segment& joint = model.joint(index);
    const double margin = kMargin * (joint.upper - joint.lower);
    Channel channel = {joint.name, joint.lower + margin, joint.upper - margin, {}, 0, 0};
    const auto trunk = gait_.trunk.find(joint.name);
    const auto limb = gait_.limbs.find(joint.name.substr(1));
    if (trunk != gait_.trunk.end()) {
      channel.swing = trunk->second;
    } else if (limb != gait_.limbs.end()) {
      channel.swing = limb->second;
      if (joint.name[0] == 'R') Mirror(&channel);
    }
    channel.swing.first *= Between(0.85, 1.15);
    channel.swing.second *= Between(0.85, 1.15);
    channel.late += Between(-0.15, 0.15);
    channel.sway_at = Between(0, 2 * kPi);
    return channel;
  }

  static void Mirror(Channel* channel) {
    channel->late = kPi;
    if (channel->name[2] == 'x') return;
    Swing& swing = channel->swing;
    swing = {-swing.mean, -swing.first, swing.first_at, -swing.second, swing.second_at};
  }

  /// 0 while standing, 1 in full swing.
  double Share(double t) const {
    const double s = std::clamp((t - gait_.begin) / gait_.gathering, 0.0, 1.0);
    return s * s * (3 - 2 * s);
  }
  double Phase(double t) const { return start_ + 2 * kPi * strides_ * t; }

  const Gait& gait_;
  SeededRandom random_;
  double strides_ = 0;
  double heading_ = 0;
  double start_ = 0;
  std::vector<Channel> channels_;
};

PoseTrajectory Recorded(const std::string& file) {
  return LowPassed(
      ReadMmmMotionFile(testing::SharedData("mmm/motions_legacy/" + file)).motions[0].trajectory);
}

/// The right arm up, its shoulder and elbow swinging, all else nearly still.
PoseTrajectory MakeWaving(const KinematicModel& model, int frames, std::uint64_t seed) {
  SeededRandom random(seed);
  const std::map<std::string, double> raised = {
      {"RSx_joint", 0.6}, {"RSy_joint", -0.5}, {"REx_joint", 1.4}, {"LSx_joint", 0.1},
      {"LEx_joint", 0.2}, {"RKx_joint", -0.1}, {"LKx_joint", -0.1}};
  const std::map<std::string, double> swing = {
      {"RSz_joint", 0.5}, {"REx_joint", 0.4}, {"RWy_joint", 0.3}, {"REz_joint", 0.3}};
  const double rate = 1.2 + 0.8 * random.Uniform();  // [Hz]
  PoseTrajectory motion;
  motion.rate = 100;
  std::vector<double> phase;
  for (const int joint : testing::TrackedJoints(model)) {
    motion.joint_names.push_back(model.joint(joint).name);
    phase.push_back(2 * std::numbers::pi * random.Uniform());
  }
  for (int k = 0; k < frames; ++k) {
    const double t = k / motion.rate;
    Posture q;
    q.position = Eigen::Vector3d(0.02 * std::sin(0.8 * t), 0.02 * std::sin(1.1 * t), 1);
    q.orientation = Exp(Eigen::Vector3d(0.03 * std::sin(t), 0.03 * std::sin(0.7 * t), 0.5));
    q.joint_angles.resize(static_cast<Eigen::Index>(phase.size()));
    for (std::size_t j = 0; j < phase.size(); ++j) {
      const std::string& name = motion.joint_names[j];
      const auto up = raised.find(name);
      const auto swings = swing.find(name);
      const bool waves = swings != swing.end();
      const Segment& joint = model.joint(model.FindJoint(name));
      const double angle = (up == raised.end() ? 0 : up->second) +
                           (waves ? swings->second : 0.05) *
                               std::sin(2 * std::numbers::pi * (waves ? rate : 0.3) * t + phase[j]);
      q.joint_angles[static_cast<Eigen::Index>(j)] = std::clamp(angle, joint.lower, joint.upper);
    }
    motion.postures.push_back(q);
  }
  return motion;
}

/// Each of at most so many frames.
std::vector<NamedMotion> Cut(std::vector<NamedMotion> motions, int frames) {
  for (NamedMotion& named : motions) {
    std::vector<Posture>& postures = named.motion.postures;
    postures.resize(std::min<std::size_t>(postures.size(), frames));
  }
  return motions;
}

}  // namespace

std::vector<NamedMotion> SessionMotions(const KinematicModel& model, int frames,
                                        std::uint64_t seed) {
  return Cut(
      {{"walking", Walker(model, Walking(), seed + 2000).Go(frames)},
       {"quick motion", Walker(model, Running(), seed + 3000).Go(frames)},
       {"range of motion", testing::RangeOfMotion(model, frames / kRate, kRangeShare, seed + 500)},
       {"waving", MakeWaving(model, frames, seed)},
       {"cartwheel", testing::MakeCartwheel(model)}},
      frames);
}

std::vector<NamedMotion> SessionMotionsWithRecordedOnes(const KinematicModel& model, int frames,
                                                        std::uint64_t seed) {
  std::vector<NamedMotion> motions = SessionMotions(model, frames, seed);
  motions[0].motion = Recorded("walking_medium01_motion395.xml");
  motions[1].motion = Recorded("test_mmm_subject314_40joints_100Hz.xml");
  return Cut(std::move(motions), frames);
}

}  // namespace mmm_converter::s2kf
