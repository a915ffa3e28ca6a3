// SPDX-License-Identifier: MIT
#include "common/io/bvh/bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "common/io/bytes/file_content.h"
#include "common/io/skeleton/skeleton_content.h"
#include "common/io/tables/table_text.h"
#include "common/math/statistics.h"
#include "common/motion/marker_sequence.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMostJoints = 10000;
constexpr int kMostChannels = 9;  // of a joint: no file at hand has more than 6
constexpr std::size_t kLongestName = 200;
constexpr double kLargest = 1e9;  // of a number that means anything
// Points of joints that have hardly any channels would take far more memory than the file.
constexpr int kMostJointsPerChannel = 8;

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f'; }

/// Words of a BVH file, and the line that each is in.
class BvhWords {
 public:
  BvhWords(std::string_view content, const std::string& file) : rest_(content), file_(file) {}

  int line() const { return line_; }

  /// Empty: the file ends.
  std::string_view Next() {
    SkipBlanks();
    std::size_t length = 0;
    while (length < rest_.size() && !IsBlank(rest_[length])) {
      if (rest_[length] == '{' || rest_[length] == '}') {
        length += length == 0 ? 1 : 0;
        break;
      }
      ++length;
    }
    return Take(length);
  }

  /// What is left of the line, up to a brace.
  std::string Name() {
    std::size_t length = 0;
    while (length < rest_.size() && rest_[length] != '\n' && rest_[length] != '{') ++length;
    const std::string_view name = Trim(Take(length));
    if (name.size() > kLongestName) Fail("a name of more than 200 characters");
    return ToUtf8(name);
  }

  /// The next line, without its end; nothing: the file ends.
  std::optional<std::string_view> Line() {
    if (rest_.empty()) return std::nullopt;
    const std::size_t length = std::min(rest_.find('\n'), rest_.size());
    const std::string_view line = rest_.substr(0, length);
    rest_.remove_prefix(std::min(length + 1, rest_.size()));
    ++line_;
    return line;
  }

  void Expect(std::string_view what) {
    const std::string_view word = Next();
    if (!EqualIgnoringCase(word, what)) Fail(Found(word), std::string(what));
  }

  double Number(const char* what) {
    const std::string_view word = Next();
    const std::optional<double> number = ParseDouble(word);
    if (!number || !(std::abs(*number) <= kLargest)) Fail(Found(word), what);
    return *number;
  }

  static std::string Found(std::string_view word) {
    if (word.empty()) return "the file ends";
    return fmt::format("\"{}\"", ToUtf8(word.substr(0, 40)));
  }

  [[noreturn]] void Fail(const std::string& found, const std::string& expected = "") const {
    throw Error(fmt::format("{}:{}: {}{}", file_, line_, found,
                            expected.empty() ? "" : "; expected " + expected));
  }

 private:
  void SkipBlanks() {
    std::size_t length = 0;
    while (length < rest_.size() && IsBlank(rest_[length])) ++length;
    Take(length);
  }

  std::string_view Take(std::size_t length) {
    const std::string_view taken = rest_.substr(0, length);
    line_ += static_cast<int>(std::count(taken.begin(), taken.end(), '\n'));
    rest_.remove_prefix(length);
    return taken;
  }

  std::string_view rest_;
  const std::string& file_;
  int line_ = 1;
};

void ReadChannels(BvhWords* words, Bvh* bvh, BvhJoint* joint) {
  const double count = words->Number("the number of channels");
  if (!(count >= 0 && count <= kMostChannels && count == std::floor(count))) {
    words->Fail(fmt::format("CHANNELS {}", count), fmt::format("0 to {}", kMostChannels));
  }
  joint->first_channel = bvh->num_channels;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const std::string_view word = words->Next();
    const std::string name = ToLower(word);
    const bool is_rotation = name.size() == 9 && name.ends_with("rotation");
    const bool is_position = name.size() == 9 && name.ends_with("position");
    const int axis = name.empty() ? -1 : name[0] - 'x';
    if ((!is_rotation && !is_position) || axis < 0 || axis > 2) {
      words->Fail(BvhWords::Found(word),
                  fmt::format("{} channels, as Xposition or Zrotation", count));
    }
    joint->channels.push_back({is_rotation, axis});
    ++bvh->num_channels;
  }
}

