// SPDX-License-Identifier: MIT
#include "common/io/npz/npz_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "common/io/npz/npz_file.h"
#include "common/io/npz/numpy_array.h"
#include "common/io/npz/smpl_model.h"
#include "common/io/skeleton/skeleton_body.h"
#include "common/io/skeleton/skeleton_content.h"
#include "common/math/rotation.h"
#include "common/math/statistics.h"
#include "common/motion/recording_content.h"
#include "common/motion/skeleton.h"
#include "common/support/error.h"
#include "common/support/units.h"
#include "common/support/warnings.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

using Layout = std::array<SmplJoint, kSmplJoints>;

inline constexpr double kFarthestJoint = 1e6;  ///< a coordinate that means anything

// Joints of SMPL with and without hands, feet and face, in the layers of smplx and of data sets.
constexpr std::size_t kCounts[] = {22, 24, 25, 45, 52, 54, 55, 73, 127, 144};
constexpr int kSampledFrames = 50;
// Limbs whose bones change their length or differ between the sides: the orders of Kinect, OpenPose
// and Human3.6M have 3 and more, those of SMPL and LAFAN1 none.
constexpr int kMostStrangeLimbs = 3;

constexpr Layout kLafan = {
    {{"Hips", -1},         {"LeftUpLeg", 0},  {"LeftLeg", 1},        {"LeftFoot", 2},
     {"LeftToe", 3},       {"RightUpLeg", 0}, {"RightLeg", 5},       {"RightFoot", 6},
     {"RightToe", 7},      {"Spine", 0},      {"Spine1", 9},         {"Spine2", 10},
     {"Neck", 11},         {"Head", 12},      {"LeftShoulder", 11},  {"LeftArm", 14},
     {"LeftForeArm", 15},  {"LeftHand", 16},  {"RightShoulder", 11}, {"RightArm", 18},
     {"RightForeArm", 19}, {"RightHand", 20}}};

SkeletonMotion MotionOf(const Layout& layout, const std::shared_ptr<const NumpyArray>& places) {
  SkeletonMotion motion;
  for (const SmplJoint& joint : layout) {
    motion.names.emplace_back(joint.name);
    motion.parents.push_back(joint.parent);
  }
  motion.has_orientations = false;
  motion.num_frames = static_cast<int>(places->rows());
  motion.pose = [places](int frame, Matrix3Xd* p, std::vector<Matrix3d>* R) {
    p->resize(3, kSmplJoints);
    R->resize(kSmplJoints, Matrix3d::Identity());
    for (int i = 0; i < 3 * kSmplJoints; ++i) {
      const double value =
          places->Number(static_cast<std::size_t>(frame), static_cast<std::size_t>(i));
      (*p)(i % 3, i / 3) = std::abs(value) < kFarthestJoint ? value : kNaN;
    }
    if (!p->allFinite()) p->setConstant(kNaN);
  };
  return motion;
}

/// How little a layout's bones are those of a body.
struct Strangeness {
  double sum = 0;  ///< how much they change over the motion, and left and right differ, by lengths
  int limbs = 0;   ///< bones of limbs that do so by far
};

bool IsOfLimb(std::string_view name) {
  constexpr std::string_view kEnds[] = {"Knee", "Ankle", "Elbow",   "Wrist",
                                        "Leg",  "Foot",  "ForeArm", "Hand"};
  return name != "L_Foot" && name != "R_Foot" && !name.ends_with("UpLeg") &&
         std::any_of(std::begin(kEnds), std::end(kEnds),
                     [&](std::string_view end) { return name.ends_with(end); });
}

