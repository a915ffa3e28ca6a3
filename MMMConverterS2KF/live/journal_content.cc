// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "MMMConverterS2KF/live/journal_lines.h"
#include "MMMConverterS2KF/report/json.h"
#include "common/convert/live_tracker.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr const char* kKind = "MMMConverterS2KF live 1";
constexpr double kAssumedRate = 100;  // [Hz] of a source that states none, in one frame
// Numbers that a motion may take in memory: several times what the journal has, and so many more.
constexpr double kNumbersPerByte = 4;
constexpr double kMoreNumbers = 2e7;
constexpr double kFarthest = 1e6;  // of the root [m]; beyond is damage
constexpr double kBridgedSeconds = 0.1;

// Numbers of a line, one after the other.
class LineNumbers {
 public:
  explicit LineNumbers(std::string_view line) : rest_(line) {}

  double Next() {
    while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
    double value = 0;
    const auto [end, failure] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (failure != std::errc()) is_whole_ = false;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }
  template <typename Vector>
  void Fill(Vector&& values) {
    for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = Next();
  }
  int NextInt() { return static_cast<int>(std::clamp(Next(), -1e9, 1e9)); }
  bool is_at_end() const { return is_whole_ && rest_.empty(); }

 private:
  std::string_view rest_;
  bool is_whole_ = true;
};

struct JournalFrame {
  std::int64_t number = 0;
  double time = 0;
  bool is_tracking = false;
  FrameDiagnostic diagnostic;
  Posture posture;
  Eigen::VectorXd deviations, residuals, verdicts;
  Eigen::VectorXd points;
};

// Sizes are those of the header; the number of assignments is told by the line's length.
bool ParseFrame(std::string_view line, const JournalHeader& header, JournalFrame* frame) {
  LineNumbers numbers(line);
  const auto joints = static_cast<Eigen::Index>(header.joints.size());
  const auto labels = static_cast<Eigen::Index>(header.labels.size());
  frame->number = static_cast<std::int64_t>(numbers.Next());
  frame->time = numbers.Next();
  frame->is_tracking = numbers.NextInt() != 0;
  if (frame->is_tracking) {
    const auto all = std::count(line.begin(), line.end(), ' ') + 1;
    const auto assignments = (all - (3 + 7 + 7 + joints + 6 + joints + 3 * labels)) / 2;
    if (assignments < 0) return false;
    FrameDiagnostic& diagnostic = frame->diagnostic;
    diagnostic.markers_seen = numbers.NextInt();
    diagnostic.markers_downweighted = numbers.NextInt();
    diagnostic.markers_wrong = numbers.NextInt();
    diagnostic.nis = numbers.Next();
    diagnostic.reassembled = numbers.NextInt() != 0;
    diagnostic.converged = numbers.NextInt() != 0;
    diagnostic.seconds = numbers.Next();
    numbers.Fill(frame->posture.position);
    numbers.Fill(frame->posture.orientation.coeffs());
    frame->posture.joint_angles.resize(joints);
    numbers.Fill(frame->posture.joint_angles);
    frame->deviations.resize(6 + joints);
    numbers.Fill(frame->deviations);
    frame->residuals.resize(assignments);
    numbers.Fill(frame->residuals);
    frame->verdicts.resize(assignments);
    numbers.Fill(frame->verdicts);
  }
  frame->points.resize(3 * labels);
  numbers.Fill(frame->points);
  return numbers.is_at_end() && std::isfinite(frame->time) &&
         frame->posture.position.cwiseAbs().maxCoeff() < kFarthest &&
         frame->posture.orientation.coeffs().allFinite() && frame->posture.joint_angles.allFinite();
}

JournalHeader ParseHeader(std::string_view line, const std::string& file) {
  JournalHeader header;
  try {
    const Json json = ParseJson(line);
    if (json.at("journal") != kKind) {
      throw Error(fmt::format("its first line names another kind"));
    }
    header.output = json.at("output");
    header.format = json.at("format");
    MmmMotionOutput& motion = header.motion;
    motion.recording_name = json.at("recording");
    motion.motion_name = json.at("motion");
    motion.model_path = json.at("model");
    motion.height = json.at("height");
    motion.mass = json.at("mass");
    if (json.contains("hand_length")) motion.hand_length = json.at("hand_length").get<double>();
    motion.comment = json.at("comment");
    header.rate = json.at("rate");
    header.labels = json.at("labels").get<std::vector<std::string>>();
    header.joints = json.at("joints").get<std::vector<std::string>>();
  } catch (const std::exception& problem) {  // ParseJson's, and what json says of a missing member
    throw Error(
        fmt::format("{}: is no journal of a live motion of this version of the program, which "
                    "it keeps there until the motion is written; move it away ({})",
                    file, problem.what()));
  }
  return header;
}

