// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/terminal/advice.h"

namespace mmm_converter {
namespace {

// Continues the library's message.
const char* OptionFor(Remedy remedy) {
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
      return " (--marker-set FILE); points without names get them by the command label, labels of "
             "an "
             "unknown meaning become a marker set by the command learn-markers";
    case Remedy::kModel:
      return " (--model FILE)";
    case Remedy::kIgnoreResiduals:
      return " (--ignore-residuals)";
    case Remedy::kLabels:
      return "; the command label finds the names of points that have none";
    case Remedy::kUnit:
      return " (another by --unit UNIT)";
    case Remedy::kUpAxis:
      return " (another by --up AXIS)";
  }
  return "";
}

// The same of a manifest of batch.
const char* AttributeFor(Remedy remedy) {
  switch (remedy) {
    case Remedy::kNone:
    case Remedy::kLabels:  // another command
      return "";
    case Remedy::kHeight:
      return "height_m=\"1.75\"";
    case Remedy::kMass:
      return "mass_kg=\"70\"";
    case Remedy::kRate:
      return "rate_hz=\"HZ\"";
    case Remedy::kFrames:
      return "frames=\"A:B\"";
    case Remedy::kSubjectPrefix:
      return "subject=\"NAME\"";
    case Remedy::kMotion:
      return "motion=\"NAME\"";
    case Remedy::kMarkerSet:
      return "markerSet=\"FILE\"";
    case Remedy::kModel:
      return "model=\"FILE\"";
    case Remedy::kIgnoreResiduals:
      return "ignoreResiduals=\"true\"";
    case Remedy::kUnit:
      return "unit=\"UNIT\"";
    case Remedy::kUpAxis:
      return "up=\"AXIS\"";
  }
  return "";
}

}  // namespace

Wording CommandLineWording() {
  return {[](const std::string& name) { return "--" + name; }, &OptionFor};
}

std::string WithManifestAdvice(const Error& error) {
  const std::string attribute = AttributeFor(error.remedy());
  return attribute.empty() ? error.what()
                           : error.what() + (" (in the manifest: " + attribute + ")");
}

}  // namespace mmm_converter