Strangeness StrangenessOf(const SkeletonMotion& motion) {
  // Noise of 3 cm changes a thigh by a quarter.
  constexpr double kChange = 0.5, kDifference = 0.3;
  std::vector<std::vector<double>> lengths(kSmplJoints);
  Matrix3Xd p;
  std::vector<Matrix3d> R;
  for (const int k : SpreadFrames(motion.num_frames, kSampledFrames)) {
    motion.pose(k, &p, &R);
    if (!p.allFinite()) continue;
    for (std::size_t j = 1; j < lengths.size(); ++j) {
      lengths[j].push_back((p.col(static_cast<Eigen::Index>(j)) - p.col(motion.parents[j])).norm());
    }
  }
  Strangeness strangeness;
  if (lengths.back().empty()) return strangeness;
  std::vector<bool> is_strange(kSmplJoints, false);
  for (std::size_t j = 1; j < lengths.size(); ++j) {
    const double median = Median(lengths[j]);
    const auto [least, most] = std::minmax_element(lengths[j].begin(), lengths[j].end());
    strangeness.sum += (*most - *least) / (median + 1e-9);
    std::string other = motion.names[j];
    for (const auto& [left, right] : {std::pair("L_", "R_"), std::pair("Left", "Right")}) {
      if (other.starts_with(left)) other = right + other.substr(std::string(left).size());
    }
    const auto found = std::find(motion.names.begin(), motion.names.end(), other);
    const auto at = static_cast<std::size_t>(found - motion.names.begin());
    const double of_other = Median(lengths[at]);
    strangeness.sum += std::abs(median - of_other) / (median + of_other + 1e-9);
    const double change = Percentile(lengths[j], 90) - Percentile(lengths[j], 10);
    if (change > kChange * median) is_strange[j] = true;
    if (std::abs(median - of_other) > kDifference * (median + of_other) / 2) {
      is_strange[j] = is_strange[at] = true;
    }
  }
  for (std::size_t j = 1; j < lengths.size(); ++j) {
    if (is_strange[j] && IsOfLimb(motion.names[j])) ++strangeness.limbs;
  }
  return strangeness;
}

/// Places of joints, frames x joints x 3, in the order of SMPL's or of LAFAN1's, whose bones tell
/// which it is. rate: 0: the file does not say.
/// @throws Error where the array is none of such places.
RecordingContent ContentOfPlaces(NumpyArray places, double rate, const std::string& file,
                                 Warnings* warnings) {
  const std::vector<std::size_t>& shape = places.head().shape;
  const bool is_right =
      !places.head().is_text() && shape.size() == 3 && shape[0] > 0 && shape[2] == 3 &&
      std::find(std::begin(kCounts), std::end(kCounts), shape[1]) != std::end(kCounts);
  if (!is_right) {
    const bool is_features = shape.size() == 2 && (shape[1] == 263 || shape[1] == 251);
    throw Error(
        fmt::format("{}: has the shape {}{}; expected places of SMPL's or LAFAN1's joints: frames "
                    "x {} x 3",
                    file, ShapeText(places.head()),
                    is_features ? ", as features of HumanML3D or KIT-ML, whose joints are in the "
                                  "folder new_joints"
                                : "",
                    fmt::join(kCounts, ", ")));
  }
  const bool can_be_lafan = shape[1] == kLafan.size();
  const auto shared = std::make_shared<const NumpyArray>(std::move(places));
  SkeletonMotion motion = MotionOf(SmplJoints(), shared);
  Strangeness strangeness = StrangenessOf(motion);
  if (can_be_lafan) {
    SkeletonMotion lafan = MotionOf(kLafan, shared);
    const Strangeness of_lafan = StrangenessOf(lafan);
    if (of_lafan.sum < strangeness.sum) {
      motion = std::move(lafan);
      strangeness = of_lafan;
    }
  }
  if (strangeness.limbs >= kMostStrangeLimbs) {
    throw Error(fmt::format(
        "{}: its joints are in another order than SMPL's or LAFAN1's: so taken, {} of "
        "the bones of both arms and legs change their length or are longer on one side; "
        "put them into that order (pelvis, L_Hip, R_Hip, Spine1, L_Knee, ...)",
        file, strangeness.limbs));
  }
  motion.rate = rate;
  return ContentOfSkeleton(std::move(motion), "joint places", file, {}, warnings);
}

