// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/support/error.h"

namespace mmm_converter {

/// The program was called in a way that it does not understand: exit code 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

struct OptionSpec {
  std::string name;      ///< long name, and a short one behind a comma: "output,o"
  std::string argument;  ///< what help calls the value; empty: a switch
  std::string help;
  std::string alias;  ///< MMMMotionConverter's name for it; may be empty
};

struct OptionGroup {
  std::string title;
  std::vector<OptionSpec> options;
};

/// What a command was given.
class Arguments {
 public:
  bool Has(const std::string& name) const { return values_.count(name) > 0; }
  std::optional<std::string> Get(const std::string& name) const;
  /// @throws UsageError where the value is not a finite number. unit, for the message: "metres".
  std::optional<double> GetNumber(const std::string& name, const std::string& unit) const;
  const std::optional<std::string>& positional() const { return positional_; }

 private:
  friend Arguments ParseArguments(const std::string&, const std::vector<OptionGroup>&,
                                  const std::vector<std::string>&);
  std::map<std::string, std::string> values_;
  std::optional<std::string> positional_;
};

/// At most one positional argument; every option at most once, under its name or its alias.
/// @throws UsageError, for an unknown option with what is near.
Arguments ParseArguments(const std::string& command, const std::vector<OptionGroup>& groups,
                         const std::vector<std::string>& words);

/// The options as help text.
std::string FormatOptions(const std::vector<OptionGroup>& groups);

}  // namespace mmm_converter
