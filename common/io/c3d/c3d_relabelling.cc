// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_relabelling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <memory>
#include <string_view>

#include "common/io/c3d/c3d_file.h"
#include "common/io/c3d/c3d_section_edit.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/text_pieces.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using FileBytes = std::vector<unsigned char>;
using Points = std::vector<C3dRelabelledPoint>;
using Events = std::vector<C3dEvent>;
using Results = std::vector<C3dResult>;

constexpr std::size_t kLongestLabel = 127;  // so that 255 labels fit behind a 16 bit offset

constexpr int kLargestInteger = 32767;

/// How POINT states results of a kind.
struct ResultTerms {
  const char* list;
  const char* units;  // the parameter that states the unit
  const char* unit;   // where it is not there
};

ResultTerms TermsOf(C3dResultKind kind) {
  if (kind == C3dResultKind::kAngle) return {"ANGLES", "ANGLE_UNITS", "deg"};
  if (kind == C3dResultKind::kMoment) return {"MOMENTS", "MOMENT_UNITS", "Nmm/kg"};
  return {"POWERS", "POWER_UNITS", "W/kg"};
}

constexpr std::uint64_t Blocks(std::uint64_t bytes) { return (bytes + kBlock - 1) / kBlock; }

/// The new file but for its frames.
struct Frame {
  std::uint64_t bytes = 0;       // of a frame of the output
  FileBytes before;              // up to the first frame
  std::uint64_t padding = 0;     // zeros behind the last frame
  std::uint64_t rest_begin = 0;  // of the input, what follows
  std::uint64_t rest_bytes = 0;
};

void CheckPoints(const std::string& input, const Points& points) {
  const auto refuse = [&](const std::string& why) {
    throw Error(fmt::format("{}: can't be written with other points: {}", input, why));
  };
  if (points.empty()) refuse("there is none");
  if (points.size() > kFullWord) {
    refuse(fmt::format("{} points; at most {} fit", points.size(), kFullWord));
  }
  for (const C3dRelabelledPoint& point : points) {
    if (point.label.size() > kLongestLabel) {
      refuse(fmt::format("label {} has more than {} bytes", point.label, kLongestLabel));
    }
  }
}

void CheckLayout(const C3dFile& file) {
  const C3dLayout& layout = file.layout();
  const std::uint64_t section = file.section_start();
  if (section < kBlock || layout.data_start < section + file.parameters().end()) {
    throw Error(fmt::format(
        "{}: its points can't be changed: the parameters are not between header and data",
        file.path()));
  }
  if (layout.points == 0 || layout.frames == 0) {
    throw Error(fmt::format("{}: holds no points in any whole frame", file.path()));
  }
}

bool HasNamesInDescriptions(const C3dParameters& parameters) {
  return ToLower(parameters.Text("MANUFACTURER", "COMPANY")).starts_with("motion analysis");
}

/// The stored labels or descriptions of the new points; where nothing is stored and a label is
/// asked for, as C3dPointNames has it.
std::vector<std::string> NewTexts(const C3dFile& file, const Points& points, const Results& results,
                                  const std::vector<std::string>& names, const char* list,
                                  bool are_names) {
  std::vector<std::string> stored = C3dSectionEdit::StoredTexts(file.parameters(), list);
  std::vector<std::string> texts;
  bool is_in_place = points.size() == static_cast<std::size_t>(file.layout().points);
  for (const C3dRelabelledPoint& point : points) {
    const auto like = static_cast<std::size_t>(point.like);
    const bool is_renamed = point.label != names[like];
    is_in_place &= like == texts.size() && !(are_names && is_renamed);
    std::string text = like < stored.size() ? stored[like] : "";
    if (are_names && (is_renamed || Trim(text).empty())) text = point.label;
    texts.push_back(std::move(text));
  }
  if (are_names && !results.empty()) {
    for (const C3dResult& result : results) texts.push_back(result.label);
    return texts;
  }
  if (is_in_place) return stored;
  // Of lists that are longer than the points; of those that are shorter, nothing is added.
  if (points.size() == static_cast<std::size_t>(file.layout().points)) {
    for (std::size_t i = points.size(); i < stored.size(); ++i) texts.push_back(stored[i]);
  }
  while (!are_names && texts.size() > stored.size() && texts.back().empty()) texts.pop_back();
  return texts;
}

