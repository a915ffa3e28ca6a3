# SPDX-License-Identifier: MIT
"""Numbers over time for pandas and xarray, which are imported where they are asked for."""

import importlib

import numpy as np

AXES = ["x", "y", "z"]
QUATERNION = ["w", "x", "y", "z"]


def optional(name, for_what):
    """A module that only this needs. Raises ImportError with what to do where it is not there."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        package = name.partition(".")[0]
        raise ImportError(f"{for_what} needs {package}: pip install {package}, or Debian's python3-{package}",
                          name=name) from error


def new_axes():
    """Of matplotlib, in a figure of their own."""
    return optional("matplotlib.pyplot", "plot").subplots()[1]


def with_unit(name, unit):
    """A column's name: "height [m]"; what has no unit has none."""
    return f"{name} [{unit}]" if unit else name


def spread(names, axes):
    """Names of the columns of an array (frames, names, axes) whose last two axes are one."""
    return [f"{name} {axis}" for name in names for axis in axes]


def dataframe(times, *blocks):
    """A pandas.DataFrame over time. blocks: (names, unit, values), values of shape (frames, ...) or None."""
    pandas = optional("pandas", "to_dataframe")
    there = [block for block in blocks if block[2] is not None]
    columns = [with_unit(name, unit) for names, unit, _ in there for name in names]
    values = np.hstack([np.reshape(values, (len(times), len(names))) for names, _, values in there])
    return pandas.DataFrame(values, columns=columns, index=pandas.Index(times, name="time [s]"))


def dataset(times, coordinates, variables):
    """An xarray.Dataset over time. variables: name -> (dimensions behind time, unit, values or None)."""
    xarray = optional("xarray", "to_xarray")
    return xarray.Dataset(
        {name: (("time", *dimensions), values, {"units": unit} if unit else {})
         for name, (dimensions, unit, values) in variables.items() if values is not None},
        coords={"time": ("time", times, {"units": "s"}), **coordinates})


class Postures:
    """Tables of what has times, root_positions, root_quaternions, joints, joint_names, and perhaps sd."""

    def to_dataframe(self):
        """Root positions [m], quaternions and joints [rad] over time [s], as a pandas.DataFrame.

        Columns are called "root x [m]", "root qw", "LKx_joint [rad]"; standard deviations, where they
        are known, "root x sd [m]", "root rotation x sd [rad]" and "LKx_joint sd [rad]".
        """
        sd = self._deviations()
        of_joints = [f"{name} sd" for name in self.joint_names]
        return dataframe(
            self.times, (spread(["root"], AXES), "m", self.root_positions),
            ([f"root q{axis}" for axis in QUATERNION], "", self.root_quaternions),
            (self.joint_names, "rad", self.joints),
            ([f"root {axis} sd" for axis in AXES], "m", None if sd is None else sd[:, :3]),
            ([f"root rotation {axis} sd" for axis in AXES] + of_joints, "rad", None if sd is None else sd[:, 3:]))

    def to_xarray(self):
        """The same as an xarray.Dataset with units: root_position, root_quaternion, joint_angle, and with
        _sd behind them the standard deviations that are known; root_rotation_sd [rad]."""
        sd = self._deviations()
        parts = (None, None, None) if sd is None else (sd[:, :3], sd[:, 3:6], sd[:, 6:])
        return dataset(self.times, {"axis": AXES, "component": QUATERNION, "joint": self.joint_names}, {
            "root_position": (("axis",), "m", self.root_positions),
            "root_quaternion": (("component",), "", self.root_quaternions),
            "joint_angle": (("joint",), "rad", self.joints),
            "root_position_sd": (("axis",), "m", parts[0]),
            "root_rotation_sd": (("axis",), "rad", parts[1]),
            "joint_angle_sd": (("joint",), "rad", parts[2])})

    def plot(self, name, axes=None):
        """Draws an angle of both sides ("knee flexion") or of one ("left knee flexion") over time, in
        degrees; `Angles.plot` says more."""
        return self.angles.plot(name, axes)

    def _deviations(self):
        return getattr(self, "sd", None)