/// From behind the first ROOT up to MOTION.
void ReadHierarchy(BvhWords* words, Bvh* bvh) {
  std::vector<int> open;  // joints whose braces are not closed
  const auto begin = [&](const std::string& name) {
    if (bvh->joints.size() >= kMostJoints) {
      words->Fail(fmt::format("more than {} joints", kMostJoints));
    }
    words->Expect("{");
    BvhJoint& joint = bvh->joints.emplace_back();
    joint.name = name;
    joint.parent = open.empty() ? -1 : open.back();
    joint.first_channel = bvh->num_channels;
    open.push_back(static_cast<int>(bvh->joints.size()) - 1);
  };
  const auto is_end = [&] {
    return bvh->joints[static_cast<std::size_t>(open.back())].name.empty();
  };
  while (true) {
    const std::string_view word = words->Next();
    if (open.empty()) {
      if (EqualIgnoringCase(word, "MOTION") && !bvh->joints.empty()) return;
      if (!EqualIgnoringCase(word, "ROOT")) {
        words->Fail(BvhWords::Found(word), bvh->joints.empty() ? "ROOT" : "MOTION");
      }
    }
    if (EqualIgnoringCase(word, "ROOT") || EqualIgnoringCase(word, "JOINT")) {
      if (!open.empty() && (EqualIgnoringCase(word, "ROOT") || is_end())) {
        words->Fail(BvhWords::Found(word) + " where it can't be");
      }
      const std::string name = words->Name();
      begin(name.empty() ? fmt::format("joint {}", bvh->joints.size() + 1) : name);
    } else if (EqualIgnoringCase(word, "End") && !is_end()) {
      words->Name();
      begin("");
    } else if (word == "}") {
      open.pop_back();
    } else if (EqualIgnoringCase(word, "OFFSET")) {
      auto& offset = bvh->joints[static_cast<std::size_t>(open.back())].offset;
      for (double& coordinate : offset) coordinate = words->Number("three numbers");
    } else if (EqualIgnoringCase(word, "CHANNELS") && !is_end()) {
      BvhJoint& joint = bvh->joints[static_cast<std::size_t>(open.back())];
      if (!joint.channels.empty()) words->Fail("CHANNELS for the second time");
      ReadChannels(words, bvh, &joint);
    } else {
      words->Fail(BvhWords::Found(word), "OFFSET, CHANNELS, JOINT, End Site or }");
    }
  }
}

/// Frame times are rounded: .0083333 is 120 Hz.
double RateOf(std::string_view text) {
  const double time = ParseDouble(text).value_or(0);
  if (!(time > 0) || !std::isfinite(1 / time)) return 0;
  const double nearest = std::round(1 / time);
  const std::size_t point = text.find('.');
  if (nearest < 1 || point == std::string_view::npos) return 1 / time;
  const auto decimals =
      std::min(text.find_first_not_of("0123456789", point + 1), text.size()) - point - 1;
  const double last_digit = std::pow(10.0, -static_cast<double>(decimals));
  return std::abs(1 / nearest - time) <= last_digit ? nearest : 1 / time;
}

/// What stands behind the colon in the next line that is not blank.
std::string_view ValueOf(const char* key, BvhWords* words) {
  std::optional<std::string_view> line = words->Line();
  while (line && Trim(*line).empty()) line = words->Line();
  const std::string_view text = Trim(line.value_or(""));
  const std::size_t colon = text.find(':');
  if (!StartsWithIgnoringCase(text, key) || colon == std::string_view::npos) {
    words->Fail(BvhWords::Found(text), fmt::format("{}: and a number", key));
  }
  return Trim(text.substr(colon + 1));
}

void ReadMotionHead(BvhWords* words, Bvh* bvh) {
  const double count = ParseDouble(ValueOf("Frames", words)).value_or(0);
  if (count > 0 && count < kLargest) bvh->declared_frames = static_cast<long>(count);
  bvh->rate = RateOf(ValueOf("Frame Time", words));
}

