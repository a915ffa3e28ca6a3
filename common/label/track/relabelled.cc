// SPDX-License-Identifier: MIT
#include "common/label/track/relabelled.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "common/io/recording/marker_labels.h"

namespace mmm_converter {
namespace {

using Stretches = std::vector<PointStretch>;

bool IsLabel(const std::string& text) { return !text.empty() && !text.starts_with('*'); }

// Of the points that stay without a name.
class Numbers {
 public:
  explicit Numbers(const std::vector<std::string>& labels) : used_(labels.begin(), labels.end()) {}
  std::string Next() {
    std::string text;
    do {
      text = fmt::format("*{}", ++number_);
    } while (!used_.insert(text).second);
    return text;
  }

 private:
  std::set<std::string> used_;
  int number_ = 0;
};

// The labelling's names and the recording's labels, compared as labels are.
class NameTable {
 public:
  NameTable(const Labelling& labelling, const std::vector<std::string>& labels) {
    for (std::size_t i = 0; i < labelling.names.size(); ++i) {
      names_.emplace(NormalizeLabel(labelling.names[i]), static_cast<int>(i));
    }
    own_.reserve(labels.size());
    for (const std::string& label : labels) {
      const auto name = names_.find(NormalizeLabel(label));
      own_.push_back(IsLabel(label) && name != names_.end() ? name->second : -1);
    }
  }
  /// The name that is the label of a point; -1: none.
  int OwnName(int point) const { return own_[static_cast<std::size_t>(point)]; }

 private:
  std::map<std::string, int> names_;
  std::vector<int> own_;
};

std::vector<NamedPiece> InOrder(std::vector<NamedPiece> pieces) {
  std::stable_sort(pieces.begin(), pieces.end(), [](const NamedPiece& a, const NamedPiece& b) {
    return std::pair<int, int>(a.point, a.begin) < std::pair<int, int>(b.point, b.begin);
  });
  return pieces;
}

void Sort(Stretches* stretches) {
  std::sort(stretches->begin(), stretches->end(),
            [](const PointStretch& a, const PointStretch& b) { return a.begin < b.begin; });
}

// Gives an owner the frames of its place that are neither its own nor of a piece.
void TakeUnseenFrames(const Stretches& pieces_of_place, int num_frames, RelabelledPoint* owner) {
  Stretches taken = owner->stretches;
  taken.insert(taken.end(), pieces_of_place.begin(), pieces_of_place.end());
  Sort(&taken);
  int free = 0;
  const auto fill_until = [&](int end) {
    if (free < end) owner->stretches.push_back({free, end, owner->place});
  };
  for (const PointStretch& one : taken) {
    fill_until(one.begin);
    free = std::max(free, one.end);
  }
  fill_until(num_frames);
}

void Join(Stretches* stretches) {
  Sort(stretches);
  Stretches joined;
  for (const PointStretch& one : *stretches) {
    if (!joined.empty() && joined.back().end == one.begin && joined.back().from == one.from) {
      joined.back().end = one.end;
    } else {
      joined.push_back(one);
    }
  }
  *stretches = std::move(joined);
}

// Of each name the point that is called so, else that which gives it most frames; -1: not given.
std::vector<int> PlacesOfNames(const std::vector<NamedPiece>& pieces, const NameTable& table,
                               std::size_t num_names, std::size_t num_points) {
  std::vector<std::map<int, int>> frames(num_names);
  for (const NamedPiece& piece : pieces) {
    if (piece.name >= 0) frames[piece.name][piece.point] += piece.end - piece.begin;
  }
  std::vector<int> places(num_names, -1);
  for (std::size_t n = 0; n < num_names; ++n) {
    const auto most =
        std::max_element(frames[n].begin(), frames[n].end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most != frames[n].end()) places[n] = most->first;
  }
  for (std::size_t p = 0; p < num_points; ++p) {
    const int own = table.OwnName(static_cast<int>(p));
    if (own >= 0 && places[own] >= 0) places[own] = static_cast<int>(p);
  }
  return places;
}

}  // namespace

std::vector<RelabelledPoint> RelabelledPoints(const Labelling& labelling,
                                              const std::vector<std::string>& labels,
                                              int num_frames) {
  const NameTable table(labelling, labels);
  const std::vector<NamedPiece> pieces = InOrder(labelling.pieces);
  const std::vector<int> places =
      PlacesOfNames(pieces, table, labelling.names.size(), labels.size());
  std::vector<Stretches> of_name(labelling.names.size());
  std::vector<Stretches> of_point(labels.size());
  std::vector<Stretches> unnamed(labels.size());
  for (const NamedPiece& piece : pieces) {
    const PointStretch stretch{piece.begin, piece.end, piece.point};
    of_point[piece.point].push_back(stretch);
    (piece.name >= 0 ? of_name[piece.name] : unnamed[piece.point]).push_back(stretch);
  }
  std::vector<std::vector<int>> names_at(labels.size());
  for (std::size_t n = 0; n < places.size(); ++n) {
    if (places[n] >= 0) names_at[places[n]].push_back(static_cast<int>(n));
  }
  Numbers numbers(labels);
  std::vector<RelabelledPoint> points;
  for (std::size_t p = 0; p < labels.size(); ++p) {
    const LabelIx place(static_cast<int>(p));
    const std::size_t first = points.size();
    const int own = table.OwnName(place);
    std::stable_partition(names_at[p].begin(), names_at[p].end(), [&](int n) { return n == own; });
    const bool own_is_free = own < 0 || places[own] < 0;
    if (own_is_free && (IsLabel(labels[p]) || of_point[p].empty())) {
      points.push_back({labels[p], false, place, {}});
      if (own < 0) points.back().stretches = std::exchange(unnamed[p], {});
    }
    for (const int n : names_at[p]) {
      points.push_back({labelling.names[n], true, place, std::move(of_name[n])});
    }
    if (!unnamed[p].empty()) {
      points.push_back({IsLabel(labels[p]) || labels[p].empty() ? numbers.Next() : labels[p], false,
                        place, std::move(unnamed[p])});
    }
    if (points.size() > first) TakeUnseenFrames(of_point[p], num_frames, &points[first]);
  }
  for (RelabelledPoint& point : points) Join(&point.stretches);
  return points;
}

MarkerSequence Relabelled(const std::vector<RelabelledPoint>& points,
                          const MarkerSequence& recording) {
  std::vector<std::string> labels;
  labels.reserve(points.size());
  for (const RelabelledPoint& point : points) labels.push_back(point.label);
  MarkerSequence relabelled(labels, recording.num_frames(), recording.rate(),
                            recording.first_time());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const PointStretch& stretch : points[i].stretches) {
      for (int k = stretch.begin; k < stretch.end; ++k) {
        relabelled.frame(k).col(static_cast<Eigen::Index>(i)) =
            recording.frame(k).col(stretch.from);
      }
    }
  }
  return relabelled;
}

