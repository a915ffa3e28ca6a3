# SPDX-License-Identifier: MIT
"""What export-poses writes for NumPy."""
import unittest
import zipfile

import numpy as np

import mmm_chain
from support import Case, ROOT, SAMPLE

MODEL = ROOT / "xml_config/models/mmm.xml"


class Poses(Case):

    def export(self, motion, *options):
        output = self.folder / "poses.npz"
        self.run_program("export-poses", motion, "-o", output, *options)
        with zipfile.ZipFile(output) as archive:
            self.assertIsNone(archive.testzip())
        return dict(np.load(output))

    def expect_points(self, poses, chain, frames, bound):
        self.assertEqual(list(poses["points"]), list(mmm_chain.POINTS))
        self.assertEqual(len(poses["time"]), len(frames))
        for k in range(0, len(frames), max(1, len(frames) // 50)):
            root, angles = frames[k]
            for i, node in enumerate(mmm_chain.POINTS.values()):
                expected = chain.pose(node, root, angles)[:3, 3]
                distance = np.linalg.norm(poses["point_positions"][k, i] - expected)
                self.assertLess(distance, bound, f"{node}, frame {k}")

    def test_joints_of_the_sample(self):
        motion = ROOT / "examples/handstand_true.xml"
        height, frames = mmm_chain.read_sensors(motion)
        poses = self.export(motion)
        self.expect_points(poses, mmm_chain.Chain(MODEL, height), frames, 1e-9)

    def test_a_point_for_each_joint_angle(self):
        motion = ROOT / "examples/handstand_true.xml"
        height, frames = mmm_chain.read_sensors(motion)
        chain = mmm_chain.Chain(MODEL, height)
        poses = self.export(motion, "--points", "kit44", "--frames", ":5")
        # The order of the file, which has it as KIT's files have.
        self.assertEqual(list(poses["points"]), list(frames[0][1]))
        self.assertEqual(poses["point_positions"].shape, (5, 44, 3))
        for i, joint in enumerate(poses["points"]):
            expected = chain.pose(joint, *frames[4])[:3, 3]
            np.testing.assert_allclose(poses["point_positions"][4, i], expected, atol=1e-9)

    def test_forms_of_rotations_agree(self):
        motion = ROOT / "examples/handstand_true.xml"
        options = ("--frames", "100:110", "--segments", "LWx_joint,RFx_joint")
        matrices = self.export(motion, *options, "--rotation", "matrix")["segment_rotations"]
        quaternions = self.export(motion, *options)["segment_rotations"]
        vectors = self.export(motion, *options, "--rotation", "vector")["segment_rotations"]
        self.assertEqual(matrices.shape, (10, 2, 3, 3))
        for k in range(10):
            for i in range(2):
                w, x, y, z = quaternions[k, i]
                cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
                of_quaternion = np.eye(3) + 2 * w * cross + 2 * cross @ cross
                angle = np.linalg.norm(vectors[k, i])
                of_vector = mmm_chain._turn(vectors[k, i] / angle, angle)[:3, :3]
                np.testing.assert_allclose(of_quaternion, matrices[k, i], atol=1e-12)
                np.testing.assert_allclose(of_vector, matrices[k, i], atol=1e-12)

    def test_a_conversion_says_what_its_motion_says(self):
        self.run_program("convert", SAMPLE, "--height", "1.8", "--frames", ":30", "-c",
                         "s2kf_offline", "-o", self.folder / "m.xml", "--export-poses",
                         self.folder / "m.npz")
        converted = dict(np.load(self.folder / "m.npz"))
        finished = self.export(self.folder / "m.xml")
        self.assertEqual(set(converted) - set(finished), {
            "segment_velocities", "segment_angular_velocities", "point_velocities",
            "center_of_mass_velocity"})
        for name, values in finished.items():
            if values.dtype.kind == "U":
                self.assertEqual(values.tolist(), converted[name].tolist())
            else:  # the motion's file has eight decimals
                np.testing.assert_allclose(values, converted[name], atol=1e-6)


if __name__ == "__main__":
    unittest.main()
