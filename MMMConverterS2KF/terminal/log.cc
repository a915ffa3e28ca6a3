// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/terminal/log.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <map>

#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/printable.h"

namespace mmm_converter {

void StartLog(const std::string& level) {
  static const std::map<std::string, spdlog::level::level_enum> levels = {
      {"off", spdlog::level::off},
      {"error", spdlog::level::err},
      {"warning", spdlog::level::warn},
      {"info", spdlog::level::info},
      {"debug", spdlog::level::debug}};
  const auto found = levels.find(level);
  if (found == levels.end()) {
    throw UsageError(fmt::format("--log: \"{}\" is not a level; use {}", level, kLogLevels));
  }
  auto logger = std::make_shared<spdlog::logger>(
      "MMMConverterS2KF", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
  logger->set_pattern("%^%l:%$ %v");
  logger->set_level(found->second);
  spdlog::set_default_logger(logger);
}

void LogError(const std::string& message) { spdlog::error("{}", Printable(message)); }
void LogWarning(const std::string& message) { spdlog::warn("{}", Printable(message)); }
void LogWarnings(const Warnings& warnings) {
  for (const Warning& warning : warnings.all()) LogWarning(warning.text);
}
void LogInfo(const std::string& message) { spdlog::info("{}", Printable(message)); }

}  // namespace mmm_converter
