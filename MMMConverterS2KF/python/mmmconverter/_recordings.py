# SPDX-License-Identifier: MIT
"""What is in files: recordings, finished motions and subjects."""

from __future__ import annotations

import dataclasses
import functools
import os
from typing import TYPE_CHECKING, Any, Optional, Sequence

import numpy as np

from . import _mmmconverter
from ._angles import Angles
from ._options import with_options
from ._present import Filed, Presented, WrongValue, given, in_metres, input_text, of_raw, path_text
from ._tables import AXES, Postures, dataframe, dataset, spread

if TYPE_CHECKING:
    from typing_extensions import Unpack
    from ._options import ReadOptions


class Recording(Presented):
    """Marker positions over time, in metres with z up.

    Made by `read` and by `from_arrays`.

    Attributes
    ----------
    labels : list of str
        Of the markers, without the subject's prefix.
    rate, first_time : float
        Frames a second, and the time of the first frame in seconds.
    markers : numpy.ndarray, shape (frames, labels, 3), read-only
        Positions in metres, NaN where a marker is not seen. It is the recording's own memory:
        nothing is copied.
    file, format, unit, up_axis, motion : str
        Where it is from, and how it was read.
    subjects : list of str
        Prefixes of labels that the file has.
    height, mass : float or None
        Of the person in metres and kilograms, as an MMM file says.
    events : list of dict
        Of a C3D file: time [s] as it stands there, label, context and subject. Most systems count
        from the capture's first frame, of which the recording may be a part.
    analog : dict
        Of a C3D file, what was sampled beside the markers: rate [Hz], labels, units, and samples, a
        numpy.ndarray, shape (moments, channels), in these units, from the first frame on.
    force_plates : list of dict
        Of a C3D file: type, as C3D counts them; channels, a numpy.ndarray of columns of the samples;
        corners, shape (4, 3), in metres where the markers are; origin, shape (3,), in metres in the
        plate's own axes; None where the file has none.
    forces : dict
        Of a C3D file, what its plates measured, in the markers' axes: rate [Hz], first_time [s],
        samples_per_frame, warnings, and plates, a list of dict: number, counted from 1; force [N] on
        the person, moment [N m] about the plate's center [m], center_of_pressure [m] and the
        free_moment there [N m], arrays of shape (samples, 3), NaN where they are not known; unloaded,
        the vertical force while nobody is there [N]; loads, begin and end [s]; tells_contact.
        Every samples_per_frame-th sample is that of a frame.
    warnings : list of str
        What there was to say when it was read.
    """

    def __init__(self, raw, options):
        self._raw = raw
        self._options = options

    labels, rate, first_time, markers, file, format, unit, up_axis, motion, subjects, height, mass, warnings = map(
        of_raw, ("labels", "rate", "first_time", "markers", "file", "format", "unit", "up_axis", "motion",
                 "subjects", "height", "mass", "warnings"))

    def __reduce__(self):
        """For pickle and copies: labels and markers."""
        return _again, (self.labels, np.array(self.markers), self.rate, self.first_time, self.file)

    # What is read once.
    events = functools.cached_property(lambda self: self._raw.events)
    analog = functools.cached_property(lambda self: self._raw.analog)
    force_plates = functools.cached_property(lambda self: self._raw.force_plates)
    forces = functools.cached_property(lambda self: self._raw.forces)

    @classmethod
    def from_arrays(cls, labels: Sequence[str], markers: Any, rate: float, first_time: float = 0.0,
                    name: str = "recording") -> "Recording":
        """A recording of positions that are there already.

        Parameters
        ----------
        labels : sequence of str
            Of the markers.
        markers : array_like, shape (frames, labels, 3)
            Positions in metres with z up; NaN: not seen.
        rate : float
            Frames a second.
        first_time : float
            Of the first frame, in seconds.
        name : str
            For messages.

        Examples
        --------
        >>> import numpy as np
        >>> Recording.from_arrays(["C7", "T10"], np.zeros((5, 2, 3)), 100).markers.shape
        (5, 2, 3)
        """
        return cls(_mmmconverter.from_arrays(list(labels), in_metres(markers), rate, first_time, name), None)

    @property
    def times(self) -> np.ndarray:
        """Of all frames, shape (frames,), in seconds."""
        return self.first_time + np.arange(len(self.markers)) / self.rate

    def to_dataframe(self):
        """The markers [m] over time [s], as a pandas.DataFrame with the columns "LASI x [m]", ..."""
        return dataframe(self.times, (spread(self.labels, AXES), "m", self.markers))

    def to_xarray(self):
        """The same as an xarray.Dataset of `position` over `time`, `label` and `axis`."""
        return dataset(self.times, {"label": self.labels, "axis": AXES},
                       {"position": (("label", "axis"), "m", self.markers)})

    def save(self, file) -> None:
        """Writes the markers: .c3d with z up, or .trc with y up, as OpenSim has it; in millimetres."""
        text = path_text(file)
        ending = os.path.splitext(text)[1].lower()
        if ending not in (".c3d", ".trc"):
            raise WrongValue(f"{text}: no recording is written so; its name may end with .c3d or .trc")
        (self._raw.save_trc if ending == ".trc" else self._raw.save_c3d)(text)

    def __len__(self):
        return len(self.markers)

    def _facts(self):
        return [("recording", os.path.basename(self.file)), ("frames", len(self)),
                ("markers", len(self.labels)), ("rate", f"{self.rate:g} Hz"),
                ("format", self.format)]


