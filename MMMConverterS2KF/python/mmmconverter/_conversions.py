# SPDX-License-Identifier: MIT
"""From a recording to a motion."""

from __future__ import annotations

import functools
import os
from typing import TYPE_CHECKING, Callable, Union

import numpy as np

from . import _mmmconverter
from ._angles import Angles
from ._ground import Ground
from ._models import Model
from ._options import with_options
from ._present import Kept, Presented, WrongValue, input_text, of_raw, path_text
from ._progress import shown
from ._recordings import Recording, keywords
from ._stills import draw_stills, still_frames
from ._tables import Postures

if TYPE_CHECKING:
    from typing_extensions import Unpack
    from ._options import ConvertOptions


class Conversion(Postures, Presented):
    """What `convert` found. J joints are tracked, M markers are used.

    Attributes
    ----------
    times : numpy.ndarray, shape (frames,)
        In seconds.
    rate : float
        Frames a second.
    root_positions : numpy.ndarray, shape (frames, 3)
        Of the model's root in the world, in metres.
    root_quaternions : numpy.ndarray, shape (frames, 4)
        w, x, y, z.
    joint_names : list of str
    joints : numpy.ndarray, shape (frames, J)
        In radians.
    sd : numpy.ndarray, shape (frames, 6 + J), or None
        Standard deviations: root position [m], its rotation about its own axes [rad], joints [rad].
    covariances : (numpy.ndarray, shape (k,), numpy.ndarray, shape (k, 6 + J, 6 + J)), or None
        Where they were asked for: the frames in which they were computed, some 13 a second, and
        covariances of what `sd` is of; their diagonals are its squares.
    velocities, accelerations : numpy.ndarray, shape (frames, 6 + J), or None
        Of the root's position and its rotation in the world, and of joints, per second and per second
        squared; where postures are smooth (config="s2kf_offline").
    angles : Angles
        Flexion, adduction and rotation of the joints in degrees, by their anatomical names.
    ground : Ground, or None
        Contacts, strides, and with force plates loads, moments and powers; None: the model has no feet.
    marker_labels : list of str
    residuals : numpy.ndarray, shape (frames, M)
        Distances of measured from model markers in metres; NaN: not seen.
    incidents : list of dict
        Labels that were wrong for a while: kind, marker, other, first_frame, last_frame.
    frames : dict of numpy.ndarray, shape (frames,)
        markers_seen, markers_wrong, nis, reassembled, converged.
    summary : dict
        The JSON that ``convert --summary`` writes.
    text : str
        The same in a dozen lines.
    verdict : str
        "good", "check" or "failed".
    reasons, warnings : list of str
    model : Model
        Of the person.
    """

    def __init__(self, raw, source):
        self._raw = raw
        self._source = source

    rate, verdict, reasons, warnings, text = map(
        of_raw, ("rate", "verdict", "reasons", "warnings", "text"))

    def __getstate__(self):
        """For pickle and copies: all numbers. A copy has no model, and writes nothing."""
        names = ("rate", "verdict", "reasons", "warnings", "text", "times", "joint_names", "postures", "sd",
                 "velocities", "accelerations", "residuals", "covariances", "marker_labels", "incidents",
                 "frames", "angles", "summary", "ground")
        return {"_source": self._source, "_raw": Kept({name: getattr(self._raw, name) for name in names})}

    # What is computed or copied once.
    times = functools.cached_property(lambda self: self._raw.times)
    joint_names = functools.cached_property(lambda self: self._raw.joint_names)
    _postures = functools.cached_property(lambda self: self._raw.postures)
    sd = functools.cached_property(lambda self: self._raw.sd)
    velocities = functools.cached_property(lambda self: self._raw.velocities)
    accelerations = functools.cached_property(lambda self: self._raw.accelerations)
    residuals = functools.cached_property(lambda self: self._raw.residuals)
    covariances = functools.cached_property(lambda self: self._raw.covariances)
    marker_labels = functools.cached_property(lambda self: self._raw.marker_labels)
    incidents = functools.cached_property(lambda self: self._raw.incidents)
    frames = functools.cached_property(lambda self: self._raw.frames)
    angles = functools.cached_property(lambda self: Angles(self.times, *self._raw.angles))
    model = functools.cached_property(lambda self: Model(self._raw.model))
    ground = functools.cached_property(lambda self: self._raw.ground and Ground(self._raw.ground))

    @property
    def root_positions(self) -> np.ndarray:
        return self._postures[0]

    @property
    def root_quaternions(self) -> np.ndarray:
        return self._postures[1]

    @property
    def joints(self) -> np.ndarray:
        return self._postures[2]

    @property
    def summary(self) -> dict:
        return self._raw.summary

    def save(self, file) -> None:
        """Writes the motion, or what the ending of the file's name says.

        .xml, or no ending: an MMM motion, the bytes that ``convert -o`` writes; .csv, .trc, .mot, .npz
        and .bvh: what ``--export-csv``, ..., ``--export-poses`` and ``--export-bvh`` write. Another
        ending is an error.
        """
        file = path_text(file)
        ending = os.path.splitext(file)[1].lower()[1:]
        for name, of_files in _mmmconverter.exporters():
            if ending == of_files:
                self._raw.export(name, file)
                return
        if ending not in ("", "xml", "mmm"):
            known = sorted({"xml"} | {of_files for _, of_files in _mmmconverter.exporters()})
            raise WrongValue(f"{file}: no motion is called so; its name may end with .{', .'.join(known)}")
        self._raw.save(file)

    def report(self, file) -> None:
        """Writes the page of ``convert --report``."""
        self._raw.report(path_text(file))

    def __len__(self):
        return len(self.times)

    def _facts(self):
        residuals = self.residuals
        mean = np.nanmean(residuals) if np.isfinite(residuals).any() else np.nan
        return [("conversion of", os.path.basename(self._source)), ("frames", len(self)),
                ("joints", len(self.joint_names)), ("markers", len(self.marker_labels)),
                ("mean distance", f"{1e3 * mean:.1f} mm"), ("verdict", self.verdict)]

    def _repr_html_(self):
        frames = still_frames(self.root_quaternions, self.joints)
        poses = self.model.forward(self.root_positions[frames], self.root_quaternions[frames],
                                   self.joints[frames], self.joint_names)
        stills = draw_stills(poses.positions, self.model.parents, self.times[frames])
        return super()._repr_html_() + stills