/// The numbers of a line; NaN for what is none.
void AppendNumbers(std::string_view line, std::vector<double>* numbers) {
  while (true) {
    std::size_t begin = 0;
    while (begin < line.size() && IsBlank(line[begin])) ++begin;
    line.remove_prefix(begin);
    if (line.empty()) return;
    std::size_t end = 0;
    while (end < line.size() && !IsBlank(line[end])) ++end;
    const double number = ParseDouble(line.substr(0, end)).value_or(kNaN);
    numbers->push_back(std::abs(number) <= kLargest ? number : kNaN);
    line.remove_prefix(end);
  }
}

/// A frame is a line, or several lines where the first one has fewer numbers.
void ReadFrames(BvhWords* words, Bvh* bvh, Warnings* warnings) {
  const auto channels = static_cast<std::size_t>(bvh->num_channels);
  const char* const kind = "frames that can't be read";
  std::vector<double> numbers;
  bool is_first = true, is_wrapped = false;
  while (const auto line = words->Line()) {
    if (!is_wrapped) numbers.clear();
    AppendNumbers(*line, &numbers);
    if (numbers.empty()) continue;
    is_wrapped |= is_first && numbers.size() < channels;
    is_first = false;
    if (is_wrapped && numbers.size() < channels) continue;
    const int frame = bvh->num_frames() + 1;
    const int at = words->line() - 1;
    const bool is_right = numbers.size() == channels;
    const bool is_known = is_right && std::none_of(numbers.begin(), numbers.end(),
                                                   [](double one) { return std::isnan(one); });
    if (!is_right) {
      WarnOfKind(warnings, kind,
                 fmt::format("line {}: {} numbers for {} channels; frame {} is not known", at,
                             numbers.size(), channels, frame));
    } else if (!is_known) {
      WarnOfKind(
          warnings, kind,
          fmt::format("line {}: something that is no number; frame {} is not known", at, frame));
    }
    if (!is_known) numbers.assign(channels, kNaN);
    bvh->numbers.insert(bvh->numbers.end(), numbers.begin(), numbers.end());
    numbers.clear();
  }
  if (is_wrapped && !numbers.empty()) {
    Warn(warnings, fmt::format("the last frame is cut: {} numbers for {} channels", numbers.size(),
                               channels));
  }
}

Matrix3d Turn(int axis, double degrees) {
  const double c = std::cos(degrees / kDegrees), s = std::sin(degrees / kDegrees);
  const int y = (axis + 1) % 3, z = (axis + 2) % 3;
  Matrix3d R = Matrix3d::Identity();
  R(y, y) = c;
  R(z, z) = c;
  R(y, z) = -s;
  R(z, y) = s;
  return R;
}

/// A root's OFFSET stands in many files as the place at rest, which its channels replace; in a few
/// they are counted from it. The ground, to which it is how high, tells which. Up is where the
/// joints are farthest from each other.
bool AddsRootOffset(Bvh bvh) {
  constexpr int kSamples = 100;
  const Vector3d offset = bvh.joints.front().offset;
  double size = 0;
  for (std::size_t j = 1; j < bvh.joints.size(); ++j) {
    size = std::max(size, bvh.joints[j].offset.norm());
  }
  // Where it is less than a limb it can't be the height of a pelvis.
  if (!(offset.norm() > size) || bvh.joints.front().channels.empty()) return false;
  std::vector<double> spans[3], lows[3];
  Eigen::Matrix3Xd p;
  std::vector<Matrix3d> R;
  const int step = std::max(1, bvh.num_frames() / kSamples);
  for (int k = 0; k < bvh.num_frames(); k += step) {
    PoseBvh(bvh, k, &p, &R);
    if (!p.allFinite()) continue;
    for (int a = 0; a < 3; ++a) {
      spans[a].push_back(p.row(a).maxCoeff() - p.row(a).minCoeff());
      lows[a].push_back((std::copysign(1, offset[a]) * p.row(a)).minCoeff());
    }
  }
  if (lows[0].empty()) return false;
  const Vector3d span(Median(spans[0]), Median(spans[1]), Median(spans[2]));
  int up = 0;
  span.maxCoeff(&up);
  const double height = std::abs(offset[up]), low = Median(lows[up]);
  return height > size && std::abs(low + height) < 0.5 * std::abs(low);
}

}  // namespace

