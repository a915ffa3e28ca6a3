// SPDX-License-Identifier: MIT
#include "tests/xml_config/xmllint.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter::testing {

bool IsValidFile(const std::string& schema, const std::string& file) {
  const std::filesystem::path folder = SourcePath("xml_config/schema");
  const std::string command = std::string(XMLLINT) + " --noout --nonet --schema '" +
                              (folder / schema).string() + "' '" + file + "' 2>&1";
  return std::system(command.c_str()) == 0;
}

bool IsValidText(const std::string& schema, const std::string& xml) {
  const std::string file = TestFolder() + "/checked.xml";
  std::ofstream(file) << xml;
  return IsValidFile(schema, file);
}

}  // namespace mmm_converter::testing
