# SPDX-License-Identifier: MIT
"""What the commands calibrate, compare, label, learn-markers and check-dynamics do."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Callable, Optional, Sequence, Union

from . import _mmmconverter
from ._conversions import Conversion
from ._options import with_options
from ._present import Filed, Presented, given, input_text, path_text
from ._progress import shown
from ._recordings import Motion, Recording, Subject, input_options, keywords

if TYPE_CHECKING:
    from typing_extensions import Unpack
    from ._options import (CalibrateOptions, CheckDynamicsOptions, CompareOptions, LabelOptions,
                           LearnMarkersOptions)

Progress = Union[Callable[[int, int], None], bool, None]


class _Study(Presented):
    """summary: a dict, the JSON that the command writes; text: what it prints; warnings."""

    def __init__(self, raw):
        self._raw = raw

    @property
    def summary(self) -> dict:
        return self._raw.summary

    @property
    def text(self) -> str:
        return self._raw.text

    @property
    def warnings(self) -> list:
        return self._raw.warnings


class Judged(_Study):

    @property
    def verdict(self) -> str:
        return self._raw.verdict


class Calibration(Judged):
    """A person as `calibrate` found them.

    Attributes
    ----------
    subject : Subject
        For `convert` and `read_model`.
    verdict : str
        "good", "check" or "failed".
    summary : dict
    text : str
    warnings : list of str
    """

    @functools.cached_property
    def subject(self) -> Subject:
        return Subject(self.summary["subject"], None, self._raw.save)

    def save(self, file) -> None:
        """Writes the subject."""
        self._raw.save(path_text(file))
        self.subject.file = path_text(file)

    def save_model(self, file) -> None:
        """Writes the subject's model, for other programs."""
        self._raw.save_model(path_text(file))

    def _facts(self):
        return [("calibration of", self.subject.name), ("height", f"{self.subject.height:.3f} m"),
                ("verdict", self.verdict)]


def _several(recordings):
    is_one = isinstance(recordings, (str, bytes, Recording)) or hasattr(recordings, "__fspath__")
    return [recordings] if is_one else list(recordings)


@with_options("calibrate")
def calibrate(recordings, *, name: Optional[str] = None, progress: Progress = None,
              **options: Unpack[CalibrateOptions]) -> Calibration:
    """Estimates segment lengths and marker places of a person, as the command does.

    Parameters
    ----------
    recordings : path or Recording, or several
        Of one person and one session.
    name : str, optional
        Of the person.
    progress : optional
        As of `convert`.
    **options

    Examples
    --------
    >>> calibration = calibrate("examples/handstand.c3d", height=1.8, name="anna")
    >>> calibration.subject
    <Subject anna: height 1.800 m, mass 70.0 kg>
    """
    request = keywords(options)
    inputs = [{**input_options(one), **request} for one in _several(recordings)]
    with shown(progress, "recordings read") as callback:
        return Calibration(_mmmconverter.calibrate(inputs, given(**request, name=name), callback))


class Comparison(_Study):
    """What `compare` measured: summary (a dict), text (a table)."""

    @property
    def warnings(self) -> list:
        return []

    def report(self, file) -> None:
        """Writes the page of ``compare --report``."""
        self._raw.report(path_text(file))

    def _facts(self):
        summary = self.summary
        return [("comparison of", f"{len(summary['contenders'])} configurations"),
                ("recordings", len(summary["trials"]))]


@with_options("compare")
def compare(recordings, configs: Sequence = ("s2kf_default", "jacobian_gradient",
                                             "jacobian_least_squares", "jacobian_pull"), *,
            truths: Optional[Sequence] = None, progress: Progress = None,
            **options: Unpack[CompareOptions]) -> Comparison:
    """Compares configurations on recordings, as the command does.

    Parameters
    ----------
    recordings : path or Recording, or several
    configs : sequence of str or path
    truths : sequence of path or None, optional
        MMM motions that the recordings' markers were made from.
    progress : optional
        As of `convert`.
    **options

    Examples
    --------
    >>> comparison = compare("examples/handstand.c3d", ["jacobian_pull"], height=1.8, frames=(0, 20))
    >>> comparison
    <Comparison 1 configurations: recordings 1>
    """
    request = keywords(options)
    inputs = [{**input_options(one), **request} for one in _several(recordings)]
    truths = ["" if one is None else path_text(one) for one in truths or [None] * len(inputs)]
    if len(truths) != len(inputs):
        raise _mmmconverter.Error(f"truths: {len(truths)} for {len(inputs)} recordings")
    configs = [path_text(one) for one in configs]
    with shown(progress, "runs") as callback:
        return Comparison(_mmmconverter.compare(inputs, configs, truths, request, callback))


