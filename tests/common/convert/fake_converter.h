// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/convert/motion_converter.h"
#include "tests/support/test_models.h"

namespace mmm_converter::testing {

/// Notes how it is called: dt of each call, 0 for Assemble.
class FakeConverter : public MotionConverter {
 public:
  FakeConverter(TrackingSetup setup, std::vector<double>* calls)
      : MotionConverter(std::move(setup)), calls_(calls) {
    estimate_.posture = ZeroPosture(*this->setup().model);
    estimate_.residuals.setZero(static_cast<Eigen::Index>(this->setup().assignments().size()));
  }
  const FrameEstimate& Assemble(const Eigen::Ref<const Eigen::Matrix3Xd>& /*frame*/) override {
    calls_->push_back(0);
    return estimate_;
  }
  const FrameEstimate& Track(const Eigen::Ref<const Eigen::Matrix3Xd>& /*frame*/,
                             double dt) override {
    calls_->push_back(dt);
    return estimate_;
  }

 private:
  std::vector<double>* calls_;
  FrameEstimate estimate_;
};

/// A small model with `labels` labels that stand for its first markers.
inline TrackingSetup SmallSetup(int labels) {
  TrackingSetup setup;
  setup.model = std::make_shared<KinematicModel>(MakeBranchedModel());
  for (int i = 0; i < labels; ++i) {
    setup.mapping.assignments.push_back({LabelIx(i), MarkerIx(i)});
  }
  return setup;
}

}  // namespace mmm_converter::testing
