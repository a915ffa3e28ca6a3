// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/entry_conversion.h"

#include "MMMConverterS2KF/report/conversion_page.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"

namespace mmm_converter {

ConversionRequest RequestOf(const BatchEntry& entry, const BatchFolder& folder) {
  ConversionRequest request = entry.request;
  request.output = folder.Full(MotionPath(entry.id));
  for (const std::string& format : entry.exports) {
    request.exports[format] = folder.Full(ExportPath(format, entry.id));
  }
  if (request.self_calibrate) request.subject_output = folder.Full(SubjectPath(entry.id));
  return request;
}

ConversionReport ConvertEntry(const ConversionRequest& request, const ReadBefore& read_before,
                              const std::function<bool()>& goes_on) {
  ConversionPlan plan = PlanConversion(request, read_before);
  // Several recordings of an object need the same model.
  if (plan.object && plan.object->is_built()) {
    throw Error(WhyNoModel(request.input.file, plan.motion_name));
  }
  CheckOutputs(request, {&plan});
  return CarryOut(std::move(plan), request.self_calibrate, [&](int, int) { return goes_on(); });
}

void WritePage(const BatchEntry& entry, const ConversionReport& report, BatchFolder* folder) {
  folder->MakeReady(PagePath(entry.id));
  WriteFileAtomically(folder->Full(PagePath(entry.id)), FormatConversionPage({&report}));
}

}  // namespace mmm_converter
