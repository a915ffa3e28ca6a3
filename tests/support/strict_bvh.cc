// SPDX-License-Identifier: MIT
#include "tests/support/strict_bvh.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>
#include <stdexcept>

namespace mmm_converter::testing {
namespace {

void Require(bool is_right, const std::string& what) {
  if (!is_right) throw std::runtime_error("BVH: " + what);
}

class BvhParser {
 public:
  explicit BvhParser(std::string_view text) : in_(std::string(text)) {}

  StrictBvh Read() {
    Expect("HIERARCHY");
    Expect("ROOT");
    ReadJoint(-1);
    Expect("MOTION");
    Expect("Frames:");
    const double frames = Number();
    Expect("Frame");
    Expect("Time:");
    bvh_.frame_time = Number();
    Require(bvh_.frame_time > 0, "frame time");
    std::string line;
    std::getline(in_, line);
    while (std::getline(in_, line)) ReadFrame(line);
    Require(static_cast<double>(bvh_.frames.size()) == frames, "number of frames");
    return std::move(bvh_);
  }

 private:
  std::string Word() {
    std::string word;
    Require(static_cast<bool>(in_ >> word), "ends early");
    return word;
  }

  void Expect(const std::string& expected) {
    const std::string word = Word();
    Require(word == expected, "\"" + word + "\" instead of \"" + expected + "\"");
  }

  double Number() {
    const std::string word = Word();
    std::size_t end = 0;
    const double value = std::stod(word, &end);
    Require(end == word.size() && std::isfinite(value), "no number: " + word);
    return value;
  }

  Eigen::Vector3d Offset() {
    Expect("OFFSET");
    Eigen::Vector3d offset;
    for (double& value : offset) value = Number();
    return offset;
  }

  void ReadJoint(int parent) {
    StrictBvhJoint joint;
    joint.name = Word();
    joint.parent = parent;
    Require(names_.insert(joint.name).second, "two joints " + joint.name);
    Expect("{");
    joint.offset = Offset();
    Expect("CHANNELS");
    const auto count = static_cast<std::size_t>(Number());
    joint.first_channel = channels_;
    for (std::size_t i = 0; i < count; ++i) joint.channels.push_back(Word());
    std::vector<std::string> expected = {"Zrotation", "Xrotation", "Yrotation"};
    if (parent < 0) {
      expected.insert(expected.begin(), {"Xposition", "Yposition", "Zposition"});
    }
    Require(joint.channels == expected, "channels of " + joint.name);
    channels_ += static_cast<int>(count);
    const int index = static_cast<int>(bvh_.joints.size());
    bvh_.joints.push_back(joint);
    ReadBelow(index);
  }

  void ReadBelow(int index) {
    int children = 0;
    for (std::string word = Word(); word != "}"; word = Word()) {
      ++children;
      if (word == "JOINT") {
        ReadJoint(index);
        continue;
      }
      Require(word == "End" && Word() == "Site" && children == 1, "children");
      Expect("{");
      StrictBvhJoint end;
      end.name = bvh_.joints[index].name + "_end";
      end.parent = index;
      end.offset = Offset();
      bvh_.joints.push_back(end);
      Expect("}");
    }
    Require(children > 0, "no End Site below " + bvh_.joints[index].name);
  }

  void ReadFrame(const std::string& line) {
    std::istringstream words(line);
    std::vector<double> frame;
    for (double value = 0; words >> value;) frame.push_back(value);
    Require(words.eof() && static_cast<int>(frame.size()) == channels_, "numbers of a frame");
    bvh_.frames.push_back(frame);
  }

  std::istringstream in_;
  std::set<std::string> names_;
  int channels_ = 0;
  StrictBvh bvh_;
};

}  // namespace

int StrictBvh::Find(const std::string& name) const {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

std::vector<Eigen::Vector3d> StrictBvh::Places(std::size_t frame) const {
  std::vector<Eigen::Affine3d> poses;
  std::vector<Eigen::Vector3d> places;
  for (const StrictBvhJoint& joint : joints) {
    Eigen::Affine3d pose = joint.parent < 0 ? Eigen::Affine3d::Identity() : poses[joint.parent];
    pose.translate(joint.offset);
    for (std::size_t i = 0; i < joint.channels.size(); ++i) {
      const std::string& channel = joint.channels[i];
      const double value = frames[frame][joint.first_channel + i];
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(channel[0] - 'X');
      if (channel.ends_with("position")) {
        pose.translate(value * axis);
      } else {
        pose.rotate(Eigen::AngleAxisd(value * std::numbers::pi / 180, axis));
      }
    }
    poses.push_back(pose);
    places.emplace_back(pose.translation());
  }
  return places;
}

StrictBvh ReadStrictBvh(std::string_view text) { return BvhParser(text).Read(); }

}  // namespace mmm_converter::testing
