// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/shared_inputs.h"

#include <filesystem>
#include <vector>

#include "common/io/bytes/file_content.h"
#include "common/io/mjcf/mjcf_robot.h"
#include "common/pipeline/dynamics/retarget_objects.h"
#include "common/support/content_hash.h"
#include "common/support/data_directory.h"
#include "common/support/folder.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRobotBytes = std::size_t{8} << 20;

std::string HashProgram() {
  std::vector<std::string> files = {"/proc/self/exe", LibraryFile()};
  const std::vector<std::string> sets = FilesIn(DataDirectory() + "/marker_sets", ".xml");
  files.insert(files.end(), sets.begin(), sets.end());
  ContentHash hash;
  hash.AddPart(MMM_CONVERTER_VERSION);
  for (const std::string& file : files) {
    if (fs::is_regular_file(file)) hash.AddPart(HashFile(file));
  }
  return hash.Hex();
}

}  // namespace

SharedInputs::SharedInputs() : program_(HashProgram()) {}

ReadBefore SharedInputs::ReadFor(const ConversionRequest& request) {
  const std::scoped_lock lock(mutex_);
  auto& model = models_[ModelFile(request.input) + '\n' + request.input.marker_file];
  if (!model.value) model = ReadModelOnce(request.input);
  const ConverterRequest& converter = request.converter;
  auto& choice =
      choices_[converter.config + '\n' + converter.converter + '\n' + converter.plugin_file];
  if (!choice.value) choice = ChooseOnce(converter);
  return {model, choice, {}};
}

std::string SharedInputs::Fingerprint(const BatchEntry& entry, const ConverterChoice& choice) {
  const ConversionRequest& request = entry.request;
  const ConverterConfig& config = choice.config;
  ContentHash hash;
  hash.AddPart(program_);
  hash.AddPart(FileHash(choice.plugin->path()));
  hash.AddPart(choice.text);
  hash.AddPart(FileHash(ModelFile(request.input)));
  hash.AddPart(fs::path(request.input.file).filename().string());
  for (const auto& [name, value] : entry.settings) {
    hash.AddPart(name);
    hash.AddPart(value);
  }
  const std::string own_set = (fs::path(config.file).parent_path() / config.marker_set).string();
  std::vector<std::string> files = FilesOf(request.label_hints);
  files.insert(files.end(), {request.input.person.processor_file, request.input.person.subject_file,
                             config.subject_file, own_set, request.input.marker_set,
                             request.input.marker_file, request.robot.map_file});
  for (const std::string& object : request.robot.objects) files.push_back(FileOfObjects(object));
  for (const std::string& file : files) {
    std::error_code failure;
    hash.AddPart(fs::is_regular_file(file, failure) ? FileHash(file) : "");
  }
  if (!request.robot.file.empty()) hash.AddPart(RobotHash(request.robot.file));
  return hash.Hex();
}

std::string SharedInputs::FileHash(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  std::string& hash = hashes_[path];
  if (hash.empty()) hash = HashFile(path);
  return hash;
}

std::string SharedInputs::RobotHash(const std::string& path) {
  {
    const std::scoped_lock lock(mutex_);
    if (const auto known = robots_.find(path); known != robots_.end()) return known->second;
  }
  std::vector<std::string> files = {path};
  if (IsMjcf(ReadFileContent(path, kMostRobotBytes))) ReadMjcf(path, nullptr, &files);
  ContentHash hash;
  for (const std::string& file : files) hash.AddPart(FileHash(file));
  const std::scoped_lock lock(mutex_);
  return robots_[path] = hash.Hex();
}

}  // namespace mmm_converter
