// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/subjects_table.h"

#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

void ReadSubjectsTableBytes(std::string_view bytes) { ReadSubjectsTable(FileOf(bytes)); }

}  // namespace mmm_converter::testing
