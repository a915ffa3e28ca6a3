// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/live/live_file_kinds.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/live/motion_journal.h"
#include "MMMConverterS2KF/report/json.h"

namespace mmm_converter {
namespace {

bool IsLiveJournal(const FileStart& file) { return file.head.starts_with("{\"journal\":"); }

Description DescribeLiveJournal(const FileStart& file, const ReadRecordingOptions&) {
  Description description;
  const JournalContent content = ReadJournal(file.path, &description.warnings);
  const JournalHeader& header = content.header;
  const MarkerSequence& markers = content.markers;
  const double seconds = content.frames > 0 ? markers.num_frames() / markers.rate() : 0;
  description.text = fmt::format(
      "{}: journal of a live motion that is coming, or whose process was killed\n", file.path);
  if (content.frames == 0) {
    description.text += "motion     no frame was tracked; there is nothing to recover\n";
  } else {
    description.text += fmt::format(
        "motion     {}, {} frames in {:.1f} s\n"
        "recover    the next live run with -o {} writes it beside that file first; for instance\n"
        "           MMMConverterS2KF live SOURCE -o {}\n",
        header.motion.motion_name, content.frames, seconds, header.output, header.output);
  }
  description.json = FormatJson({{"kind", "live journal"},
                                 {"file", file.path},
                                 {"motion", header.motion.motion_name},
                                 {"output", header.output},
                                 {"frames", content.frames},
                                 {"seconds", Number(seconds)},
                                 {"warnings", description.warnings.texts()}});
  return description;
}

}  // namespace

const std::vector<FileKind>& LiveFileKinds() {
  static const std::vector<FileKind> kKinds = {
      {"journals of live motions", IsLiveJournal, DescribeLiveJournal}};
  return kKinds;
}

}  // namespace mmm_converter
