// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/shared_inputs.h"

#include <filesystem>
#include <vector>

#include "common/io/robot/robot_file.h"
#include "common/pipeline/dynamics/retarget_objects.h"
#include "common/support/content_hash.h"
#include "common/support/data_directory.h"
#include "common/support/folder.h"
#include "common/support/opened_files.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

std::string HashProgram() {
  std::vector<std::string> files = {"/proc/self/exe", LibraryFile()};
  for (const char* folder : {"", "/marker_sets"}) {
    const std::vector<std::string> data = FilesIn(DataDirectory() + folder, ".xml");
    files.insert(files.end(), data.begin(), data.end());
  }
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
  const OpenedFiles opened;
  auto& model = models_[ModelFile(request.input) + '\n' + request.input.marker_file];
  if (!model.value.value) {
    const OpenedFiles of_model;
    model.value = ReadModelOnce(request.input);
    model.opened = of_model.files();
  }
  const ConverterRequest& converter = request.converter;
  auto& choice =
      choices_[converter.config + '\n' + converter.converter + '\n' + converter.plugin_file];
  if (!choice.value.value) {
    const OpenedFiles of_choice;
    choice.value = ChooseOnce(converter);
    choice.opened = of_choice.files();
  }
  OpenedFiles::Note(model.opened);
  OpenedFiles::Note(choice.opened);
  return {model.value, choice.value, {}, {}, opened.files()};
}

std::set<std::string> SharedInputs::FilesOf(const BatchEntry& entry,
                                            const ReadBefore& read_before) {
  const ConversionRequest& request = entry.request;
  const ConverterConfig& config = read_before.choice.value->config;
  const OpenedFiles files;
  OpenedFiles::Note(read_before.opened);
  const std::string own_set = (fs::path(config.file).parent_path() / config.marker_set).string();
  std::vector<std::string> named = mmm_converter::FilesOf(request.label_hints);
  named.insert(named.end(), {request.input.person.processor_file, request.input.person.subject_file,
                             config.subject_file, own_set, request.input.marker_set,
                             request.input.forces_file, request.robot.map_file});
  for (const std::string& object : request.robot.objects) named.push_back(FileOfObjects(object));
  std::error_code failure;
  for (const std::string& file : named) {
    if (fs::is_regular_file(file, failure)) OpenedFiles::Note(file);
  }
  if (!request.robot.file.empty()) OpenedFiles::Note(FilesOfRobot(request.robot.file));
  return files.files();
}

std::string SharedInputs::Fingerprint(const BatchEntry& entry, const ReadBefore& read_before) {
  ContentHash hash;
  hash.AddPart(program_);
  hash.AddPart(read_before.choice.value->text);
  hash.AddPart(fs::path(entry.request.input.file).filename().string());
  for (const auto& [name, value] : entry.settings) {
    hash.AddPart(name);
    hash.AddPart(value);
  }
  std::multiset<std::string> hashes;  // folders may be moved; the settings say what is what
  for (const std::string& file : FilesOf(entry, read_before)) hashes.insert(FileHash(file));
  for (const std::string& one : hashes) hash.AddPart(one);
  return hash.Hex();
}

std::string SharedInputs::FileHash(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  std::string& hash = hashes_[path];
  if (hash.empty()) hash = HashFile(path);
  return hash;
}

std::set<std::string> SharedInputs::FilesOfRobot(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  std::set<std::string>& files = robots_[path];
  if (!files.empty()) return files;
  const OpenedFiles opened;
  ReadRobotFile(path, nullptr);
  return files = opened.files();
}

}  // namespace mmm_converter
