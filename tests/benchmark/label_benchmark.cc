// SPDX-License-Identifier: MIT
// Figures of labelling (LabelCases), names taken away, points shuffled in every frame; hard: 30 %
// hidden in blocks of 0.5 s, 5 ghosts a frame:
//   label_benchmark WHAT FIRST_SEED LAST_SEED [RECORDING...]
// WHAT: rows of the table in main, with commas between. Times are of the processor.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/fit/posture_search.h"
#include "common/label/search/body_search.h"
#include "common/label/search/label_body.h"
#include "common/label/track/label_recording.h"
#include "common/label/track/label_tracker.h"
#include "common/math/seeded_random.h"
#include "common/support/error.h"
#include "common/support/parallel.h"
#include "tests/benchmark/label_cases.h"
#include "tests/benchmark/label_counts.h"
#include "tests/support/all_indices.h"
#include "tests/support/unnamed_points.h"

namespace mmm_converter {
namespace {

constexpr int kStarts = 10;          // of each recording
constexpr double kStartRight = 0.9;  // of the points, where a start is right
constexpr double kNear = 0.03;       // [m] of a posture that is known
constexpr int kEventFrames = 400;    // of a recording at most, where events are mended
constexpr std::array<const char*, 5> kEvents = {"pair", "nearest pair", "limb", "renamed", "split"};

double ProcessorSeconds() {
  timespec now = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class Labels {
 public:
  Labels(int first, int last, const std::vector<std::string>& only)
      : first_(first), last_(last), real_(RealCases(only)) {
    const bool is_wanted =
        only.empty() || std::find(only.begin(), only.end(), kMadeCase) != only.end();
    for (int seed = first; is_wanted && seed <= last; ++seed) made_.push_back(MadeCase(seed));
    if (real_.empty() && made_.empty()) throw Error("no such recording");
  }

  using Label = std::function<void(const LabelCase&, const TrackingSetup&,
                                   const testing::UnnamedPoints&, Counts*)>;

  void Names(const Label& label, bool is_calibrated, bool is_hard) const {
    std::map<std::string, std::vector<Counts>> all;
    ForEachCase(
        [&](const LabelCase& one, int seed) {
          testing::UnnamedErrors errors;
          if (is_hard) errors = {0.3, 5};
          testing::UnnamedPoints points = MakeUnnamed(one.recording, errors, seed);
          const std::vector<int> markers = MarkerOfLabel(one);
          for (auto& frame : points.truth) {
            for (int& truth : frame) truth = truth >= 0 && markers[truth] < 0 ? -1 : truth;
          }
          Counts counts;
          counts.frames = one.recording.num_frames();
          const double begin = ProcessorSeconds();
          label(one, is_calibrated ? one.calibrated : one.by_height, points, &counts);
          if (counts.seconds == 0) counts.seconds = ProcessorSeconds() - begin;
          return counts;
        },
        &all);
    PrintCounts(all);
  }

  /// The points of a frame that are seen.
  struct Seen {
    Seen(const testing::UnnamedPoints& made, int k) {
      for (int c = 0; c < made.points.num_labels(); ++c) {
        if (IsSeen(made.points.frame(k).col(c))) {
          columns.push_back(c);
          truth.push_back(made.truth[k][c]);
        }
      }
      points = made.points.frame(k)(Eigen::all, columns);
    }
    void Count(const TrackingSetup& setup, const std::vector<int>& point_of_marker,
               Counts* counts) const {
      std::vector<int> given(truth.size(), -1);
      for (std::size_t m = 0; m < point_of_marker.size(); ++m) {
        if (point_of_marker[m] >= 0) given[point_of_marker[m]] = setup.assignments()[m].label;
      }
      for (std::size_t p = 0; p < given.size(); ++p) counts->Count(truth[p], given[p]);
    }
    std::vector<int> columns, truth;
    Eigen::Matrix3Xd points;
  };

  /// A whole recording.
  static void Offline(const LabelCase& one, const TrackingSetup& setup,
                      const testing::UnnamedPoints& made, Counts* counts) {
    Count(made, LabelRecording({{setup}}, one.recording.labels(), made.points, {}, {}), counts);
  }

  /// The name of each point, by frame and column; -1: none.
  static std::vector<std::vector<int>> GivenNames(const testing::UnnamedPoints& made,
                                                  const Labelling& labelling) {
    std::vector<std::vector<int>> given = made.truth;
    for (auto& frame : given) std::fill(frame.begin(), frame.end(), -1);
    for (const NamedPiece& piece : labelling.pieces) {
      for (int k = piece.begin; k < piece.end; ++k) given[k][piece.point] = piece.name;
    }
    return given;
  }

  static void Count(const testing::UnnamedPoints& made, const Labelling& labelling,
                    Counts* counts) {
    const auto given = GivenNames(made, labelling);
    for (std::size_t k = 0; k < given.size(); ++k) {
      for (std::size_t c = 0; c < given[k].size(); ++c) {
        if (IsSeen(made.points.frame(k).col(c))) counts->Count(made.truth[k][c], given[k][c]);
      }
    }
  }

  /// Frame by frame from the first one on; the time is that of the frames after the start.
  static void Online(const LabelCase& /*one*/, const TrackingSetup& setup,
                     const testing::UnnamedPoints& made, Counts* counts) {
    const LabelBody body(setup);
    LabelTracker tracker(body);
    double begin = 0;
    for (int k = 0; k < made.points.num_frames(); ++k) {
      const Seen seen(made, k);
      if (k == 0) {
        tracker.Start(BodySearch(body).Find(seen.points));
        begin = ProcessorSeconds();
      }
      seen.Count(setup, tracker.Track(seen.points, 1 / made.points.rate()), counts);
    }
    counts->seconds = ProcessorSeconds() - begin;
  }

  /// Single frames: shares of the starts.
  using Find = std::function<BodyMatch(BodySearch*, const Seen&, int k)>;
  static void Starts(const LabelBody& body, const TrackingSetup& setup,
                     const testing::UnnamedPoints& made, const Find& find, Counts* counts) {
    BodySearch search(body);
    counts->frames = 0;
    for (int i = 0; i < kStarts; ++i) {
      const int k = (2 * i + 1) * made.points.num_frames() / (2 * kStarts);
      const Seen seen(made, k);
      Counts own;
      seen.Count(setup, find(&search, seen, k).point_of_marker, &own);
      counts->frames += 1;
      if (own.right >= kStartRight * own.markers()) {
        counts->right += 1;
        continue;
      }
      counts->wrong += 1;
      for (const auto& [labels, count] : own.confusions) counts->confusions[labels] += count;
    }
  }

  static void FromNothing(const LabelCase& /*one*/, const TrackingSetup& setup,
                          const testing::UnnamedPoints& made, Counts* counts) {
    const LabelBody body(setup);
    const auto find = [](BodySearch* search, const Seen& seen, int) {
      return search->Find(seen.points);
    };
    Starts(body, setup, made, find, counts);
  }

  /// From the posture of all labels, those that are hidden too: what a search could find at best.
  static void FromTheLabels(const LabelCase& one, const TrackingSetup& setup,
                            const testing::UnnamedPoints& made, Counts* counts) {
    constexpr int kAttempts = 16;
    const LabelBody body(setup);
    PostureSearch postures(body.kinematics);
    const Eigen::VectorXd scale = Eigen::VectorXd::Ones(body.num_markers());
    const auto find = [&](BodySearch* search, const Seen& seen, int k) {
      const Eigen::Matrix3Xd z =
          one.recording.frame(k)(Eigen::all, LabelIndices(setup.assignments()));
      Posture posture;
      postures.Assemble(z, scale, {}, kAttempts, &posture);
      return search->FindNear(seen.points, posture, kNear);
    };
    Starts(body, setup, made, find, counts);
  }

  /// Two persons and a box, each on its own.
  void Together(bool is_hard) const {
    using OfBodies = std::map<std::string, Counts>;
    std::vector<OfBodies> runs(static_cast<std::size_t>(last_ - first_ + 1));
    ParallelFor(static_cast<int>(runs.size()), 0, [&](int i) {
      const int seed = first_ + i;
      const TogetherCase one = MakeTogether(seed);
      testing::UnnamedErrors errors;
      if (is_hard) errors = {0.3, 5};
      const testing::UnnamedPoints made = MakeUnnamed(one.recording, errors, seed);
      const double begin = ProcessorSeconds();
      const auto given =
          GivenNames(made, LabelRecording(one.scene, one.recording.labels(), made.points, {}, {}));
      const double seconds = ProcessorSeconds() - begin;
      for (std::size_t k = 0; k < given.size(); ++k) {
        for (std::size_t c = 0; c < given[k].size(); ++c) {
          if (!IsSeen(made.points.frame(static_cast<int>(k)).col(static_cast<int>(c)))) continue;
          const int truth = made.truth[k][c];
          const int name = std::max(truth, given[k][c]);
          if (name < 0) continue;
          const std::string& label = one.recording.labels()[truth < 0 ? name : truth];
          runs[i]["body " + label.substr(0, label.find(':'))].Count(truth, given[k][c]);
        }
      }
      for (auto& [body, counts] : runs[i]) {
        counts.frames = one.recording.num_frames();
        counts.seconds = seconds;
      }
    });
    std::map<std::string, std::vector<Counts>> all;
    for (const OfBodies& run : runs) {
      for (const auto& [body, counts] : run) all[body].push_back(counts);
    }
    PrintCounts(all);
  }

  /// Events of a second mended, and labels that are changed without need.
  void Repair() const {
    for (std::size_t e = 0; e < kEvents.size(); ++e) {
      std::map<std::string, std::vector<Counts>> all;
      ForEachCase(
          [&](LabelCase one, int seed) {
            one.recording =
                one.recording.Slice(0, std::min(one.recording.num_frames(), kEventFrames));
            const int second = static_cast<int>(one.recording.rate());
            SeededRandom random(static_cast<std::uint64_t>(seed) + 100 * e);
            const int begin = random.UniformIndex(std::max(one.recording.num_frames() - second, 1));
            return Mended(one,
                          Break(one, static_cast<LabelEvent>(e), begin, random.UniformIndex(1000)));
          },
          &all);
      std::printf("%s\n", kEvents[e]);
      PrintRepair(all);
    }
    std::map<std::string, std::vector<Counts>> all;
    ForEachCase(
        [&](const LabelCase& one, int seed) {
          return Mended(one, Break(one, LabelEvent::kPair, one.recording.num_frames(), seed));
        },
        &all);
    std::printf("none broken\n");
    PrintRepair(all);
  }

 private:
  void ForEachCase(const std::function<Counts(const LabelCase&, int)>& run,
                   std::map<std::string, std::vector<Counts>>* all) const {
    std::vector<std::pair<const LabelCase*, int>> runs;  // with seed
    for (int seed = first_; seed <= last_; ++seed) {
      for (const LabelCase& one : real_) runs.emplace_back(&one, seed);
    }
    for (std::size_t i = 0; i < made_.size(); ++i) {
      runs.emplace_back(&made_[i], first_ + static_cast<int>(i));
    }
    std::vector<Counts> counts(runs.size());
    ParallelFor(static_cast<int>(runs.size()), 0,
                [&](int i) { counts[i] = run(*runs[i].first, runs[i].second); });
    for (std::size_t i = 0; i < runs.size(); ++i) {
      (*all)[runs[i].first->name].push_back(counts[i]);
      PrintConfusions(*runs[i].first, runs[i].second, counts[i]);
    }
  }

  static Counts Mended(const LabelCase& one, const BrokenLabels& broken) {
    LabelOptions options;
    options.stored = testing::AllIndices<LabelIx>(one.recording.labels().size());
    Counts counts;
    counts.frames = one.recording.num_frames();
    const double begin = ProcessorSeconds();
    const Labelling labelling =
        LabelRecording({{one.calibrated}}, one.recording.labels(), broken.recording, options, {});
    counts.seconds = ProcessorSeconds() - begin;
    const std::vector<int> markers = MarkerOfLabel(one);
    for (const NamedPiece& piece : labelling.pieces) {
      for (int k = piece.begin; k < piece.end; ++k) {
        const int own = broken.own[k][piece.point];
        if (own < 0 || markers[own] < 0) continue;
        if (own == piece.point) {
          if (piece.name == own) continue;
          ++counts.changed;
          ++counts.confusions[{own, piece.name}];
        } else {
          counts.Count(own, piece.name);
        }
      }
    }
    return counts;
  }

  static void PrintConfusions(const LabelCase& one, int seed, const Counts& counts) {
    constexpr std::size_t kMost = 6;
    std::vector<std::pair<int, std::string>> lines;
    for (const auto& [labels, count] : counts.confusions) {
      const auto name = [&](int label) {
        return label < 0 ? std::string("nothing") : one.recording.labels()[label];
      };
      lines.emplace_back(count, fmt::format("{} as {}", name(labels.first), name(labels.second)));
    }
    std::sort(lines.rbegin(), lines.rend());
    lines.resize(std::min(lines.size(), kMost));
    for (const auto& [count, line] : lines) {
      std::printf("  %s, %d: %s, %d\n", one.name.c_str(), seed, line.c_str(), count);
    }
  }

  static void PrintRepair(const std::map<std::string, std::vector<Counts>>& all) {
    for (const auto& [name, runs] : all) {
      Counts sum;
      for (const Counts& c : runs) {
        sum.right += c.right;
        sum.wrong += c.wrong + c.left;
        sum.changed += c.changed;
        sum.frames += c.frames;
      }
      std::printf("%-8s mended %.0f of %.0f points; changed without need %.0f in %.0f frames\n",
                  name.c_str(), sum.right, sum.right + sum.wrong, sum.changed, sum.frames);
    }
  }

  int first_;
  int last_;
  std::vector<LabelCase> real_;
  std::vector<LabelCase> made_;  // by seed
};

}  // namespace
}  // namespace mmm_converter

int main(int argc, char** argv) try {
  using mmm_converter::Labels;
  const std::span<char*> args(argv, static_cast<std::size_t>(argc));
  if (argc < 4) throw mmm_converter::Error("WHAT FIRST_SEED LAST_SEED [RECORDING...]");
  const Labels labels(std::stoi(args[2]), std::stoi(args[3]), {args.begin() + 4, args.end()});
  const std::map<std::string, std::function<void()>> table = {
      {"offline", [&] { labels.Names(Labels::Offline, true, false); }},
      {"offline-hard", [&] { labels.Names(Labels::Offline, true, true); }},
      {"offline-height", [&] { labels.Names(Labels::Offline, false, false); }},
      {"offline-height-hard", [&] { labels.Names(Labels::Offline, false, true); }},
      {"online", [&] { labels.Names(Labels::Online, true, false); }},
      {"online-hard", [&] { labels.Names(Labels::Online, true, true); }},
      {"starts", [&] { labels.Names(Labels::FromNothing, true, false); }},
      {"starts-hard", [&] { labels.Names(Labels::FromNothing, true, true); }},
      {"starts-height", [&] { labels.Names(Labels::FromNothing, false, false); }},
      {"starts-height-hard", [&] { labels.Names(Labels::FromNothing, false, true); }},
      {"starts-near", [&] { labels.Names(Labels::FromTheLabels, true, false); }},
      {"starts-near-hard", [&] { labels.Names(Labels::FromTheLabels, true, true); }},
      {"together", [&] { labels.Together(false); }},
      {"together-hard", [&] { labels.Together(true); }},
      {"repair", [&] { labels.Repair(); }}};
  std::stringstream whats(args[1]);
  for (std::string what; std::getline(whats, what, ',');) {
    const auto found = table.find(what);
    if (found == table.end()) {
      std::string message = what + " is none of";
      for (const auto& [name, run] : table) message.append(" ").append(name);
      throw mmm_converter::Error(message);
    }
    std::printf("%s\n", what.c_str());
    found->second();
  }
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "label_benchmark: %s\n", e.what());
  return 1;
}
