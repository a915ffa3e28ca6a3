// SPDX-License-Identifier: MIT
#include "tests/common/retarget/biped.h"

#include <fmt/format.h>

#include "common/io/urdf/urdf_robot.h"

namespace mmm_converter::testing {
namespace {

constexpr double kPi = 3.14;

struct JointText {
  std::string name, parent, place, axis;
  double lower, upper, velocity;
  std::string mimic = {};
};

/// A joint with the link that it carries; the link's centre of mass and box, if it has one.
std::string JointAndLink(const JointText& joint, const std::string& mass_at,
                         const std::string& shape = "") {
  return fmt::format(
      R"(<link name="{0}_link"><inertial><origin xyz="{1}"/><mass value="1"/><inertia ixx="0.01"
 ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>{2}</link>
<joint name="{0}" type="revolute"><parent link="{3}"/><child link="{0}_link"/><origin xyz="{4}"/>
<axis xyz="{5}"/><limit lower="{6}" upper="{7}" effort="100" velocity="{8}"/>{9}</joint>
)",
      joint.name, mass_at, shape, joint.parent, joint.place, joint.axis, joint.lower, joint.upper,
      joint.velocity, joint.mimic);
}

/// A knee or an elbow.
std::string FoldText(const BipedShape& shape, JointText joint, const std::string& mass_at,
                     const std::string& body = "") {
  if (!shape.halves) return JointAndLink(joint, mass_at, body);
  JointText half = joint;
  half.name += "_half";
  half.lower /= 2;
  half.upper /= 2;
  joint.parent = half.name + "_link";
  joint.place = fmt::format("0 0 {}", -*shape.halves);
  if (shape.halves_reversed) joint.axis = "0 -1 0";
  joint.mimic = fmt::format(R"(<mimic joint="{}" multiplier="{}"/>)", half.name,
                            shape.halves_reversed ? -1 : 1);
  return JointAndLink(half, "0 0 0") + JointAndLink(joint, mass_at, body);
}

std::string LegText(const BipedShape& shape, const std::string& side, double y) {
  const std::string here = "0 0 0", foot = shape.has_sole
                                               ? R"(<collision><origin xyz="0.04 0 -0.07"/>
<geometry><box size="0.2 0.08 0.02"/></geometry></collision>)"
                                               : "";
  const auto link = [&](const char* name) { return side + name + "_link"; };
  const double v = shape.hip_velocity, slip = y > 0 ? shape.slip : 0;
  const double thigh = y > 0 ? 0.36 : shape.right_thigh;
  return JointAndLink({side + "hip_yaw", "pelvis", fmt::format("0 {} 0", y), "0 0 1", -1, 1, v},
                      here) +
         JointAndLink({side + "hip_roll", link("hip_yaw"), fmt::format("{} 0 0", slip), "1 0 0",
                       -0.6, 0.6, v},
                      here) +
         JointAndLink({side + "hip_pitch", link("hip_roll"), fmt::format("{} 0 0", -slip), "0 1 0",
                       -2, 2, v},
                      "0 0 -0.18") +
         FoldText(shape,
                  {side + "knee", link("hip_pitch"), fmt::format("0 0 {}", -thigh), "0 1 0",
                   shape.knee_lower, shape.knee_upper, 20},
                  "0 0 -0.18") +
         JointAndLink(
             {side + "ankle_pitch", link("knee"),
              fmt::format(R"(0 0 -0.36" rpy="0 {} 0)", shape.ankle_zero), "0 1 0", -1, 1, 20},
             here) +
         JointAndLink({side + "ankle_roll", link("ankle_pitch"), here, "1 0 0", -0.5, 0.5, 20},
                      "0.02 0 -0.04", foot) +
         (shape.has_toes ? JointAndLink({side + "toes", link("ankle_roll"), "0.12 0 -0.06", "0 1 0",
                                         -1, 1, 20},
                                        "0.02 0 0", R"(<collision><origin xyz="0.05 0 -0.01"/>
<geometry><box size="0.1 0.08 0.02"/></geometry></collision>)")
                         : "");
}