// What says in which block something begins that now begins `shift` blocks later.
void MovePointers(const C3dFile& file, std::uint64_t data_shift, std::int64_t rest_shift,
                  unsigned char* header, C3dSectionEdit* section) {
  const C3dLayout& layout = file.layout();
  const auto old_block = static_cast<std::int64_t>(layout.data_start / kBlock + 1);
  const auto new_block = old_block + static_cast<std::int64_t>(data_shift);
  const auto moved = [&](std::int64_t block) {
    if (block == old_block) return new_block;
    return block > old_block ? block + rest_shift : block;
  };
  for (const C3dParameter& parameter : file.parameters().all()) {
    const auto block = parameter.name == "DATA_START" ? parameter.Number(0) : std::nullopt;
    if (!block || !(*block >= 1 && *block <= kFullWord)) continue;
    const bool is_of_points = parameter.group == "POINT" && data_shift > 0;
    const std::int64_t now = is_of_points ? new_block : moved(static_cast<std::int64_t>(*block));
    if (now != static_cast<std::int64_t>(*block)) {
      section->SetNumber(parameter, static_cast<int>(now));
    }
  }
  // The section of labels and ranges, which stands between parameters and data or behind these.
  constexpr int kIsThere = 12345;
  unsigned char* const ranges = header + 2 * (149 - 1);
  const std::int64_t block = C3dWord(ranges, layout.processor);
  if (C3dWord(ranges - 2, layout.processor) != kIsThere) return;
  const bool is_before_data =
      block < old_block && block * kBlock > file.section_start() + file.parameters().end();
  StoreC3dWord(static_cast<int>(is_before_data ? block + static_cast<std::int64_t>(data_shift)
                                               : moved(block)),
               layout.processor, ranges);
}

// Sizes and places behind the first frame.
void LayOutRest(const C3dFile& file, std::size_t num_points, Frame* frame) {
  const C3dLayout& layout = file.layout();
  const std::uint64_t old_bytes = layout.frame_bytes * layout.frames;
  const std::uint64_t new_bytes = frame->bytes * layout.frames;
  if (num_points == static_cast<std::size_t>(layout.points)) {
    frame->rest_begin = layout.data_start + old_bytes;
    frame->rest_bytes = file.data_bytes() - old_bytes;
    return;
  }
  const std::uint64_t padded = Blocks(old_bytes) * kBlock;
  // A part of a frame, or a file that ends with its last frame, is followed by nothing.
  if (layout.declared_frames > layout.frames || file.data_bytes() < padded) return;
  frame->padding = Blocks(new_bytes) * kBlock - new_bytes;
  frame->rest_begin = layout.data_start + padded;
  frame->rest_bytes = file.data_bytes() - padded;
}

/// What the file's unit of results is for theirs, by what it states.
double UnitOf(const C3dParameters& parameters, C3dResultKind kind) {
  const std::string unit = ToLower(parameters.Text("POINT", TermsOf(kind).units));
  if (kind == C3dResultKind::kAngle) return unit.starts_with("rad") ? 1 / kDegrees : 1;
  const bool is_of_thousandths =
      kind == C3dResultKind::kMoment ? unit.find("mm") != unit.npos : unit.starts_with("mw");
  return is_of_thousandths || (unit.empty() && kind == C3dResultKind::kMoment) ? kMillimetres : 1;
}

/// As the file lists and states results.
void ListResults(const C3dParameters& parameters, const Results& results, C3dSectionEdit* section) {
  for (const C3dResultKind kind :
       {C3dResultKind::kAngle, C3dResultKind::kMoment, C3dResultKind::kPower}) {
    const ResultTerms terms = TermsOf(kind);
    std::vector<std::string> texts = C3dSectionEdit::StoredTexts(parameters, terms.list);
    while (!texts.empty() && Trim(texts.back()).empty()) texts.pop_back();
    const std::size_t before = texts.size();
    for (const C3dResult& result : results) {
      if (result.kind == kind) texts.push_back(result.label);
    }
    if (texts.size() == before) continue;
    section->SetPointTexts(terms.list, texts);
    if (parameters.Text("POINT", terms.units).empty()) {
      section->SetPointTexts(terms.units, {terms.unit});
    }
  }
}

