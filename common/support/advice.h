// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "common/support/error.h"

namespace mmm_converter {

/// How a program's users give what the library's messages ask for.
struct Wording {
  std::function<std::string(const std::string& name)> option;  ///< by its plain name: "height"
  std::function<std::string(Remedy remedy)> advice;            ///< continues a message; or ""
};

/// A program says so once, before it has threads. Without, options have their plain names, and
/// there is no advice.
void SetWording(const Wording& wording);

/// An option as the program's users write it.
std::string OptionText(const std::string& name);

/// What went wrong, and what the user can do, where that is known.
std::string WithAdvice(const std::string& failure, Remedy remedy);
std::string WithAdvice(const Error& error);

}  // namespace mmm_converter
