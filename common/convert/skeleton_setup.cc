// SPDX-License-Identifier: MIT
#include "common/convert/skeleton_setup.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/fit/posture_search.h"
#include "common/math/statistics.h"
#include "common/model/model_scaling.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kLengthFrames = 200, kPostureFrames = 16, kPoseAttempts = 8, kRounds = 5;
constexpr double kMass = 70;  // [kg]; nothing here depends on it

// What weights are relative to: a centre is off by that much where a person's joint is none of the
// model's [m].
constexpr double kCentreDeviation = 0.01;
// Of points, which turn 0.1 m from their joint, with soft tissue and the rigs' own axes [m].
constexpr double kLeastPointDeviation = 0.03, kMostStray = 0.06;
constexpr double kUnplacedDeviation = 0.2;  // where places are still looked for: centres come first

/// A collar bone turns about its inner end, some 25 mm from the middle, the model's about a place
/// 87 mm from there, and would hardly move the shoulder; longer behind it, it does.
constexpr double kOuterCollarScale = 2;

/// Where a joint of a body is on the model of 1 m; of the side "L".
struct JointPlace {
  BodyJoint joint;
  const char* segment;  ///< behind the side
  const char* turning;  ///< the segment that the bone which begins there turns with, likewise
  Vector3d p_SM;        ///< of 1 m [m]
  double deviation;     ///< of a person's from there [m]; 0: it is the centre
};

const JointPlace kPlaces[] = {
    {BodyJoint::kPelvis, "", "", {0, 0, 0.02}, 0.1},
    {BodyJoint::kThorax, "collarSegment_joint", "collarSegment_joint", {0, 0, -0.1}, 0.1},
    {BodyJoint::kNeck, "collarSegment_joint", "collarSegment_joint", {0, -0.01, 0.04}, 0.04},
    {BodyJoint::kHead, "HeadSegment_joint", "HeadSegment_joint", {0, 0, -0.11}, 0.05},
    {BodyJoint::kShoulder, "Ssegment_joint", "Sy_joint", {0, 0, 0}, 0},
    {BodyJoint::kElbow, "Esegment_joint", "Ez_joint", {0, 0, 0}, 0},
    {BodyJoint::kWrist, "Wsegment_joint", "Wy_joint", {0, 0, 0}, 0},
    {BodyJoint::kHip, "Hsegment_joint", "Hy_joint", {0, 0, 0}, 0},
    {BodyJoint::kKnee, "Ksegment_joint", "Kx_joint", {0, 0, 0}, 0},
    {BodyJoint::kAnkle, "Asegment_joint", "Ay_joint", {0, 0, 0}, 0},
    {BodyJoint::kToe, "Ay_joint", "Fx_joint", {0, 0.085, -0.03}, 0.05},
};

const JointPlace& PlaceOf(BodyJoint joint) {
  return *std::find_if(std::begin(kPlaces), std::end(kPlaces),
                       [&](const JointPlace& one) { return one.joint == joint; });
}

int SegmentOf(const KinematicModel& model, const std::string& side, const std::string& name) {
  return name.empty() ? 0 : model.FindSegment(side + name);
}

int LabelOf(const std::vector<SkeletonJoint>& body, BodyJoint joint, const char* side) {
  for (const SkeletonJoint& one : body) {
    if (one.joint == joint && one.side == side) return one.label;
  }
  return -1;
}

std::vector<int> SeenFrames(const MarkerSequence& markers, const std::vector<SkeletonJoint>& body,
                            int most) {
  std::vector<int> seen;
  for (int k = 0; k < markers.num_frames(); ++k) {
    if (markers.frame(k).col(body.front().label).allFinite()) seen.push_back(k);
  }
  std::vector<int> frames;
  const auto count = std::min(seen.size(), static_cast<std::size_t>(most));
  for (std::size_t i = 0; i < count; ++i) frames.push_back(seen[i * seen.size() / count]);
  return frames;
}