// Where on the grid each frame is. Where the source's time ran back or stood, frames follow each
// other.
std::vector<double> GridOf(const std::vector<JournalFrame>& frames, double rate) {
  std::vector<double> grid;
  double shift = frames.front().time;
  for (const JournalFrame& frame : frames) {
    double index = std::round((frame.time - shift) * rate);
    if (!grid.empty() && index <= grid.back()) {
      index = grid.back() + 1;
      if (frame.time <= frames[grid.size() - 1].time) shift = frame.time - index / rate;
    }
    grid.push_back(index);
  }
  return grid;
}

// Of frames that share a place on the coarser grid the first with a posture stays. Returns the
// places.
std::vector<int> KeepOneOf(int step, const std::vector<double>& grid,
                           std::vector<JournalFrame>* frames) {
  std::vector<int> places;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const int place = static_cast<int>(grid[i] / step);
    JournalFrame& frame = (*frames)[i];
    if (places.empty() || place != places.back()) {
      places.push_back(place);
    } else if (!frame.is_tracking || (*frames)[places.size() - 1].is_tracking) {
      continue;
    }
    if (places.size() <= i) (*frames)[places.size() - 1] = std::move(frame);
  }
  frames->resize(places.size());
  return places;
}

double MedianRate(const std::vector<JournalFrame>& frames) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (frames[i].time > frames[i - 1].time) steps.push_back(frames[i].time - frames[i - 1].time);
  }
  if (steps.empty()) return kAssumedRate;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return std::clamp(1 / *middle, kLowestRate, kHighestRate);
}

// Postures of frames from `begin` to `end`, both of which have one.
void Interpolate(int begin, int end, PoseTrajectory* trajectory) {
  const Posture& first = trajectory->postures[begin];
  const Eigen::VectorXd way = Local(first, trajectory->postures[end]);
  for (int k = begin + 1; k < end; ++k) {
    trajectory->postures[k] = Retract(first, way * (double(k - begin) / (end - begin)));
  }
}

// Before the first posture, what is not of the same time.
void DropStray(std::vector<JournalFrame>* frames) {
  auto begin = std::find_if(frames->begin(), frames->end(),
                            [](const JournalFrame& one) { return one.is_tracking; });
  while (begin != frames->begin() && begin != frames->end() &&
         begin->time - std::prev(begin)->time <= kLongestGap) {
    --begin;
  }
  frames->erase(frames->begin(), begin);
}

void FillResult(const std::vector<JournalFrame>& frames, const std::vector<int>& grid,
                JournalContent* content) {
  const auto first = std::find_if(frames.begin(), frames.end(),
                                  [](const JournalFrame& one) { return one.is_tracking; });
  content->first_tracked = grid[static_cast<std::size_t>(first - frames.begin())];
  const int count = grid.back() + 1;
  const auto assignments = first->residuals.size();
  ConversionResult& result = content->result;
  PoseTrajectory& trajectory = result.trajectory;
  trajectory.joint_names = content->header.joints;
  trajectory.postures.resize(static_cast<std::size_t>(count));
  trajectory.standard_deviations.setConstant(first->deviations.size(), count, kNaN);
  result.residuals.setConstant(assignments, count, kNaN);
  result.frames.resize(static_cast<std::size_t>(count));
  Eigen::MatrixXi& verdicts = content->verdicts;
  verdicts.setConstant(assignments, count, kAsLabelled);
  int last = -1;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const int k = grid[i];
    const JournalFrame& frame = frames[i];
    content->markers.frame(k) =
        Eigen::Map<const Eigen::Matrix3Xd>(frame.points.data(), 3, frame.points.size() / 3);
    if (!frame.is_tracking) continue;
    trajectory.postures[k] = frame.posture;
    if (last >= 0) Interpolate(last, k, &trajectory);
    last = k;
    trajectory.standard_deviations.col(k) = frame.deviations;
    if (frame.residuals.size() == assignments) {
      result.residuals.col(k) = frame.residuals;
      verdicts.col(k) = frame.verdicts.cwiseMax(kAsLabelled).cwiseMin(assignments).cast<int>();
    }
    result.frames[k] = frame.diagnostic;
  }
  for (int k = 0; k < content->first_tracked; ++k) {
    trajectory.postures[k] = first->posture;
    trajectory.standard_deviations.col(k) = first->deviations;
  }
  result.incidents =
      FindIncidents(verdicts, static_cast<int>(std::lround(kBridgedSeconds * trajectory.rate)));
}