def _again(labels, markers, rate, first_time, name):
    return Recording.from_arrays(labels, markers, rate, first_time, name)


@with_options("read")
def read(file, *, with_unlabelled: bool = False, **options: Unpack[ReadOptions]) -> Recording:
    """Reads the markers of a C3D, TRC or MMM file.

    Parameters
    ----------
    file : path
        Its format is told from its content.
    with_unlabelled : bool
        Points without a label, too, as "*" and a number.
    **options

    Returns
    -------
    Recording

    Raises
    ------
    Error
        Where the file is no recording, or is not clear.

    Examples
    --------
    >>> recording = read("examples/handstand.c3d")
    >>> recording.markers.shape, recording.rate
    ((675, 53, 3), 100.0)
    >>> recording.labels[:3]
    ['L3', 'STRN', 'T10']
    """
    options = keywords(options, file=input_text(file))
    raw = _mmmconverter.read(dict(options, with_unlabelled=with_unlabelled))
    return Recording(raw, options)


@dataclasses.dataclass(repr=False, eq=False)
class Motion(Postures, Presented):
    """A motion of an MMM file, or of arrays.

    Attributes
    ----------
    name, type, model : str
        Of the motion; "mmm" or "object"; the model as the file names it.
    height, mass, hand_length : float or None
        Of the person, in metres and kilograms.
    rate, first_time : float
        Of the postures, in frames a second and seconds.
    root_positions : numpy.ndarray, shape (frames, 3)
    root_quaternions : numpy.ndarray, shape (frames, 4)
        w, x, y, z.
    joint_names : list of str
    joints : numpy.ndarray, shape (frames, joints)
    labels : list of str
    markers : numpy.ndarray, shape (frames, labels, 3)
        Those that the file has; it may have none.
    file : str
        That it was read from.
    """

    name: str
    type: str
    model: str
    height: Optional[float]
    mass: Optional[float]
    hand_length: Optional[float]
    rate: float
    first_time: float
    joint_names: list
    root_positions: np.ndarray
    root_quaternions: np.ndarray
    joints: np.ndarray
    labels: list = dataclasses.field(default_factory=list)
    markers: Any = None
    file: str = ""

    @classmethod
    def from_arrays(cls, joint_names: Sequence[str], root_positions: Any, root_quaternions: Any, joints: Any,
                    rate: float, *, height: float, mass: Optional[float] = None, first_time: float = 0.0,
                    name: str = "motion") -> "Motion":
        """A motion of postures that are there already, of a person of this height [m] and mass [kg].

        Examples
        --------
        >>> import numpy as np
        >>> upright = np.tile([1.0, 0, 0, 0], (5, 1))
        >>> Motion.from_arrays(["LKx_joint"], np.zeros((5, 3)), upright, np.zeros((5, 1)), 100, height=1.8)
        <Motion motion: frames 5, joints 1, rate 100 Hz>
        """
        positions, quaternions, values = (np.asarray(one, dtype=float)
                                          for one in (root_positions, root_quaternions, joints))
        return cls(name, "mmm", "", height, mass, None, rate, first_time, list(joint_names), positions, quaternions, values)

    @functools.cached_property
    def angles(self) -> Angles:
        """Flexion, adduction and rotation of the joints in degrees, by their anatomical names, of the
        model that the file names, else of the shipped one."""
        from ._models import read_model
        named = os.path.join(os.path.dirname(self.file), self.model) if self.model else ""
        size = {"height": self.height, "mass": self.mass} if self.height else {}
        return read_model(named if os.path.isfile(named) else None, **size).angles(self)

    @property
    def times(self) -> np.ndarray:
        """Of all postures, shape (frames,), in seconds."""
        return self.first_time + np.arange(len(self.root_positions)) / self.rate

    def _facts(self):
        return [("motion", self.name), ("frames", len(self.root_positions)),
                ("joints", len(self.joint_names)), ("rate", f"{self.rate:g} Hz")]