FileBytes BytesBeforeFrames(C3dFile* file, const Points& points, const Results& results,
                            const Events* events, Frame* frame) {
  const C3dLayout& layout = file->layout();
  const C3dParameters& parameters = file->parameters();
  const std::uint64_t section_start = file->section_start();
  FileBytes before = file->ReadBytes(0, section_start);
  unsigned char* const header = before.data();
  FileBytes old_section = file->ReadBytes(section_start, layout.data_start - section_start);
  const int stated_blocks = old_section[2];
  C3dSectionEdit section(std::move(old_section), parameters, file->path());
  const std::vector<std::string> names = C3dPointNames(*file, nullptr);
  section.SetPointTexts("LABELS", NewTexts(*file, points, results, names, "LABELS", true));
  if (parameters.Find("POINT", "DESCRIPTIONS") != nullptr) {
    section.SetPointTexts("DESCRIPTIONS", NewTexts(*file, points, results, names, "DESCRIPTIONS",
                                                   HasNamesInDescriptions(parameters)));
  }
  ListResults(parameters, results, &section);
  if (events != nullptr) section.SetEvents(*events);
  const std::size_t all_points = points.size() + results.size();
  if (all_points != static_cast<std::size_t>(layout.points)) {
    const int count = static_cast<int>(all_points);
    StoreC3dWord(count, layout.processor, header + 2 * (2 - 1));
    const C3dParameter* const used = parameters.Find("POINT", "USED");
    if (used != nullptr) section.SetNumber(*used, count);
  }
  const auto data_blocks = [&](std::uint64_t frame_bytes) {
    return static_cast<std::int64_t>(Blocks(frame_bytes * layout.frames));
  };
  // A header that contradicts the data can't be left so where what it was judged by changes.
  const bool header_is_wrong = C3dDataStartOfHeader(file->header(), section_start, stated_blocks,
                                                    layout.data_start + file->data_bytes()) == 0;
  if (header_is_wrong && section.HasNewTexts()) section.StateSize();
  const std::uint64_t data_shift = section.MoreBlocks();
  if (data_shift > 0 || (header_is_wrong && section.HasNewTexts())) {
    StoreC3dWord(static_cast<int>(layout.data_start / kBlock + 1 + data_shift), layout.processor,
                 header + 2 * (9 - 1));
  }
  MovePointers(*file, data_shift,
               static_cast<std::int64_t>(data_shift) + data_blocks(frame->bytes) -
                   data_blocks(layout.frame_bytes),
               header, &section);
  const FileBytes changed = section.Finish();
  before.insert(before.end(), changed.begin(), changed.end());
  return before;
}

/// Makes frames of the output from those of the input, which must come in their order.
class FrameMaker {
 public:
  FrameMaker(const C3dFile& file, const Points& points, const Results& results)
      : layout_(file.layout()), points_(points), results_(results), next_(points.size(), 0) {
    for (const C3dResult& result : results) {
      units_.push_back(UnitOf(file.parameters(), result.kind));
    }
    if (layout_.floats) {
      StoreC3dFloat(-1, layout_.processor, &unseen_[12]);
    } else {
      StoreC3dWord(-1, layout_.processor, &unseen_[6]);
    }
  }

  void Append(int frame, const unsigned char* stored, std::string* out) {
    const std::size_t point_bytes = layout_.floats ? 16 : 8;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const std::vector<C3dStretch>& stretches = points_[i].stretches;
      std::size_t& next = next_[i];
      while (next < stretches.size() && stretches[next].end <= frame) ++next;
      const bool is_there = next < stretches.size() && stretches[next].begin <= frame;
      const unsigned char* const from =
          is_there ? stored + point_bytes * static_cast<std::size_t>(stretches[next].point)
                   : unseen_;
      out->append(reinterpret_cast<const char*>(from), point_bytes);
    }
    for (std::size_t i = 0; i < results_.size(); ++i) AppendResult(i, frame, out);
    const std::uint64_t of_points = point_bytes * static_cast<std::uint64_t>(layout_.points);
    out->append(reinterpret_cast<const char*>(stored + of_points), layout_.frame_bytes - of_points);
  }

 private:
  void AppendResult(std::size_t i, int frame, std::string* out) const {
    const C3dResult& result = results_[i];
    const Eigen::Index column = frame - result.first_frame;
    unsigned char point[16];
    std::copy(std::begin(unseen_), std::end(unseen_), point);
    if (column >= 0 && column < result.values.cols() && result.values.col(column).allFinite()) {
      const Eigen::Vector3d value = units_[i] * result.values.col(column);
      for (int j = 0; j < 3; ++j) {
        if (layout_.floats) {
          StoreC3dFloat(static_cast<float>(value[j]), layout_.processor, &point[4 * j]);
        } else {
          StoreC3dWord(static_cast<int>(std::lround(value[j] / layout_.scale)), layout_.processor,
                       &point[2 * j]);
        }
      }
      std::fill_n(&point[layout_.floats ? 12 : 6], layout_.floats ? 4 : 2, 0);
    }
    out->append(reinterpret_cast<const char*>(point), layout_.floats ? 16 : 8);
  }

  const C3dLayout& layout_;
  const Points& points_;
  const Results& results_;
  std::vector<double> units_;      // of each result
  std::vector<std::size_t> next_;  // stretch of each point
  unsigned char unseen_[16] = {};
};

void CopyRest(C3dFile* file, const Frame& frame, PieceWriter* pieces) {
  for (std::uint64_t done = 0; done < frame.rest_bytes;) {
    const std::uint64_t count = std::min(kBufferBytes, frame.rest_bytes - done);
    const FileBytes bytes = file->ReadBytes(frame.rest_begin + done, count);
    pieces->text()->append(bytes.begin(), bytes.end());
    pieces->EndPart();
    done += count;
  }
}

