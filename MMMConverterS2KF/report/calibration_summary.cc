// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/calibration_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/conversion_summary.h"
#include "MMMConverterS2KF/report/subject_json.h"
#include "common/calibrate/joint_doubts.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kChanged = 0.01;                  // of a scale, to be told
constexpr double kUndetermined = 0.5;              // observability: more is assumed than measured
constexpr std::size_t kNamesShown = 6;             // in a line
constexpr std::size_t kCalibrationLineStart = 11;  // width of a line's name

struct Named {
  double size = 0;  ///< what the list is sorted by
  std::string text;
};

// The largest first, and how many more there are.
std::string JoinLargest(std::vector<Named> items, const char* none) {
  if (items.empty()) return none;
  std::stable_sort(items.begin(), items.end(),
                   [](const Named& a, const Named& b) { return a.size > b.size; });
  std::vector<std::string> texts;
  texts.reserve(kNamesShown + 1);
  for (std::size_t i = 0; i < std::min(items.size(), kNamesShown); ++i) {
    texts.push_back(items[i].text);
  }
  if (items.size() > kNamesShown) {
    texts.push_back(fmt::format("{} more", items.size() - kNamesShown));
  }
  return JoinNames(texts, ", ");
}

bool IsUndetermined(double deviation, double prior) {
  return prior > 0 && Observability(deviation, prior) < kUndetermined;
}

std::string ChangedSegments(const Subject& subject) {
  std::vector<Named> changed;
  for (const SegmentScale& scale : subject.scales) {
    const double change = scale.scale - 1;
    if (std::abs(change) < kChanged) continue;
    changed.push_back(
        {std::abs(change), fmt::format("{} {:+.1f} ± {:.1f} %", scale.segment, kPercent * change,
                                       kPercent * scale.standard_deviation)});
  }
  return JoinLargest(std::move(changed), "none by more than 1 %");
}

std::string LargestOffsets(const Subject& subject) {
  std::vector<Named> moved;
  moved.reserve(subject.offsets.size());
  for (const MarkerOffset& offset : subject.offsets) {
    const double distance = offset.offset.norm();
    moved.push_back(
        {distance, fmt::format("{} {:.0f} ± {:.0f} mm", offset.marker, kMillimetres * distance,
                               kMillimetres * Deviation(offset))});
  }
  return JoinLargest(std::move(moved), "none");
}

std::string UndeterminedNames(const Subject& subject) {
  std::vector<Named> names;
  for (const SegmentScale& scale : subject.scales) {
    if (!IsUndetermined(scale.standard_deviation, scale.prior_deviation)) continue;
    names.push_back({scale.standard_deviation / scale.prior_deviation, scale.segment});
  }
  for (const MarkerOffset& offset : subject.offsets) {
    if (!IsUndetermined(Deviation(offset), offset.prior_deviation)) continue;
    names.push_back({Deviation(offset) / offset.prior_deviation, offset.marker});
  }
  return JoinLargest(std::move(names), "nothing");
}

std::string CalibrationLine(const std::string& name, const std::string& text) {
  return fmt::format("{:<{}}{}\n", name, kCalibrationLineStart, text);
}

// Nothing, or a line.
std::string DoubtsLine(const Subject& subject) {
  std::vector<std::string> texts = DescribeDoubts(subject.joints);
  if (texts.empty()) return "";
  if (texts.size() > kNamesShown) {
    const std::size_t more = texts.size() - kNamesShown;
    texts.resize(kNamesShown);
    texts.push_back(fmt::format("{} more", more));
  }
  return CalibrationLine("not apart", JoinNames(texts, "; ") +
                                          ": angles may be off by that in all "
                                          "frames; more movement tells them apart");
}

double MeanOffset(const Subject& subject) {
  double sum = 0;
  for (const MarkerOffset& offset : subject.offsets) sum += offset.offset.norm();
  return subject.offsets.empty() ? 0 : sum / static_cast<double>(subject.offsets.size());
}

}  // namespace

std::string FormatSubjectSummary(const Subject& subject) {
  return CalibrationLine("segments", ChangedSegments(subject)) +
         CalibrationLine("offsets",
                         fmt::format("mean {:.1f} mm; largest: {}",
                                     kMillimetres * MeanOffset(subject), LargestOffsets(subject))) +
         CalibrationLine("unknown", UndeterminedNames(subject) +
                                        " (half or more of it is what was assumed beforehand)") +
         DoubtsLine(subject);
}

std::string FormatTakenFrames(const std::vector<CalibrationInput>& recordings,
                              const Subject& subject) {
  std::string text;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const CalibrationInput& one = recordings[r];
    text += CalibrationLine(
        "recording",
        fmt::format("{}: {} of {} frames taken, {} markers{}", one.input.recording.file,
                    subject.sources[r].frames, one.input.recording.markers.num_frames(),
                    one.setup.assignments().size(),
                    one.setup.marker_set.empty() ? "" : ", marker set " + one.setup.marker_set));
  }
  return text;
}

std::string FormatCalibrationSummary(const CalibrationReport& report, const std::string& file) {
  const CalibrationResult& result = report.result;
  std::string text = FormatTakenFrames(report.recordings, result.subject);
  text += CalibrationLine("person",
                          fmt::format("\"{}\", {:.3g} m ({}), {:.4g} kg ({})", result.subject.name,
                                      report.person.height.value, report.person.height.source,
                                      report.person.mass.value, report.person.mass.source));
  text += CalibrationLine("model", report.recordings.front().input.model_file);
  text += CalibrationLine(
      "distance",
      fmt::format("mean {:.1f} mm before, {:.1f} after, over {} frames; {} iterations",
                  kMillimetres * result.distance_before, kMillimetres * result.distance_after,
                  result.frames, result.iterations));
  text += FormatSubjectSummary(result.subject);
  return text +
         fmt::format(
             "{} has the person: with it, the best postures leave {:.1f} mm to the markers "
             "where the scaled model leaves {:.1f}.\n",
             file, kMillimetres * result.distance_after, kMillimetres * result.distance_before) +
         FormatVerdict(report.verdict);
}

Json ToJson(const CalibrationReport& report, const std::string& file) {
  const CalibrationResult& result = report.result;
  Json recordings = Json::array();
  for (const CalibrationInput& one : report.recordings) {
    recordings.push_back({{"file", one.input.recording.file},
                          {"frames", one.input.recording.markers.num_frames()},
                          {"first_frame", one.input.first_frame},
                          {"markers", one.setup.assignments().size()},
                          {"marker_set", one.setup.marker_set},
                          {"ignored", one.setup.mapping.ignored_labels},
                          {"absent", one.setup.mapping.absent_markers}});
  }
  return {{"program", SubjectProgram()},
          {"output", file},
          {"recordings", recordings},
          {"model", report.recordings.front().input.model_file},
          {"height_source", report.person.height.source},
          {"mass_source", report.person.mass.source},
          {"calibration", ToJson(result)},
          {"subject", ToJson(result.subject)},
          {"verdict", ToJson(report.verdict)},
          {"warnings", report.warnings.texts()}};
}

Json ToJson(const CalibrationResult& result) {
  return {{"frames", result.frames},
          {"iterations", result.iterations},
          {"distance_before_mm", kMillimetres * result.distance_before},
          {"distance_after_mm", kMillimetres * result.distance_after}};
}

}  // namespace mmm_converter
