// SPDX-License-Identifier: MIT
#include "common/live/qtm/qtm_commands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr long kLowestUdpPort = 1023;
constexpr long kHighestUdpPort = 65535;

constexpr std::array<std::pair<const char*, QtmComponent>, 19> kComponentNames = {{
    {"3d", QtmComponent::k3d},
    {"3dnolabels", QtmComponent::k3dNoLabels},
    {"analog", QtmComponent::kAnalog},
    {"force", QtmComponent::kForce},
    {"6d", QtmComponent::k6d},
    {"6deuler", QtmComponent::k6dEuler},
    {"2d", QtmComponent::k2d},
    {"2dlin", QtmComponent::k2dLinearized},
    {"3dres", QtmComponent::k3dResiduals},
    {"3dnolabelsres", QtmComponent::k3dNoLabelsResiduals},
    {"6dres", QtmComponent::k6dResiduals},
    {"6deulerres", QtmComponent::k6dEulerResiduals},
    {"analogsingle", QtmComponent::kAnalogSingle},
    {"image", QtmComponent::kImage},
    {"forcesingle", QtmComponent::kForceSingle},
    {"gazevector", QtmComponent::kGazeVector},
    {"timecode", QtmComponent::kTimecode},
    {"skeleton", QtmComponent::kSkeleton},
    {"eyetracker", QtmComponent::kEyeTracker},
}};

/// The first of the word's parts between colons.
std::string Head(const std::string& word) { return word.substr(0, word.find(':')); }

std::optional<long> NumberBehindColon(const std::string& word) {
  const std::size_t colon = word.rfind(':');
  return colon == std::string::npos ? std::nullopt : ParseLong(word.substr(colon + 1));
}

bool TakeRate(const std::string& word, QtmStreamRequest* request) {
  if (word == "allframes") return true;
  const auto number = NumberBehindColon(word);
  if (!number || *number < 1 || *number > 1000000) return false;
  if (Head(word) == "frequencydivisor") {
    request->divisor = static_cast<int>(*number);
    return true;
  }
  request->frequency = static_cast<double>(*number);
  return Head(word) == "frequency";
}

bool TakeUdp(const std::string& word, QtmStreamRequest* request) {
  const auto port = NumberBehindColon(word);
  if (!port || *port < kLowestUdpPort || *port > kHighestUdpPort) return false;
  request->udp_port = static_cast<int>(*port);
  const std::size_t first = word.find(':');
  const std::size_t last = word.rfind(':');
  if (first != last) request->udp_host = word.substr(first + 1, last - first - 1);
  return true;
}

}  // namespace

std::vector<std::string> SplitQtmCommand(std::string_view text) {
  std::vector<std::string> words(1);
  for (const char c : ToLower(text)) {
    if (c != ' ' && c != '\t' && c != '\r' && c != '\n') {
      words.back() += c;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

std::optional<std::vector<QtmComponent>> ParseQtmComponents(const std::vector<std::string>& words) {
  std::vector<QtmComponent> components;
  for (const std::string& word : words) {
    const auto* const found =
        std::find_if(kComponentNames.begin(), kComponentNames.end(),
                     [name = Head(word)](const auto& row) { return name == row.first; });
    if (found == kComponentNames.end()) return std::nullopt;
    if (std::find(components.begin(), components.end(), found->second) == components.end()) {
      components.push_back(found->second);
    }
  }
  if (components.empty()) return std::nullopt;
  return components;
}

std::optional<QtmParameterChoice> ParseQtmParameterChoice(const std::vector<std::string>& words) {
  if (words.empty()) return std::nullopt;
  QtmParameterChoice choice;
  const std::array<std::pair<const char*, bool*>, 9> names = {{{"general", &choice.general},
                                                               {"3d", &choice.the_3d},
                                                               {"6d", &choice.the_6d},
                                                               {"analog", &choice.analog},
                                                               {"force", &choice.force},
                                                               {"gazevector", &choice.gaze_vector},
                                                               {"eyetracker", &choice.eye_tracker},
                                                               {"image", &choice.image},
                                                               {"skeleton", &choice.skeleton}}};
  for (const std::string& word : words) {
    bool is_known = word == "all" || word == "calibration";
    for (const auto& [name, member] : names) {
      if (word != "all" && Head(word) != name) continue;
      *member = true;
      is_known = true;
    }
    if (!is_known) return std::nullopt;
  }
  return choice;
}

std::optional<QtmStreamRequest> ParseQtmStreamRequest(const std::vector<std::string>& words) {
  QtmStreamRequest request;
  if (words.empty()) return std::nullopt;
  if (words.front() == "stop") {
    request.stop = true;
    return request;
  }
  if (!TakeRate(words.front(), &request)) return std::nullopt;
  std::size_t first_component = 1;
  if (words.size() > 1 && Head(words[1]) == "udp") {
    if (!TakeUdp(words[1], &request)) return std::nullopt;
    ++first_component;
  }
  auto components = ParseQtmComponents(
      {words.begin() + static_cast<std::ptrdiff_t>(first_component), words.end()});
  if (!components) return std::nullopt;
  request.components = std::move(*components);
  return request;
}

bool IsAskedFor(const QtmStreamRequest& request, std::int64_t number, double rate) {
  if (request.frequency <= 0) return number % request.divisor == 0;
  if (request.frequency >= rate) return true;
  const double share = request.frequency / rate;
  const auto n = static_cast<double>(number);
  return number == 0 || std::floor(n * share) > std::floor((n - 1) * share);
}

}  // namespace mmm_converter