// The names that AMASS, smplx, GVHMR, WHAM, AIST++ and others give to the same arrays.
const std::vector<std::string> kPoses = {"poses", "smpl_poses", "fullpose", "full_pose", "pose"};
const std::vector<std::string> kRoots = {"root_orient", "global_orient", "root_pose", "poses_root"};
const std::vector<std::string> kBodies = {"pose_body", "body_pose", "poses_body"};
const std::vector<std::string> kTranslations = {"trans",       "transl",     "smpl_trans",
                                                "translation", "root_trans", "Th"};
const std::vector<std::string> kRates = {"mocap_framerate", "mocap_frame_rate", "framerate",
                                         "frame_rate",      "mocap_fps",        "fps"};
const std::vector<std::string> kPlaces = {
    "global_joint_positions", "joint_positions", "joints", "positions", "keypoints3d", "joints3d"};

constexpr std::size_t kMostColumns = 9 * kSmplJoints;
constexpr std::size_t kSmplXColumns = 3 * 55;
constexpr std::size_t kMotionXColumns = 322;

/// Joints that an array has rotations of, with the root: those of SMPL's body, of SMPL, SMPL-H and
/// SMPL-X, and of SMPL-X without its eyes or its jaw.
constexpr std::size_t kJointCounts[] = {22, 24, 52, 53, 54, 55};

/// How many numbers a joint's rotation has in an array of `joints` with SMPL's body's, 22, or less
/// where some of them are elsewhere: 3 of a vector, 9 of a matrix; 0: it has none of these shapes.
std::size_t RotationWidth(const NumpyHead& head, std::size_t joints) {
  const std::vector<std::size_t>& shape = head.shape;
  const std::size_t count = head.row_size();
  const auto has = [&](std::size_t width) {
    if (joints == 1) return count == width;
    return std::any_of(std::begin(kJointCounts), std::end(kJointCounts), [&](std::size_t all) {
      return count == width * (all + joints - kSmplJoints);
    });
  };
  const bool is_flat = shape.size() < 3 || count == shape.back();
  if (is_flat) return has(3) ? 3 : has(9) ? 9 : 0;
  const bool has_matrices =
      shape.back() == 9 || (shape.back() == 3 && shape[shape.size() - 2] == 3);
  if (has_matrices) return count >= 9 * joints ? 9 : 0;
  return shape.back() == 3 && count >= 3 * joints ? 3 : 0;
}

/// Rotations of joints in an array: rotation vectors, or matrices where there are nine numbers.
struct Rotations {
  std::shared_ptr<const NumpyArray> array;
  int first_joint = 0;  ///< of which its first one is
  std::size_t width = 3;

  Matrix3d Of(std::size_t frame, int joint) const {
    const std::size_t begin = width * static_cast<std::size_t>(joint - first_joint);
    const auto at = [&](std::size_t i) { return array->Number(frame, begin + i); };
    Matrix3d R = Matrix3d::Constant(kNaN);
    if (width == 9) {
      Matrix3d M;
      for (std::size_t i = 0; i < 9; ++i) {
        M(static_cast<int>(i / 3), static_cast<int>(i % 3)) = at(i);
      }
      if (M.allFinite() && M.determinant() > 0.5 && M.norm() < 2) R = NearestRotation(M);
      return R;
    }
    const Vector3d turn(at(0), at(1), at(2));
    if (turn.norm() < kFarthestJoint) R = Exp(turn).toRotationMatrix();
    return R;
  }
};

/// The arrays of a motion.
struct SmplMotion {
  std::vector<Rotations> rotations;               ///< of all joints, or of the root and the others
  std::shared_ptr<const NumpyArray> translation;  ///< none: not known
  std::size_t first_column = 0;                   ///< of it
  double unit = 1;                                ///< of it [m]

  bool has_expressions() const {
    const Rotations& last = rotations.back();
    return rotations.size() > 1 || last.array->row_size() == last.width / 3 * kSmplXColumns;
  }
};

