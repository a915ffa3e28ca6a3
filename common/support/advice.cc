// SPDX-License-Identifier: MIT
#include "common/support/advice.h"

namespace mmm_converter {
namespace {

Wording& TheWording() {
  static Wording wording = {[](const std::string& name) { return name; },
                            [](Remedy /*remedy*/) { return std::string(); }};
  return wording;
}

}  // namespace

void SetWording(const Wording& wording) { TheWording() = wording; }

std::string OptionText(const std::string& name) { return TheWording().option(name); }

std::string WithAdvice(const std::string& failure, Remedy remedy) {
  return failure + TheWording().advice(remedy);
}

std::string WithAdvice(const Error& error) { return WithAdvice(error.what(), error.remedy()); }

}  // namespace mmm_converter
