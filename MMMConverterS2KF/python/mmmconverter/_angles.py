# SPDX-License-Identifier: MIT
"""Joint angles by the names that people have for them."""

from __future__ import annotations

from typing import List

import numpy as np

from ._present import Presented
from ._tables import dataframe, dataset, new_axes

COLOURS = {"left": "#c8553d", "right": "#2a7f9e", "": "#444444"}


class Angles(Presented):
    """Joint angles by their anatomical names, in degrees: "left knee flexion", "pelvis tilt".

    Attributes
    ----------
    times : numpy.ndarray, shape (frames,)
        In seconds.
    names : list of str
    values : numpy.ndarray, shape (frames, names)
        In degrees.
    sd : numpy.ndarray, shape (frames, names), or None
        Their standard deviations, in degrees.

    Examples
    --------
    >>> result = mmmconverter.convert("examples/handstand.c3d", height=1.8)
    >>> knee = result.angles["left knee flexion"]
    >>> knee.shape
    (675,)
    """

    def __init__(self, times, names, values, sd):
        self.times = times
        self._names = names
        self.names: List[str] = [" ".join(filter(None, (side, joint, motion)))
                                 for joint, side, motion in names]
        self.values = np.degrees(values)
        self.sd = None if sd is None else np.degrees(sd)

    def __getitem__(self, name) -> np.ndarray:
        return self.values[:, self._column(name)]

    def __len__(self):
        return len(self.times)

    def to_dataframe(self):
        """The angles and their standard deviations [degrees] over time [s], as a pandas.DataFrame with the
        columns "left knee flexion [deg]", "left knee flexion sd [deg]"."""
        return dataframe(self.times, (self.names, "deg", self.values),
                         ([f"{name} sd" for name in self.names], "deg", self.sd))

    def to_xarray(self):
        """The same as an xarray.Dataset of `angle` and `angle_sd` over `time` and `name`, with units."""
        return dataset(self.times, {"name": self.names},
                       {"angle": (("name",), "deg", self.values), "angle_sd": (("name",), "deg", self.sd)})

    def plot(self, name, axes=None):
        """Draws an angle of both sides ("knee flexion") or of one ("left knee flexion"), with the band
        of two standard deviations. Returns the matplotlib.axes.Axes."""
        chosen = [column for column, (joint, _, motion) in enumerate(self._names)
                  if name == f"{joint} {motion}"] or [self._column(name)]
        if axes is None:
            axes = new_axes()
        for column in chosen:
            side = self._names[column][1]
            line, = axes.plot(self.times, self.values[:, column], color=COLOURS[side], label=side or name)
            if self.sd is not None:
                reach = 2 * self.sd[:, column]
                axes.fill_between(self.times, self.values[:, column] - reach, self.values[:, column] + reach,
                                  color=line.get_color(), alpha=0.25, linewidth=0)
        axes.set_xlabel("time [s]")
        axes.set_ylabel(f"{name} [°]")
        axes.legend()
        return axes

    def _column(self, name) -> int:
        if name not in self.names:
            raise KeyError(f"no angle is called {name!r}; there are {', '.join(self.names)}")
        return self.names.index(name)

    def _facts(self):
        return [("angles", f"of {len(self)} frames"), ("names", len(self.names))]
