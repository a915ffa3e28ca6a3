// SPDX-License-Identifier: MIT
#include "common/forces/emg.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "common/io/c3d/c3d_analog.h"
#include "common/io/tables/column_names.h"
#include "common/motion/low_pass.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr double kHighPass = 20;  // [Hz]
constexpr double kEnvelope = 6;   // [Hz]
constexpr std::size_t kMostNamed = 40;

/// What a unit is in millivolts; nothing: it is no voltage.
std::optional<double> MillivoltsOf(const std::string& unit) {
  const std::string lower = ToLower(std::string(Trim(unit)));
  if (lower.empty() || lower == "v" || lower == "volt" || lower == "volts") return 1000;
  if (lower == "mv") return 1;
  if (lower == "uv" || lower == "\xc2\xb5v" || lower == "\xce\xbcv" || lower == "\xb5v")
    return 1e-3;
  return {};
}

struct SideWord {
  const char* word;
  const char* side;
};
constexpr std::array<SideWord, 4> kWords = {
    {{"left", "left"}, {"right", "right"}, {"l", "left"}, {"r", "right"}}};

bool IsSeparator(char c) { return c == ' ' || c == '_' || c == '.' || c == '-' || c == ':'; }

/// Separators at both ends are no part of a name.
std::string Bare(std::string name) {
  while (!name.empty() && IsSeparator(name.back())) name.pop_back();
  std::size_t begin = 0;
  while (begin < name.size() && IsSeparator(name[begin])) ++begin;
  return name.substr(begin);
}

/// By a word that separators set apart.
std::optional<EmgChannel> ByWord(const std::string& label) {
  const std::string lower = ToLower(label);
  for (const auto& [text, side] : kWords) {
    const std::string word = text;
    if (lower.size() <= word.size() + 1) continue;
    const std::size_t rest = lower.size() - word.size();
    if (lower.starts_with(word) && IsSeparator(label[word.size()])) {
      return EmgChannel{Bare(label.substr(word.size())), side};
    }
    if (lower.ends_with(word) && IsSeparator(label[rest - 1])) {
      return EmgChannel{Bare(label.substr(0, rest)), side};
    }
  }
  return {};
}

/// By a letter that the label beside it has otherwise.
std::optional<EmgChannel> ByPair(const std::string& label, const std::vector<std::string>& labels) {
  const std::string lower = ToLower(label);
  if (lower.size() < 2 || (lower[0] != 'l' && lower[0] != 'r')) return {};
  std::string other = lower;
  other[0] = lower[0] == 'l' ? 'r' : 'l';
  const bool has_other = std::any_of(labels.begin(), labels.end(),
                                     [&](const std::string& one) { return ToLower(one) == other; });
  if (!has_other) return {};
  return EmgChannel{Bare(label.substr(1)), lower[0] == 'l' ? "left" : "right"};
}

std::vector<int> Choose(const std::string& file, const C3dAnalog& analog,
                        const std::string& labels) {
  std::vector<std::string> there;
  for (const C3dAnalogChannel& one : analog.channels) there.emplace_back(Trim(one.label));
  const auto refuse = [&](const std::string& why) {
    const std::size_t more = there.size() > kMostNamed ? there.size() - kMostNamed : 0;
    std::vector<std::string> named(there.begin(), there.end() - static_cast<std::ptrdiff_t>(more));
    throw Error(fmt::format("{}: {}; its analog channels are {}{}", file, why,
                            there.empty() ? "none" : fmt::format("{}", fmt::join(named, ", ")),
                            more > 0 ? fmt::format(" and {} more", more) : ""));
  };
  std::vector<int> chosen;
  if (ToLower(labels) == "all") {
    for (std::size_t i = 0; i < there.size(); ++i) {
      const std::string text = ToLower(there[i] + " " + analog.channels[i].description);
      if (text.find("emg") != text.npos) chosen.push_back(static_cast<int>(i));
    }
    if (chosen.empty()) refuse("no analog channel is called EMG");
    return chosen;
  }
  for (const std::string& label : Split(labels, ',')) {
    const std::string asked = ToLower(std::string(Trim(label)));
    const auto found = std::find_if(there.begin(), there.end(),
                                    [&](const std::string& one) { return ToLower(one) == asked; });
    if (found == there.end()) refuse(fmt::format("has no analog channel {}", Trim(label)));
    chosen.push_back(static_cast<int>(found - there.begin()));
  }
  return chosen;
}

}  // namespace

std::vector<EmgChannel> EmgChannelsOf(const std::vector<std::string>& labels) {
  std::vector<EmgChannel> channels;
  for (const std::string& label : labels) {
    std::optional<EmgChannel> channel = ByWord(label);
    if (!channel) channel = ByPair(label, labels);
    channels.push_back(channel && !channel->muscle.empty() ? *channel : EmgChannel{label, ""});
  }
  return channels;
}

Emg ReadEmg(const std::string& file, const std::string& labels, Warnings* warnings) {
  C3dFile c3d(file, nullptr);
  const C3dAnalog analog = ReadC3dAnalog(c3d, nullptr);
  const std::vector<int> chosen = Choose(file, analog, labels);
  if (!(LargestCutoff(analog.rate) > kHighPass)) {
    throw Error(
        fmt::format("{}: its analog channels have {:g} samples a second; EMG needs more than {:g}",
                    file, analog.rate, kHighPass / LargestCutoff(1)));
  }
  std::vector<std::string> names;
  Eigen::RowVectorXd scales(static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const C3dAnalogChannel& channel = analog.channels[static_cast<std::size_t>(chosen[i])];
    const std::optional<double> scale = MillivoltsOf(channel.unit);
    if (!scale) {
      throw Error(fmt::format("{}: channel {} is in {}, and EMG is a voltage", file, channel.label,
                              Trim(channel.unit)));
    }
    if (Trim(channel.unit).empty()) {
      Warn(warnings,
           fmt::format("{}: channel {} states no unit: taken as volts", file, channel.label));
    }
    names.push_back(PlainCell(Trim(channel.label)));
    scales[static_cast<Eigen::Index>(i)] = *scale;
  }
  const Eigen::MatrixXd samples =
      ReadC3dAnalogSamples(&c3d, analog)(chosen, Eigen::all).transpose() * scales.asDiagonal();
  const Eigen::MatrixXd rectified =
      (samples - LowPassed(samples, analog.rate, kHighPass)).cwiseAbs();
  const Eigen::MatrixXd smooth = LowPassed(rectified, analog.rate, kEnvelope).cwiseMax(0);
  const int step = std::max(analog.samples_per_frame, 1);
  Emg emg;
  emg.channels = EmgChannelsOf(names);
  emg.rate = analog.rate / step;
  emg.first_time = c3d.layout().first_time(emg.rate);
  emg.envelopes.resize(smooth.cols(), smooth.rows() / step);
  for (Eigen::Index k = 0; k < emg.envelopes.cols(); ++k) {
    emg.envelopes.col(k) = smooth.row(k * step).transpose();
  }
  return emg;
}

}  // namespace mmm_converter
