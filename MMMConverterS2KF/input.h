// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "MMMConverterS2KF/command_line.h"
#include "MMMConverterS2KF/person.h"
#include "common/io/mmm_model.h"
#include "common/io/recording.h"
#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// A recording and its person, as the user names them. Empty: a default.
struct InputRequest {
  std::string file;
  ReadRecordingOptions reading;
  std::optional<int> first_frame;         ///< counted from 0
  std::optional<int> end_frame;           ///< the frame behind the last
  std::string model_file;                 ///< reference model
  std::shared_ptr<const MmmModel> model;  ///< of that file, where it has been read before
  PersonRequest person;
};

struct Input {
  Recording recording;  ///< the frames asked for
  int first_frame = 0;  ///< of them, counted from 0
  std::string model_file;
  std::shared_ptr<const KinematicModel> reference;  ///< not scaled
  std::vector<std::string> warnings;
};

/// The file of the reference model.
std::string ModelFile(const InputRequest& request);

/// @throws Error
Input ReadInput(const InputRequest& request);

/// The options of an InputRequest, for every command that reads recordings.
const std::vector<OptionGroup>& InputOptions();

/// "A:B": frames A to B-1, counted from 0; either may be left out.
/// @throws UsageError
void ParseFrames(const std::string& text, InputRequest* request);

/// @throws UsageError
InputRequest MakeInputRequest(const Arguments& arguments, const std::string& file);

}  // namespace mmm_converter