/// Lengths of a skeleton's body over the frames [m]; NaN where it lacks a joint.
class BodyLengths {
 public:
  BodyLengths(const std::vector<SkeletonJoint>& body, const MarkerSequence& markers)
      : body_(body), markers_(markers), frames_(SeenFrames(markers, body, kLengthFrames)) {}

  double Between(BodyJoint a, const char* side_a, BodyJoint b, const char* side_b) const {
    const int from = LabelOf(body_, a, side_a), to = LabelOf(body_, b, side_b);
    if (from < 0 || to < 0) return kNaN;
    std::vector<double> lengths;
    for (const int k : frames_) {
      lengths.push_back((markers_.frame(k).col(from) - markers_.frame(k).col(to)).norm());
    }
    return Median(lengths);
  }

  /// From the middle of the hips to that of the shoulders, with a straight back.
  double Trunk() const {
    const int of[] = {LabelOf(body_, BodyJoint::kShoulder, "L"),
                      LabelOf(body_, BodyJoint::kShoulder, "R"),
                      LabelOf(body_, BodyJoint::kHip, "L"), LabelOf(body_, BodyJoint::kHip, "R")};
    if (*std::min_element(std::begin(of), std::end(of)) < 0) return kNaN;
    std::vector<double> lengths;
    for (const int k : frames_) {
      const auto p = markers_.frame(k);
      lengths.push_back((p.col(of[0]) + p.col(of[1]) - p.col(of[2]) - p.col(of[3])).norm() / 2);
    }
    return Percentile(lengths, 90);
  }

 private:
  const std::vector<SkeletonJoint>& body_;
  const MarkerSequence& markers_;
  const std::vector<int> frames_;
};

double LengthIn(const KinematicModel& model, const std::string& segment) {
  return model.segments()[static_cast<std::size_t>(model.FindSegment(segment))]
      .X_PF.translation()
      .norm();
}

/// A place on the model by which a label of the recording is tracked.
struct TrackedLabel {
  int label = 0;
  int segment = 0;
  Vector3d p_SM = Vector3d::Zero();  ///< of the person [m]
  double deviation = 0;              ///< 0: the centre of a joint
  bool is_point = false;             ///< its place is not known before it has been found
  double stray = 0;                  ///< about the place that was found [m]
};

class SkeletonFit {
 public:
  SkeletonFit(const Recording& recording, const KinematicModel& reference,
              const std::vector<int>& joints)
      : markers_(recording.markers),
        reference_(reference),
        joints_(joints),
        subject_(SubjectOfSkeleton(recording, reference, std::nullopt)),
        person_(FitToSubject(ScaleWinter(reference, {subject_.height, kMass, {}}), subject_)),
        frames_(SeenFrames(markers_, recording.body, kPostureFrames)),
        postures_(frames_.size()) {
    for (const SkeletonJoint& joint : recording.body) {
      const JointPlace& place = PlaceOf(joint.joint);
      const int segment = SegmentOf(reference, joint.side, place.segment);
      labels_.push_back({joint.label, segment, subject_.height * place.p_SM, place.deviation});
      const int turning = SegmentOf(reference, joint.side, place.turning);
      for (const int point : joint.points) {
        labels_.push_back({point, turning, Vector3d::Zero(), kLeastPointDeviation, true});
      }
    }
  }

  MarkerSet Run() {
    for (int round = 0; round < kRounds; ++round) {
      Pose(round);
      Place();
    }
    MarkerSet set;
    set.name = "joints of the skeleton";
    for (const TrackedLabel& one : labels_) {
      if (one.is_point && one.stray > kMostStray) continue;
      const std::string& label = markers_.labels()[static_cast<std::size_t>(one.label)];
      const std::string& segment =
          reference_.segments()[static_cast<std::size_t>(one.segment)].name;
      set.pairs.push_back({label, label, Scale(one)});
      set.places.push_back({label, segment, one.p_SM / LengthScale(segment), 0});
    }
    return set;
  }

 private:
  double LengthScale(const std::string& segment) const {
    for (const SegmentScale& one : subject_.scales) {
      if (one.segment == segment) return subject_.height * one.scale;
    }
    return subject_.height;
  }

