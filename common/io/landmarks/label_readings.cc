// SPDX-License-Identifier: MIT
#include "common/io/landmarks/label_readings.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "common/io/landmarks/label_parser.h"

namespace mmm_converter {
namespace {

constexpr int kSeveral = 3;

enum class Limbs { kNone, kArms, kLegs };

Limbs LimbsOf(const std::string& part) {
  for (const char* one : {"upper arm", "forearm", "hand"}) {
    if (part == one) return Limbs::kArms;
  }
  for (const char* one : {"thigh", "shank", "ankle", "foot"}) {
    if (part == one) return Limbs::kLegs;
  }
  return Limbs::kNone;
}

/// "r asis#2": another point of the same name in its file.
bool IsCopy(const std::string& label) {
  const std::size_t mark = label.rfind('#');
  return mark != std::string::npos && mark > 0 && mark + 1 < label.size() &&
         std::all_of(label.begin() + static_cast<std::ptrdiff_t>(mark) + 1, label.end(),
                     [](char c) { return c >= '0' && c <= '9'; });
}

/// Origin and axes of a segment, stored as points: "LTIO", "LTIA", "LTIL" and "LTIP".
bool IsOfAxes(const std::string& name, const std::set<std::string>& all) {
  constexpr std::string_view kEnds = "oalp";
  if (name.size() != 4 || kEnds.find(name.back()) == std::string_view::npos) return false;
  return std::all_of(kEnds.begin(), kEnds.end(),
                     [&](char end) { return all.contains(name.substr(0, 3) + end); });
}

/// Names that differ by their last letter only, which is A, B, C and so on: without it.
std::set<std::string> SeriesOf(const std::set<std::string>& all) {
  std::set<std::string> series;
  for (const std::string& name : all) {
    if (name.size() < 3 || name.back() != 'a') continue;
    const std::string stem = name.substr(0, name.size() - 1);
    if (all.contains(stem + 'b') && all.contains(stem + 'c')) series.insert(stem);
  }
  return series;
}

bool IsOfSeries(const std::string& name, const std::set<std::string>& series) {
  constexpr char kLast = 'h';
  return !name.empty() && name.back() >= 'a' && name.back() <= kLast &&
         series.contains(name.substr(0, name.size() - 1));
}

/// The labels of a person on their way to one meaning each.
class LabelsOfPerson {
 public:
  LabelsOfPerson(const std::vector<std::string>& labels, const std::vector<bool>& seen,
                 const LandmarkTable& table, const std::vector<std::string>& prefix)
      : table_(table), read_(labels.size()), is_used_(labels.size(), true) {
    std::vector<LabelParser> parsers;
    std::set<std::string> all;
    for (const std::string& label : labels) {
      parsers.emplace_back(label, table, prefix);
      all.insert(parsers.back().whole());
    }
    const std::set<std::string> series = SeriesOf(all);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (!seen.empty() && !seen[i]) is_used_[i] = false;
      if (IsCopy(labels[i])) {
        read_[i].why_left_out = "another point of the same name";
      } else if (parsers[i].is_computed() || IsOfAxes(parsers[i].whole(), all)) {
        read_[i].why_left_out = "a computed point";
      } else {
        const bool is_of_series = IsOfSeries(parsers[i].whole(), series);
        Take(is_of_series ? parsers[i].OfSeries() : parsers[i].Candidates(), parsers[i].whole(),
             all, &read_[i]);
        if (is_of_series && read_[i].readings.empty()) {
          read_[i].why_left_out = "one of a series of an unknown part of the body";
        }
      }
      if (read_[i].readings.empty()) is_used_[i] = false;
      bones_.push_back(parsers[i].Bones());
    }
  }

  int num_used() const {
    return static_cast<int>(std::count(is_used_.begin(), is_used_.end(), true));
  }

  std::vector<ReadLabel> Read() {
    TakeAloneWithoutSide();
    if (AreBones()) TakeBones();
    SortReadings(AreKeypoints());
    PreferShownLimbs();
    TakeFree();
    LeaveOutLoneLimbs();
    LeaveOutJointsOfMarkers();
    return std::move(read_);
  }

