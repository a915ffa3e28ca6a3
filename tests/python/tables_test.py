# SPDX-License-Identifier: MIT
"""Tables with units, for pandas and xarray, and pictures. Where a library is absent, what it would be given."""
import sys
import types
import unittest
import unittest.mock

import numpy as np

import mmmconverter
from support import Case, ROOT, SAMPLE


class Table:
    """What is used of a pandas.DataFrame."""

    def __init__(self, values, columns, index):
        self.values, self.columns, self.index = np.asarray(values), list(columns), index
        assert self.values.shape == (len(index), len(self.columns))

    def __getitem__(self, name):
        return self.values[:, self.columns.index(name)]


class Times(list):

    def __init__(self, values, name):
        super().__init__(values)
        self.name = name


class Dataset(dict):
    """What is used of an xarray.Dataset: all variables must fit the coordinates."""

    def __init__(self, variables, coords):
        super().__init__(variables)
        self.coords = coords
        sizes = {name: len(one[1] if isinstance(one, tuple) else one) for name, one in coords.items()}
        for dimensions, values, _ in variables.values():
            assert len(dimensions) == np.ndim(values)
            for dimension, size in zip(dimensions, np.shape(values)):
                assert sizes.setdefault(dimension, size) == size, dimension


class Tables(Case):

    def setUp(self):
        super().setUp()
        fakes = {"pandas": types.SimpleNamespace(DataFrame=Table, Index=Times),
                 "xarray": types.SimpleNamespace(Dataset=Dataset)}
        patch = unittest.mock.patch.dict(sys.modules, fakes)
        patch.start()
        self.addCleanup(patch.stop)

    @classmethod
    def setUpClass(cls):
        cls.result = mmmconverter.convert(SAMPLE, height=1.8, frames=(0, 20))
        cls.motion = mmmconverter.read_motion(ROOT / "examples/handstand_true.xml")

    def test_a_recording(self):
        recording = mmmconverter.read(SAMPLE)
        table = recording.to_dataframe()
        self.assertEqual(table.index.name, "time [s]")
        np.testing.assert_array_equal(table.index, recording.times)
        self.assertEqual(table.columns[:3], ["L3 x [m]", "L3 y [m]", "L3 z [m]"])
        np.testing.assert_array_equal(table["STRN z [m]"], recording.markers[:, 1, 2])
        dimensions, values, attributes = recording.to_xarray()["position"]
        self.assertEqual((dimensions, attributes), (("time", "label", "axis"), {"units": "m"}))
        np.testing.assert_array_equal(values, recording.markers)

    def test_a_conversion_has_its_deviations(self):
        result = self.result
        table = result.to_dataframe()
        np.testing.assert_array_equal(table["root z [m]"], result.root_positions[:, 2])
        np.testing.assert_array_equal(table["root qw"], result.root_quaternions[:, 0])
        knee = result.joint_names.index("LKx_joint")
        np.testing.assert_array_equal(table["LKx_joint [rad]"], result.joints[:, knee])
        np.testing.assert_array_equal(table["LKx_joint sd [rad]"], result.sd[:, 6 + knee])
        np.testing.assert_array_equal(table["root y sd [m]"], result.sd[:, 1])
        np.testing.assert_array_equal(table["root rotation x sd [rad]"], result.sd[:, 3])
        data = result.to_xarray()
        self.assertEqual(data["joint_angle_sd"][2], {"units": "rad"})
        np.testing.assert_array_equal(data["root_rotation_sd"][1], result.sd[:, 3:6])

    def test_a_motion_of_a_file_has_none(self):
        table = self.motion.to_dataframe()
        self.assertEqual(table.columns[7:], [f"{name} [rad]" for name in self.motion.joint_names])
        self.assertEqual(set(self.motion.to_xarray()), {"root_position", "root_quaternion", "joint_angle"})

    def test_a_robots_motion(self):
        moved = mmmconverter.retarget(self.motion, ROOT / "examples/robot/biped.urdf", frames=(0, 20))
        table = moved.to_dataframe()
        np.testing.assert_allclose(table.index, self.motion.times[:20])
        knee = moved.joint_names.index("left_knee")
        np.testing.assert_array_equal(table["left_knee [rad]"], moved.joints[:, knee])
        import matplotlib
        matplotlib.use("Agg")
        line, = moved.plot("left_knee").get_lines()
        np.testing.assert_array_equal(line.get_ydata(), np.degrees(moved.joints[:, knee]))

    def test_what_a_missing_library_is(self):
        with unittest.mock.patch.dict(sys.modules, {"pandas": None}):
            with self.assertRaisesRegex(ImportError, "to_dataframe needs pandas: .*python3-pandas"):
                self.motion.to_dataframe()

    def test_poses(self):
        model = mmmconverter.read_model(height=1.8)
        poses = model.forward(self.motion)
        wrist = poses.segments.index("LWx_joint")
        table = poses.to_dataframe()
        np.testing.assert_array_equal(table["LWx_joint z [m]"], poses.positions[:, wrist, 2])
        marker = f"marker {poses.marker_names[0]} x [m]"
        np.testing.assert_array_equal(table[marker], poses.markers[:, 0, 0])
        self.assertEqual(poses.to_xarray()["segment_rotation"][1].shape, (675, 129, 3, 3))
        alone = model.forward([0, 0, 1], [1, 0, 0, 0])
        with self.assertRaisesRegex(ValueError, "poses.times = "):
            alone.to_dataframe()
        alone.times = 2.5
        self.assertEqual(alone.to_xarray()["marker_position"][1].shape, (1, 53, 3))
        np.testing.assert_array_equal(alone.to_dataframe()["LWx_joint z [m]"], [alone.positions[wrist, 2]])

    def test_angles(self):
        angles = self.result.angles
        table = angles.to_dataframe()
        np.testing.assert_array_equal(table["left knee flexion [deg]"], angles["left knee flexion"])
        column = angles.names.index("right hip flexion")
        np.testing.assert_array_equal(table["right hip flexion sd [deg]"], angles.sd[:, column])
        self.assertEqual(angles.to_xarray()["angle"][2], {"units": "deg"})

    def test_angles_of_a_motion_are_those_of_its_conversion(self):
        self.result.save(self.folder / "m.xml")
        motion = mmmconverter.read_motion(self.folder / "m.xml")
        self.assertEqual(motion.file, str(self.folder / "m.xml"))
        self.assertEqual(motion.angles.names, self.result.angles.names)
        np.testing.assert_allclose(motion.angles.values, self.result.angles.values, atol=1e-5)
        of_model = self.result.model.angles(self.result)
        np.testing.assert_array_equal(of_model.values, self.result.angles.values)
        knee, trunk = (of_model.names.index(name) for name in ("left knee flexion", "trunk flexion"))
        np.testing.assert_array_equal(of_model.sd[:, knee], self.result.angles.sd[:, knee])
        # Errors of the lower and the upper spine cancel.
        self.assertTrue((of_model.sd[:, trunk] > self.result.angles.sd[:, trunk]).all())

    def test_a_motion_is_drawn(self):
        import matplotlib
        matplotlib.use("Agg")
        axes = self.motion.plot("knee flexion")
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("time [s]", "knee flexion [°]"))
        self.assertEqual([text.get_text() for text in axes.get_legend().get_texts()], ["left", "right"])
        left = self.motion.angles["left knee flexion"]
        np.testing.assert_array_equal(axes.get_lines()[0].get_ydata(), left)
        self.assertEqual(len(axes.collections), 0)  # no band without deviations
        self.assertEqual(len(self.result.plot("knee flexion").collections), 2)


if __name__ == "__main__":
    unittest.main()