/// rest: the places of joints at the zero pose.
std::function<void(int, Matrix3Xd*, std::vector<Matrix3d>*)> Poses(const SmplMotion& motion,
                                                                   const Matrix3Xd& rest) {
  return [motion, rest](int k, Matrix3Xd* p, std::vector<Matrix3d>* R) {
    p->resize(3, kSmplJoints);
    R->resize(kSmplJoints);
    const auto frame = static_cast<std::size_t>(k);
    p->col(0) = rest.col(0);
    for (int a = 0; a < 3 && motion.translation; ++a) {
      const std::size_t column = motion.first_column + static_cast<std::size_t>(a);
      (*p)(a, 0) += motion.unit * motion.translation->Number(frame, column);
    }
    for (int j = 0; j < kSmplJoints; ++j) {
      const auto at = static_cast<std::size_t>(j);
      const Rotations& of = j < motion.rotations.back().first_joint ? motion.rotations.front()
                                                                    : motion.rotations.back();
      const Matrix3d local = of.Of(frame, j);
      const int parent = SmplJoints()[at].parent;
      if (parent < 0) {
        (*R)[at] = local;
        continue;
      }
      const Matrix3d& above = (*R)[static_cast<std::size_t>(parent)];
      (*R)[at] = above * local;
      p->col(j) = p->col(parent) + above * (rest.col(j) - rest.col(parent));
    }
    const bool is_known =
        p->allFinite() && p->cwiseAbs().maxCoeff() < kFarthestJoint &&
        std::all_of(R->begin(), R->end(), [](const Matrix3d& one) { return one.allFinite(); });
    if (!is_known) p->setConstant(kNaN);
  };
}

SkeletonMotion SkeletonOf(const SmplMotion& motion, const Matrix3Xd& rest, int num_frames) {
  SkeletonMotion skeleton;
  for (const SmplJoint& joint : SmplJoints()) {
    skeleton.names.emplace_back(joint.name);
    skeleton.parents.push_back(joint.parent);
  }
  skeleton.num_frames = num_frames;
  skeleton.pose = Poses(motion, rest);
  return skeleton;
}

void WarnOfStandIn(Warnings* warnings) {
  Warn(warnings,
       "the body is one of 1.7 m with the MMM model's proportions, as SMPL's own model is not "
       "given: limbs are within some 3 degrees, places within some centimetres");
}

/// @throws Error where there are so many frames that they would take far more memory than the file.
int CheckFrames(std::size_t frames, const std::string& file) {
  constexpr std::size_t kFrames = 200'000, kBytesPerFrame = 32;
  const std::size_t most = kFrames + RegularFileSize(file) / kBytesPerFrame;
  if (frames <= most) return static_cast<int>(frames);
  throw Error(
      fmt::format("{}: says that it has {} frames; at most {} are read of a file of its size", file,
                  frames, most));
}

class SmplFile {
 public:
  SmplFile(const std::string& file, Warnings* warnings)
      : file_(file), archive_(file), warnings_(warnings) {}

  RecordingContent Read(const std::string& model_file) {
    ReadRotations();
    ReadTranslation();
    const bool has_model = !model_file.empty();
    const SmplModel model = has_model ? ReadSmplModel(model_file) : StandInSmplModel(Kind());
    if (!has_model) WarnOfStandIn(warnings_);
    SkeletonMotion motion = SkeletonOf(
        motion_, model.Joints(has_model ? Betas() : std::vector<double>()), CountFrames());
    motion.rate = RateOf(motion.num_frames);
    return ContentOfSkeleton(std::move(motion), "AMASS", file_, {}, warnings_);
  }

  /// [Hz]; 0: it does not say.
  double RateOf(int num_frames) {
    const std::string name = archive_.FirstOf(kRates);
    if (!name.empty()) return Scalar(name);
    if (!archive_.Has("mocap_time_length")) return 0;
    const double rate = num_frames / Scalar("mocap_time_length");
    const double nearest = std::round(rate);
    // The length is that from the first to the last frame, or with the last one's.
    return nearest > 0 && std::abs(rate - nearest) * num_frames < 2 * nearest ? nearest : rate;
  }