bool LooksLikeBvh(std::string_view content) {
  if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
  return StartsWithIgnoringCase(Trim(content), "HIERARCHY");
}

Bvh ParseBvh(std::string_view content, const std::string& file, Warnings* warnings) {
  const WarningContext context(warnings, file);
  if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
  BvhWords words(content, file);
  Bvh bvh;
  words.Expect("HIERARCHY");
  ReadHierarchy(&words, &bvh);
  if (bvh.num_channels == 0 ||
      static_cast<int>(bvh.joints.size()) > kMostJointsPerChannel * bvh.num_channels) {
    throw Error(fmt::format("{}: {} joints with {} channels are no motion", file, bvh.joints.size(),
                            bvh.num_channels));
  }
  ReadMotionHead(&words, &bvh);
  ReadFrames(&words, &bvh, warnings);
  if (bvh.num_frames() == 0) {
    throw Error(fmt::format("{}: has no whole frame of {} numbers", file, bvh.num_channels));
  }
  if (bvh.declared_frames > 0 && bvh.declared_frames != bvh.num_frames()) {
    Warn(warnings,
         fmt::format("Frames: says {}, there are {}", bvh.declared_frames, bvh.num_frames()));
  }
  bvh.adds_root_offset = AddsRootOffset(bvh);
  if (bvh.adds_root_offset) {
    Warn(warnings,
         "the root's OFFSET is added to its position channels, which puts the lowest "
         "joint on the ground");
  }
  return bvh;
}

void PoseBvh(const Bvh& bvh, int frame, Eigen::Matrix3Xd* p, std::vector<Matrix3d>* R) {
  const auto num_joints = bvh.joints.size();
  p->resize(3, static_cast<Eigen::Index>(num_joints));
  R->resize(num_joints);
  const double* numbers = bvh.numbers.data() + static_cast<std::size_t>(frame) *
                                                   static_cast<std::size_t>(bvh.num_channels);
  for (std::size_t j = 0; j < num_joints; ++j) {
    const BvhJoint& joint = bvh.joints[j];
    Vector3d t = joint.offset;
    Matrix3d turn = Matrix3d::Identity();
    for (std::size_t c = 0; c < joint.channels.size(); ++c) {
      const double value = numbers[static_cast<std::size_t>(joint.first_channel) + c];
      const auto [is_rotation, axis] = joint.channels[c];
      if (is_rotation) {
        turn = turn * Turn(axis, value);
      } else {
        t[axis] = value + (joint.parent < 0 && bvh.adds_root_offset ? joint.offset[axis] : 0);
      }
    }
    const auto i = static_cast<Eigen::Index>(j);
    if (joint.parent < 0) {
      p->col(i) = t;
      (*R)[j] = turn;
    } else {
      const Matrix3d& above = (*R)[static_cast<std::size_t>(joint.parent)];
      p->col(i) = p->col(joint.parent) + above * t;
      (*R)[j] = above * turn;
    }
  }
}

RecordingContent ReadBvhContent(const std::string& file, const ContentOptions& options,
                                Warnings* warnings) {
  const auto bvh = std::make_shared<const Bvh>(ParseBvh(ReadFileContent(file), file, warnings));
  SkeletonMotion motion;
  for (const BvhJoint& joint : bvh->joints) {
    motion.names.push_back(joint.name);
    motion.parents.push_back(joint.parent);
  }
  motion.rate = bvh->rate;
  motion.num_frames = bvh->num_frames();
  motion.declared_frames = bvh->declared_frames;
  motion.pose = [bvh](int frame, Eigen::Matrix3Xd* p, std::vector<Matrix3d>* R) {
    PoseBvh(*bvh, frame, p, R);
  };
  return ContentOfSkeleton(std::move(motion), "BVH", file, options, warnings);
}

}  // namespace mmm_converter