  static double Scale(const TrackedLabel& one) {
    if (one.deviation == 0) return 1;
    return std::max(kLeastPointDeviation, one.deviation) / kCentreDeviation;
  }

  void Pose(int round) {
    ModelDescription description = DescriptionOf(person_);
    description.markers.clear();
    std::vector<MarkerIx> used, all;
    const auto add = [&](int segment, const Vector3d& p) {
      all.emplace_back(static_cast<int>(description.markers.size()));
      description.markers.push_back({std::to_string(all.size()), segment, p});
    };
    VectorXd scales(static_cast<Eigen::Index>(labels_.size()));
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      add(labels_[i].segment, labels_[i].p_SM);
      const bool is_placed = round > 0 && labels_[i].deviation > 0;
      scales[static_cast<Eigen::Index>(i)] =
          is_placed ? kUnplacedDeviation / kCentreDeviation : Scale(labels_[i]);
    }
    used = all;
    for (const TrackedLabel& one : labels_) {
      for (const Vector3d& p :
           {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)}) {
        add(one.segment, p);
      }
    }
    const KinematicModel model(std::move(description));
    const MarkerKinematics kinematics(model, joints_, used), everything(model, joints_, all);
    MarkerJacobian at = everything.MakeJacobian();
    PostureSearch search(kinematics);
    PostureFitOptions options;
    options.robust_distance = 0.1;
    std::vector<Matrix3Xd> z;
    for (const int k : frames_) {
      Matrix3Xd& of_frame = z.emplace_back(3, scales.size());
      for (std::size_t i = 0; i < labels_.size(); ++i) {
        auto place = of_frame.col(static_cast<Eigen::Index>(i));
        place = markers_.frame(k).col(labels_[i].label);
        if (round == 0 && labels_[i].is_point) place.setConstant(kNaN);
      }
    }
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      if (round == 0)
        search.Assemble(z[f], scales, options, kPoseAttempts, &postures_[f]);
      else
        search.fit().Solve(z[f], scales, options, &postures_[f]);
    }
    const auto take_over = [&](std::size_t from, std::size_t to) {
      search.ImproveFrom(postures_[from].joint_angles, z[to], scales, options, &postures_[to]);
    };
    for (std::size_t f = 1; f < frames_.size(); ++f) take_over(f - 1, f);
    for (std::size_t f = frames_.size(); f-- > 1;) take_over(f, f - 1);
    p_WM_.clear();
    for (const Posture& posture : postures_) {
      everything.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                                posture.joint_angles, &at);
      p_WM_.push_back(at.p_WM.rightCols(4 * static_cast<Eigen::Index>(labels_.size())));
    }
  }

  /// What is no centre, where the postures have it.
  void Place() {
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      TrackedLabel& one = labels_[i];
      if (one.deviation == 0) continue;
      std::vector<double> coordinates[3];
      std::vector<Vector3d> places;
      for (std::size_t f = 0; f < frames_.size(); ++f) {
        const auto at = p_WM_[f].middleCols<4>(4 * static_cast<Eigen::Index>(i));
        const Matrix3d R = at.rightCols<3>().colwise() - at.col(0);
        const Vector3d p = markers_.frame(frames_[f]).col(one.label);
        if (!p.allFinite()) continue;
        places.emplace_back(R.transpose() * (p - at.col(0)));
        for (int a = 0; a < 3; ++a) coordinates[a].push_back(places.back()[a]);
      }
      if (places.empty()) continue;
      for (int a = 0; a < 3; ++a) one.p_SM[a] = Median(coordinates[a]);
      std::vector<double> strays;
      strays.reserve(places.size());
      for (const Vector3d& p : places) strays.push_back((p - one.p_SM).norm());
      one.stray = Median(strays);
      one.deviation = std::max(kLeastPointDeviation, one.stray);
    }
  }

  const MarkerSequence& markers_;
  const KinematicModel& reference_;
  const std::vector<int>& joints_;
  const Subject subject_;
  const KinematicModel person_;
  std::vector<TrackedLabel> labels_;
  const std::vector<int> frames_;
  std::vector<Posture> postures_;
  std::vector<Matrix3Xd> p_WM_;  ///< by frame: origin and axes of each label's segment
};

}  // namespace

