# SPDX-License-Identifier: MIT
"""Models of persons, forward kinematics, and tracking frame by frame."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Sequence

import numpy as np

from . import _mmmconverter
from ._angles import Angles
from ._options import with_options
from ._present import Presented, WrongValue, given, in_metres, of_raw, path_text
from ._recordings import keywords
from ._tables import AXES, dataframe, dataset, spread

if TYPE_CHECKING:
    from typing_extensions import Unpack
    from ._options import ReadModelOptions


class _Places(NamedTuple):
    positions: np.ndarray
    rotations: np.ndarray
    markers: np.ndarray


class Poses(_Places):
    """Where a body is; of one posture without the first axis.

    Attributes
    ----------
    positions : numpy.ndarray, shape (frames, segments, 3)
        Origins of all segments in metres.
    rotations : numpy.ndarray, shape (frames, segments, 3, 3)
        Their rotation matrices in the world.
    markers : numpy.ndarray, shape (frames, markers, 3)
        Of all model markers in metres.
    segments, marker_names : list of str
        Of the model.
    times : numpy.ndarray, shape (frames,), or None
        In seconds, where they are known.
    """

    segments: list = []
    marker_names: list = []
    times: Optional[np.ndarray] = None

    def to_dataframe(self):
        """Places of segments and markers [m] over time [s], as a pandas.DataFrame with the columns
        "LWx_joint x [m]", "marker LASI x [m]"; rotations are left out."""
        markers = [f"marker {name}" for name in self.marker_names]
        return dataframe(self._times(), (spread(self.segments, AXES), "m", self.positions),
                         (spread(markers, AXES), "m", self.markers))

    def to_xarray(self):
        """All as an xarray.Dataset: segment_position [m], segment_rotation, marker_position [m]."""
        many = self.positions.ndim > 2
        positions, rotations, markers = self if many else (one[np.newaxis] for one in self)
        return dataset(self._times(), {"segment": self.segments, "marker": self.marker_names, "axis": AXES}, {
            "segment_position": (("segment", "axis"), "m", positions),
            "segment_rotation": (("segment", "row", "column"), "", rotations),
            "marker_position": (("marker", "axis"), "m", markers)})

    def _times(self):
        if self.times is None:
            raise WrongValue("times: those of the frames are not known; set them, poses.times = ...")
        return np.atleast_1d(self.times)


class Model(Presented):
    """A kinematic model, scaled to a person. Made by `read_model` and `Conversion.model`.

    Attributes
    ----------
    segments, markers, joint_names : list of str
    parents : list of int
        Of each segment the index of the one that carries it; -1: of the root.
    limits : numpy.ndarray, shape (joints, 2)
        In radians.
    height : float or None
        That it was scaled by, in metres.
    mass : float
        In kilograms.
    """

    def __init__(self, raw):
        self._raw = raw

    file, name, segments, parents, markers, joint_names, limits, mass, height = map(of_raw, (
        "file", "name", "segments", "parents", "markers", "joint_names", "limits", "mass", "height"))

    def forward(self, root_positions: Any, root_quaternions: Any = None, joints: Any = None,
                joint_names: Optional[Sequence[str]] = None) -> Poses:
        """Poses of all segments and places of all markers, of one posture or of many at once.

        Parameters
        ----------
        root_positions : array_like, shape (3,) or (frames, 3)
            In metres; or a `Conversion`, `Motion` or `Estimate`, alone.
        root_quaternions : array_like, shape (4,) or (frames, 4)
            w, x, y, z, of length 1.
        joints : array_like, shape (joints,) or (frames, joints)
            In radians.
        joint_names : sequence of str, optional
            Of the columns of `joints`; default: all joints of the model. Others are at 0, or at their
            limit.

        Examples
        --------
        >>> model = read_model(height=1.8)
        >>> motion = mmmconverter.read_motion("examples/handstand_true.xml")
        >>> poses = model.forward(motion)
        >>> poses.markers.shape
        (675, 53, 3)
        >>> wrist = model.segments.index("LWx_joint")
        >>> np.round(poses.positions[0, wrist], 3)
        array([-0.287,  0.059,  0.886])
        """
        times = getattr(root_positions, "times", None)
        positions, quaternions, joints, joint_names = self._postures(
            root_positions, root_quaternions, joints, joint_names)
        if positions.ndim > 1:
            poses = Poses(*self._raw.forward(positions, quaternions, joints, joint_names))
        else:
            arrays = self._raw.forward(positions[np.newaxis], quaternions[np.newaxis],
                                       joints[np.newaxis], joint_names)
            poses = Poses(*(array[0] for array in arrays))
        poses.segments, poses.marker_names, poses.times = self.segments, self.markers, times
        return poses

    def place_markers(self, root_positions: Any, root_quaternions: Any = None, joints: Any = None,
                      joint_names: Optional[Sequence[str]] = None) -> np.ndarray:
        """Places of all markers alone, several times as fast as `forward`, whose arguments it has.

        Returns
        -------
        numpy.ndarray, shape (markers, 3) or (frames, markers, 3)
            In metres; the last digits may be others than those of `forward`.
        """
        positions, quaternions, joints, joint_names = self._postures(
            root_positions, root_quaternions, joints, joint_names)
        if positions.ndim > 1:
            return self._raw.place_markers(positions, quaternions, joints, joint_names)
        return self._raw.place_markers(positions[np.newaxis], quaternions[np.newaxis],
                                       joints[np.newaxis], joint_names)[0]

    def angles(self, motion) -> Angles:
        """Angles of a `Motion` or `Conversion` by their anatomical names, in degrees; with standard
        deviations where it has them, of joints whose errors are taken as independent: those of
        `Conversion.angles` know how they hang together.

        Examples
        --------
        >>> motion = mmmconverter.read_motion("examples/handstand_true.xml")
        >>> angles = read_model(height=1.8).angles(motion)
        >>> angles
        <Angles of 675 frames: names 37>
        """
        postures = self._postures(motion, None, None, None)
        return Angles(motion.times, *self._raw.angles(*postures, getattr(motion, "sd", None)))

    def _postures(self, root_positions, root_quaternions, joints, joint_names):
        if root_quaternions is None:
            source = root_positions
            is_one = hasattr(source, "root_position")
            root_positions = source.root_position if is_one else source.root_positions
            root_quaternions = source.root_quaternion if is_one else source.root_quaternions
            joints, joint_names = source.joints, source.joint_names
        positions = np.asarray(root_positions, dtype=float)
        quaternions = np.asarray(root_quaternions, dtype=float)
        joints = np.asarray(joints if joints is not None else np.zeros(positions.shape[:-1] + (0,)),
                            dtype=float)
        if joint_names is None:
            joint_names = self.joint_names if joints.shape[-1] > 0 else []
        if np.any(np.abs(np.linalg.norm(quaternions, axis=-1) - 1) > 1e-6):
            raise _mmmconverter.Error("root_quaternions: must have the length 1")
        return positions, quaternions, joints, list(joint_names)

    def _facts(self):
        size = "not scaled" if self.height is None else f"{self.height:g} m"
        return [("model", self.name), ("height", size), ("segments", len(self.segments)),
                ("joints", len(self.joint_names)), ("markers", len(self.markers))]


@with_options("read_model")
def read_model(model=None, **options: Unpack[ReadModelOptions]) -> Model:
    """The model of a person.

    Parameters
    ----------
    model : path, optional
        An MMM reference model or a URDF; default: the shipped MMM model.
    **options

    Without a person it is as the file has it, an MMM model of 1 m and 1 kg.

    Examples
    --------
    >>> read_model(height=1.75)
    <Model MMM: height 1.75 m, segments 129, joints 92, markers 53>
    """
    request = keywords(options, model=model)
    if "height" in request and not {"mass", "person", "subject"} & set(request):
        request["mass"] = 70.0
    return Model(_mmmconverter.read_model(request))


@dataclasses.dataclass(repr=False, eq=False)
class Estimate(Presented):
    """What a `Tracker` knows of a frame.

    Attributes
    ----------
    root_position, root_quaternion : numpy.ndarray, shapes (3,), (4,)
        In metres; w, x, y, z.
    joints : numpy.ndarray, shape (joints,)
        Of the tracker's `joint_names`, in radians.
    joint_names : list of str
    sd : numpy.ndarray, shape (6 + joints,), or None
        Standard deviations: root position [m], its rotation about its own axes [rad], joints [rad].
    residuals : numpy.ndarray, shape (markers,)
        Distances of measured from model markers in metres, of the tracker's `marker_labels`.
    markers_seen, markers_wrong : int
    nis : float
        Normalised innovation squared over its degrees of freedom.
    reassembled, converged : bool
    """

    root_position: np.ndarray
    root_quaternion: np.ndarray
    joints: np.ndarray
    joint_names: list
    sd: Optional[np.ndarray]
    residuals: np.ndarray
    markers_seen: int
    markers_wrong: int
    nis: float
    reassembled: bool
    converged: bool

    def _facts(self):
        of_person = np.isfinite(self.residuals).any()  # a robot has none
        return [("estimate", "of a frame"), ("markers seen", self.markers_seen),
                *([("mean distance", f"{1e3 * np.nanmean(self.residuals):.1f} mm")] if of_person else []),
                ("converged", self.converged)]


class Tracker(Presented):
    """Tracks a person frame by frame, as a live system does.

    Parameters
    ----------
    model : Model
        Of the person.
    labels : sequence of str
        Of the markers of each frame.
    config : str or path, optional
        Default: s2kf_default.
    marker_set : str or path, optional
        Which labels stand for which markers; default: the set that knows most labels.

    Attributes
    ----------
    joint_names, marker_labels : list of str
        Of the joints that are tracked, and of the markers that are used.
    warnings : list of str

    Examples
    --------
    >>> recording = mmmconverter.read("examples/handstand.c3d")
    >>> tracker = Tracker(read_model(height=1.8), recording.labels)
    >>> estimate = tracker.assemble(recording.markers[0])
    >>> for frame in recording.markers[1:10]:
    ...     estimate = tracker.track(frame, 1 / recording.rate)
    >>> estimate.joints.shape, estimate.markers_seen
    ((44,), 53)
    """

    def __init__(self, model: Model, labels: Sequence[str], config=None, *,
                 converter: Optional[str] = None, plugin=None, marker_set=None):
        self._raw = _mmmconverter.Tracker(model._raw, list(labels), given(
            config=config, converter=converter, plugin=plugin, marker_set=marker_set))
        self.labels = list(labels)
        self.joint_names = self._raw.joint_names
        self.marker_labels = self._raw.marker_labels
        self.warnings = self._raw.warnings

    def assemble(self, frame: Any) -> Estimate:
        """The posture of a first frame, from nothing. frame: shape (labels, 3), metres, NaN: not seen."""
        return Estimate(joint_names=self.joint_names, **self._raw.assemble(in_metres(frame)))

    def track(self, frame: Any, dt: float) -> Estimate:
        """The posture `dt` seconds after the last frame; any number of markers may be unseen."""
        return Estimate(joint_names=self.joint_names, **self._raw.track(frame, dt))

    def _facts(self):
        return [("tracker", "of a person"), ("joints", len(self.joint_names)),
                ("markers", len(self.marker_labels))]
