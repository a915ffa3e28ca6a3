// SPDX-License-Identifier: MIT
#include "common/motion/marker_sequence.h"

#include <algorithm>
#include <cassert>

#include "common/support/units.h"

namespace mmm_converter {

MarkerSequence::MarkerSequence(std::vector<std::string> labels, int num_frames, double rate,
                               double first_time)
    : labels_(std::move(labels)),
      num_frames_(num_frames),
      rate_(rate),
      first_time_(first_time),
      p_WM_(labels_.size() * 3 * num_frames, kNaN) {
  assert(rate > 0);
}

int MarkerSequence::FindLabel(const std::string& label) const {
  const auto it = std::find(labels_.begin(), labels_.end(), label);
  return it == labels_.end() ? -1 : static_cast<int>(it - labels_.begin());
}

Eigen::Map<const Eigen::Matrix3Xd> MarkerSequence::frame(int k) const {
  assert(k >= 0 && k < num_frames_);
  return {p_WM_.data() + static_cast<std::size_t>(k) * 3 * labels_.size(), 3, num_labels()};
}

Eigen::Map<Eigen::Matrix3Xd> MarkerSequence::frame(int k) {
  assert(k >= 0 && k < num_frames_);
  return {p_WM_.data() + static_cast<std::size_t>(k) * 3 * labels_.size(), 3, num_labels()};
}

MarkerSequence MarkerSequence::Slice(int begin, int end) const {
  assert(0 <= begin && begin <= end && end <= num_frames_);
  MarkerSequence slice(labels_, end - begin, rate_, time(begin));
  std::copy_n(p_WM_.begin() + static_cast<std::ptrdiff_t>(begin) * 3 * num_labels(),
              slice.p_WM_.size(), slice.p_WM_.begin());
  return slice;
}

}  // namespace mmm_converter
