// SPDX-License-Identifier: MIT
#include "common/io/recording/recording_axes.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "common/io/recording/marker_labels.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr int kMaxSampledFrames = 500;
constexpr std::pair<const char*, double> kLengthUnits[] = {
    {"mm", 0.001}, {"m", 1}, {"cm", 0.01}, {"in", 0.0254}};

/// Frames spread evenly over the trial.
std::vector<int> SampleFrames(const MarkerSequence& markers) {
  const int count = std::min(markers.num_frames(), kMaxSampledFrames);
  std::vector<int> frames(count);
  for (int i = 0; i < count; ++i) {
    frames[i] = static_cast<int>(static_cast<long>(i) * markers.num_frames() / count);
  }
  return frames;
}

double Quantile(std::vector<double> values, double q) {
  const auto at = values.begin() + std::lround(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

struct Box {
  Eigen::Array3d low = Eigen::Array3d::Constant(INFINITY);
  Eigen::Array3d high = Eigen::Array3d::Constant(-INFINITY);
  int seen = 0;
};

/// without: by label; empty: none is left out.
Box BoxOf(const Eigen::Ref<const Eigen::Matrix3Xd>& frame, const std::vector<bool>& without = {}) {
  Box box;
  for (int i = 0; i < frame.cols(); ++i) {
    if (!IsSeen(frame.col(i))) continue;
    if (!without.empty() && without[static_cast<std::size_t>(i)]) continue;
    box.low = box.low.min(frame.col(i).array());
    box.high = box.high.max(frame.col(i).array());
    ++box.seen;
  }
  return box;
}

/// Median over frames of the diagonal of the box around all markers [file units]; 0: no frame has
/// three.
double SizeOf(const MarkerSequence& markers, const std::vector<bool>& without) {
  std::vector<double> sizes;
  for (const int k : SampleFrames(markers)) {
    const Box box = BoxOf(markers.frame(k), without);
    if (box.seen >= 3) sizes.push_back((box.high - box.low).matrix().norm());
  }
  return sizes.empty() ? 0 : Quantile(std::move(sizes), 0.5);
}

std::vector<int> LabelsIn(const std::vector<std::optional<BodyRegion>>& regions,
                          BodyRegion region) {
  std::vector<int> found;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (regions[i] == region) found.push_back(static_cast<int>(i));
  }
  return found;
}

std::optional<UnitDecision> UnitFromText(const std::string& text) {
  const std::string name = NormalizeLabel(text);
  const auto unit = [](int i) {
    return UnitDecision{kLengthUnits[i].first, kLengthUnits[i].second, false, "", false};
  };
  if (name == "mm" || name.starts_with("millim")) return unit(0);
  if (name == "m" || name.starts_with("mete") || name.starts_with("metr")) return unit(1);
  if (name == "cm" || name.starts_with("centim")) return unit(2);
  if (name == "in" || name.starts_with("inch")) return unit(3);
  return std::nullopt;
}

/// Mean of the seen ones; NaN if none is.
Eigen::Vector3d Mean(const Eigen::Ref<const Eigen::Matrix3Xd>& frame, const std::vector<int>& of) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int seen = 0;
  for (const int i : of) {
    if (!IsSeen(frame.col(i))) continue;
    sum += frame.col(i);
    ++seen;
  }
  return sum / seen;
}

/// From low to high markers in each sampled frame, from the best pair of regions that is there.
std::vector<Eigen::Vector3d> BodyAxes(const MarkerSequence& markers) {
  constexpr std::pair<BodyRegion, BodyRegion> kHighLow[] = {
      {BodyRegion::kHead, BodyRegion::kFeet},       {BodyRegion::kShoulders, BodyRegion::kFeet},
      {BodyRegion::kHead, BodyRegion::kPelvis},     {BodyRegion::kShoulders, BodyRegion::kPelvis},
      {BodyRegion::kPelvis, BodyRegion::kFeet},     {BodyRegion::kHead, BodyRegion::kThorax},
      {BodyRegion::kShoulders, BodyRegion::kThorax}};
  const auto regions = BodyRegionsOf(markers.labels());
  const std::vector<int> frames = SampleFrames(markers);
  std::vector<Eigen::Vector3d> best;
  for (const auto& [high, low] : kHighLow) {
    std::vector<Eigen::Vector3d> axes;
    const std::vector<int> high_labels = LabelsIn(regions, high);
    const std::vector<int> low_labels = LabelsIn(regions, low);
    for (const int k : frames) {
      const Eigen::Vector3d d =
          Mean(markers.frame(k), high_labels) - Mean(markers.frame(k), low_labels);
      if (d.allFinite()) axes.push_back(d);
    }
    if (2 * axes.size() >= frames.size() && !axes.empty()) return axes;
    if (axes.size() > best.size()) best = std::move(axes);
  }
  return best;
}

