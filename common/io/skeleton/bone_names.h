// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter {

/// What the name of a bone can be of; xml_config/bones.xml has the names. A leg is a hip or a knee,
/// a foot an ankle or toes, a shoulder that of the arm or of the collar, an arm an upper arm or a
/// forearm, a hand a wrist or what is behind it.
enum class BoneKind {
  kNone,
  kHip,
  kLeg,
  kKnee,
  kAnkle,
  kFoot,
  kToe,
  kCollar,
  kShoulder,
  kUpperArm,
  kArm,
  kElbow,
  kWrist,
  kHand,
  kNeck,
  kHead,
};

struct BoneName {
  BoneKind kind = BoneKind::kNone;
  char side = ' ';  ///< 'L', 'R' or, of the middle, ' '
};

/// A `<Bones>` file.
class BoneNames {
 public:
  /// @throws Error with file and line for anything that is not well-formed or not allowed.
  explicit BoneNames(const std::string& path);

  /// What a joint's name says of the bone that begins there.
  BoneName Find(std::string_view joint) const;

 private:
  /// is_whole: all words are the bone's, else those at their end may be.
  BoneKind KindOf(const std::vector<std::string>& words, bool is_whole) const;
  BoneName FindInWords(const std::vector<std::string>& words) const;

  std::map<std::string, BoneKind> kinds_;  ///< by spelling
  std::vector<std::string> sides_[2];      ///< left, right
  std::vector<std::string> leave_, no_bone_;
};

/// The shipped file, read once. @throws Error as BoneNames.
const BoneNames& ShippedBoneNames();

}  // namespace mmm_converter
