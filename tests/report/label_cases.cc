// SPDX-License-Identifier: MIT
#include "tests/report/label_cases.h"

namespace mmm_converter::testing {

LabelReport LabelCase(const std::string& text) {
  constexpr int kFrames = 60;
  LabelReport report;
  Recording& recording = report.input.recording;
  recording.file = text + ".c3d";
  recording.format = "C3D";
  recording.markers = MarkerSequence({"LKNE", text, "*1"}, kFrames, 100, 0);
  for (int k = 0; k < kFrames; ++k) {
    for (int i = 0; i < 3; ++i) recording.markers.frame(k).col(i) << i, 0.01 * k, 0.1 * i * k;
  }
  Labelling& labelling = report.found.labelling;
  labelling.names = {"LKNE", text};
  const LabelIx left(0);
  const LabelIx right(1);
  labelling.pieces = {
      {left, 0, 20, 0, 1},   {left, 20, 40, 1, 0.995},   {left, 40, 50, 0, 1},
      {left, 50, 60, -1, 1}, {right, 0, 20, 1, 1},       {right, 20, 40, 0, 0.99},
      {right, 40, 60, 1, 1}, {LabelIx(2), 0, 50, -1, 1}, {LabelIx(2), 50, 60, 0, 0.97}};
  const std::vector<std::string>& labels = recording.markers.labels();
  report.found.points = RelabelledPoints(labelling, labels, kFrames);
  report.found.changes = ChangesOf(labelling, labels);
  report.found.is_repair = text == "RKNE";
  report.warnings.Add(text);
  return report;
}

}  // namespace mmm_converter::testing
