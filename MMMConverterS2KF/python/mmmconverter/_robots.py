# SPDX-License-Identifier: MIT
"""What the command retarget does."""

from __future__ import annotations

from typing import TYPE_CHECKING, Mapping, Optional, Sequence, Union

import numpy as np

from . import _mmmconverter
from ._conversions import Conversion
from ._options import with_options
from ._present import WrongValue, path_text
from ._progress import shown
from ._recordings import input_options, keywords
from ._studies import Judged, Progress, finished
from ._tables import Postures, new_axes

if TYPE_CHECKING:
    from typing_extensions import Unpack
    from ._options import RetargetOptions


class Retargeted(Postures, Judged):
    """A motion that `retarget` brought to a robot.

    Attributes
    ----------
    times : array (frames,)
        [s]
    root_positions : array (frames, 3)
        Of the robot's root [m].
    root_quaternions : array (frames, 4)
        w, x, y, z.
    joints : array (frames, joints)
        Angles [rad], shifts [m].
    joint_names : list of str
    rate : float
        [Hz]
    verdict : str
        "good", "check" or "failed".
    summary : dict
    text : str
    warnings : list of str
    """

    def __init__(self, raw):
        super().__init__(raw)
        self.rate, self.joint_names = raw.rate, raw.joint_names
        self.root_positions, self.root_quaternions, self.joints = raw.arrays
        self.times = raw.first_time + np.arange(len(self.joints)) / self.rate

    def plot(self, name, axes=None):
        """Draws a joint of the robot over time, in degrees. Returns the matplotlib.axes.Axes."""
        if name not in self.joint_names:
            raise KeyError(f"no joint is called {name!r}; there are {', '.join(self.joint_names)}")
        axes = axes if axes is not None else new_axes()
        axes.plot(self.times, np.degrees(self.joints[:, self.joint_names.index(name)]), label=name)
        axes.set_xlabel("time [s]")
        axes.set_ylabel("joint [°]")
        axes.legend()
        return axes

    def save(self, file) -> None:
        """Writes an MMM motion (.xml) with the robot's model; `export` writes other formats."""
        if not path_text(file).endswith(".xml"):
            raise ValueError(f"save: {path_text(file)}: is an MMM motion, .xml; export writes other formats")
        self._raw.save(path_text(file))

    def export(self, format, file, *, rate=None, order=None) -> None:
        """Writes what robot learning reads, as ``retarget --export-FORMAT``.

        Parameters
        ----------
        format : str
            "lafan1", "gmr", "mujoco", "locomujoco", "beyondmimic", "mjlab" or "phc".
        file : path
        rate : float, optional
            [Hz]; default: what the format's readers expect.
        order : str, optional
            Of joints where no file tells it: "isaac" or "mujoco".
        """
        self._raw.export(format, path_text(file), rate, order)

    def report(self, file) -> None:
        """Writes the page of ``retarget --report``."""
        self._raw.report(path_text(file))

    def _facts(self):
        return [("robot", self.summary["robot"]), ("frames", len(self.joints)), ("verdict", self.verdict)]


def robot_options(hold, sole, weights):
    """The options hold, sole and weights for the compiled part."""
    options = {"hold": ",".join(f"{name}={float(angle)!r}" for name, angle in hold.items())} if hold else {}
    if sole is not None:
        options["sole"] = sole if isinstance(sole, str) else ",".join(repr(float(size)) for size in sole)
    if weights:
        options["weights"] = ",".join(f"{group}={float(weight)!r}" for group, weight in weights.items())
    return options


@with_options("retarget")
def retarget(recording, robot, *, map=None, sole_height: Optional[float] = None,
             sole: Union[str, Sequence[float], None] = None,
             hold: Optional[Mapping[str, float]] = None,
             weights: Optional[Mapping[str, float]] = None, objects=None, progress: Progress = None,
             **options: Unpack[RetargetOptions]) -> Retargeted:
    """Brings a person's motion to a humanoid robot, as the command does.

    Parameters
    ----------
    recording : path, Recording, Conversion or Motion
        A recording, which is converted first, or a finished motion.
    robot : path
        URDF or MJCF.
    map : path, optional
        Which joints are its limbs, instead of what its structure tells.
    sole_height : float, optional
        Of the last ankle link's origin above the sole [m], where the file does not tell it.
    sole : (float, float, float) or str, optional
        Length and width of the feet and the height of that origin [m], where the file has neither
        shapes nor meshes; of both "shapes" or "meshes".
    hold : dict, optional
        Angles of joints that follow nobody [deg; sliding mm] by name; ``*`` is any text:
        ``{"left_hand_*": 30}``.
    weights : dict, optional
        How much "feet", "hands", "trunk" and "limbs" count against each other, 0.01 to 100.
    objects : path or list of them, optional
        MMM files of rigid objects beside the person, or FILE:NAME,NAME; hands that hold one keep
        their place at it.
    progress : optional
        As of `convert`.
    **options

    Examples
    --------
    >>> moved = retarget("examples/handstand_true.xml", "examples/robot/biped.urdf", frames=(0, 50))
    >>> moved.joints.shape
    (50, 21)
    """
    raw, source = finished(recording) or (None, None)
    request = keywords(options)
    if isinstance(recording, Conversion) and request:
        raise WrongValue(f"{next(iter(request))}: a conversion is taken as it is; give it to convert()")
    request.update(input_options(recording) if raw is None else {"file": source}, robot=path_text(robot),
                   **robot_options(hold, sole, weights))
    if objects is not None:
        several = objects if isinstance(objects, (list, tuple)) else [objects]
        request["objects"] = [path_text(one) for one in several]
    with shown(progress, "frames") as callback:
        return Retargeted(_mmmconverter.retarget(raw, request, path_text(map) if map is not None else "",
                                                 sole_height, callback))
