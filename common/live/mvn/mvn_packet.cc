// SPDX-License-Identifier: MIT
#include "common/live/mvn/mvn_packet.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr std::uint8_t kLastDatagram = 0x80;
constexpr std::size_t kLongestName = 200;

// Segments by their number from 0, and the one that carries each.
struct MvnJoint {
  const char* name;
  int parent;
};
constexpr std::array<MvnJoint, kMvnSegments> kMvnTree = {{{"Pelvis", -1},
                                                          {"L5", 0},
                                                          {"L3", 1},
                                                          {"T12", 2},
                                                          {"T8", 3},
                                                          {"Neck", 4},
                                                          {"Head", 5},
                                                          {"RightShoulder", 4},
                                                          {"RightUpperArm", 7},
                                                          {"RightForeArm", 8},
                                                          {"RightHand", 9},
                                                          {"LeftShoulder", 4},
                                                          {"LeftUpperArm", 11},
                                                          {"LeftForeArm", 12},
                                                          {"LeftHand", 13},
                                                          {"RightUpperLeg", 0},
                                                          {"RightLowerLeg", 15},
                                                          {"RightFoot", 16},
                                                          {"RightToe", 17},
                                                          {"LeftUpperLeg", 0},
                                                          {"LeftLowerLeg", 19},
                                                          {"LeftFoot", 20},
                                                          {"LeftToe", 21}}};

void AddByte(std::uint8_t value, std::string* bytes) { *bytes += static_cast<char>(value); }

void AddShort(std::uint16_t value, std::string* bytes) {
  AddByte(static_cast<std::uint8_t>(value >> 8), bytes);
  AddByte(static_cast<std::uint8_t>(value), bytes);
}

void AddLong(std::uint32_t value, std::string* bytes) {
  AddShort(static_cast<std::uint16_t>(value >> 16), bytes);
  AddShort(static_cast<std::uint16_t>(value), bytes);
}

void AddFloat(double value, std::string* bytes) {
  AddLong(std::bit_cast<std::uint32_t>(static_cast<float>(value)), bytes);
}

void AddVector(const Eigen::Vector3d& v, std::string* bytes) {
  for (const double value : v) AddFloat(value, bytes);
}

std::string Datagram(const char* kind, const MvnMoment& moment, int items,
                     const std::string& payload) {
  std::string bytes = std::string("MXTP") + kind;
  bytes.reserve(24 + payload.size());
  AddLong(moment.sample, &bytes);
  AddByte(kLastDatagram, &bytes);
  AddByte(static_cast<std::uint8_t>(items), &bytes);
  AddLong(moment.milliseconds, &bytes);
  AddByte(0, &bytes);  // character
  AddByte(kMvnSegments, &bytes);
  AddByte(0, &bytes);  // props
  AddByte(0, &bytes);  // finger segments
  AddShort(0, &bytes);
  AddShort(static_cast<std::uint16_t>(payload.size()), &bytes);
  return bytes + payload;
}

// Turns about x, y and z of R = Ry Rx Rz [degrees].
Eigen::Vector3d TurnsOf(const Eigen::Matrix3d& R) {
  const double x = std::asin(std::clamp(-R(1, 2), -1.0, 1.0));
  const double y = std::atan2(R(0, 2), R(2, 2));
  const double z = std::atan2(R(1, 0), R(1, 1));
  return kDegrees * Eigen::Vector3d(x, y, z);
}

}  // namespace

std::string FormatMvnPoses(const MvnMoment& moment, const MvnPoses& poses) {
  std::string items;
  items.reserve(kMvnSegments * 32);
  for (int i = 0; i < kMvnSegments; ++i) {
    const Eigen::Isometry3d& pose = poses[static_cast<std::size_t>(i)];
    const Eigen::Quaterniond q(pose.linear());
    AddLong(static_cast<std::uint32_t>(i + 1), &items);
    AddVector(pose.translation(), &items);
    for (const double value : {q.w(), q.x(), q.y(), q.z()}) AddFloat(value, &items);
  }
  return Datagram("02", moment, kMvnSegments, items);
}

std::string FormatMvnName(const MvnMoment& moment, const std::string& name) {
  std::size_t end = std::min(name.size(), kLongestName);
  const auto is_within_character = [&](std::size_t i) {
    return (name[i] & 0xC0) == 0x80;
  };  // UTF-8
  while (end > 0 && end < name.size() && is_within_character(end)) --end;
  std::string line = name.substr(0, end);
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return Datagram("12", moment, 1, "name:" + line + "\n");
}

std::string FormatMvnScale(const MvnMoment& moment, const MvnPoses& t_pose) {
  std::string items;
  AddLong(kMvnSegments, &items);
  for (std::size_t i = 0; i < kMvnTree.size(); ++i) {
    const std::string name = kMvnTree[i].name;
    AddLong(static_cast<std::uint32_t>(name.size()), &items);
    items += name;
    AddVector(t_pose[i].translation(), &items);
  }
  AddLong(0, &items);  // points
  return Datagram("13", moment, kMvnSegments, items);
}

std::string FormatMvnJointAngles(const MvnMoment& moment, const MvnPoses& poses) {
  std::string items;
  items.reserve(kMvnSegments * 20);
  for (std::size_t i = 0; i < kMvnTree.size(); ++i) {
    if (kMvnTree[i].parent < 0) continue;
    const auto parent = static_cast<std::size_t>(kMvnTree[i].parent);
    AddLong(static_cast<std::uint32_t>(256 * (parent + 1)), &items);
    AddLong(static_cast<std::uint32_t>(256 * (i + 1)), &items);
    AddVector(TurnsOf(poses[parent].linear().transpose() * poses[i].linear()), &items);
  }
  return Datagram("20", moment, kMvnSegments - 1, items);
}

std::string FormatMvnTimeCode(const MvnMoment& moment) {
  const std::uint32_t seconds = moment.milliseconds / 1000;
  return Datagram("25", moment, 1,
                  fmt::format("{:02}:{:02}:{:02}.{:03}", seconds / 3600 % 24, seconds / 60 % 60,
                              seconds % 60, moment.milliseconds % 1000));
}

}  // namespace mmm_converter
