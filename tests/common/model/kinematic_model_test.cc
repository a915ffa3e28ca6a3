// SPDX-License-Identifier: MIT
#include "common/model/kinematic_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;

Segment Node(const char* name, int parent, JointType type = JointType::kFixed, double lower = 0,
             double upper = 0) {
  Segment segment;
  segment.name = name;
  segment.parent = parent;
  segment.type = type;
  segment.lower = lower;
  segment.upper = upper;
  return segment;
}

/// hand < arm < root > head, written children first.
ModelDescription Body() {
  ModelDescription body;
  body.segments = {Node("hand", 1, JointType::kRevolute, -1, 1),
                   Node("arm", 3, JointType::kRevolute, 0, 2),
                   Node("head", 3, JointType::kPrismatic, 0, 0.1), Node("root", -1)};
  body.segments[0].mass = 1;
  body.segments[3].mass = 2.5;
  body.markers = {{"H", 0, {0.1, 0, 0}}, {"R", 3, {0, 0, 0}}};
  return body;
}

std::string MessageFor(const ModelDescription& description) {
  try {
    const KinematicModel model(description);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(KinematicModel, PutsParentsBeforeTheirChildren) {
  const KinematicModel model(Body());
  ASSERT_EQ(model.segments().size(), 4u);
  const char* const names[] = {"root", "arm", "hand", "head"};
  const int parents[] = {-1, 0, 1, 0};
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(model.segments()[i].name, names[i]);
    EXPECT_EQ(model.segments()[i].parent, parents[i]);
  }
  EXPECT_EQ(model.markers()[0].segment, 2);
  EXPECT_EQ(model.markers()[1].segment, 0);
  EXPECT_EQ(model.total_mass(), 3.5);
}

TEST(KinematicModel, NumbersTheJointsThatCanMove) {
  ModelDescription body = Body();
  body.segments.push_back(Node("stiff", 0, JointType::kRevolute, 0.3, 0.3));
  const KinematicModel model(body);
  ASSERT_EQ(model.num_joints(), 2);
  EXPECT_EQ(model.joint(0).name, "arm");
  EXPECT_EQ(model.joint(1).name, "hand");
  EXPECT_EQ(model.joint_segment(1), model.FindSegment("hand"));
  EXPECT_EQ(model.FindJoint("hand"), 1);
  for (const char* still : {"head", "root", "stiff", "no such node"}) {
    EXPECT_EQ(model.FindJoint(still), -1) << still;
  }
  EXPECT_EQ(model.FindSegment("no such node"), -1);
  EXPECT_EQ(model.FindMarker("R"), 1);
  EXPECT_EQ(model.FindMarker("r"), -1);
}

TEST(KinematicModel, RefusesWhatIsNoTree) {
  ModelDescription body = Body();
  body.segments[3].parent = 0;
  EXPECT_THAT(MessageFor(body), HasSubstr("no root"));
  body = Body();
  body.segments[2].parent = -1;
  EXPECT_THAT(MessageFor(body), HasSubstr("two roots, 'head' and 'root'"));
  body = Body();
  body.segments[1].parent = 0;
  EXPECT_THAT(MessageFor(body), HasSubstr("'hand' hangs in a circle"));
  body = Body();
  body.segments[1].parent = 17;
  EXPECT_THAT(MessageFor(body), HasSubstr("'arm': its parent does not exist"));
  body = Body();
  body.segments[1].name = "hand";
  EXPECT_THAT(MessageFor(body), HasSubstr("two nodes called 'hand'"));
  body = Body();
  body.markers[1].name = "H";
  EXPECT_THAT(MessageFor(body), HasSubstr("two markers called 'H'"));
  body = Body();
  body.markers[1].segment = 4;
  EXPECT_THAT(MessageFor(body), HasSubstr("marker 'R'"));
  EXPECT_THAT(MessageFor(ModelDescription()), HasSubstr("no nodes"));
}

TEST(KinematicModel, RefusesImpossibleNumbers) {
  ModelDescription body = Body();
  body.segments[0].lower = 2;
  EXPECT_THAT(MessageFor(body), HasSubstr("'hand': its joint limits are crossed"));
  body = Body();
  body.segments[0].upper = std::numeric_limits<double>::infinity();
  EXPECT_THAT(MessageFor(body), HasSubstr("'hand': one of its numbers is not finite"));
  body = Body();
  body.segments[1].X_PF.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(MessageFor(body), HasSubstr("'arm': one of its numbers is not finite"));
  body = Body();
  body.segments[1].mass = -1;
  EXPECT_THAT(MessageFor(body), HasSubstr("its mass is -1 kg"));
  body = Body();
  body.segments[1].axis = {1, 1, 0};
  EXPECT_THAT(MessageFor(body), HasSubstr("not a unit vector"));
  body = Body();
  body.segments[1].X_PF.linear() *= 2;
  EXPECT_THAT(MessageFor(body), HasSubstr("not a rotation"));
  body = Body();
  body.segments[3] = Node("root", -1, JointType::kRevolute, -1, 1);
  EXPECT_THAT(MessageFor(body), HasSubstr("'root' is the floating root"));
}

}  // namespace
}  // namespace mmm_converter
