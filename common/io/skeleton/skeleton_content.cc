// SPDX-License-Identifier: MIT
#include "common/io/skeleton/skeleton_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "common/io/skeleton/bone_names.h"
#include "common/io/skeleton/skeleton_body.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Hip to ankle along the bones: 0.71 to 0.98 m in the skeletons at hand [m].
constexpr double kLeg = 0.84;
constexpr double kShortestLeg = 0.5, kLongestLeg = 1;
constexpr std::size_t kMostRoots = 16;  // persons and things; each takes the poses of all
constexpr double kArm = 0.1;            // of a point that shows an orientation, from its joint [m]

/// Those of skeletons: dm is MakeHuman's, the last CMU's, 0.45 in an inch.
constexpr std::pair<const char*, double> kUnits[] = {{"m", 1},       {"dm", 0.1},
                                                     {"cm", 0.01},   {"mm", 0.001},
                                                     {"in", 0.0254}, {"in / 0.45", 0.0254 / 0.45}};

bool HasOrientation(BodyJoint joint) {
  return joint == BodyJoint::kPelvis || joint == BodyJoint::kThorax || joint == BodyJoint::kHead ||
         joint == BodyJoint::kShoulder || joint == BodyJoint::kWrist || joint == BodyJoint::kHip ||
         joint == BodyJoint::kAnkle;
}

/// A point that turns with a joint.
struct TurningPoint {
  int joint = 0;
  int axis = 0;  ///< of the joint on which it is
};

/// Without what all of them begin with up to a colon, and each once, however they are compared.
std::vector<std::string> LabelsOf(const SkeletonMotion& motion) {
  std::vector<std::string> labels;
  for (int j = 0; j < motion.num_joints(); ++j) {
    const std::string& name = motion.names[static_cast<std::size_t>(j)];
    const int parent = motion.parents[static_cast<std::size_t>(j)];
    labels.push_back(name.empty() && parent >= 0 ? labels[static_cast<std::size_t>(parent)] + ".end"
                                                 : name);
  }
  const std::string prefix = labels.front().substr(0, labels.front().rfind(':') + 1);
  const bool is_common = std::all_of(labels.begin(), labels.end(), [&](const std::string& label) {
    return label.size() > prefix.size() && label.starts_with(prefix);
  });
  if (is_common) {
    for (std::string& label : labels) label.erase(0, prefix.size());
  }
  return labels;
}

/// As labels are compared: without case, blanks and punctuation.
std::string Bare(const std::string& label) {
  std::string bare;
  for (const char c : ToLower(label)) {
    if (c < 0 || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z')) bare += c;
  }
  return bare;
}

void MakeUnique(std::vector<std::string>* labels) {
  std::set<std::string> taken;
  for (std::string& label : *labels) {
    std::replace(label.begin(), label.end(), ':', '_');
    if (label.starts_with('*')) label.front() = '_';
    const std::string base = label;
    for (std::size_t i = 2; Bare(label).empty() || !taken.insert(Bare(label)).second; ++i) {
      label = fmt::format("{}_{}", base, i);
    }
  }
}

/// The two axes of a joint that are most across the bone to `child`, or any two.
std::pair<int, int> AxesAcross(const SkeletonMotion& motion, int joint, int child) {
  if (child < 0) return {0, 1};
  Vector3d along = Vector3d::Zero();
  Matrix3Xd p;
  std::vector<Matrix3d> R;
  for (const int k : SpreadFrames(motion.num_frames, 10)) {
    motion.pose(k, &p, &R);
    const Vector3d bone =
        R[static_cast<std::size_t>(joint)].transpose() * (p.col(child) - p.col(joint));
    if (bone.allFinite()) along += bone.cwiseAbs();
  }
  int most = 0;
  along.maxCoeff(&most);
  return {most == 0 ? 1 : 0, most == 2 ? 1 : 2};
}

int LabelOf(const FoundBody& body, BodyJoint joint, const std::string& side) {
  for (const SkeletonJoint& one : body.joints) {
    if (one.joint == joint && one.side == side) return one.label;
  }
  return -1;
}

/// Where the bone that begins at a joint ends.
int EndOf(const FoundBody& body, const SkeletonJoint& joint) {
  if (joint.joint == BodyJoint::kHip) return LabelOf(body, BodyJoint::kKnee, joint.side);
  if (joint.joint == BodyJoint::kShoulder) return LabelOf(body, BodyJoint::kElbow, joint.side);
  if (joint.joint == BodyJoint::kAnkle) return LabelOf(body, BodyJoint::kToe, joint.side);
  return -1;
}

std::vector<TurningPoint> AddPoints(const SkeletonMotion& motion, std::vector<std::string>* labels,
                                    FoundBody* body) {
  std::vector<TurningPoint> points;
  for (SkeletonJoint& joint : body->joints) {
    if (!motion.has_orientations || !HasOrientation(joint.joint)) continue;
    const auto [first, second] = AxesAcross(motion, joint.label, EndOf(*body, joint));
    for (const int axis : {first, second}) {
      joint.points.push_back(static_cast<int>(labels->size()));
      labels->push_back(
          fmt::format("{}.{}", (*labels)[static_cast<std::size_t>(joint.label)], "xyz"[axis]));
      points.push_back({joint.label, axis});
    }
  }
  return points;
}

void DecideUnit(double leg_length, RecordingContent* content, Warnings* warnings) {
  double nearest = 1e9;
  for (const auto& [name, metres] : kUnits) {
    const double off = std::abs(std::log(leg_length * metres / kLeg));
    if (!(off < nearest)) continue;
    nearest = off;
    content->unit = name;
    content->metres = metres;
  }
  const double leg = leg_length * content->metres;
  if (leg > kShortestLeg && leg < kLongestLeg) return;
  content->doubt = fmt::format(
      "in no usual unit the legs are as long as a person's: read as {}, "
      "they have {:.2f} m; check the unit",
      content->unit, leg);
  Warn(warnings, content->doubt);
}

/// The joints from one root up to the next.
SkeletonMotion PartOf(const std::shared_ptr<const SkeletonMotion>& whole, int begin, int end) {
  SkeletonMotion part = *whole;
  part.names = {whole->names.begin() + begin, whole->names.begin() + end};
  part.parents.clear();
  for (int j = begin; j < end; ++j) {
    const int parent = whole->parents[static_cast<std::size_t>(j)];
    part.parents.push_back(parent < 0 ? -1 : parent - begin);
  }
  part.pose = [whole, begin, end](int frame, Matrix3Xd* p, std::vector<Matrix3d>* R) {
    Matrix3Xd all;
    std::vector<Matrix3d> turns;
    whole->pose(frame, &all, &turns);
    *p = all.middleCols(begin, end - begin);
    *R = {turns.begin() + begin, turns.begin() + end};
  };
  return part;
}

/// By what stands before a colon, else by the names of their roots; where these do not tell them
/// apart, by their numbers.
std::vector<std::string> NamesOfPersons(const std::vector<SkeletonMotion>& persons) {
  std::vector<std::string> names, numbers;
  for (const SkeletonMotion& person : persons) {
    const std::string& root = person.names.front();
    names.push_back(root.substr(0, root.rfind(':')));
    numbers.push_back(std::to_string(names.size()));
  }
  const std::set<std::string> different(names.begin(), names.end());
  return different.size() == names.size() ? names : numbers;
}

/// Leaves the skeleton of one person, where there are several.
void ChoosePerson(const std::string& file, const ContentOptions& options, SkeletonMotion* motion,
                  RecordingContent* content) {
  std::vector<int> roots;
  for (int j = 0; j < motion->num_joints(); ++j) {
    if (motion->parents[static_cast<std::size_t>(j)] < 0) roots.push_back(j);
  }
  if (roots.size() < 2 || roots.size() > kMostRoots || options.all_subjects) return;
  roots.push_back(motion->num_joints());
  const auto whole = std::make_shared<const SkeletonMotion>(*motion);
  std::vector<SkeletonMotion> persons;
  for (std::size_t i = 0; i + 1 < roots.size(); ++i) {
    SkeletonMotion part = PartOf(whole, roots[i], roots[i + 1]);
    if (!FindBody(part, ShippedBoneNames()).joints.empty()) persons.push_back(std::move(part));
  }
  if (persons.size() < 2) return;
  content->persons = NamesOfPersons(persons);
  const std::string all = FirstNames(content->persons);
  if (!options.subject) {
    throw Error(fmt::format("{}: there are several persons: {}; choose one of them", file, all),
                Remedy::kSubjectPrefix);
  }
  for (std::size_t i = 0; i < persons.size(); ++i) {
    if (!EqualIgnoringCase(content->persons[i], Trim(*options.subject))) continue;
    content->person = content->persons[i];
    *motion = std::move(persons[i]);
    return;
  }
  throw Error(
      fmt::format("{}: there is no subject {}; the file has: {}", file, *options.subject, all));
}

}  // namespace