std::string HandText(const BipedShape& shape, const std::string& side) {
  const std::string hand = side + "wrist_link", mass = "0 0 -0.02";
  const std::string at = fmt::format("0 0.02 {}", -shape.palm);
  return JointAndLink({side + "wrist", side + "elbow_link", "0 0 -0.22", "0 1 0", -1, 1, 20},
                      "0 0 -0.05") +
         JointAndLink({side + "finger_1", hand, at, "0 1 0", 0.1, 1.5, 5}, mass) +
         JointAndLink({side + "finger_2", hand, at, "0 1 0", 0.1, 1.5, 5}, mass) +
         JointAndLink({side + "thumb", hand, "0.02 0 -0.06", "0 0 1", -1, 1, 5}, mass);
}

std::string ArmText(const BipedShape& shape, const std::string& side, double y) {
  const std::string here = "0 0 0";
  const auto link = [&](const char* name) { return side + name + "_link"; };
  const double slip = y > 0 ? shape.slip : -shape.slip;
  std::string text, chest = "waist_link", place = fmt::format("0 {} 0.4", y - slip);
  if (shape.has_clavicles) {
    const std::string middle = fmt::format("0 {} 0.4", 0.2 * y);
    text = JointAndLink({side + "clavicle_z", chest, middle, "0 0 1", -0.3, 0.3, 20}, here) +
           JointAndLink({side + "clavicle_x", link("clavicle_z"), here, "1 0 0", -0.3, 0.3, 20},
                        fmt::format("0 {} 0", 0.4 * y));
    chest = link("clavicle_x");
    place = fmt::format("0 {} 0", 0.8 * y - slip);
  }
  text += JointAndLink({side + "shoulder_pitch", chest, place, "0 1 0", -3, 3, 20}, here) +
          JointAndLink({side + "shoulder_roll", link("shoulder_pitch"), fmt::format("0 {} 0", slip),
                        "1 0 0", -kPi, kPi, 20},
                       here);
  text += JointAndLink({side + "shoulder_yaw", link("shoulder_roll"), here, "0 0 1", -2, 2, 20},
                       "0 0 -0.12") +
          FoldText(shape,
                   {side + "elbow", link("shoulder_yaw"), "0 0 -0.25", shape.elbow_axis,
                    shape.elbow_lower, shape.elbow_upper, 20},
                   "0 0 -0.22",
                   shape.has_bodies ? R"(<collision><origin xyz="0 0 -0.13"/>
<geometry><box size="0.05 0.05 0.2"/></geometry></collision>)"
                                    : "");
  if (shape.elbow_bends_twice) {
    text +=
        JointAndLink({side + "elbow_x", link("elbow"), here, "1 0 0", -2.4, 2.4, 20}, "0 0 -0.22");
  }
  return text;
}

}  // namespace

std::string BipedText(const BipedShape& shape) {
  const char* mass = R"(<inertial><origin xyz="0 0 0"/><mass value="5"/><inertia ixx="0.1" ixy="0"
 ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>)";
  std::string text = R"(<robot name="biped">)";
  if (!shape.has_legs) {
    text += R"(<link name="world"/><joint name="stand" type="fixed"><parent link="world"/>
<child link="pelvis"/></joint>)";
  }
  text += fmt::format(R"(<link name="pelvis">{}</link>)", mass);
  if (shape.has_legs) {
    text += LegText(shape, shape.sides[0], 0.1) + LegText(shape, shape.sides[1], -0.1);
  }
  text += JointAndLink({"waist", "pelvis", "0 0 0.1", "0 0 1", -1, 1, 20}, "0 0 0.2",
                       shape.has_bodies ? R"(<collision><origin xyz="0 0 0.2"/>
<geometry><box size="0.2 0.24 0.4"/></geometry></collision>)"
                                        : "");
  text += ArmText(shape, shape.sides[0], 0.2) + ArmText(shape, shape.sides[1], -0.2);
  if (shape.has_fingers) text += HandText(shape, shape.sides[0]) + HandText(shape, shape.sides[1]);
  return text + "</robot>";
}

Robot MakeBiped(const BipedShape& shape) { return ParseUrdfRobot(BipedText(shape), "biped.urdf"); }

}  // namespace mmm_converter::testing