bool HasBody(const KinematicModel& reference) {
  return std::all_of(std::begin(kPlaces), std::end(kPlaces), [&](const JointPlace& place) {
    const bool is_sided = place.joint >= BodyJoint::kShoulder;
    for (const char* side : {"L", "R"}) {
      const std::string of = is_sided ? side : "";
      if (SegmentOf(reference, of, place.segment) < 0) return false;
      if (SegmentOf(reference, of, place.turning) < 0) return false;
    }
    return true;
  });
}

Subject SubjectOfSkeleton(const Recording& recording, const KinematicModel& reference,
                          const std::optional<double>& height) {
  using enum BodyJoint;
  const BodyLengths lengths(recording.body, recording.markers);
  std::map<std::string, double> length_of;  // [m]
  double legs = 0, arms = 0, of_legs = 0, of_arms = 0;
  for (const char* side : {"L", "R"}) {
    const auto bone = [&](const char* segment, BodyJoint a, BodyJoint b, double* sum,
                          double* of_model) {
      const double length = lengths.Between(a, side, b, side);
      length_of[std::string(side) + segment] = length;
      *sum += length;
      *of_model += LengthIn(reference, std::string(side) + segment);
    };
    bone("Ksegment_joint", kHip, kKnee, &legs, &of_legs);
    bone("Asegment_joint", kKnee, kAnkle, &legs, &of_legs);
    bone("Esegment_joint", kShoulder, kElbow, &arms, &of_arms);
    bone("Wsegment_joint", kElbow, kWrist, &arms, &of_arms);
    length_of[std::string(side) + "Hsegment_joint"] = lengths.Between(kHip, "L", kHip, "R") / 2;
  }
  // Up to where the collar bones begin.
  const std::string trunk[] = {"BPSegment_joint", "BTSegment_joint", "collarSegment_joint"};
  double of_trunk = 0;
  for (const std::string& segment : trunk) of_trunk += LengthIn(reference, segment);
  const double trunk_height = lengths.Trunk() / of_trunk;

  Subject subject;
  subject.name = "skeleton";
  subject.model = reference.name();
  // Legs are what differs least between persons of a height and rigs of a person.
  const double by_legs = legs / of_legs, by_arms = arms / of_arms;
  double by_lengths = 0.5 * by_legs + 0.2 * by_arms + 0.3 * trunk_height;
  if (std::isnan(by_lengths)) by_lengths = std::isnan(by_legs) ? by_arms : by_legs;
  subject.height = std::clamp(height.value_or(by_lengths), kLeastHeight, kLargestHeight);
  subject.mass = kMass;
  const auto scale = [&](const std::string& segment, double value) {
    if (std::isnan(value)) return;
    subject.scales.push_back(
        {segment, std::clamp(value, kLeastSegmentScale, kLargestSegmentScale), 0, 0});
  };
  for (const auto& [segment, length] : length_of) {
    scale(segment, length / (subject.height * LengthIn(reference, segment)));
  }
  for (const std::string& segment : trunk) scale(segment, trunk_height / subject.height);
  const double shoulder = lengths.Between(kShoulder, "L", kShoulder, "R") / 2 / subject.height;
  for (const std::string side : {"L", "R"}) {
    if (std::isnan(shoulder)) continue;
    const double collar = LengthIn(reference, side + "SCsegment_joint");
    const double arm = LengthIn(reference, side + "Ssegment_joint");
    const double outer = std::clamp(shoulder - kLeastSegmentScale * collar,
                                    kLeastSegmentScale * arm, kOuterCollarScale * arm);
    scale(side + "Ssegment_joint", outer / arm);
    scale(side + "SCsegment_joint", (shoulder - outer) / collar);
  }
  return subject;
}

MarkerSet PlaceSkeleton(const Recording& recording, const KinematicModel& reference,
                        const std::vector<int>& joints) {
  return SkeletonFit(recording, reference, joints).Run();
}

}  // namespace mmm_converter
