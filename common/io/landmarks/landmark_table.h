// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace mmm_converter {

enum class LandmarkKind {
  kSkin,     ///< a marker on the skin
  kPoint,    ///< the same, and a keypoint of programs that see persons in videos
  kJoint,    ///< the centre of a joint, or such a keypoint
  kSegment,  ///< worn somewhere on the segment: clusters, wands
};

enum class BodySide { kNone, kLeft, kRight };

/// A `<Landmark>`: what markers are put on. Of a sided one the left is described.
struct Landmark {
  std::string name;
  LandmarkKind kind = LandmarkKind::kSkin;
  std::string part;  ///< of the body: "head", "upper arm", "pelvis"
  bool is_sided = false;
  std::string marker;                              ///< of the model, named after it; may be empty
  std::string segment;                             ///< of the model of 1 m; empty: the marker's
  Eigen::Vector3d p_SM = Eigen::Vector3d::Zero();  ///< in axes of the segment [m]
  double deviation = 0;  ///< of worn markers from there, on each axis, of a person [m]
};

/// A `<Landmarks>` file: the landmarks and their spellings, and words for sides (xml_config/
/// landmarks.xml, which says what its elements mean).
class LandmarkTable {
 public:
  /// @throws Error with file and line for anything that is not well-formed or not allowed.
  explicit LandmarkTable(const std::string& path);

  const std::vector<Landmark>& landmarks() const { return landmarks_; }
  const std::string& file() const { return file_; }

  /// Landmarks (with or without sides) of that spelling, in small letters and digits, in the order
  /// of the file.
  const std::vector<int>& Find(const std::string& spelling, bool is_sided) const;

  /// The joints that a bone of that name begins at; a skeleton's bone has the name of a segment.
  const std::vector<int>& FindBone(const std::string& spelling, bool is_sided) const;

  /// Words for left and right; longer ones first.
  const std::vector<std::string>& side_words(BodySide side) const;
  /// Single letters that stand for sides in some languages only.
  const std::string& side_letters(BodySide side) const;

  /// Spellings of all elements Word, which tell places on landmarks; longer ones first.
  const std::vector<std::string>& place_words() const { return place_words_; }

  bool IsLeftOut(const std::string& word) const { return Contains(leave_, word); }
  bool IsComputed(const std::string& word) const { return Contains(computed_, word); }

 private:
  using Meanings = std::unordered_map<std::string, std::vector<int>>;
  static const std::vector<int>& Find(const Meanings& meanings, const std::string& spelling);
  static bool Contains(const std::vector<std::string>& words, const std::string& word);

  std::string file_;
  std::vector<Landmark> landmarks_;
  Meanings sided_, middle_, sided_bones_, middle_bones_;
  std::vector<std::string> left_, right_;
  std::string left_letters_, right_letters_;
  std::vector<std::string> leave_, computed_, place_words_;
};

/// The shipped table, read once. @throws Error as LandmarkTable.
const LandmarkTable& ShippedLandmarks();

}  // namespace mmm_converter