RecordingContent ContentOfSkeleton(SkeletonMotion motion, const std::string& format,
                                   const std::string& file, const ContentOptions& options,
                                   Warnings* warnings) {
  const WarningContext context(warnings, file);
  RecordingContent content;
  ChoosePerson(file, options, &motion, &content);
  content.format = format;
  content.rate = motion.rate;
  content.declared_frames = motion.declared_frames;
  content.usual_up_axes = {UpAxis::kY, UpAxis::kZ};
  content.labels = LabelsOf(motion);
  FoundBody body = FindBody(motion, ShippedBoneNames());
  std::vector<TurningPoint> points;
  double arm = 0;
  if (body.joints.empty()) {
    content.doubt_of_names =
        "no two legs are found by the names of the joints, nor two arms alone; they are taken for "
        "markers; write their names into bones.xml";
    Warn(warnings, content.doubt_of_names);
  } else {
    DecideUnit(body.leg_length, &content, warnings);
    points = AddPoints(motion, &content.labels, &body);
    arm = kArm / content.metres;
  }
  if (body.is_by_lengths) {
    content.doubt_of_names =
        "the names of the joints tell no two legs (bones.xml); legs and arms are those that the "
        "lengths of the bones tell";
    Warn(warnings, content.doubt_of_names);
  }
  if (body.has_exchanged_sides) {
    content.doubt_of_names =
        "knees and toes tell that the joints which are named left are right, or the file is "
        "mirrored; so they are taken";
    Warn(warnings, content.doubt_of_names);
  }
  MakeUnique(&content.labels);
  content.body = std::move(body.joints);
  const auto all = std::make_shared<const SkeletonMotion>(std::move(motion));
  content.read = [all, points, arm](const std::vector<int>& chosen,
                                    const std::vector<std::string>& labels, double rate) {
    MarkerSequence markers(labels, all->num_frames, rate, 0);
    Matrix3Xd p;
    std::vector<Matrix3d> R;
    for (int k = 0; k < all->num_frames; ++k) {
      all->pose(k, &p, &R);
      auto frame = markers.frame(k);
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        const int point = chosen[i] - all->num_joints();
        auto place = frame.col(static_cast<Eigen::Index>(i));
        if (point < 0) {
          place = p.col(chosen[i]);
          continue;
        }
        const TurningPoint& of = points[static_cast<std::size_t>(point)];
        place = p.col(of.joint) + arm * R[static_cast<std::size_t>(of.joint)].col(of.axis);
      }
    }
    return markers;
  };
  return content;
}

}  // namespace mmm_converter