 private:
  /// An array of one axis is a single frame.
  NumpyArray ReadNumbers(const std::string& name) const {
    NumpyArray array = archive_.Read(name, kMostColumns);
    if (array.head().shape.size() == 1) array.MakeRow();
    return array;
  }

  [[noreturn]] void RefuseShape(const std::string& name, const NumpyArray& array,
                                const std::string& expected) const {
    throw Error(fmt::format("{}: {} has the shape {}{}; expected {}", file_, name,
                            ShapeText(array.head()), array.head().is_text() ? " of texts" : "",
                            expected));
  }

  void AddRotations(const std::string& name, int first_joint, int num_joints) {
    const auto array = std::make_shared<const NumpyArray>(ReadNumbers(name));
    const auto joints = static_cast<std::size_t>(num_joints);
    const std::size_t width = RotationWidth(array->head(), joints);
    if (array->head().is_text() || array->rows() == 0 || width == 0) {
      RefuseShape(name, *array,
                  joints == 1 ? "a rotation vector or a matrix for each frame: frames x 3 or 9"
                              : fmt::format("rotation vectors or matrices of {} joints or more for "
                                            "each frame: frames x {} or {} x 3",
                                            joints, 3 * joints, joints));
    }
    motion_.rotations.push_back({array, first_joint, width});
  }

  void ReadRotations() {
    const std::string all = archive_.FirstOf(kPoses);
    if (!all.empty()) {
      AddRotations(all, 0, kSmplJoints);
      return;
    }
    AddRotations(archive_.FirstOf(kRoots), 0, 1);
    AddRotations(archive_.FirstOf(kBodies), 1, kSmplJoints - 1);
  }

  void ReadTranslation() {
    const std::string name = archive_.FirstOf(kTranslations);
    if (name.empty()) {
      Warn(warnings_, "there is no trans: the pelvis is held in place");
      return;
    }
    motion_.translation = std::make_shared<const NumpyArray>(ReadNumbers(name));
    if (motion_.translation->head().is_text() || motion_.translation->rows() == 0 ||
        motion_.translation->row_size() != 3) {
      RefuseShape(name, *motion_.translation, "frames x 3");
    }
    for (const char* scale : {"smpl_scaling", "scaling"}) {  // AIST++
      if (archive_.Has(scale)) motion_.unit = 1 / Scalar(scale);
    }
    if (!(motion_.unit > 0 && std::isfinite(motion_.unit))) motion_.unit = 1;
  }

  int CountFrames() {
    std::size_t least = motion_.rotations.front().array->rows(), most = least;
    const auto take = [&](const NumpyArray& array) {
      least = std::min(least, array.rows());
      most = std::max(most, array.rows());
    };
    take(*motion_.rotations.back().array);
    if (motion_.translation) take(*motion_.translation);
    if (least != most) {
      Warn(warnings_, fmt::format("the arrays have {} and {} frames; the first {} are read", least,
                                  most, least));
    }
    return CheckFrames(least, file_);
  }

  SmplKind Kind() const {
    if (archive_.Has("surface_model_type")) {
      const std::string type = archive_.Read("surface_model_type").Text();
      return type.find('x') == std::string::npos ? SmplKind::kSmplH : SmplKind::kSmplX;
    }
    return motion_.has_expressions() ? SmplKind::kSmplX : SmplKind::kSmplH;
  }

  std::vector<double> Betas() const {
    std::vector<double> betas;
    if (!archive_.Has("betas")) return betas;
    const NumpyArray of_file = archive_.Read("betas");
    if (of_file.head().is_text() || of_file.head().size() == 0) return betas;
    const bool has_rows = of_file.head().shape.size() > 1;
    const std::size_t count = has_rows ? of_file.row_size() : of_file.rows();
    for (std::size_t i = 0; i < std::min<std::size_t>(count, 300); ++i) {
      const double beta = has_rows ? of_file.Number(0, i) : of_file.Number(i, 0);
      betas.push_back(std::abs(beta) < kFarthestJoint ? beta : 0);
    }
    return betas;
  }

