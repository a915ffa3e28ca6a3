# SPDX-License-Identifier: MIT
"""Where feet stood, strides, and what the ground did."""

from __future__ import annotations

import os
from typing import Dict, List

import numpy as np

from ._present import Presented, WrongValue
from ._tables import optional, with_unit

SAMPLES = 101  # of a stride, from contact (0 %) to contact (100 %)
SIDES = ("left", "right")


def _table(rows, index=None):
    return optional("pandas", "ground").DataFrame(rows, index=index)


class Ground(Presented):
    """What is known of the ground under a person, as DataFrames of pandas.

    Attributes
    ----------
    contacts : pandas.DataFrame
        When each foot stood: foot, begin_s, end_s and their deviations, plates.
    loads : pandas.DataFrame
        When each force plate bore somebody, and which foot.
    strides : pandas.DataFrame
        A row for each stride: side, begin_s, end_s, cadence, speed, lengths, times.
    parameters : pandas.DataFrame
        Means of the strides' figures, their deviations and numbers, of the left and the right foot, and
        the symmetry index in percent.
    cycles : pandas.DataFrame
        Joint angles in degrees over the gait cycle, means of the strides; the index is the percent.
    moments, powers, forces : pandas.DataFrame
        The same of joint moments [N m/kg] and powers [W/kg], and of the ground's vertical force in body
        weights; empty without force plates.
    emg : pandas.DataFrame
        The same of muscles [mV], of the channels that `emg` names.
    work : pandas.DataFrame
        What hips, knees and ankles give and take in a stride [J/kg].
    mass : dict or None
        What force plates bore: kg, deviation_kg, intervals.
    kind : str
        "walking", "running", "walking backwards", "stairs" or "a ramp".
    """

    def __init__(self, raw):
        self._contacts = raw["contacts"]
        self._gait = raw["gait"]
        self.mass = self._contacts["mass"]
        self.kind: str = self._gait["kind"]

    contacts = property(lambda self: _table(self._contacts["contacts"]))
    loads = property(lambda self: _table(self._contacts["loads"]))
    strides = property(lambda self: _table(self._gait["strides"]))
    work = property(lambda self: _table(self._gait["work"]))
    moments = property(lambda self: self._curves("forces", lambda one: one["unit"] == "N m/kg"))
    powers = property(lambda self: self._curves("forces", lambda one: one["unit"] == "W/kg"))
    forces = property(lambda self: self._curves("forces", lambda one: one["joint"] == "ground"))
    emg = property(lambda self: self._curves("forces", lambda one: one["unit"] == "mV"))
    cycles = property(lambda self: self._curves("cycles", lambda one: True))

    @property
    def parameters(self):
        summary = self._gait["summary"]
        return _table({f"{side} {figure}": {name: values[figure] for name, values in summary[side].items()}
                       for side in SIDES for figure in ("mean", "sd", "strides")}
                      | {"symmetry index [%]": summary["symmetry_index_percent"]})

    def _curves(self, part, is_asked):
        columns: Dict[str, List[float]] = {}
        for one in filter(is_asked, self._gait[part]):
            name = f"{one['side']} {one['joint']} {one.get('angle') or one.get('what')}"
            columns[with_unit(name, one.get("unit", "deg"))] = one.get("mean_degrees") or one.get("mean")
        pandas = optional("pandas", "ground")
        return pandas.DataFrame(columns, index=pandas.Index(range(SAMPLES), name="percent"), dtype=float)

    def _facts(self):
        return [("ground", f"of {self.kind}"), ("contacts", len(self._contacts["contacts"])),
                ("strides", len(self._gait["strides"]))]


class Strides(Presented):
    """Strides of one or several recordings, and joint angles over each of them.

    Attributes
    ----------
    trials : list of str
        Whose each stride is: the name of its recording.
    sides : list of str
        "left" or "right": of the foot that begins and ends it.

    Examples
    --------
    >>> results = [mmmconverter.convert(file, height=1.75) for file in files]
    >>> knee = mmmconverter.strides(results)["left knee flexion"]
    >>> mean, sd = knee.mean(axis=0), knee.std(axis=0, ddof=1)
    >>> pyplot.plot(mean); pyplot.fill_between(range(101), mean - sd, mean + sd, alpha=0.3)
    """

    def __init__(self, strides):
        self._strides = strides
        self.trials: List[str] = [trial for trial, _, _ in strides]
        self.sides: List[str] = [row["side"] for _, _, row in strides]

    def __getitem__(self, name) -> np.ndarray:
        """An angle in degrees over each stride of its side, or of both feet where it has none ("pelvis
        tilt"); shape (strides, 101)."""
        side = name.split()[0] if name.split()[:1] and name.split()[0] in SIDES else None
        curves = []
        for _, result, row in self._strides:
            if side in (None, row["side"]):
                times = np.linspace(row["begin_s"], row["end_s"], SAMPLES)
                curves.append(np.interp(times, result.times, result.angles[name]))
        return np.reshape(curves, (-1, SAMPLES))

    def __len__(self):
        return len(self._strides)

    def to_dataframe(self):
        """A row for each stride, with its trial, as a pandas.DataFrame."""
        return _table([{"trial": trial, **row} for trial, _, row in self._strides])

    def _facts(self):
        return [("strides", f"of {len(set(self.trials))} recordings"), ("strides", len(self))]


def strides(results) -> Strides:
    """The strides of conversions together.

    Parameters
    ----------
    results : Conversion, or several

    Returns
    -------
    Strides
    """
    found = []
    for result in [results] if hasattr(results, "ground") else results:
        if not hasattr(result, "ground"):
            raise WrongValue(f"strides: conversions are expected, not {type(result).__name__}")
        trial = os.path.splitext(os.path.basename(result._source))[0]
        rows = result.ground._gait["strides"] if result.ground is not None else []
        found += [(trial, result, row) for row in rows]
    return Strides(found)