/// Where the lowest markers are along an axis, over the trial [file units].
struct LowEnd {
  double median = NAN;
  double range = NAN;  ///< of the middle 80 % of the frames
};

LowEnd LowEndOf(const MarkerSequence& markers, UpAxis up) {
  const int axis = static_cast<int>(up) % 3;
  const bool is_negative = static_cast<int>(up) >= 3;
  std::vector<double> low;
  for (const int k : SampleFrames(markers)) {
    const Box box = BoxOf(markers.frame(k));
    if (2 * box.seen < markers.num_labels()) continue;
    low.push_back(is_negative ? -box.high[axis] : box.low[axis]);
  }
  if (low.empty()) return {};
  return {Quantile(low, 0.5), Quantile(low, 0.9) - Quantile(low, 0.1)};
}

/// Along one axis: do the highest markers move less than the lowest, so that the ground is there?
bool GroundIsAtTheHighEnd(const MarkerSequence& markers, int axis) {
  const double low = LowEndOf(markers, static_cast<UpAxis>(axis)).range;
  const double high = LowEndOf(markers, static_cast<UpAxis>(axis + 3)).range;
  return high < 0.5 * low;
}

/// Are the lowest markers near 0 throughout, as the ground of most laboratories is?
bool IsOnGround(const MarkerSequence& markers, double metres, UpAxis up) {
  constexpr double kNear = 0.2;  // [m]; markers on feet are at most that high
  const LowEnd low = LowEndOf(markers, up);
  return metres * std::abs(low.median) < kNear && metres * low.range < kNear;
}

/// The axis along which the person stands most of the time; nothing where the markers do not tell,
/// and why.
struct BodyAxis {
  std::optional<UpAxis> up;
  std::string why_unknown;
  bool is_person = false;   ///< labels tell head from feet
  bool is_upright = false;  ///< far more along it than along any other
};

BodyAxis FindBodyAxis(const MarkerSequence& markers) {
  const std::vector<Eigen::Vector3d> axes = BodyAxes(markers);
  if (axes.empty()) return {std::nullopt, "no labels that tell head from feet", false};
  std::array<double, 3> lengths{};
  for (int i = 0; i < 3; ++i) {
    std::vector<double> along(axes.size());
    std::transform(axes.begin(), axes.end(), along.begin(),
                   [i](const Eigen::Vector3d& d) { return std::abs(d[i]); });
    lengths[i] = Quantile(std::move(along), 0.5);
  }
  const int axis =
      static_cast<int>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
  std::array<double, 3> sorted = lengths;
  std::sort(sorted.begin(), sorted.end());
  if (sorted[2] < 1.3 * sorted[1])
    return {std::nullopt, "the markers do not tell which axis is up", true};
  const auto upright = std::count_if(axes.begin(), axes.end(),
                                     [axis](const Eigen::Vector3d& d) { return d[axis] > 0; });
  const double share = static_cast<double>(upright) / static_cast<double>(axes.size());
  // Now this way, now that way up: the ground decides.
  const bool mixed = share > 0.02 && share < 0.98;
  const bool down = mixed ? GroundIsAtTheHighEnd(markers, axis) : share < 0.5;
  // From head to feet persons who stand are 3 times and more as high as they are deep, those who
  // start a sprint hardly twice.
  constexpr double kUpright = 2.5;
  return {static_cast<UpAxis>(axis + (down ? 3 : 0)), "", true, sorted[2] > kUpright * sorted[1]};
}