@with_options("convert")
def convert(recording, *, progress: Union[Callable[[int, int], None], bool, None] = None,
            **options: Unpack[ConvertOptions]) -> Conversion:
    """Converts a recording into a motion, as the command ``convert`` does; writes nothing.

    Other threads run meanwhile; Ctrl-C ends it.

    Parameters
    ----------
    recording : Recording or path
        Of a `Recording`, what it was read with stays (unit, up, rate, ...); to find labels, it must
        have been read `with_unlabelled`.
    progress : callable or False, optional
        Is called with (frames done, all frames) some 20 times a second. What it raises ends the
        conversion. Default: a bar on the standard error in a terminal or a notebook, after a second;
        False: none.
    **options

    Returns
    -------
    Conversion

    Raises
    ------
    Error
        With the text that the program would print.

    Examples
    --------
    >>> result = convert("examples/handstand.c3d", height=1.8, config="s2kf_offline", frames=(0, 60))
    >>> result
    <Conversion handstand.c3d: frames 60, joints 44, markers 53, mean distance 38.5 mm, verdict check>
    >>> result.root_positions.shape, result.velocities.shape
    ((60, 3), (60, 50))
    """
    source = recording.file if isinstance(recording, Recording) else input_text(recording)
    request = keywords(options, file=source)
    raw = recording._raw if isinstance(recording, Recording) else None
    if raw is not None:
        was_read = recording._options or {}
        for name, *_ in _mmmconverter.options("read"):
            if name in request and request[name] != was_read.get(name):
                raise WrongValue(f"{name}: the recording was read without it; give it to read()")
    if raw is not None and recording._options is not None:
        request = {**recording._options, **request}
    with shown(progress, "frames") as callback:
        return Conversion(_mmmconverter.convert(dict(request, recording=raw), callback), source)
