// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/batch_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "MMMConverterS2KF/report/conversion_summary.h"

namespace mmm_converter {
namespace {

using Json = nlohmann::ordered_json;

std::string Dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

double Rounded(double seconds) { return std::round(seconds * 1e3) / 1e3; }

// The label with the largest mean distance, and that distance.
std::pair<Json, Json> WorstMarker(const Json& used) {
  std::pair<Json, Json> worst;
  for (const Json& marker : used) {
    const Json& distance = marker.at("distance_mm").at("mean");
    if (!distance.is_number()) continue;
    if (worst.second.is_null() || distance > worst.second) worst = {marker.at("label"), distance};
  }
  return worst;
}

Json TextOrNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += c;
    field += c;
  }
  field += '"';
  return field;
}

// Objects become columns "a.b", arrays of text one text.
void Flatten(const std::string& name, const Json& value, Json* row) {
  if (value.is_object()) {
    for (const auto& [key, part] : value.items()) {
      std::string column = name;
      if (!column.empty()) column += '.';
      Flatten(column += key, part, row);
    }
  } else if (value.is_array()) {
    std::string text;
    for (const Json& part : value) {
      text +=
          (text.empty() ? "" : "; ") + (part.is_string() ? part.get<std::string>() : Dump(part));
    }
    (*row)[name] = text;
  } else {
    (*row)[name] = value;
  }
}

std::string FormatCell(const Json& row, const std::string& column) {
  const auto cell = row.find(column);
  if (cell == row.end() || cell->is_null()) return "";
  return CsvField(cell->is_string() ? cell->get<std::string>() : Dump(*cell));
}

// Columns in the order of the first row that has them; those of metadata by name, after the others.
std::vector<std::string> Columns(const std::vector<Json>& rows) {
  constexpr const char* kMetadata = "metadata.";
  std::vector<std::string> columns;
  std::set<std::string> known;
  std::set<std::string> metadata;
  for (const Json& row : rows) {
    for (const auto& [name, value] : row.items()) {
      if (name.starts_with(kMetadata)) {
        metadata.insert(name);
      } else if (known.insert(name).second) {
        columns.push_back(name);
      }
    }
  }
  columns.insert(columns.end(), metadata.begin(), metadata.end());
  return columns;
}

}  // namespace

std::string FormatResult(const ConversionReport& report, double seconds) {
  const Json summary = Json::parse(FormatSummaryJson(report));
  const Json& person = summary.at("person");
  const Json& markers = summary.at("markers");
  const auto [worst_label, worst_distance] = WorstMarker(markers.at("used"));
  const std::string configuration =
      std::filesystem::path(report.converter.config.file).stem().string();
  return Dump(
      {{"state", "converted"},
       {"reason", nullptr},
       {"frames", summary.at("frames")},
       {"rate_hz", summary.at("rate_hz")},
       {"height_m", person.at("height_m")},
       {"height_source", person.at("height_source")},
       {"mass_kg", person.at("mass_kg")},
       {"mass_source", person.at("mass_source")},
       {"subject", report.person.subject ? Json(report.person.subject->name) : Json(nullptr)},
       {"converter", summary.at("converter")},
       {"configuration", configuration},
       {"markers_used", markers.at("used").size()},
       {"markers_absent", markers.at("absent").size()},
       {"markers_ignored", markers.at("ignored").size()},
       {"distance_mm", summary.at("distance_mm")},
       {"worst_marker", worst_label},
       {"worst_marker_mm", worst_distance},
       {"frames_with_missing_markers", summary.at("frames_with_missing_markers")},
       {"frames_not_converged", summary.at("frames_not_converged")},
       {"frames_reassembled", summary.at("frames_reassembled")},
       {"wrong_markers", summary.at("wrong_markers").size()},
       {"noise_scale", summary.at("noise_scale")},
       {"nis_over_degrees_of_freedom", summary.at("nis_over_degrees_of_freedom")},
       {"ms_per_frame", summary.at("ms_per_frame")},
       {"seconds", Rounded(seconds)},
       {"warnings", summary.at("warnings")}});
}

std::string FormatFailure(const std::string& reason, double seconds) {
  return Dump({{"state", "failed"}, {"reason", reason}, {"seconds", Rounded(seconds)}});
}

std::string FormatResultLine(const BatchEntry& entry, const std::string& result,
                             const std::string& motion, const std::string& report) {
  const Json known = result.empty()
                         ? Json{{"state", "missing"}, {"reason", "was not converted yet"}}
                         : Json::parse(result);
  Json line = {{"id", entry.id}, {"state", known.at("state")}, {"reason", known.at("reason")}};
  line["recording"] = entry.request.input.file;
  line["group"] = entry.group;
  line["metadata"] = entry.metadata;
  line["motion"] = TextOrNull(motion);
  line["report"] = TextOrNull(report);
  line.update(known);
  return Dump(line);
}

ResultFigures ReadFigures(const std::string& line) {
  const Json json = Json::parse(line);
  ResultFigures figures;
  figures.state = json.at("state").get<std::string>();
  const auto number = [](const Json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_number() ? found->get<double>() : 0;
  };
  figures.seconds = number(json, "seconds");
  if (figures.state != "converted") return figures;
  figures.mean_distance_mm = number(json.at("distance_mm"), "mean");
  figures.frames = static_cast<long>(number(json, "frames"));
  const double rate = number(json, "rate_hz");
  if (rate > 0) figures.recorded_seconds = static_cast<double>(figures.frames) / rate;
  figures.warnings = static_cast<int>(json.at("warnings").size());
  return figures;
}

std::string FormatResultsCsv(const std::vector<std::string>& lines) {
  std::vector<Json> rows(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) Flatten("", Json::parse(lines[i]), &rows[i]);
  const std::vector<std::string> columns = Columns(rows);
  std::string csv;
  for (const std::string& column : columns) csv += (csv.empty() ? "" : ",") + CsvField(column);
  csv += "\n";
  for (const Json& row : rows) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i > 0) csv += ',';
      csv += FormatCell(row, columns[i]);
    }
    csv += '\n';
  }
  return csv;
}

}  // namespace mmm_converter