void WriteFrames(C3dFile* file, const Points& points, const Results& results, PieceWriter* pieces) {
  const C3dLayout& layout = file->layout();
  FrameMaker maker(*file, points, results);
  file->ReadAllFrames([&](int first, int count, const unsigned char* stored) {
    for (int i = 0; i < count; ++i) {
      maker.Append(first + i, stored + layout.frame_bytes * static_cast<std::uint64_t>(i),
                   pieces->text());
      pieces->EndPart();
    }
  });
}

/// events: null: as they are.
Frame LayOut(C3dFile* file, const Points& points, const Results& results, const Events* events) {
  CheckLayout(*file);
  const C3dLayout& layout = file->layout();
  Frame frame;
  const std::size_t all_points = points.size() + results.size();
  const std::int64_t more = static_cast<std::int64_t>(all_points) - layout.points;
  frame.bytes = layout.frame_bytes + static_cast<std::uint64_t>(more * (layout.floats ? 16 : 8));
  LayOutRest(*file, all_points, &frame);
  frame.before = BytesBeforeFrames(file, points, results, events, &frame);
  return frame;
}

void WriteChanged(C3dFile* file, const Points& points, const Results& results, const Events* events,
                  const std::string& output) {
  const Frame frame = LayOut(file, points, results, events);
  WriteFileAtomically(output, [&](const TextSink& sink) {
    PieceWriter pieces(sink);
    pieces.text()->append(file->leading_zeros(), '\0');
    pieces.text()->append(frame.before.begin(), frame.before.end());
    WriteFrames(file, points, results, &pieces);
    pieces.text()->append(frame.padding, '\0');
    CopyRest(file, frame, &pieces);
    pieces.Flush();
  });
}

Points AllPoints(const C3dFile& file) {
  const std::vector<std::string> names = C3dPointNames(file, nullptr);
  Points points;
  for (int i = 0; i < file.layout().points; ++i) {
    points.push_back(
        {names[static_cast<std::size_t>(i)], i, {{0, static_cast<int>(file.layout().frames), i}}});
  }
  return points;
}

/// What the file's words hold of a result, in its own unit.
double MostOf(const C3dFile& file, const C3dResult& result) {
  if (file.layout().floats) return std::numeric_limits<double>::infinity();
  return kLargestInteger * file.layout().scale / UnitOf(file.parameters(), result.kind);
}

void CheckResults(const C3dFile& file, const Results& results) {
  const C3dLayout& layout = file.layout();
  CheckLayout(file);
  if (layout.points + results.size() > kFullWord) {
    throw Error(fmt::format("{}: {} points and {} results; at most {} fit", file.path(),
                            layout.points, results.size(), kFullWord));
  }
  for (const C3dResult& result : results) {
    const double most = MostOf(file, result);
    if (!(result.values.cwiseAbs().array() > most).any()) continue;
    throw Error(fmt::format("{}: {} is beyond the {:.3g} that the file's 16 bit integers hold",
                            file.path(), result.label, most));
  }
}

Results WithFreeLabels(const C3dFile& file, Results results) {
  const std::vector<std::string> taken = C3dPointNames(file, nullptr);
  for (C3dResult& result : results) {
    while (std::find(taken.begin(), taken.end(), result.label) != taken.end()) {
      result.label += "_MMM";
    }
  }
  return results;
}

}  // namespace

void WriteRelabelledC3d(const std::string& input, const Points& points, const std::string& output) {
  CheckPoints(input, points);
  C3dFile file(input);
  WriteChanged(&file, points, {}, nullptr, output);
}

void WriteC3dWithEvents(const std::string& input, const Events& events, const std::string& output) {
  C3dFile file(input);
  WriteChanged(&file, AllPoints(file), {}, &events, output);
}

void WriteC3dWithResults(const std::string& input, const Results& results, const Events& events,
                         const std::string& output) {
  C3dFile file(input);
  CheckResults(file, results);
  WriteChanged(&file, AllPoints(file), WithFreeLabels(file, results), &events, output);
}

std::vector<std::string> HideUnstorable(const C3dFile& file, Results* results) {
  std::vector<std::string> hidden;
  for (C3dResult& result : *results) {
    const double most = MostOf(file, result);
    int frames = 0;
    for (auto value : result.values.colwise()) {
      if (!(value.cwiseAbs().array() > most).any()) continue;
      value.setConstant(std::numeric_limits<double>::quiet_NaN());
      ++frames;
    }
    if (frames == 0) continue;
    hidden.push_back(fmt::format("{} in {} frame{}", result.label, frames, frames == 1 ? "" : "s"));
  }
  return hidden;
}

void CheckC3dResults(const std::string& input, const Results& results, const Events& events) {
  C3dFile file(input);
  CheckResults(file, results);
  LayOut(&file, AllPoints(file), WithFreeLabels(file, results), &events);
}

}  // namespace mmm_converter
