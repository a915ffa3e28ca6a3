// SPDX-License-Identifier: MIT
// Joint moments of made persons who walk with the forces that their motion needs, tracked from
// markers: how far they are off, and whether their deviations say so.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/kinetics/moment_deviations.h"
#include "common/math/seeded_random.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/session.h"
#include "tests/plugins/s2kf/session_motions.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::s2kf {
namespace {

using Eigen::Index;

constexpr std::uint64_t kFirstWalker = 401;
constexpr int kWalkers = 4;
constexpr int kCalibratedWalkers = 1;  // of them: calibrations take long
constexpr int kFrames = 250;

/// The ground's forces on the feet, of which each plate bears one. In single support that foot has
/// all, between two supports the load goes over from one to the other.
struct Walker {
  explicit Walker(const Session& session)
      : motion(SessionMotions(session.model, kFrames, session.seed)[0].motion) {
    const int frames = motion.num_frames();
    const PoseTrajectory smooth = SmoothMotion(session.person, motion, 0);
    const FootMotion feet = MoveFeet(session.person, motion);
    forces.rate = motion.rate;
    forces.first_time = motion.first_time;
    for (const Side side : kSides) {
      PlateForces plate;
      plate.plate.number = side == Side::kLeft ? 1 : 2;
      plate.force = plate.moment = plate.cop = plate.free_moment =
          Eigen::Matrix3Xd::Zero(3, frames);
      PlateLoad load;
      load.plate = static_cast<std::size_t>(side);
      load.samples = {0, frames};
      load.begin = motion.first_time;
      load.end = motion.time(frames);
      load.bearer = side == Side::kLeft ? Bearer::kLeft : Bearer::kRight;
      contacts.loads.push_back(load);
      contacts.contacts.push_back({side, {}, {}, 0, 0, {plate.plate.number}});
      forces.plates.push_back(plate);
    }
    for (int k = 0; k < frames; ++k) {
      const Eigen::VectorXd needed =
          InverseDynamics(session.person, smooth.postures[k], smooth.velocities.col(k),
                          smooth.accelerations.col(k), {});
      const Eigen::Vector3d force = needed.head<3>();
      const Eigen::Vector3d moment =
          needed.segment<3>(3) + smooth.postures[k].position.cross(force);
      // The lower foot bears more.
      constexpr double kRamp = 0.02;  // [m]
      const auto height = [&](Side side) {
        return std::min(feet.foot(side).heel(2, k), feet.foot(side).toe(2, k));
      };
      const double left =
          1 / (1 + std::exp((height(Side::kLeft) - height(Side::kRight)) / (kRamp / 4)));
      for (std::size_t i = 0; i < 2; ++i) {
        const double share = i == 0 ? left : 1 - left;
        forces.plates[i].force.col(k) = share * force;
        forces.plates[i].moment.col(k) = share * moment;
      }
    }
  }

  PoseTrajectory motion;
  Contacts contacts;
  RecordedForces forces;
};

struct Score {
  int count = 0, within_one = 0, within_two = 0;
  double squares = 0;
  double peak = 0;

  void Add(const JointForces& found, const JointForces& truth) {
    for (Index i = 0; i < found.forces.rows(); ++i) {
      if (!found.is_of_leg[static_cast<std::size_t>(i)] || !IsKept(found.names[i])) continue;
      for (Index k = 30; k < found.forces.cols() - 30; k += 5) {
        const double deviation = found.deviations(i, k);
        if (!(deviation > 0) || !std::isfinite(found.forces(i, k))) continue;
        const double error = std::abs(found.forces(i, k) - truth.forces(i, k));
        ++count;
        within_one += error < deviation;
        within_two += error < 2 * deviation;
        squares += error * error;
        peak = std::max(peak, std::abs(truth.forces(i, k)));
      }
    }
  }

  /// Hips, knees and ankles.
  static bool IsKept(const std::string& name) {
    return name.size() > 1 && (name[1] == 'H' || name[1] == 'K' || name[1] == 'A');
  }

  double One() const { return static_cast<double>(within_one) / count; }
  double Two() const { return static_cast<double>(within_two) / count; }
  double Rms() const { return std::sqrt(squares / count); }
};

/// The body that is assumed has masses of its own, and the centre of pressure is off.
void Spoil(SeededRandom* random, KinematicModel* model, RecordedForces* forces) {
  const ForceErrors sizes;
  ModelDescription body = DescriptionOf(*model);
  for (Segment& one : body.segments) {
    const double factor = 1 + sizes.mass * random->Normal();
    one.mass *= factor;
    one.inertia *= factor;
  }
  *model = KinematicModel(body);
  for (PlateForces& plate : forces->plates) {
    const Eigen::Vector3d moved =
        sizes.center_of_pressure * Eigen::Vector3d(random->Normal(), random->Normal(), 0);
    for (Index k = 0; k < plate.force.cols(); ++k) {
      plate.moment.col(k) += moved.cross(Eigen::Vector3d(plate.force.col(k)));
    }
  }
}

void Measure(const Session& session, const KinematicModel& known, const char* preset,
             Score* score) {
  const Walker walker(session);
  const MarkerSequence seen = session.Record(walker.motion);
  S2kfConverter converter(SetupOf(known, session.joints, AssignAll(known, seen)),
                          ReadSettings(ReadConverterConfig(testing::SourcePath(
                              std::string("xml_config/converters/") + preset + ".xml"))));
  converter.KeepCovariances();
  const ConversionResult result = converter.Convert(seen, {});
  SeededRandom random(session.seed);
  KinematicModel model = known;
  RecordedForces forces = walker.forces;
  Spoil(&random, &model, &forces);
  JointForces found = ComputeJointForces(model, result.trajectory, walker.contacts, forces);
  EstimateDeviations(model, result.trajectory, walker.contacts, forces, result.covariances, {},
                     &found);
  const JointForces truth =
      ComputeJointForces(session.person, walker.motion, walker.contacts, walker.forces);
  score->Add(found, truth);
}

TEST(MomentsTest, OfTrackedWalkers) {
  Score calibrated, uncalibrated;
  for (int i = 0; i < kWalkers; ++i) {
    const Session session(kFirstWalker + static_cast<std::uint64_t>(i));
    Measure(session, session.model, "s2kf_default", &uncalibrated);
    if (i < kCalibratedWalkers) Measure(session, session.Calibrate(), "s2kf_default", &calibrated);
  }
  for (const Score* one : {&uncalibrated, &calibrated}) {
    std::printf("[ measured ] %s: within one %.2f, two %.2f, rms %.1f N m, %.1f %% of peak\n",
                one == &calibrated ? "calibrated" : "uncalibrated", one->One(), one->Two(),
                one->Rms(), 100 * one->Rms() / one->peak);
  }
  // Errors of a session last: one person tells no share.
  EXPECT_GT(uncalibrated.One(), 0.60);
  EXPECT_LT(uncalibrated.One(), 0.88);
  EXPECT_GT(uncalibrated.Two(), 0.90);
  EXPECT_GT(calibrated.Two(), 0.85);
  EXPECT_LT(calibrated.Rms(), 0.05 * calibrated.peak);
}

}  // namespace
}  // namespace mmm_converter::s2kf