std::vector<LabelChange> ChangesOf(const Labelling& labelling,
                                   const std::vector<std::string>& labels) {
  const NameTable table(labelling, labels);
  std::vector<LabelChange> changes;
  bool goes_on = false;  // the last change may have more pieces
  for (const NamedPiece& piece : InOrder(labelling.pieces)) {
    const int own = table.OwnName(piece.point);
    if (piece.name == own || (piece.name < 0 && own < 0)) {
      goes_on = false;
      continue;
    }
    const std::string to = piece.name < 0 ? "" : labelling.names[piece.name];
    LabelChange* const last = goes_on ? &changes.back() : nullptr;
    if (last != nullptr && last->point == piece.point && last->to == to) {
      last->end = piece.end;
      last->probability = std::min(last->probability, piece.probability);
      continue;
    }
    changes.push_back(
        {piece.point, piece.begin, piece.end, labels[piece.point], to, piece.probability});
    goes_on = true;
  }
  std::stable_sort(changes.begin(), changes.end(),
                   [](const LabelChange& a, const LabelChange& b) { return a.begin < b.begin; });
  return changes;
}

void KeepLabelsOfAllFrames(const std::vector<std::string>& labels,
                           const std::set<std::string>& kept, Labelling* labelling) {
  const NameTable table(*labelling, labels);
  std::set<int> wrong;  // points that never have their own name
  for (const NamedPiece& piece : labelling->pieces) {
    if (table.OwnName(piece.point) >= 0 && kept.contains(labels[piece.point])) {
      wrong.insert(piece.point);
    }
  }
  for (const NamedPiece& piece : labelling->pieces) {
    if (piece.name == table.OwnName(piece.point)) wrong.erase(piece.point);
  }
  for (bool is_settled = false; !is_settled;) {
    is_settled = true;
    for (const NamedPiece& piece : labelling->pieces) {
      if (piece.name < 0 || wrong.contains(piece.point)) continue;
      const auto owner = std::find_if(wrong.begin(), wrong.end(), [&](int point) {
        return table.OwnName(point) == piece.name;
      });
      if (owner == wrong.end()) continue;
      wrong.erase(owner);
      is_settled = false;
    }
  }
  for (NamedPiece& piece : labelling->pieces) {
    if (wrong.contains(piece.point)) piece.name = table.OwnName(piece.point);
  }
}

}  // namespace mmm_converter