class LabelledRecording(_Study):
    """Names that `label` found: recording, summary, text, warnings."""

    @functools.cached_property
    def recording(self) -> Recording:
        """With the names; what has none is called "*" and a number."""
        return Recording(self._raw.recording, None)

    def save(self, file) -> None:
        """Writes the recording under the names; a C3D file as C3D keeps all else."""
        self._raw.save(path_text(file))

    def report(self, file) -> None:
        """Writes the page of ``label --report``."""
        self._raw.report(path_text(file))

    def _facts(self):
        return [("labels of", self.recording.file), ("points", len(self.recording.labels))]


@with_options("label")
def label(recording, *, progress: Progress = None,
          **options: Unpack[LabelOptions]) -> LabelledRecording:
    """Names the points of a recording by the body that wears them, as the command does.

    Parameters
    ----------
    recording : path or Recording
    progress : optional
        As of `convert`.
    **options
    """
    request = {**input_options(recording), **keywords(options)}
    with shown(progress, "frames") as callback:
        return LabelledRecording(_mmmconverter.label(request, callback))


class LearnedMarkers(Filed, _Study):
    """Where markers that no marker set knows are worn: summary, text, warnings. It may stand for the
    marker set's file: ``convert(recording, marker_set=learned)``.

    Attributes
    ----------
    file : str or None
        Where it is saved.
    """

    def save(self, file) -> None:
        """Writes the marker set."""
        self._raw.save(path_text(file))
        self.file = path_text(file)

    def _write(self, file):
        self._raw.save(file)

    def __fspath__(self) -> str:
        return self._as_file()

    def _facts(self):
        summary = self.summary
        learnt = sum(one["left_out"] is None for one in summary["markers"])
        return [("marker set", f"of {len(summary['inputs'])} recordings"), ("markers", learnt),
                ("mean distance", f"{summary['mean_distance_mm']:.1f} mm")]


@with_options("learn_markers")
def learn_markers(recordings, *, name: Optional[str] = None, progress: Progress = None,
                  **options: Unpack[LearnMarkersOptions]) -> LearnedMarkers:
    """Finds where markers are worn whose labels nobody knows, as the command learn-markers does.

    Parameters
    ----------
    recordings : path or Recording, or several
        Of one person and one session.
    name : str, optional
        Of the marker set; default: that of its file.
    progress : optional
        As of `convert`.
    **options
    """
    options = keywords(options)
    inputs = [{**input_options(one), **options} for one in _several(recordings)]
    with shown(progress, "steps") as callback:
        return LearnedMarkers(_mmmconverter.learn_markers(inputs, given(**options, name=name), callback))


class Dynamics(_Study):
    """What `check_dynamics` found: summary, text, warnings.

    Attributes
    ----------
    judgement : str
        "plausible", "implausible" or "not judged".
    """

    @property
    def judgement(self) -> str:
        return self._raw.judgement

    def report(self, file) -> None:
        """Writes the page of ``check-dynamics --report``."""
        self._raw.report(path_text(file))

    def _facts(self):
        return [("dynamics", self.judgement), ("checks", len(self.summary["checks"]))]


def finished(motion):
    """Of a Motion or Conversion what the compiled part takes, and a name; None: it is none."""
    if isinstance(motion, Motion):
        return vars(motion), motion.file or motion.name
    return (motion._raw, motion._source) if isinstance(motion, Conversion) else None


@with_options("check_dynamics")
def check_dynamics(file, *, progress: Progress = None,
                   **options: Unpack[CheckDynamicsOptions]) -> Dynamics:
    """Whether a human body can move like a motion, as the command says.

    Parameters
    ----------
    file : path, Motion or Conversion
        A finished motion; `Motion.from_arrays` makes one. A conversion has its model and person.
    progress : optional
        As of `convert`.
    **options

    Examples
    --------
    >>> check_dynamics("examples/handstand_true.xml").judgement
    'plausible'
    """
    raw, source = finished(file) or (None, input_text(file))
    request = keywords(options, file=source)
    with shown(progress, "frames") as callback:
        return Dynamics(_mmmconverter.check_dynamics(raw, request, callback))
