// SPDX-License-Identifier: MIT
#pragma once

#include "MMMConverterS2KF/report/file_kinds.h"
#include "MMMConverterS2KF/report/json.h"

namespace mmm_converter {

// The describers of the table of kinds: see FileKind.

Description DescribeC3d(const FileStart& file, const ReadRecordingOptions& options);
Description DescribeMarkerTable(const FileStart& file, const ReadRecordingOptions& options);
Description DescribeMotions(const FileStart& file, const ReadRecordingOptions& options);
Description DescribeModel(const FileStart& file, const ReadRecordingOptions& options);
Description DescribeOsim(const FileStart& file, const ReadRecordingOptions& options);
Description DescribeConfiguration(const FileStart& file, const ReadRecordingOptions& options);
Description DescribeMarkerSet(const FileStart& file, const ReadRecordingOptions& options);
Description DescribeSubjectFile(const FileStart& file, const ReadRecordingOptions& options);
Description DescribePerson(const FileStart& file, const ReadRecordingOptions& options);
Description DescribePlugin(const FileStart& file, const ReadRecordingOptions& options);
Description DescribePage(const FileStart& file, const ReadRecordingOptions& options);
Description DescribeSummary(const FileStart& file, const ReadRecordingOptions& options);
Description DescribeSampleSet(const FileStart& file, const ReadRecordingOptions& options);

bool IsNpz(const FileStart& file);
Description DescribeNpz(const FileStart& file, const ReadRecordingOptions& options);
bool IsBvh(const FileStart& file);
Description DescribeBvh(const FileStart& file, const ReadRecordingOptions& options);

// Of robots, as files of robot learning have them.
bool IsLafanTable(const FileStart& file);
Description DescribeLafanTable(const FileStart& file, const ReadRecordingOptions& options);
bool IsPickle(const FileStart& file);
Description DescribePickle(const FileStart& file, const ReadRecordingOptions& options);

/// A table of the program's own: of its first line.
bool IsTable(const FileStart& file);
Description DescribeTable(const FileStart& file, const ReadRecordingOptions& options);

}  // namespace mmm_converter
