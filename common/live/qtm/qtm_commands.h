// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/live/qtm/qtm_data.h"
#include "common/live/qtm/qtm_parameters.h"

namespace mmm_converter {

// Commands as a server gets them: words between blanks, in any case.

std::vector<std::string> SplitQtmCommand(std::string_view text);  ///< in lower case

/// "3D 6DRes Skeleton:global"; nothing where one is not known, or there is none.
std::optional<std::vector<QtmComponent>> ParseQtmComponents(const std::vector<std::string>& words);

/// "General 3D", "All"; nothing where one is not known, or there is none.
std::optional<QtmParameterChoice> ParseQtmParameterChoice(const std::vector<std::string>& words);

struct QtmStreamRequest {
  bool stop = false;
  int divisor = 1;       ///< every n-th frame
  double frequency = 0;  ///< [Hz] at most; 0: all
  int udp_port = 0;      ///< 0: by TCP
  std::string udp_host;  ///< empty: where the command comes from
  std::vector<QtmComponent> components;
};

/// What follows StreamFrames; nothing where it is not understood.
std::optional<QtmStreamRequest> ParseQtmStreamRequest(const std::vector<std::string>& words);

/// Whether the frame of a running number is among those asked for, of a recording with that rate.
bool IsAskedFor(const QtmStreamRequest& request, std::int64_t number, double rate);

}  // namespace mmm_converter