  double Scalar(const std::string& name) {
    try {
      const NumpyArray array = archive_.Read(name);
      if (!array.head().is_text() && array.head().size() > 0) return array.Number(0, 0);
    } catch (const Error& error) {
      Warn(warnings_, error.what());
    }
    return 0;
  }

  const std::string& file_;
  NpzFile archive_;
  Warnings* warnings_;
  SmplMotion motion_;
};

/// Rotation vectors of the body and others, expressions, translation, shape.
RecordingContent ReadMotionX(const std::shared_ptr<const NumpyArray>& array, int num_frames,
                             const std::string& file, const std::string& model_file,
                             Warnings* warnings) {
  constexpr std::size_t kTranslation = 309, kBetas = 312;
  SmplMotion motion;
  motion.rotations.push_back({array});
  motion.translation = array;
  motion.first_column = kTranslation;
  std::vector<double> betas;
  for (std::size_t i = kBetas; i < kMotionXColumns && num_frames > 0; ++i) {
    const double beta = array->Number(0, i);
    betas.push_back(std::abs(beta) < kFarthestJoint ? beta : 0);
  }
  const bool has_model = !model_file.empty();
  const SmplModel model =
      has_model ? ReadSmplModel(model_file) : StandInSmplModel(SmplKind::kSmplX);
  if (!has_model) WarnOfStandIn(warnings);
  return ContentOfSkeleton(
      SkeletonOf(motion, model.Joints(has_model ? betas : std::vector<double>()), num_frames),
      "Motion-X", file, {}, warnings);
}

bool HasRotations(const NpzFile& archive) {
  return !archive.FirstOf(kPoses).empty() ||
         (!archive.FirstOf(kRoots).empty() && !archive.FirstOf(kBodies).empty());
}

}  // namespace

bool HoldsMotion(const std::string& file) {
  try {
    const NpzFile archive(file);
    return HasRotations(archive) || !archive.FirstOf(kPlaces).empty();
  } catch (const Error&) {  // whoever reads it says so
    return false;
  }
}

RecordingContent ReadNpzContent(const std::string& file, const ContentOptions& options,
                                Warnings* warnings) {
  const WarningContext context(warnings, file);
  const NpzFile archive(file);
  if (HasRotations(archive)) return SmplFile(file, warnings).Read(options.smpl_model);
  const std::string places = archive.FirstOf(kPlaces);
  if (!places.empty()) {
    NumpyArray array = archive.Read(places);
    const double rate = SmplFile(file, warnings).RateOf(CheckFrames(array.rows(), file));
    return ContentOfPlaces(std::move(array), rate, fmt::format("{}: {}", file, places), warnings);
  }
  throw Error(
      fmt::format("{}: has no motion of a person: expected poses, or root_orient and pose_body, or "
                  "global_joint_positions; it has {}",
                  file, archive.NamesForUsers()));
}

RecordingContent ReadNpyContent(const std::string& file, const ContentOptions& options,
                                Warnings* warnings) {
  const WarningContext context(warnings, file);
  const ByteSource source = BytesOfFile(file);
  NumpyReader reader(file, kMotionXColumns);
  std::string part;
  for (std::uint64_t at = 0; at < source.size; at += part.size()) {
    part.resize(std::min<std::uint64_t>(1 << 16, source.size - at));
    source.read(at, part.size(), part.data());
    reader.Add(part);
  }
  NumpyArray array = reader.Finish();
  const int num_frames = CheckFrames(array.rows(), file);
  const std::vector<std::size_t>& shape = array.head().shape;
  if (shape.size() == 2 && shape[1] == kMotionXColumns && !array.head().is_text()) {
    const auto all = std::make_shared<const NumpyArray>(std::move(array));
    return ReadMotionX(all, num_frames, file, options.smpl_model, warnings);
  }
  return ContentOfPlaces(std::move(array), 0, file, warnings);
}

}  // namespace mmm_converter