def read_motions(file) -> "list[Motion]":
    """All motions of an MMM file (1.0 or 2.0), persons and objects.

    Examples
    --------
    >>> [motion.name for motion in read_motions("examples/handstand_true.xml")]
    ['synthetic_subject']
    """
    file = input_text(file)
    return [Motion(**one, file=file) for one in _mmmconverter.read_motions(file)]


def read_motion(file, motion: Optional[str] = None) -> Motion:
    """The motion of that name of an MMM file, or else the only one with joint angles.

    Examples
    --------
    >>> read_motion("examples/handstand_true.xml")
    <Motion synthetic_subject: frames 675, joints 44, rate 100 Hz>
    """
    motions = read_motions(file)
    found = [one for one in motions if one.name == motion] if motion is not None else [
        one for one in motions if len(one.joints) > 0 and len(one.joint_names) > 0]
    if len(found) == 1:
        return found[0]
    names = ", ".join(one.name for one in motions)
    raise _mmmconverter.Error(
        f"{path_text(file)}: which motion? It has {names or 'none'} (motion=\"NAME\")")


class Subject(Filed, Presented):
    """A calibrated person: height, mass, segment lengths and marker places.

    Attributes
    ----------
    file : str or None
        Where it is saved.
    name : str
    height, mass : float
        In metres and kilograms.
    data : dict
        All that is known, with standard deviations; the report's README.md says what is in it.
    """

    def __init__(self, data, file=None, write=None):
        self.data = data
        self.file = file
        self._write = write

    name = property(lambda self: self.data["name"])
    height = property(lambda self: self.data["height_m"])
    mass = property(lambda self: self.data["mass_kg"])

    def _facts(self):
        return [("subject", self.name), ("height", f"{self.height:.3f} m"),
                ("mass", f"{self.mass:.1f} kg")]


def read_subject(file, model=None) -> Subject:
    """A subject that `calibrate` wrote. model: its `Model`, where that is not the shipped one."""
    from ._models import read_model
    reference = model if model is not None else read_model()
    data = _mmmconverter.read_subject(input_text(file), reference._raw)
    return Subject(data, path_text(file))


def subject_file(subject):
    """The file of what a function was given as a subject; None: nothing."""
    if subject is None:
        return None
    subject = getattr(subject, "subject", subject)  # of a Calibration
    return subject._as_file() if isinstance(subject, Subject) else path_text(subject)


def keywords(options, **more):
    """What was given, as the compiled part takes it."""
    found = given(**options, **more)
    if isinstance(found.get("frames"), (slice, range)):
        frames = found["frames"]
        if frames.step not in (None, 1):
            raise WrongValue("frames: all frames between two are taken, without a step")
        found["frames"] = (frames.start, frames.stop)
    if "subject" in found:
        found["subject"] = subject_file(found["subject"])
    if "and_subjects" in found:
        one = found["and_subjects"]
        is_one = isinstance(one, (str, Subject)) or hasattr(one, "subject") or hasattr(one, "__fspath__")
        found["and_subjects"] = [subject_file(other) for other in ([one] if is_one else one)]
    return found


def input_options(recording):
    """The options that read a recording again, or the recording itself where it is of arrays."""
    if not isinstance(recording, Recording):
        return {"file": input_text(recording)}
    return {"recording": recording._raw} if recording._options is None else dict(recording._options)