 private:
  /// Readings that the other labels allow. LARM is no left arm where nothing begins with R and most
  /// labels have no side.
  void Take(const std::vector<Candidate>& candidates, const std::string& whole,
            const std::set<std::string>& all, ReadLabel* label) {
    const bool is_lumbar =
        whole.size() == 2 && whole[0] == 'l' && whole[1] >= '0' && whole[1] <= '9';
    bool has_side = false, is_attached = false, is_pair = false;
    std::vector<LabelReading> without_side;
    std::vector<std::pair<std::size_t, LabelReading>> by_doubt;
    for (const Candidate& one : candidates) {
      const bool is_sided = Of(one.reading).is_sided;
      if (!is_sided && is_lumbar && all.contains("r" + whole.substr(1))) continue;
      const auto& others = one.counterparts;
      const bool has_other = std::any_of(others.begin(), others.end(),
                                         [&](const auto& other) { return all.contains(other); });
      if (one.needs_counterpart && !has_other) continue;
      if (is_sided && one.reading.side == BodySide::kNone) {
        without_side.push_back(one.reading);
        continue;
      }
      const bool is_part = !others.empty();
      constexpr std::size_t kNoPair = 100;
      const std::size_t doubt = !is_part ? 0 : has_other ? one.side_length : kNoPair;
      by_doubt.emplace_back(doubt, one.reading);
      has_side |= is_sided;
      is_attached |= is_part;
      is_pair |= has_other;
    }
    // LIEL, beside RIEL, is no left EL.
    std::stable_sort(by_doubt.begin(), by_doubt.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [unused, reading] : by_doubt) label->readings.push_back(reading);
    if (!has_side && label->readings.empty()) {
      if (!without_side.empty()) ++num_without_side_;
      label->readings = std::move(without_side);
    } else if (is_attached && !is_pair && !without_side.empty()) {
      alone_.emplace_back(label, without_side);
    }
  }

  void TakeAloneWithoutSide() {
    if (num_without_side_ < kSeveral) return;
    for (auto& [label, readings] : alone_) label->readings = std::move(readings);
  }

  const Landmark& Of(const LabelReading& reading) const {
    return table_.landmarks()[static_cast<std::size_t>(reading.landmark)];
  }

  bool HasKind(const ReadLabel& label, LandmarkKind kind) const {
    return std::any_of(label.readings.begin(), label.readings.end(),
                       [&](const auto& reading) { return Of(reading).kind == kind; });
  }

  /// Names of a skeleton's bones, one point each, and none of what markers are put on.
  bool AreBones() const {
    constexpr int kFewest = 8;
    std::set<std::pair<int, BodySide>> sided;
    int bones = 0;
    for (std::size_t i = 0; i < read_.size(); ++i) {
      if (!is_used_[i]) continue;
      const LabelReading& marker = read_[i].readings[0];
      const Landmark& landmark = Of(marker);
      if (bones_[i].empty()) {
        const bool is_limb = LimbsOf(landmark.part) != Limbs::kNone && landmark.part != "foot";
        if (is_limb || (landmark.part == "pelvis" && landmark.is_sided)) return false;
      } else if (landmark.is_sided) {
        ++bones;
        sided.emplace(bones_[i][0].landmark, bones_[i][0].side);
      }
    }
    return bones >= kFewest && static_cast<int>(sided.size()) == bones;
  }

  void TakeBones() {
    for (std::size_t i = 0; i < read_.size(); ++i) {
      if (!bones_[i].empty() && is_used_[i]) read_[i].readings = bones_[i];
    }
  }

