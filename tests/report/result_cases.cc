// SPDX-License-Identifier: MIT
#include "tests/report/result_cases.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/math/seeded_random.h"
#include "tests/report/comparison_cases.h"

namespace mmm_converter::testing {
namespace {

// Four decimals, as in results.jsonl.
double Rounded(double value) { return std::round(value * 1e4) / 1e4; }

// What is known of an entry before it is converted; no figures.
Json Unconverted(const std::string& id, const std::string& group, const std::string& reason) {
  return {{"id", id},
          {"state", "failed"},
          {"reason", reason},
          {"recording", id + ".c3d"},
          {"group", group},
          {"metadata", {{"session", "2"}}},
          {"motion", nullptr},
          {"report", nullptr},
          {"frames", nullptr},
          {"distance_mm", nullptr},
          {"ms_per_frame", nullptr},
          {"seconds", 0.01},
          {"warnings", Json::array()}};
}

Json Converted(const std::string& id, const std::string& group, SeededRandom* random) {
  const double mean = 20 + 8 * std::abs(random->Normal());
  const int frames = 500 + random->UniformIndex(1000);
  Json result = Unconverted(id, group, "");
  result["state"] = "converted";
  result["reason"] = nullptr;
  result["motion"] = "motions/" + id + ".xml";
  result["frames"] = frames;
  result["rate_hz"] = 100.0;
  result["height_m"] = 1.68;
  result["height_source"] = "given";
  result["mass_kg"] = 62.0;
  result["mass_source"] = "given";
  result["subject"] = nullptr;
  result["converter"] = "S2KFConverter";
  result["configuration"] = "s2kf_default";
  result["markers_used"] = 50;
  result["markers_absent"] = random->UniformIndex(4);
  result["markers_ignored"] = 0;
  result["distance_mm"] = {
      {"mean", Rounded(mean)}, {"p95", Rounded(1.6 * mean)}, {"max", Rounded(4 * mean)}};
  result["worst_marker"] = random->Uniform() < 0.5 ? "RASI" : "LFWT";
  result["worst_marker_mm"] = Rounded(2 * mean);
  result["frames_with_missing_markers"] = random->UniformIndex(100);
  result["frames_not_converged"] = random->Uniform() < 0.8 ? 0 : random->UniformIndex(frames / 2);
  result["frames_reassembled"] = 0;
  result["wrong_markers"] = random->UniformIndex(3);
  result["process_noise_scale"] = nullptr;
  result["nis_over_degrees_of_freedom"] = Rounded(1 + 0.1 * random->Normal());
  const double milliseconds = 0.3 + 0.05 * std::abs(random->Normal());
  result["ms_per_frame"] = {{"median", Rounded(milliseconds)}, {"p99", Rounded(4 * milliseconds)}};
  result["seconds"] = Rounded(0.001 * frames * milliseconds);
  return result;
}

}  // namespace

std::vector<Json> ManyResults(int count) {
  SeededRandom random(1);
  std::vector<Json> results;
  results.reserve(count);
  for (int i = 0; i < count; ++i) {
    const std::string group = std::to_string(1000 + i / 40);
    const std::string id = fmt::format("files_motions_{}/Recording_{:06}", group, i);
    Json result = Converted(id, group, &random);
    if (i % 50 == 13) {
      result = Unconverted(id, group, "no marker of the recording stands for one of the model");
    } else if (i % 100 == 77) {
      result = Unconverted(id, group, "no shard has converted it");
      result["state"] = "missing";
    } else if (i % 10 == 0) {
      result["warnings"] = {fmt::format("{} frames have no markers at all", i % 7 + 1)};
      result["report"] = "reports/" + id + ".html";
    }
    results.push_back(result);
  }
  return results;
}

std::vector<Json> HostileResults() {
  const std::string text = kHostileText;
  SeededRandom random(2);
  Json odd = Converted("a b/50%#1?x=\\'\"<", text, &random);  // a path that needs escaping
  odd["report"] = "reports/a b/50%#1?x=\\'\"<.html";
  odd["warnings"] = {text, text};
  odd["metadata"] = {{text, text}, {"__proto__", "session"}, {"constructor", nullptr}};
  odd["worst_marker"] = text;
  odd["distance_mm"] = {{"mean", 1e300}, {"p95", -5}, {"max", nullptr}};
  std::vector<Json> results = {odd};
  for (const char* path : {"javascript:window.hacked=3", "JavaScript:alert(1)", "//elsewhere/x",
                           "/etc/x", "https://elsewhere/x", "data:text/html,x", ""}) {
    Json linked = Converted(text + path, text, &random);
    linked["report"] = path;
    linked["motion"] = path;
    results.push_back(linked);
  }
  results.push_back(Unconverted(text, text, text));
  Json missing = Unconverted(text, text, text);
  missing["state"] = "missing";
  missing["reason"] = nullptr;
  results.push_back(missing);
  results.push_back(Json::object());
  results.push_back(
      Json::parse(R"({"id":null,"state":"converted","motion":[1],"report":{"a":1},"metadata":[],)"
                  R"("distance_mm":7,"frames":0,"frames_not_converged":0,"warnings":"none",)"
                  R"("__proto__":{"state":"x"},"group":["g"]})"));
  return results;
}

std::vector<Json> FailedResults(int count) {
  std::vector<Json> results;
  results.reserve(count);
  for (int i = 0; i < count; ++i) {
    const std::string id = fmt::format("broken/{}", i);
    results.push_back(Unconverted(id, "broken", id + ".c3d: no such file"));
  }
  return results;
}

}  // namespace mmm_converter::testing
