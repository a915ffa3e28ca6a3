// SPDX-License-Identifier: MIT
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <memory>

#include "common/live/pose_frame.h"
#include "common/support/units.h"
#include "tests/common/convert/fake_converter.h"

namespace mmm_converter::testing {

inline std::shared_ptr<const LiveBody> SmallBody() {
  auto body = std::make_shared<LiveBody>();
  body->name = "anna";
  body->setup = SmallSetup(3);
  body->setup.joints = {1, 0};
  body->labels = {"a", "b", "c", "spare"};
  return body;
}

inline PoseFrame SmallFrame(const LiveBody& body) {
  PoseFrame frame;
  frame.number = 42;
  frame.time = 1.25;
  frame.is_tracking = true;
  frame.points.setConstant(3, 4, 0.5);
  frame.points.col(1).setConstant(kNaN);
  FrameEstimate& estimate = frame.estimate;
  estimate.posture = ZeroPosture(*body.setup.model);
  estimate.posture.position << 1, 2, 3;
  estimate.posture.joint_angles[0] = 0.1;
  estimate.posture.joint_angles[1] = 0.2;
  estimate.standard_deviations =
      Eigen::VectorXd::LinSpaced(6 + body.setup.model->num_joints(), 0.01, 0.02);
  estimate.residuals = Eigen::Vector3d(0.01, kNaN, 0.03);
  estimate.verdicts = Eigen::Vector3i(kAsLabelled, kAsLabelled, 0);
  return frame;
}

// A port that is free now.
inline int FreePort() {
  boost::asio::io_context context;
  using boost::asio::ip::tcp;
  const tcp::acceptor acceptor(context, {boost::asio::ip::make_address("127.0.0.1"), 0});
  return acceptor.local_endpoint().port();
}

}  // namespace mmm_converter::testing
