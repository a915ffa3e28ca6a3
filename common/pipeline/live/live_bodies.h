// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/io/recording/marker_labels.h"
#include "common/pipeline/live_request.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// Which of a source's labels are a body's, and what it calls them. source: for messages.
/// @throws Error
using ChooseLabels = std::function<LabelSelection(const std::vector<std::string>& labels,
                                                  const std::string& source, Warnings* warnings)>;

/// One of those that a stream shows at once, each tracked by itself.
struct LiveBodyRequest {
  LiveRequest request;
  ChooseLabels choose;
  std::vector<std::string> other_names = {};  ///< of the first body: those that it can't have
};

/// Where the first motion of an object beside the one of `output` is written: OUTPUT_NAME.xml.
std::string OutputOfObject(const std::string& output, const std::string& name);

/// The person or the object that the request's model is, and then its other objects, each called as
/// its file. An object has the labels of the subject that is called like it (Box:M1), else those of
/// the one subject, or without a subject, that are its markers; the person has the rest.
/// selects_labels: as of LiveSource.
/// @throws Error where a model can't be read, is none of a rigid object, or two have one name or
/// outputs of one name.
std::vector<LiveBodyRequest> BodiesOf(const LiveRequest& request, bool selects_labels);

}  // namespace mmm_converter