/// body: contradicts what the file states. Who stands on the ground of the one axis and not of the
/// other settles it. Where none does, nobody stands on the head throughout; but who lies may be
/// where the file has no ground.
UpAxisDecision WeighStated(const MarkerSequence& markers, double metres, UpAxis stated,
                           UpAxis body) {
  constexpr double kTravel = 1;  // [m]
  const bool is_opposite = static_cast<int>(stated) % 3 == static_cast<int>(body) % 3;
  const bool is_impossible = metres * LowEndOf(markers, stated).range > kTravel;
  const bool stands_by_body = IsOnGround(markers, metres, body);
  const bool stands_by_file = IsOnGround(markers, metres, stated);
  if (!stands_by_file && (is_opposite || (stands_by_body && is_impossible))) {
    return {body, true,
            fmt::format("the file states that {} is up, but most of the time the person's head is "
                        "towards {}{}; {} is taken",
                        Name(stated), Name(body), stands_by_body ? ", and the ground is there" : "",
                        Name(body)),
            !stands_by_body};
  }
  return {stated, false,
          fmt::format("the file states that {} is up, but most of the time the person's head is "
                      "towards {}; {} is taken",
                      Name(stated), Name(body), Name(stated)),
          true};
}

/// The first of the usual axes that has a ground; nothing where none has.
std::optional<UpAxis> UsualWithGround(const MarkerSequence& markers, double metres,
                                      const std::vector<UpAxis>& usual) {
  const auto found = std::find_if(usual.begin(), usual.end(),
                                  [&](UpAxis axis) { return IsOnGround(markers, metres, axis); });
  return found == usual.end() ? std::nullopt : std::optional(*found);
}

/// How high the markers are along an axis, on average over them [file units].
double MedianHeight(const MarkerSequence& markers, UpAxis up) {
  const int axis = static_cast<int>(up) % 3;
  const double sign = static_cast<int>(up) >= 3 ? -1 : 1;
  std::vector<int> all(static_cast<std::size_t>(markers.num_labels()));
  std::iota(all.begin(), all.end(), 0);
  std::vector<double> heights;
  for (const int k : SampleFrames(markers)) {
    const double height = sign * Mean(markers.frame(k), all)[axis];
    if (std::isfinite(height)) heights.push_back(height);
  }
  return heights.empty() ? NAN : Quantile(std::move(heights), 0.5);
}

/// Among the usual ones another axis than `body` that has a ground under someone who lies there;
/// nothing: none has.
std::optional<UpAxis> GroundUnderWhoLies(const MarkerSequence& markers, double metres,
                                         const std::vector<UpAxis>& usual, UpAxis body) {
  // The lowest marker [m]; where places are counted from the pelvis, some are below it along any
  // axis, and nobody who stands there is as thick as that on one side.
  constexpr double kLowest = -0.03, kHighest = 0.2, kRange = 0.1, kThickness = 0.05;
  const auto regions = BodyRegionsOf(markers.labels());
  const bool has_feet = !LabelsIn(regions, BodyRegion::kFeet).empty();
  const bool may_lie = has_feet && !IsOnGround(markers, metres, body);
  for (const UpAxis axis : usual) {
    if (!may_lie || static_cast<int>(axis) % 3 == static_cast<int>(body) % 3) continue;
    const LowEnd low = LowEndOf(markers, axis);
    if (metres * low.median > kLowest && metres * low.median < kHighest &&
        metres * low.range < kRange && metres * MedianHeight(markers, axis) > kThickness) {
      return axis;
    }
  }
  return std::nullopt;
}

/// Who crouches or lies tells no axis, or one that is not up: the ground does, and else the
/// format's first usual axis is up.
UpAxisDecision WeighGround(const MarkerSequence& markers, double metres,
                           const std::vector<UpAxis>& usual, const std::string& why,
                           bool is_person) {
  const auto with_ground = UsualWithGround(markers, metres, usual);
  const UpAxis axis = with_ground.value_or(usual.empty() ? UpAxis::kZ : usual.front());
  return {axis, is_person && with_ground,
          fmt::format("{}; {} is taken as up{}", why, Name(axis),
                      with_ground ? ", where the ground is" : ""),
          !is_person || !with_ground};
}

/// body: is none of the usual ones.
UpAxisDecision WeighUsual(const MarkerSequence& markers, double metres,
                          const std::vector<UpAxis>& usual, UpAxis body) {
  const std::string said = fmt::format(
      "the file does not state which axis is up, and most of the time the person's "
      "head is towards {}",
      Name(body));
  const auto with_ground = UsualWithGround(markers, metres, usual);
  if (with_ground && !IsOnGround(markers, metres, body)) {
    const char* name = Name(*with_ground);
    return {*with_ground, true,
            fmt::format("{}, but the ground is along {}; {} is taken", said, name, name)};
  }
  return {body, true, fmt::format("{}, which is unusual; {} is taken as up", said, Name(body)),
          true};
}

}  // namespace

