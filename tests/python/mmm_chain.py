# SPDX-License-Identifier: MIT
"""The MMM model's joints by hand: from the XML of the model and the numbers of a motion's file."""
import math
import xml.etree.ElementTree as ET

import numpy as np

# The points of the KIT Motion-Language data set and the joints of the MMM model that turn there.
POINTS = {
    "root": "root_joint", "BP": "BPx_joint", "BT": "BTx_joint", "BLN": "BLNx_joint",
    "BUN": "BUNx_joint", "LS": "LSx_joint", "LE": "LEx_joint", "LW": "LWx_joint",
    "RS": "RSx_joint", "RE": "REx_joint", "RW": "RWx_joint", "LH": "LHx_joint", "LK": "LKx_joint",
    "LA": "LAx_joint", "LMrot": "LMrot_joint", "LF": "LFx_joint", "RH": "RHx_joint",
    "RK": "RKx_joint", "RA": "RAx_joint", "RMrot": "RMrot_joint", "RF": "RFx_joint"}


def _matrix(transform):
    result = np.eye(4)
    if transform is None:
        return result
    element = transform.find("Matrix4x4")
    if element is None:
        translation = transform.find("Translation")
        if translation is not None:
            result[:3, 3] = [float(translation.get(axis)) for axis in "xyz"]
            if translation.get("units", translation.get("unit", "m")) == "mm":
                result[:3, 3] /= 1000
        turn = transform.find("RollPitchYaw")
        if turn is not None:
            degrees = turn.get("units", "radian") == "degree"
            roll, pitch, yaw = (float(turn.get(name)) * (math.pi / 180 if degrees else 1)
                                for name in ("roll", "pitch", "yaw"))
            result = result @ _turn((0, 0, 1), yaw) @ _turn((0, 1, 0), pitch) @ _turn(
                (1, 0, 0), roll)
        return result
    for i in range(4):
        row = element.find(f"row{i + 1}")
        result[i] = [float(row.get(f"c{j + 1}")) for j in range(4)]
    if element.get("units", element.get("unit", "m")) == "mm":
        result[:3, 3] /= 1000
    return result


def _turn(axis, angle):
    x, y, z = axis
    c, s = math.cos(angle), math.sin(angle)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    result = np.eye(4)
    result[:3, :3] = np.eye(3) + s * cross + (1 - c) * cross @ cross
    return result


class Chain:
    """Of the model file, for a person of that height [m]."""

    def __init__(self, model_file, height):
        self._nodes = {}
        parents = {}
        for node in ET.parse(model_file).getroot().iter("RobotNode"):
            transform = _matrix(node.find("Transform"))
            transform[:3, 3] *= height
            joint = node.find("Joint")
            axis = None
            if joint is not None and joint.get("type") == "revolute":
                element = joint.find("axis") if joint.find("axis") is not None else joint.find("Axis")
                if element is not None:
                    axis = [float(element.get(name)) for name in "xyz"]
            self._nodes[node.get("name")] = (transform, axis)
            for child in node.iter("Child"):
                parents[child.get("name")] = node.get("name")
        self._parents = parents

    def pose(self, name, root, angles):
        """Of a node: 4x4 [m], with the root at `root` (4x4) and joints at `angles` (by name)."""
        if name == "root_joint":
            return root
        transform, axis = self._nodes[name]
        result = self.pose(self._parents[name], root, angles) @ transform
        return result if axis is None else result @ _turn(axis, angles.get(name, 0.0))


def root_pose(position_mm, rpy):
    """Of MMM's RootPosition and RootRotation."""
    result = _turn((0, 0, 1), rpy[2]) @ _turn((0, 1, 0), rpy[1]) @ _turn((1, 0, 0), rpy[0])
    result[:3, 3] = np.array(position_mm) / 1000
    return result


def read_legacy(file):
    """Height [m] and frames (root, angles by name) of the motion of an MMM 1.0 file."""
    motion = ET.parse(file).getroot().find("Motion")
    names = [joint.get("name") for joint in motion.find("JointOrder")]
    numbers = lambda frame, name: [float(word) for word in frame.find(name).text.split()]
    frames = [(root_pose(numbers(frame, "RootPosition"), numbers(frame, "RootRotation")),
               dict(zip(names, numbers(frame, "JointPosition"))))
              for frame in motion.iter("MotionFrame")]
    return float(motion.find("ModelProcessorConfig/Height").text), frames


def read_sensors(file):
    """The same of the only motion of an MMM 2.0 file, at the times of its root poses."""
    motion = ET.parse(file).getroot().find("Motion")
    angles = {}
    roots = {}
    for sensor in motion.iter("Sensor"):
        if sensor.get("type") == "ModelPose":
            for one in sensor.iter("Measurement"):
                numbers = lambda name: [float(word) for word in one.find(name).text.split()]
                roots[float(one.get("timestep"))] = root_pose(
                    numbers("RootPosition"), numbers("RootRotation"))
        if sensor.get("type") == "Kinematic":
            names = [joint.get("name") for joint in sensor.iter("Joint")]
            for one in sensor.iter("Measurement"):
                values = [float(word) for word in one.find("JointPosition").text.split()]
                angles.setdefault(float(one.get("timestep")), {}).update(zip(names, values))
    frames = [(roots[time], angles[time]) for time in sorted(roots)]
    return float(motion.find(".//Height").text), frames
