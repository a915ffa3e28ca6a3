// SPDX-License-Identifier: MIT
#include "common/retarget/aim_weights.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

// Beyond, aims are as good as none, or stiffer than limits.
constexpr double kLeastWeight = 0.01, kMostWeight = 100;

constexpr std::array<std::pair<const char*, double AimWeights::*>, 4> kGroups = {
    {{"feet", &AimWeights::feet},
     {"hands", &AimWeights::hands},
     {"trunk", &AimWeights::trunk},
     {"limbs", &AimWeights::limbs}}};

/// where: the option, or the file and line.
void TakeWeight(const std::string& where, const std::string& text, std::vector<std::string>* named,
                AimWeights* weights) {
  const std::size_t equals = text.find('=');
  const std::string name(Trim(text.substr(0, equals)));
  double* value = nullptr;
  for (const auto& [group, member] : kGroups) {
    if (name == group) value = &(weights->*member);
  }
  const double number =
      equals == std::string::npos ? 0 : ParseDouble(text.substr(equals + 1)).value_or(0);
  if (value == nullptr || !(number >= kLeastWeight && number <= kMostWeight)) {
    throw Error(
        fmt::format("{}: \"{}\" is no weight of feet, hands, trunk or limbs from {:g} to "
                    "{:g}, as feet=2 is",
                    where, text, kLeastWeight, kMostWeight));
  }
  for (const std::string& other : *named) {
    if (other != name) continue;
    throw Error(fmt::format("{}: {} has two weights; give one", where, name));
  }
  named->push_back(name);
  *value = number;
}

}  // namespace

AimWeights ParseAimWeights(const std::string& text) {
  AimWeights weights;
  std::vector<std::string> named;
  if (text.empty()) return weights;
  for (const std::string& part : Split(text, ',')) {
    TakeWeight(OptionText("weights"), part, &named, &weights);
  }
  return weights;
}

AimWeights ParseAimWeightLines(const std::string& content, const std::string& file) {
  AimWeights weights;
  std::vector<std::string> named;
  int number = 0;
  for (const std::string& line : Split(content, '\n')) {
    ++number;
    const std::string text(Trim(line.substr(0, line.find('#'))));
    if (!text.empty()) TakeWeight(fmt::format("{}:{}", file, number), text, &named, &weights);
  }
  return weights;
}

double Weighed(double deviation, double weight) { return deviation / std::sqrt(weight); }

}  // namespace mmm_converter
