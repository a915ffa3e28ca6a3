// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "common/live/frame_source.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter::testing {

/// A clock that goes on when it is told to.
class TestClock {
 public:
  std::function<SteadyTime()> Now() const {
    return [now = now_] { return *now; };
  }
  void GoOn(std::chrono::nanoseconds time) { *now_ += time; }

 private:
  std::shared_ptr<SteadyTime> now_ = std::make_shared<SteadyTime>(std::chrono::hours(1));
};

/// Points of which each coordinate tells frame, marker and axis; "B" is not seen in frame 3.
inline MarkerSequence SampleRecording(const std::vector<std::string>& labels = {"A", "B", "C c"},
                                      int num_frames = 8) {
  MarkerSequence recording(labels, num_frames, 120, 0);
  for (int k = 0; k < num_frames; ++k) {
    for (int i = 0; i < recording.num_labels(); ++i) {
      recording.frame(k).col(i) = Eigen::Vector3d(0.25 * k, 0.5 * (i + 1), -0.125 * k * i);
    }
  }
  if (num_frames > 3 && labels.size() > 1) {
    recording.frame(3).col(1).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return recording;
}

inline void ExpectFrame(const StreamFrame& frame, const MarkerSequence& recording, int k) {
  const auto expected = recording.frame(k);
  ASSERT_EQ(frame.points.cols(), expected.cols());
  for (Eigen::Index i = 0; i < expected.cols(); ++i) {
    if (IsSeen(expected.col(i))) {
      // Floats of some metres, or thousands of millimetres.
      EXPECT_LT((frame.points.col(i) - expected.col(i)).norm(), 1e-6) << k << " " << i;
    } else {
      EXPECT_TRUE(frame.points.col(i).array().isNaN().all()) << k << " " << i;
    }
  }
}

/// What the source says next; it and the server take turns.
template <typename Server>
StreamEvent NextOf(FrameSource* source, Server* server, StreamFrame* frame) {
  StreamEvent event = StreamEvent::kNothing;
  for (int i = 0; i < 1000 && event == StreamEvent::kNothing; ++i) {
    server->Step(std::chrono::milliseconds(0));
    event = source->Next(std::chrono::milliseconds(0), frame);
  }
  return event;
}

/// The recording has points without a label; takes its layout and frames, and expects them.
template <typename Server>
void ExpectUnlabelled(FrameSource* source, Server* server, const MarkerSequence& recording,
                      const std::vector<std::string>& labels) {
  StreamFrame frame;
  ASSERT_EQ(NextOf(source, server, &frame), StreamEvent::kLayout);
  EXPECT_EQ(source->layout().labels, labels);
  int frames = 0;
  for (; NextOf(source, server, &frame) == StreamEvent::kFrame; ++frames) {
    const auto expected = recording.frame(static_cast<int>(frame.number - 1));
    int column = 0, unlabelled = 0;
    for (Eigen::Index i = 0; i < expected.cols(); ++i) {
      const bool has_label = recording.labels()[static_cast<std::size_t>(i)][0] != '*';
      if (!has_label && !IsSeen(expected.col(i))) continue;
      if (!has_label) {
        ASSERT_LT(unlabelled, frame.unnamed) << frame.number;
      }
      const Eigen::Vector3d p =
          has_label ? frame.points.col(column++) : frame.unnamed_points.col(unlabelled++);
      EXPECT_LT((p - expected.col(i)).norm(), 1e-6) << frame.number << " " << i;  // floats
    }
    EXPECT_EQ(frame.unnamed, unlabelled);
  }
  EXPECT_GT(frames, 0);
}

/// Takes the layout and all frames of the recording.
template <typename Server>
void ExpectRecording(FrameSource* source, Server* server, const MarkerSequence& recording) {
  StreamFrame frame;
  ASSERT_EQ(NextOf(source, server, &frame), StreamEvent::kLayout);
  EXPECT_EQ(source->layout().labels, recording.labels());
  EXPECT_EQ(source->layout().rate, recording.rate());
  for (int k = 0; k < recording.num_frames(); ++k) {
    ASSERT_EQ(NextOf(source, server, &frame), StreamEvent::kFrame) << k;
    EXPECT_EQ(frame.number, k + 1);
    EXPECT_EQ(frame.unnamed, 0);
    ExpectFrame(frame, recording, k);
  }
  EXPECT_EQ(source->counts().frames, recording.num_frames());
  EXPECT_EQ(source->counts().lost, 0);
  EXPECT_EQ(source->counts().broken, 0);
}

/// Both clients take their layout, then the same frames of the recording, which is looped.
template <typename Source, typename Server>
void ExpectLoopForTwo(Source* first, Source* second, Server* server,
                      const MarkerSequence& recording) {
  StreamFrame frame;
  EXPECT_EQ(NextOf(first, server, &frame), StreamEvent::kLayout);
  EXPECT_EQ(NextOf(second, server, &frame), StreamEvent::kLayout);
  EXPECT_EQ(server->num_clients(), 2U);
  for (int i = 0; i < 30; ++i) {
    for (Source* source : {first, second}) {
      ASSERT_EQ(NextOf(source, server, &frame), StreamEvent::kFrame);
      ExpectFrame(frame, recording, static_cast<int>((frame.number - 1) % recording.num_frames()));
    }
  }
  EXPECT_EQ(first->counts().lost, 0);
}

/// The server's recording becomes another while it is looped: the layout comes, then its frames.
template <typename Server>
void ExpectReplaced(FrameSource* source, Server* server, const MarkerSequence& other) {
  StreamFrame frame;
  EXPECT_EQ(NextOf(source, server, &frame), StreamEvent::kLayout);
  EXPECT_EQ(NextOf(source, server, &frame), StreamEvent::kFrame);
  server->Replace(other);
  StreamEvent event = StreamEvent::kFrame;
  while (event == StreamEvent::kFrame) event = NextOf(source, server, &frame);
  ASSERT_EQ(event, StreamEvent::kLayout);
  EXPECT_EQ(source->layout().labels, other.labels());
  ASSERT_EQ(NextOf(source, server, &frame), StreamEvent::kFrame);
  ExpectFrame(frame, other, static_cast<int>((frame.number - 1) % other.num_frames()));
}

}  // namespace mmm_converter::testing