UnitDecision ParseUnit(const std::string& text) {
  if (auto unit = UnitFromText(text)) return *unit;
  throw Error(fmt::format("unknown unit \"{}\"; use mm, cm, m or in", text));
}

UnitDecision DecideUnit(const MarkerSequence& markers, const std::string& said) {
  const auto regions = BodyRegionsOf(markers.labels());
  std::vector<bool> unknown(regions.size());
  std::transform(regions.begin(), regions.end(), unknown.begin(),
                 [](const auto& region) { return !region.has_value(); });
  const bool person = std::count(unknown.begin(), unknown.end(), false) >= 8;
  // Things beside a person may be far off.
  const double size = SizeOf(markers, person ? unknown : std::vector<bool>{});
  const auto plausible = [&](double metres) {
    return person ? size * metres >= 0.5 && size * metres <= 3
                  : size * metres >= 0.02 && size * metres <= 10;
  };
  std::optional<UnitDecision> unit = UnitFromText(said);
  if (unit && (size == 0 || plausible(unit->metres))) return *unit;
  const std::string claim =
      unit ? fmt::format("the file says {}", said)
           : fmt::format("the file gives no unit that is known (\"{}\")", said);
  for (const auto& [name, metres] : kLengthUnits) {
    if (name == std::string("in") || !plausible(metres)) continue;
    if (unit && !person) continue;
    return {name, metres, true,
            fmt::format("{}; read as {}, so that the markers span {:.2f} m", claim, name,
                        size * metres),
            unit.has_value()};
  }
  UnitDecision kept = unit.value_or(UnitDecision{});
  kept.guessed = !unit;
  kept.is_doubtful = true;
  kept.warning = fmt::format("{}; read as {}, the markers span {:.3g} m: check the unit", claim,
                             kept.unit, size * kept.metres);
  return kept;
}

UpAxisDecision DecideUpAxis(const MarkerSequence& markers, double metres,
                            const UpAxisClaims& claims) {
  const BodyAxis body = FindBodyAxis(markers);
  const auto contradicts = [&body](UpAxis axis) { return body.up && *body.up != axis; };
  if (claims.given) {
    if (!contradicts(*claims.given)) return {*claims.given, false, ""};
    return {*claims.given, false,
            fmt::format("{} is given as up, but most of the time the person's head is towards {}",
                        Name(*claims.given), Name(*body.up))};
  }
  if (claims.stated) {
    if (contradicts(*claims.stated)) {
      return WeighStated(markers, metres, *claims.stated, *body.up);
    }
    return {*claims.stated, body.up.has_value(), ""};
  }
  if (!body.up) {
    return WeighGround(markers, metres, claims.usual, body.why_unknown, body.is_person);
  }
  if (std::count(claims.usual.begin(), claims.usual.end(), *body.up) > 0) {
    if (const auto ground = GroundUnderWhoLies(markers, metres, claims.usual, *body.up)) {
      return {*ground, true,
              fmt::format("the file does not state which axis is up; the person is along {}, and "
                          "low along {}, as who lies there: {} is taken as up",
                          Name(*body.up), Name(*ground), Name(*ground))};
    }
    const bool is_first = claims.usual.front() == *body.up;
    if (is_first || body.is_upright || IsOnGround(markers, metres, *body.up)) {
      return {*body.up, true, ""};
    }
    return WeighGround(markers, metres, claims.usual,
                       "the person is bent, so that the markers do not tell which axis is up",
                       true);
  }
  return WeighUsual(markers, metres, claims.usual, *body.up);
}

void ToMetresAndZUp(double metres, UpAxis axis, MarkerSequence* markers) {
  if (metres == 1 && axis == UpAxis::kZ) return;
  if (axis == UpAxis::kZ) {
    for (int k = 0; k < markers->num_frames(); ++k) markers->frame(k) *= metres;
    return;
  }
  const Eigen::Matrix3d rotation = RotationToZUp(axis);
  Eigen::Matrix3Xd turned(3, markers->num_labels());
  for (int k = 0; k < markers->num_frames(); ++k) {
    turned.noalias() = metres * rotation * markers->frame(k);
    markers->frame(k) = turned;
  }
}

}  // namespace mmm_converter
