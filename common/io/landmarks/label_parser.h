// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/landmarks/label_readings.h"

namespace mmm_converter {

/// A meaning of a label, and what it needs to be right.
struct Candidate {
  LabelReading reading;
  /// Names of the same on the other side; empty: it has no side, or a word says it.
  std::vector<std::string> counterparts = {};
  bool needs_counterpart = false;  ///< else it is wrong
  std::size_t side_length = 0;     ///< of what says it, where that is a part of a word
};

/// Finds what a label can mean, and what that needs.
class LabelParser {
 public:
  /// prefix: words that all names of a file begin with, of no meaning here.
  LabelParser(std::string_view label, const LandmarkTable& table,
              const std::vector<std::string>& prefix = {});

  bool is_computed() const { return is_computed_; }
  /// The name without what tells nothing, in small letters and digits.
  const std::string& whole() const { return whole_; }

  std::vector<Candidate> Candidates();
  /// As one of a series of letters, "RFMA" to "RFMD": what its name without the letter means.
  std::vector<Candidate> OfSeries();
  /// What it means if it is the name of a skeleton's bone: the joint that this begins at.
  std::vector<LabelReading> Bones();

 private:
  void AddAll();
  void Add(const std::string& name, bool is_sided, Candidate candidate);
  std::vector<int> Meanings(const std::string& name, bool is_sided) const;
  /// Where on a segment a marker of a cluster is worn may be said in any words: "thighpostsup2".
  std::vector<int> SegmentsOf(const std::string& name, bool is_sided, int num_words) const;
  void AddSideWord(std::size_t i);
  void AddAtEnd(BodySide side, bool at_end);
  /// The side is one letter of the name: "MLG" and "MLD", "FRTHI" and "FLTHI".
  void AddLetter(std::size_t at);
  /// The part of the body that a segment's name means; empty: it is none.
  std::string PartOf(const std::string& word) const;
  /// "pelvis-RASIS", "Foot_R_Heel": the segment is said, too.
  void AddBesideSegment();
  /// Single letters that stand for a side in any language.
  std::string LettersOf(BodySide side) const;

  const LandmarkTable& table_;
  std::vector<std::string> words_;
  std::string whole_;
  bool is_computed_ = false;
  enum class Looking { kAnywhere, kAtSegments, kAtBones, kAtSeries };
  Looking looking_ = Looking::kAnywhere;
  std::vector<Candidate> found_;
};

/// Words that nearly all names begin with, as "Body_RKnee" and "251112_KUO_LASI".
std::vector<std::string> CommonPrefix(const std::vector<std::string>& labels);

}  // namespace mmm_converter
