// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/support/error.h"

namespace mmm_converter {

/// How a user asks for something.
enum class Medium { kCommandLine, kManifest, kPython };

/// What is done with what is asked for; a set of them is their union, a | b.
using Task = unsigned;
namespace task {
inline constexpr Task kConvert = 1;
inline constexpr Task kLabel = 1 << 1;
inline constexpr Task kCalibrate = 1 << 2;
inline constexpr Task kCompare = 1 << 3;
inline constexpr Task kEvaluate = 1 << 4;
inline constexpr Task kLearnMarkers = 1 << 5;
inline constexpr Task kReport = 1 << 6;
inline constexpr Task kLive = 1 << 7;
inline constexpr Task kServe = 1 << 8;
inline constexpr Task kRead = 1 << 9;  ///< a recording alone
inline constexpr Task kInfo = 1 << 10;
inline constexpr Task kCheckDynamics = 1 << 11;
inline constexpr Task kExportPoses = 1 << 12;
inline constexpr Task kModel = 1 << 13;  ///< of a person, without a recording
inline constexpr Task kRetarget = 1 << 14;
inline constexpr Task kBatch = 1 << 15;  ///< of a manifest, which has the other options
}  // namespace task

enum class OptionKind {
  kSwitch,
  kText,
  kNumber,
  kWhole,    ///< a whole number
  kChoice,   ///< Option::argument has all: "mm|cm|m|in"
  kFrames,   ///< "A:B"
  kAxis,     ///< "-y"
  kFile,     ///< or folder
  kShipped,  ///< a file, or the name of something that is installed
  kSubject   ///< a person's file; of Python also the person
};

/// Where a value goes; a function returns false where it is not what the kind expects.
using OptionTarget =
    std::variant<std::monostate, bool*, int*, std::uint64_t*, double*, std::optional<double>*,
                 std::string*, std::optional<std::string>*, std::vector<std::string>*,
                 std::function<bool(const std::string&)>>;

/// What an option is called; empty where a medium does not have it.
struct OptionNames {
  const char* line = "";       ///< in the command line, a short one behind a comma
  const char* attribute = "";  ///< in a manifest; a length in millimetres ends with _mm
  const char* keyword = "";    ///< in Python
};

struct OptionValue {
  OptionKind kind = OptionKind::kSwitch;
  const char* argument =
      "";                 ///< what help calls it; of a choice all, of an attribute's switch, too
  const char* unit = "";  ///< of a number, in words: "metres"
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
};

/// What few options have.
struct OptionNotes {
  const char* alias = "";       ///< MMMMotionConverter's name
  const char* absent = "";      ///< why a medium does not have it
  const char* with = "";        ///< the option that it says more of
  const char* of_motions = "";  ///< the default where finished motions are read
  Remedy remedy = Remedy::kNone;
};

/// Something that a user may ask for: a row of a table, from which come the command line with its
/// help, the attributes of a manifest with their schema, and the keywords of Python.
struct Option {
  OptionNames names;
  OptionValue value;
  const char* help = "";       ///< {name}: another option, as the medium calls it (Spell)
  const char* otherwise = "";  ///< the default, in words
  Task tasks = 0;
  OptionTarget to = {};
  OptionNotes notes = {};
  const char* group = "";  ///< of help
};

/// A row of a table.
Option Row(OptionNames names, OptionValue value, const char* help, const char* otherwise,
           Task tasks, OptionTarget to, OptionNotes notes = {}, const char* group = "");

/// Whether it may be given several times, or takes several values.
bool IsList(const Option& option);

/// The long name, without dashes.
std::string LongName(const Option& option);

/// As users write it, of the command line with its dashes; the plain name where the medium lacks
/// it.
std::string NameIn(Medium medium, const Option& option);

/// A text in which {name} is as the medium calls that option of the table.
std::string Spell(Medium medium, const std::string& text, const std::vector<Option>& table);

/// What a number of this attribute is given in [SI].
double UnitOfAttribute(const Option& option);

/// The values that are allowed where they are few.
std::vector<std::string> Choices(Medium medium, const Option& option);

/// Sets what the option goes to: to the last value, of a list to all. unit: of numbers [SI].
/// Returns what is expected where a value is something else, else nothing.
std::string SetOption(const Option& option, const std::vector<std::string>& values,
                      double unit = 1);

}  // namespace mmm_converter
