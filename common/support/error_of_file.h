// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/support/error.h"

namespace mmm_converter {

/// What the action gives. An Error that does not begin with the name of the file gets it in front.
template <typename Action>
auto OfFile(const std::string& file, const Action& action) {
  try {
    return action();
  } catch (const Error& error) {
    const std::string what = error.what();
    if (what.starts_with(file)) throw;
    throw Error(file + ": " + what, error.remedy());
  }
}

/// The same of a file that another one names, which its Errors then say.
template <typename Action>
auto NamedBy(const std::string& file, const Action& action) {
  try {
    return action();
  } catch (const Error& error) {
    throw Error(std::string(error.what()) + " (named by " + file + ")", error.remedy());
  }
}

}  // namespace mmm_converter
