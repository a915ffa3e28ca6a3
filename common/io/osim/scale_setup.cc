// SPDX-License-Identifier: MIT
#include "common/io/osim/scale_setup.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/io/osim/osim_values.h"
#include "common/io/osim/osim_xml.h"
#include "common/support/error.h"
#include "common/support/error_of_file.h"
#include "common/support/text.h"

namespace mmm_converter {

using Eigen::Vector3d;

namespace {

class SetupReader {
 public:
  SetupReader(const OsimPartReader& read_part, Diagnostics* diagnostics)
      : read_part_(read_part), diagnostics_(diagnostics) {}

  ScaleSetup Read(const XmlElement& tool);

 private:
  bool Flag(const XmlElement& object, std::string_view name, bool otherwise) const {
    return ReadOsimFlag(object, name, otherwise, diagnostics_);
  }
  /// The text of a property that names a file; empty: none.
  static std::string FileOf(const XmlElement& object, std::string_view name) {
    const std::string_view text = OsimText(object, name);
    return EqualIgnoringCase(text, "Unassigned") ? "" : std::string(text);
  }
  /// A set that is a property, in a file of its own or not. Calls visit for it.
  template <typename Visit>
  void WithSet(const XmlElement& owner, const char* name, const Visit& visit) const;
  template <typename Visit>
  void ForEach(const XmlElement& owner, const char* set, const Visit& visit) const;

  void ReadScaler(const XmlElement& scaler);
  void ReadMeasurement(const XmlElement& element);
  void ReadPlacer(const XmlElement& placer);
  ScaleSetup::TimeRange ReadTimes(const XmlElement& object) const;
  Vector3d ReadAxes(const XmlElement& body) const;

  const OsimPartReader& read_part_;
  Diagnostics* diagnostics_;
  ScaleSetup setup_;
};

template <typename Visit>
void SetupReader::WithSet(const XmlElement& owner, const char* name, const Visit& visit) const {
  const XmlElement* set = owner.FindChild(name);
  if (set == nullptr) return;
  const std::string* file = set->FindAttribute("file");
  if (file == nullptr || file->empty()) return visit(*set);
  visit(NamedBy(fmt::format("{}:{}", diagnostics_->file(), set->line),
                [&] { return ParseOsimPart(read_part_(*file), *file, name); }));
}

template <typename Visit>
void SetupReader::ForEach(const XmlElement& owner, const char* set, const Visit& visit) const {
  WithSet(owner, set, [&](const XmlElement& element) {
    const XmlElement* objects = element.FindChild("objects");
    if (objects == nullptr) return;
    for (const XmlElement& object : objects->children) visit(object);
  });
}

ScaleSetup::TimeRange SetupReader::ReadTimes(const XmlElement& object) const {
  const XmlElement* element = object.FindChild("time_range");
  if (element == nullptr || element->text.empty()) return std::nullopt;
  std::vector<double> times;  // "-Inf Inf" is everything
  if (AppendDoubles(element->text, &times) && times.size() == 2 && times[0] <= times[1]) {
    return std::array<double, 2>{times[0], times[1]};
  }
  diagnostics_->AddError(element->line,
                         fmt::format("<time_range>: \"{:.60}\" is not two times, the "
                                     "earlier first",
                                     element->text));
  return std::nullopt;
}

Vector3d SetupReader::ReadAxes(const XmlElement& body) const {
  Vector3d axes = Vector3d::Zero();
  for (const std::string& axis : Words(OsimText(body, "axes"))) {
    constexpr std::string_view kAxes = "xyz";
    const std::size_t index = axis.size() == 1 ? kAxes.find(ToLower(axis)) : std::string_view::npos;
    if (index == std::string_view::npos) {
      diagnostics_->AddError(body.line,
                             fmt::format("<axes>: \"{:.20}\" is none of X, Y and Z", axis));
    } else {
      axes[static_cast<Eigen::Index>(index)] = 1;
    }
  }
  return axes;
}

void SetupReader::ReadMeasurement(const XmlElement& element) {
  if (!element.Is("Measurement") || !Flag(element, "apply", true)) return;
  ScaleSetup::Measurement one;
  one.name = OsimName(element);
  one.line = element.line;
  ForEach(element, "MarkerPairSet", [&](const XmlElement& pair) {
    const std::vector<std::string> names = Words(OsimText(pair, "markers"));
    if (names.size() == 2) {
      one.pairs.push_back({names[0], names[1]});
    } else {
      diagnostics_->AddError(pair.line, fmt::format("measurement '{}': a pair has {} markers",
                                                    one.name, names.size()));
    }
  });
  ForEach(element, "BodyScaleSet",
          [&](const XmlElement& body) { one.bodies.emplace_back(OsimName(body), ReadAxes(body)); });
  if (one.pairs.empty()) {
    diagnostics_->AddError(element.line,
                           fmt::format("measurement '{}' has no pair of markers", one.name));
  }
  setup_.measurements.push_back(std::move(one));
}

void SetupReader::ReadScaler(const XmlElement& scaler) {
  setup_.scales = Flag(scaler, "apply", true);
  setup_.keeps_mass_distribution = Flag(scaler, "preserve_mass_distribution", true);
  setup_.scaling_time = ReadTimes(scaler);
  const std::vector<std::string> order = Words(OsimText(scaler, "scaling_order"));
  const auto at = [&order](const char* step) {
    return std::find_if(order.begin(), order.end(),
                        [step](const std::string& word) { return EqualIgnoringCase(word, step); });
  };
  const auto measured = at("measurements");
  const auto manual = at("manualScale");
  setup_.measures_first = measured <= manual;
  if (order.empty() || measured != order.end()) {
    ForEach(scaler, "MeasurementSet", [&](const XmlElement& one) { ReadMeasurement(one); });
  }
  if (order.empty() || manual != order.end()) {
    ForEach(scaler, "ScaleSet", [&](const XmlElement& one) {
      if (!one.Is("Scale") || !Flag(one, "apply", true)) return;
      setup_.factors.push_back({std::string(OsimText(one, "segment")),
                                ReadOsimVector(one, "scales", Vector3d::Ones(), diagnostics_)});
    });
  }
}

void SetupReader::ReadPlacer(const XmlElement& placer) {
  setup_.places_markers = Flag(placer, "apply", true);
  if (!setup_.places_markers) return;
  setup_.placing_time = ReadTimes(placer);
  WithSet(placer, "IKTaskSet",
          [&](const XmlElement& set) { setup_.tasks = ReadIkTasks(set, diagnostics_); });
}

ScaleSetup SetupReader::Read(const XmlElement& tool) {
  const double mass = ReadOsimNumber(tool, "mass", -1, diagnostics_);
  if (mass > 0) setup_.mass = mass;
  if (const XmlElement* maker = tool.FindChild("GenericModelMaker")) {
    setup_.marker_file = FileOf(*maker, "marker_set_file");
  }
  const XmlElement* scaler = tool.FindChild("ModelScaler");
  setup_.scales = scaler != nullptr;
  if (scaler != nullptr) ReadScaler(*scaler);
  const XmlElement* placer = tool.FindChild("MarkerPlacer");
  setup_.places_markers = placer != nullptr;
  if (placer != nullptr) ReadPlacer(*placer);
  diagnostics_->ThrowIfErrors();
  return std::move(setup_);
}

}  // namespace

ScaleSetup ParseScaleSetup(std::string_view content, const std::string& file,
                           const OsimPartReader& read_part) {
  Diagnostics diagnostics(file);
  return SetupReader(read_part, &diagnostics).Read(ParseOsimPart(content, file, "ScaleTool"));
}

}  // namespace mmm_converter