  /// Joints by name, and nothing that only a marker can be on but the head and the feet.
  bool AreKeypoints() const {
    int joints = 0;
    for (std::size_t i = 0; i < read_.size(); ++i) {
      if (!is_used_[i]) continue;
      const ReadLabel& label = read_[i];
      joints += HasKind(label, LandmarkKind::kJoint) ? 1 : 0;
      const bool may_be_keypoint =
          HasKind(label, LandmarkKind::kJoint) || HasKind(label, LandmarkKind::kPoint);
      const std::string& part = Of(label.readings[0]).part;
      if (!may_be_keypoint && part != "head" && part != "foot" && part != "hand") return false;
    }
    return joints >= 4;
  }

  void SortReadings(bool are_keypoints) {
    for (ReadLabel& label : read_) {
      std::stable_sort(label.readings.begin(), label.readings.end(),
                       [&](const auto& a, const auto& b) {
                         const bool a_is_joint = Of(a).kind == LandmarkKind::kJoint;
                         const bool b_is_joint = Of(b).kind == LandmarkKind::kJoint;
                         return a_is_joint != b_is_joint && a_is_joint == are_keypoints;
                       });
    }
  }

  /// Arms or legs that no other label names are not there.
  void PreferShownLimbs() {
    const auto is_of = [&](const LabelReading& one, Limbs limbs) {
      return LimbsOf(Of(one).part) == limbs;
    };
    const auto count = [&](Limbs limbs) {
      int labels = 0;
      for (std::size_t i = 0; i < read_.size(); ++i) {
        const auto& readings = read_[i].readings;
        labels += is_used_[i] && std::all_of(readings.begin(), readings.end(),
                                             [&](const auto& one) { return is_of(one, limbs); });
      }
      return labels;
    };
    const int arms = count(Limbs::kArms), legs = count(Limbs::kLegs);
    if (arms + legs > 0) TellHandsFromFeet(legs > 0 ? "hand" : "foot");
    if ((arms == 0) == (legs == 0)) return;
    const Limbs absent = arms == 0 ? Limbs::kArms : Limbs::kLegs;
    for (ReadLabel& label : read_) {
      std::stable_partition(label.readings.begin(), label.readings.end(),
                            [&](const auto& one) { return !is_of(one, absent); });
    }
  }

  /// MET2 is of the foot where legs are there, else of the hand. absent: "hand" or "foot".
  void TellHandsFromFeet(const std::string& absent) {
    for (ReadLabel& label : read_) {
      const auto is_of = [&](const std::string& part) {
        return std::any_of(label.readings.begin(), label.readings.end(),
                           [&](const auto& one) { return Of(one).part == part; });
      };
      if (!is_of("hand") || !is_of("foot")) continue;
      std::erase_if(label.readings, [&](const auto& one) { return Of(one).part == absent; });
    }
  }

  /// A leg that one or two labels name and nothing else of the body bears out, no pelvis and not
  /// the other leg, is none: RTB, beside the labels of an arm, is of that. The same of arms.
  void LeaveOutLoneLimbs() {
    constexpr int kFewestOfLimb = 3;
    for (const auto& [limbs, root, name] : {std::tuple(Limbs::kArms, "shoulder", "an arm"),
                                            std::tuple(Limbs::kLegs, "pelvis", "a leg")}) {
      std::vector<ReadLabel*> labels;
      bool is_rooted = false, are_clusters = true;
      int others = 0;
      std::map<BodySide, int> count;
      for (std::size_t i = 0; i < read_.size(); ++i) {
        if (!is_used_[i] || !read_[i].why_left_out.empty()) continue;
        const LabelReading& one = read_[i].readings[0];
        const Landmark& landmark = Of(one);
        if (LimbsOf(landmark.part) == limbs) {
          labels.push_back(&read_[i]);
          ++count[one.side];
          are_clusters &= landmark.kind == LandmarkKind::kSegment;
        } else {
          is_rooted |= landmark.part == root;
          ++others;
        }
      }
      const bool is_of_one_side = count.size() < 2;
      const bool are_few = std::all_of(count.begin(), count.end(), [&](const auto& side) {
        return side.second < kFewestOfLimb;
      });
      const bool is_borne_out =
          are_clusters ? is_rooted && !is_of_one_side : is_rooted || !is_of_one_side;
      if (!are_few || is_borne_out || others < kFewestOfLimb) continue;
      for (ReadLabel* label : labels) {
        label->why_left_out = std::string("nothing else shows ") + name;
      }
    }
  }

