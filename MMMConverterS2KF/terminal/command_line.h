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
  std::string alias;        ///< MMMMotionConverter's name for it; may be empty
  bool repeatable = false;  ///< may be given several times
};

struct OptionGroup {
  std::string title;  ///< empty: its options are understood, but no help names them
  std::vector<OptionSpec> options;
};

/// What a command was given.
class Arguments {
 public:
  bool Has(const std::string& name) const { return values_.count(name) > 0; }
  std::optional<std::string> Get(const std::string& name) const;
  /// @throws UsageError where the value is none of the choices, which the message lists.
  std::string GetChoice(const std::string& name, const std::vector<std::string>& choices,
                        const std::string& otherwise) const;
  /// @throws UsageError where the value is not a finite number. unit, for the message: "metres".
  std::optional<double> GetNumber(const std::string& name, const std::string& unit) const;
  std::optional<int> GetInteger(const std::string& name, int minimum, int maximum) const;
  /// Of a repeatable option, in order.
  std::vector<std::string> GetAll(const std::string& name) const;
  /// What the i-th of the positional arguments was given: of these repeatable options, which stand
  /// there once for all or once for each, the i-th value.
  /// @throws UsageError where one is there another number of times.
  Arguments ForPositional(int i, const std::vector<std::string>& options) const;
  const std::vector<std::string>& positionals() const { return positionals_; }
  std::optional<std::string> positional() const {  ///< the first
    return positionals_.empty() ? std::nullopt : std::optional(positionals_.front());
  }

 private:
  friend Arguments ParseArguments(const std::string&, const std::vector<OptionGroup>&,
                                  const std::vector<std::string>&, bool);
  std::map<std::string, std::vector<std::string>> values_;
  std::vector<std::string> positionals_;
};

/// At most one positional argument unless several are allowed; every option that is not repeatable
/// at most once, under its name or its alias.
/// @throws UsageError, for an unknown option with what is near.
Arguments ParseArguments(const std::string& command, const std::vector<OptionGroup>& groups,
                         const std::vector<std::string>& words, bool several_positionals = false);

/// The options as help text.
std::string FormatOptions(const std::vector<OptionGroup>& groups);

}  // namespace mmm_converter
