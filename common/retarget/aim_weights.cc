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

void TakeWeight(const std::string& text, std::vector<std::string>* named, AimWeights* weights) {
  const std::size_t equals = text.find('=');
  const std::string name(Trim(text.substr(0, equals)));
  double* value = nullptr;
  for (const auto& [group, member] : kGroups) {
    if (name == group) value = &(weights->*member);
  }
  const auto number =
      equals == std::string::npos ? std::nullopt : ParseDouble(text.substr(equals + 1));
  if (value == nullptr || !number || !(*number >= kLeastWeight && *number <= kMostWeight)) {
    throw Error(
        fmt::format("{}: \"{}\" is no weight of feet, hands, trunk or limbs from {:g} to "
                    "{:g}; for instance feet=2,hands=0.5",
                    OptionText("weights"), text, kLeastWeight, kMostWeight));
  }
  for (const std::string& other : *named) {
    if (other != name) continue;
    throw Error(fmt::format("{}: {} has two weights; give one", OptionText("weights"), name));
  }
  named->push_back(name);
  *value = *number;
}

}  // namespace

AimWeights ParseAimWeights(const std::string& text) {
  AimWeights weights;
  std::vector<std::string> named;
  if (text.empty()) return weights;
  for (const std::string& part : Split(text, ',')) TakeWeight(part, &named, &weights);
  return weights;
}

double Weighed(double deviation, double weight) { return deviation / std::sqrt(weight); }

}  // namespace mmm_converter
