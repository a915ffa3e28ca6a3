// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/python/advice.h"

#include <algorithm>

namespace mmm_converter::python {
namespace {

// Continues the library's message.
const char* KeywordFor(Remedy remedy) {
  switch (remedy) {
    case Remedy::kNone:
      return "";
    case Remedy::kHeight:
      return ", e.g. height=1.75";
    case Remedy::kMass:
      return ", e.g. mass=70";
    case Remedy::kRate:
      return " (rate=HZ)";
    case Remedy::kFrames:
      return " (frames=(A, B))";
    case Remedy::kSubjectPrefix:
      return " (prefix=\"NAME\")";
    case Remedy::kMotion:
      return " (motion=\"NAME\")";
    case Remedy::kMarkerSet:
      return " (marker_set=\"FILE\"); points without names get them by label()";
    case Remedy::kModel:
      return " (model=\"FILE\")";
    case Remedy::kIgnoreResiduals:
      return " (ignore_residuals=True)";
    case Remedy::kLabels:
      return "; label() finds the names of points that have none";
    case Remedy::kUnit:
      return " (another by unit=\"UNIT\")";
    case Remedy::kUpAxis:
      return " (another by up=\"AXIS\")";
  }
  return "";
}

// "subject-file": "subject_file=".
std::string Keyword(const std::string& option) {
  if (option == "subject") return "prefix=";
  std::string keyword = option + "=";
  std::replace(keyword.begin(), keyword.end(), '-', '_');
  return keyword;
}

}  // namespace

Wording KeywordWording() { return {&Keyword, &KeywordFor}; }

}  // namespace mmm_converter::python
