// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "common/io/xml/xml_document.h"
#include "common/model/body_bounds.h"
#include "common/retarget/body_map.h"
#include "common/support/diagnostics.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMostMapBytes = std::size_t{1} << 20;

std::string Attribute(const XmlElement& element, const char* name) {
  const std::string* value = element.FindAttribute(name);
  return value == nullptr ? "" : *value;
}

std::optional<Eigen::Vector3d> ParseForward(const std::string& text) {
  std::istringstream words(text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    const auto number = ParseDouble(word);
    if (!number) return {};
    numbers.push_back(*number);
  }
  if (numbers.size() != 3 || !IsWithin(numbers[2], kLongestDirection)) return {};
  const double level = std::hypot(numbers[0], numbers[1]);
  if (!(level >= 0.1) || !IsWithin(level, kLongestDirection)) return {};
  return Eigen::Vector3d(numbers[0], numbers[1], 0).normalized();
}

void ReadLimbChoice(const XmlElement& element, BodyMapChoice* choice, Diagnostics* problems) {
  const std::string name = Attribute(element, "name");
  const LimbChoice limb = {Attribute(element, "first"), Attribute(element, "fold"),
                           Attribute(element, "last")};
  if (limb.first.empty() || limb.last.empty()) {
    problems->AddError(element.line, "<Limb> needs the joints first=\"\" and last=\"\"");
  }
  for (const bool is_leg : {true, false}) {
    for (const Side side : kSides) {
      if (name != LimbName(is_leg, side)) continue;
      auto& chosen = (is_leg ? choice->legs : choice->arms)[static_cast<std::size_t>(side)];
      if (chosen) problems->AddError(element.line, fmt::format("a second {}", name));
      chosen = limb;
      return;
    }
  }
  problems->AddError(element.line,
                     fmt::format("<Limb name=\"{}\">: expected \"left leg\", \"right leg\", \"left "
                                 "arm\" or \"right arm\"",
                                 name));
}

std::string FormatLimb(const KinematicModel& model, const LimbMap& limb, bool is_leg, Side side) {
  const auto name = [&](int segment) { return model.segments()[segment].name; };
  return fmt::format("  {:<9} {} to {}; {} {}; {:.0f} and {:.0f} mm\n", LimbName(is_leg, side),
                     name(limb.chain.front()), name(limb.chain.back()), is_leg ? "knee" : "elbow",
                     name(limb.chain[limb.fold]), 1e3 * limb.upper.length, 1e3 * limb.lower.length);
}

}  // namespace

BodyMapChoice ReadBodyMapChoice(const std::string& file) {
  const XmlElement root = ReadXmlFile(file, kMostMapBytes);
  Diagnostics problems(file);
  BodyMapChoice choice;
  if (!root.Is("BodyMap")) {
    problems.AddError(root.line, fmt::format("<{}> is no <BodyMap>", root.name));
  }
  if (const std::string* forward = root.FindAttribute("forward")) {
    choice.forward = ParseForward(*forward);
    if (!choice.forward) {
      problems.AddError(root.line, fmt::format("forward=\"{}\": expected a level direction, as in "
                                               "\"1 0 0\"",
                                               *forward));
    }
  }
  for (const XmlElement& element : root.children) {
    if (element.Is("Limb")) {
      ReadLimbChoice(element, &choice, &problems);
    } else {
      problems.AddError(element.line, fmt::format("<{}> is no <Limb>", element.name));
    }
  }
  if (choice.legs[0].has_value() != choice.legs[1].has_value() ||
      choice.arms[0].has_value() != choice.arms[1].has_value()) {
    problems.AddError(root.line, "limbs come in pairs, left and right");
  }
  problems.ThrowIfErrors();
  return choice;
}

std::string FormatBodyMap(const KinematicModel& model, const BodyMap& map) {
  std::string text = fmt::format("{}\n", model.name());
  for (const Side side : kSides) {
    if (const auto& leg = map.leg(side)) text += FormatLimb(model, *leg, true, side);
  }
  for (const Side side : kSides) {
    if (const auto& arm = map.arm(side)) text += FormatLimb(model, *arm, false, side);
  }
  text += fmt::format("  pelvis    {}\n  chest     {}\n", model.segments()[map.pelvis].name,
                      model.segments()[map.chest].name);
  const Eigen::Vector3d forward = map.R_WA.col(0);
  text += fmt::format("  forward   {:.2f} {:.2f} 0 at the zero pose: {}\n", forward.x() + 0.0,
                      forward.y() + 0.0, JoinNames(map.evidence, " and "));
  return text;
}

}  // namespace mmm_converter
