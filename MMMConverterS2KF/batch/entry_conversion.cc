// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/entry_conversion.h"

#include "MMMConverterS2KF/report/conversion_page.h"
#include "common/support/atomic_file.h"

namespace mmm_converter {

ConversionReport ConvertEntry(const BatchEntry& entry, const BatchFolder& folder,
                              ConversionRequest* request, const std::function<bool()>& goes_on) {
  request->builds_models = false;  // several recordings of an object need the same
  request->output = folder.Full(MotionPath(entry.id));
  for (const std::string& format : entry.exports) {
    request->exports[format] = folder.Full(ExportPath(format, entry.id));
  }
  if (request->self_calibrate) request->subject_output = folder.Full(SubjectPath(entry.id));
  return RunConversion(*request, [&](int, int) { return goes_on(); });
}

void WritePage(const BatchEntry& entry, const ConversionReport& report, BatchFolder* folder) {
  folder->MakeReady(PagePath(entry.id));
  WriteFileAtomically(folder->Full(PagePath(entry.id)), FormatConversionPage({&report}));
}

}  // namespace mmm_converter
