// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/terminal/manual.h"

namespace mmm_converter {

std::string FormatHelp(const Manual& manual) {
  std::string help = manual.text;
  const std::size_t place = help.find(kPlaceOfOptions);
  if (place != std::string::npos) {
    help.replace(place, std::string(kPlaceOfOptions).size(), FormatOptions(manual.options));
  }
  return help;
}

std::vector<std::string> NamesOf(const OptionSpec& option) {
  const std::size_t comma = option.name.find(',');
  std::vector<std::string> names = {"--" + option.name.substr(0, comma)};
  if (comma != std::string::npos) names.push_back("-" + option.name.substr(comma + 1));
  return names;
}

}  // namespace mmm_converter