// A journal without a whole line is one of a process that was killed in its first: a part of a
// header.
void CheckHasBegun(const std::string& file) {
  const std::string begin = fmt::format(R"({{"journal":"{}")", kKind);
  if (begin.starts_with(FirstBytes(file, begin.size()))) return;
  throw Error(
      fmt::format("{}: is no journal of a live motion, which the program keeps there until the "
                  "motion is written; move it away",
                  file));
}

std::string FreeName(const std::filesystem::path& output) {
  // It is written without its model, as MMM's.
  const std::string ending = output.extension() == ".mot" || output.extension() == ".sto"
                                 ? ".xml"
                                 : output.extension().string();
  for (int i = 1;; ++i) {
    const auto name =
        output.parent_path() / fmt::format("{}_recovered{}{}", output.stem().string(),
                                           i == 1 ? "" : fmt::format("_{}", i), ending);
    if (!std::filesystem::exists(name)) return name.string();
  }
}

}  // namespace

std::string FormatJournalHeader(const JournalHeader& header) {
  const MmmMotionOutput& motion = header.motion;
  Json json = {{"journal", kKind},
               {"output", header.output},
               {"format", header.format},
               {"recording", motion.recording_name},
               {"motion", motion.motion_name},
               {"model", motion.model_path},
               {"height", motion.height},
               {"mass", motion.mass},
               {"comment", motion.comment},
               {"rate", header.rate},
               {"labels", header.labels},
               {"joints", header.joints}};
  if (motion.hand_length) json["hand_length"] = *motion.hand_length;
  return FormatJsonLine(json);
}

JournalContent ReadJournal(const std::string& file, Warnings* warnings) {
  JournalContent content;
  std::vector<JournalFrame> frames;
  bool has_header = false;
  ForEachLine(file, [&](std::string_view line) {
    if (!has_header || line.starts_with('{')) {
      JournalHeader header = ParseHeader(line, file);
      const bool is_same =
          header.labels == content.header.labels && header.joints == content.header.joints;
      if (!has_header || is_same) content.header = std::move(header);
      has_header = true;
      return;
    }
    JournalFrame frame;
    if (!ParseFrame(line, content.header, &frame)) return;
    frames.push_back(std::move(frame));
  });
  while (!frames.empty() && !frames.back().is_tracking) frames.pop_back();
  DropStray(&frames);
  if (frames.empty()) return content;
  content.frames = static_cast<int>(frames.size());
  double rate = IsFrameRate(content.header.rate) ? content.header.rate : MedianRate(frames);
  const JournalFrame& last = frames.back();
  const double numbers_per_frame =
      static_cast<double>(last.points.size() + 7 + last.posture.joint_angles.size() +
                          last.deviations.size() + 2 * last.residuals.size());
  const double numbers =
      kMoreNumbers + kNumbersPerByte * static_cast<double>(std::filesystem::file_size(file));
  const double most_frames = std::floor(numbers / numbers_per_frame);
  const std::vector<double> grid = GridOf(frames, rate);
  const double step = std::ceil((grid.back() + 1) / most_frames);
  if (!IsFrameRate(rate / step)) {
    throw Error(
        fmt::format("{}: reaches over {:.6g} frames of {:g} Hz, which a journal of its size can't "
                    "fill; move it away",
                    file, grid.back() + 1, rate));
  }
  if (step > 1) {
    rate /= step;
    warnings->Add(
        fmt::format("{} frames came of {:.6g}: the motion has {:.4g} Hz, 1/{:g} of the "
                    "source's rate",
                    frames.size(), grid.back() + 1, rate, step));
  }
  const std::vector<int> places = KeepOneOf(static_cast<int>(step), grid, &frames);
  content.first_number = frames.front().number;
  content.markers =
      MarkerSequence(content.header.labels, places.back() + 1, rate, frames.front().time);
  content.result.trajectory.rate = rate;
  content.result.trajectory.first_time = frames.front().time;
  FillResult(frames, places, &content);
  return content;
}

std::string RecoverMotion(const std::string& output, Warnings* warnings) {
  const std::string journal = JournalOf(output);
  if (!std::filesystem::exists(journal)) return "";
  JournalContent content;
  {
    const LineFile only_one(journal);  // no process is writing to it
    content = ReadJournal(journal, warnings);
    if (content.frames == 0) CheckHasBegun(journal);
  }
  std::string written;
  if (content.frames > 0) {
    const JournalHeader& header = content.header;
    MmmMotionOutput motion = header.motion;
    motion.trajectory = &content.result.trajectory;
    if (!header.labels.empty()) motion.markers = &content.markers;
    written = FreeName(output);
    WriteFileAtomically(
        written, header.format == "1.0" ? FormatMmmMotion1(motion) : FormatMmmMotion2(motion));
  }
  std::filesystem::remove(journal);
  return written;
}

}  // namespace mmm_converter
