// SPDX-License-Identifier: MIT
#include "common/io/mmm/mmm_model.h"

#include "common/io/mmm/mmm_model_subject.h"
#include "common/io/mmm/mmm_object_model.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

void ReadMmmModelBytes(std::string_view bytes) {
  Warnings warnings;
  const KinematicModel read = ParseMmmModel(bytes, kInputName, &warnings);
  // A subject of whom nothing is known has the model as it is.
  Subject subject;
  subject.model = read.name();
  subject.height = 1;
  subject.mass = 1;
  const KinematicModel same =
      ParseMmmModel(FormatSubjectModel(std::string(bytes), kInputName, subject), kInputName);
  Require(same.segments().size() == read.segments().size(), "the segments of the model");
  Require(same.markers().size() == read.markers().size(), "the markers of the model");
  if (read.segments().size() > 1 || read.markers().empty()) return;
  const std::string object = FormatObjectModel(read, "");
  Require(FormatObjectModel(ParseMmmModel(object, kInputName), "") == object,
          "the same bytes when an object is read and written again");
}

}  // namespace mmm_converter::testing
