// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/terminal/advice.h"

namespace mmm_converter {
namespace {

// Continues the library's message.
const char* AdviceFor(Remedy remedy) {
  switch (remedy) {
    case Remedy::kNone:
      return "";
    case Remedy::kHeight:
      return ", e.g. --height 1.75";
    case Remedy::kMass:
      return ", e.g. --mass 70";
    case Remedy::kRate:
      return " (--rate HZ)";
    case Remedy::kFrames:
      return " (--frames A:B)";
    case Remedy::kSubjectPrefix:
      return " (--subject NAME)";
    case Remedy::kMotion:
      return " (--motion NAME)";
    case Remedy::kMarkerSet:
      return " (--marker-set FILE); points without names get them by the command label";
    case Remedy::kModel:
      return " (--model FILE)";
    case Remedy::kIgnoreResiduals:
      return " (--ignore-residuals)";
    case Remedy::kLabels:
      return "; the command label finds the names of points that have none";
  }
  return "";
}

}  // namespace

std::string WithAdvice(const Error& error) { return WithAdvice(error.what(), error.remedy()); }

std::string WithAdvice(const std::string& failure, Remedy remedy) {
  return failure + AdviceFor(remedy);
}

}  // namespace mmm_converter
