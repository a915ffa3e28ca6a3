// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/python/requests.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <map>
#include <tuple>

#include "MMMConverterS2KF/python/module.h"
#include "common/pipeline/comparison/comparison_setup.h"
#include "common/pipeline/dynamics/dynamics_check.h"
#include "common/support/error.h"

namespace mmm_converter::python {

namespace py = pybind11;

namespace {

constexpr Medium kMedium = Medium::kPython;

// The package's functions that have options.
const std::map<std::string, Task> kTasks = {
    {"calibrate", task::kCalibrate}, {"check_dynamics", task::kCheckDynamics},
    {"compare", task::kCompare},     {"convert", task::kConvert},
    {"label", task::kLabel},         {"learn_markers", task::kLearnMarkers},
    {"live", task::kLive},           {"read", task::kRead},
    {"read_model", task::kModel},    {"retarget", task::kRetarget}};

// A value as the command line has it.
std::string TextOfValue(const py::handle& value, OptionKind kind) {
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (kind == OptionKind::kSwitch)
    return py::bool_(py::reinterpret_borrow<py::object>(value)) ? "true" : "false";
  if (kind == OptionKind::kNumber) return fmt::format("{}", value.cast<double>());
  if (kind == OptionKind::kWhole) return fmt::format("{}", value.cast<long>());
  if (kind == OptionKind::kFrames) {
    const auto frames = value.cast<std::pair<std::optional<long>, std::optional<long>>>();
    const auto text = [](const std::optional<long>& frame) {
      return frame ? fmt::format("{}", *frame) : "";
    };
    return text(frames.first) + ':' + text(frames.second);
  }
  return py::module_::import("os").attr("fspath")(value).cast<std::string>();
}

std::vector<std::string> TextsOfValue(const py::handle& value, const Option& option) {
  const bool is_one =
      !IsList(option) || py::isinstance<py::str>(value) || py::hasattr(value, "__fspath__");
  if (is_one) return {TextOfValue(value, option.value.kind)};
  std::vector<std::string> texts;
  for (const py::handle one : value) texts.push_back(TextOfValue(one, option.value.kind));
  return texts;
}

// For people, and for programs that check types.
struct KeywordType {
  const char* words;
  const char* annotation;
};

KeywordType TypeOf(const Option& option) {
  constexpr const char* kPath = "Union[str, os.PathLike]";
  static const std::map<OptionKind, KeywordType> types = {
      {OptionKind::kSwitch, {"bool", "bool"}},
      {OptionKind::kNumber, {"float", "float"}},
      {OptionKind::kWhole, {"int", "int"}},
      {OptionKind::kFrames, {"(int, int)", "Tuple[Optional[int], Optional[int]]"}},
      {OptionKind::kFile, {"path", kPath}},
      {OptionKind::kShipped, {"str or path", kPath}},
      {OptionKind::kSubject, {"path, Subject or Calibration", "Any"}}};
  if (IsList(option) && option.value.kind == OptionKind::kFile) {
    return {"sequence of path", "Sequence[Union[str, os.PathLike]]"};
  }
  if (IsList(option)) return {"sequence of path, Subject or Calibration", "Sequence[Any]"};
  const auto found = types.find(option.value.kind);
  return found == types.end() ? KeywordType{"str", "str"} : found->second;
}

// What a motion's file is written with, of which postures that are given one by one have none.
bool IsOfWriting(const Option& option) {
  const std::string name = option.names.keyword;
  return name == "format" || name == "model_path";
}

// Of each keyword its name, type in words, annotation, and help.
py::list OptionsOf(const std::string& name) {
  const Task task = kTasks.at(name);
  std::vector<Option> table = DescribedOptions();
  static ComparisonOptions comparison;
  static DynamicsOptions dynamics;
  for (const auto& more : {Options(&comparison), Options(&dynamics)}) {
    table.insert(table.end(), more.begin(), more.end());
  }
  py::list options;
  for (const Option& option : table) {
    if ((option.tasks & task) == 0 || *option.names.keyword == 0) continue;
    if (task == task::kLive && IsOfWriting(option)) continue;
    const KeywordType type = TypeOf(option);
    options.append(py::make_tuple(option.names.keyword, type.words, type.annotation,
                                  HelpOf(kMedium, option, task)));
  }
  return options;
}

}  // namespace

void ReadKeywords(const py::dict& options, const std::vector<Option>& table) {
  for (const Option& option : table) {
    const char* const name = option.names.keyword;
    if (*name == 0 || !options.contains(name) || options[name].is_none()) continue;
    const py::object value = options[name];
    std::vector<std::string> texts;
    try {
      texts = TextsOfValue(value, option);
    } catch (const py::cast_error&) {
      throw py::type_error(fmt::format("{}: {} is not allowed; it is {}", name,
                                       py::repr(value).cast<std::string>(), TypeOf(option).words));
    }
    const std::string expected = SetOption(option, texts);
    if (expected.empty()) continue;
    throw Error(fmt::format("{}: {} is not allowed; {}", name, py::repr(value).cast<std::string>(),
                            expected));
  }
}

ConversionRequest RequestOf(const py::dict& options) {
  ConversionRequest request;
  ReadKeywords(options, Options(&request));
  request.input.file = TextOf(options, "file");
  if (IsSet(options, "recording")) {
    const auto& read = options["recording"].cast<const ReadRecordingResult&>();
    request.input.recording = {read.recording, read.warnings};
    request.input.file = read.recording->file;
  }
  return request;
}

std::string TextOf(const py::dict& options, const char* key) {
  if (!options.contains(key) || options[key].is_none()) return "";
  return TextOfValue(py::object(options[key]), OptionKind::kFile);
}

bool IsSet(const py::dict& options, const char* key) {
  return options.contains(key) && py::bool_(options[key]);
}

void BindOptions(py::module_* module) {
  module->def("options", &OptionsOf);
  module->def("tasks", [] {
    std::vector<std::string> names;
    names.reserve(std::size(kTasks));
    for (const auto& [name, task] : kTasks) names.push_back(name);
    return names;
  });
}

}  // namespace mmm_converter::python
