// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <map>
#include <thread>

namespace mmm_converter {

/// Ends connections to a ZeroMQ publisher that are too many, or that say more than a subscriber
/// has to: ZeroMQ itself bounds one message, but neither the number of connections nor that of
/// subscriptions, for each of which it keeps memory. On a thread of its own.
class SubscriberGuard {
 public:
  static constexpr int kMostSubscribers = 32;
  /// [bytes] that a subscriber may say at most: some hundred subscriptions. More come with time,
  /// so that who shows every second that it is there may stay for ever.
  static constexpr double kMostHeard = 1 << 16;
  static constexpr double kMoreInASecond = 10;

  /// publisher: a socket of ZeroMQ with its context, which listens at the TCP port afterwards and
  /// lives longer than this.
  SubscriberGuard(void* context, void* publisher, int port);
  ~SubscriberGuard();
  SubscriberGuard(const SubscriberGuard&) = delete;
  SubscriberGuard& operator=(const SubscriberGuard&) = delete;

 private:
  using Time = std::chrono::steady_clock::time_point;

  void Watch();
  /// false: there are no more to come.
  bool TakeEvent();
  void TakeConnection(int handle);
  void EndTalkative();
  bool IsConnection(int handle) const;

  void* publisher_;
  void* events_;  // of the publisher's connections
  int port_;
  std::map<int, Time> since_;  // by handle
  std::thread thread_;
};

}  // namespace mmm_converter