  /// Of several readings, the first that no label without choice has.
  void TakeFree() {
    std::set<std::pair<int, BodySide>> taken;
    const auto key = [](const LabelReading& one) { return std::pair(one.landmark, one.side); };
    for (std::size_t i = 0; i < read_.size(); ++i) {
      if (is_used_[i] && read_[i].readings.size() == 1) taken.insert(key(read_[i].readings[0]));
    }
    // LELB is at the elbow in any case, LLE may be at the knee.
    for (const bool of_one_part : {true, false}) {
      for (std::size_t i = 0; i < read_.size(); ++i) {
        auto& readings = read_[i].readings;
        if (!is_used_[i] || readings.size() < 2) continue;
        const bool is_of_one = std::all_of(readings.begin(), readings.end(), [&](const auto& one) {
          return Of(one).part == Of(readings[0]).part;
        });
        if (is_of_one != of_one_part) continue;
        const auto free =
            std::stable_partition(readings.begin(), readings.end(), [&](const auto& one) {
              return Of(one).kind == LandmarkKind::kSegment || !taken.contains(key(one));
            });
        if (free != readings.begin()) taken.insert(key(readings[0]));
      }
    }
  }

  /// A joint's centre tells nothing beside markers on both of its sides, of which it was computed.
  void LeaveOutJointsOfMarkers() {
    const auto count = [&](const std::string& part, BodySide side) {
      int markers = 0;
      for (std::size_t i = 0; i < read_.size(); ++i) {
        if (!is_used_[i] || !read_[i].why_left_out.empty()) continue;
        const LabelReading& one = read_[i].readings[0];
        const Landmark& landmark = Of(one);
        const bool is_there = landmark.part == part && landmark.kind == LandmarkKind::kSkin &&
                              (part == "pelvis" || one.side == side);
        markers += is_there ? 1 : 0;
      }
      return markers;
    };
    for (std::size_t i = 0; i < read_.size(); ++i) {
      if (!is_used_[i] || Of(read_[i].readings[0]).kind != LandmarkKind::kJoint) continue;
      const LabelReading& one = read_[i].readings[0];
      const std::string& part = Of(one).part;
      if (part == "head" || part == "neck" || part == "thorax") continue;
      if (count(part, one.side) >= (part == "pelvis" ? 3 : 1)) {
        read_[i].why_left_out = "a joint's centre beside its markers";
      }
    }
  }

  const LandmarkTable& table_;
  std::vector<ReadLabel> read_;
  std::vector<bool> is_used_;
  std::vector<std::vector<LabelReading>> bones_;  ///< what labels mean as names of bones
  int num_without_side_ = 0;  ///< labels that tell the side of no sided landmark
  /// Whose side may be a part of their name, and what they mean then.
  std::vector<std::pair<ReadLabel*, std::vector<LabelReading>>> alone_;
};

}  // namespace

std::vector<LabelReading> ReadingsOf(std::string_view label, const LandmarkTable& table) {
  std::vector<LabelReading> readings;
  for (const Candidate& one : LabelParser(label, table).Candidates()) {
    if (!one.needs_counterpart) readings.push_back(one.reading);
  }
  return readings;
}

std::vector<ReadLabel> ReadLabels(const std::vector<std::string>& labels,
                                  const std::vector<bool>& seen, const LandmarkTable& table) {
  LabelsOfPerson person(labels, seen, table, {});
  const std::vector<std::string> prefix = CommonPrefix(labels);
  if (prefix.empty()) return person.Read();
  LabelsOfPerson shortened(labels, seen, table, prefix);
  return shortened.num_used() > person.num_used() ? shortened.Read() : person.Read();
}

}  // namespace mmm_converter
