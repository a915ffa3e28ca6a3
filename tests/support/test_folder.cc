// SPDX-License-Identifier: MIT
#include "tests/support/test_folder.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>

namespace mmm_converter::testing {
namespace {

/// Owned by GoogleTest, which tells it of every test's end.
class FolderOfTest : public ::testing::EmptyTestEventListener {
 public:
  static FolderOfTest& Get() {
    static FolderOfTest* const listener = [] {
      auto* made = new FolderOfTest;
      ::testing::UnitTest::GetInstance()->listeners().Append(made);
      return made;
    }();
    return *listener;
  }

  const std::string& Path() {
    if (!folder_) folder_.emplace();
    return folder_->path();
  }

 private:
  void OnTestEnd(const ::testing::TestInfo& /*test*/) override { folder_.reset(); }

  std::optional<TemporaryFolder> folder_;
};

}  // namespace

TemporaryFolder::TemporaryFolder()
    : path_(std::filesystem::temp_directory_path() / "mmm_converter_test_XXXXXX") {
  if (mkdtemp(path_.data()) == nullptr)
    throw std::system_error(errno, std::generic_category(), path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

const std::string& TestFolder() { return FolderOfTest::Get().Path(); }

}  // namespace mmm_converter::testing
