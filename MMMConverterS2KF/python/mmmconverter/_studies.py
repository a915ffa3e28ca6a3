# SPDX-License-Identifier: MIT
"""What the commands calibrate, compare, label and check-dynamics do."""

from __future__ import annotations

import functools
from typing import Callable, Optional, Sequence, Union

from . import _mmmconverter
from ._present import Presented, given, path_text
from ._progress import shown
from ._recordings import Recording, Subject, input_options, subject_file

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


class Calibration(_Study):
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

    @property
    def verdict(self) -> str:
        return self._raw.verdict

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


def calibrate(recordings, *, height: Optional[float] = None, mass: Optional[float] = None,
              hand_length: Optional[float] = None, person=None, name: Optional[str] = None,
              config=None, model=None, marker_set=None, frames=None,
              progress: Progress = None) -> Calibration:
    """Estimates segment lengths and marker places of a person, as the command does.

    Parameters
    ----------
    recordings : path or Recording, or several
        Of one person and one session, from files.
    name : str, optional
        Of the person.
    height, mass, hand_length, person, config, model, marker_set, frames, progress : optional
        As of `convert`.

    Examples
    --------
    >>> calibration = calibrate("examples/handstand.c3d", height=1.8, name="anna")
    >>> calibration.subject
    <Subject anna: height 1.800 m, mass 70.0 kg>
    """
    inputs = []
    for one in _several(recordings):
        inputs.append(dict(input_options(one, "calibrate"), **given(
            height=height, mass=mass, hand_length=hand_length, person=person, model=model,
            marker_set=marker_set, frames=frames)))
    with shown(progress, "recordings read") as callback:
        return Calibration(_mmmconverter.calibrate(inputs, given(config=config, name=name), callback))


class Comparison(_Study):
    """What `compare` measured: summary (a dict), text (a table)."""

    warnings = property(lambda self: [])

    def report(self, file) -> None:
        """Writes the page of ``compare --report``."""
        self._raw.report(path_text(file))

    def _facts(self):
        summary = self.summary
        return [("comparison of", f"{len(summary['contenders'])} configurations"),
                ("recordings", len(summary["trials"]))]


def compare(recordings, configs: Sequence = ("s2kf_default", "jacobian_gradient",
                                             "jacobian_least_squares", "jacobian_pull"), *,
            height: Optional[float] = None, mass: Optional[float] = None, subject=None,
            truths: Optional[Sequence] = None, hide: float = 0.0, repeat: int = 1, seed: int = 1,
            jobs: int = 0, model=None, marker_set=None, frames=None,
            progress: Progress = None) -> Comparison:
    """Compares configurations on recordings, as the command does.

    Parameters
    ----------
    recordings : path or Recording, or several
        From files.
    configs : sequence of str or path
    truths : sequence of path or None, optional
        MMM motions that the recordings' markers were made from.
    hide : float
        Probability with which a marker hides, in the paper's model.
    repeat, seed, jobs : int
        Runs of different hidden markers; runs at a time (0: as many as there are cores).
    height, mass, subject, model, marker_set, frames, progress : optional
        As of `convert`.

    Examples
    --------
    >>> comparison = compare("examples/handstand.c3d", ["jacobian_pull"], height=1.8, frames=(0, 20))
    >>> comparison
    <Comparison 1 configurations: recordings 1>
    """
    inputs = []
    for one in _several(recordings):
        inputs.append(dict(input_options(one, "compare"), **given(
            height=height, mass=mass, subject_file=subject_file(subject), model=model,
            marker_set=marker_set, frames=frames)))
    truths = ["" if one is None else path_text(one) for one in truths or [None] * len(inputs)]
    if len(truths) != len(inputs):
        raise _mmmconverter.Error(f"truths: {len(truths)} for {len(inputs)} recordings")
    options = {"hide": hide, "repeat": repeat, "seed": seed, "jobs": jobs, "truths": truths}
    configs = [path_text(one) for one in configs]
    with shown(progress, "runs") as callback:
        return Comparison(_mmmconverter.compare(inputs, configs, options, callback))


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


def label(recording, *, height: Optional[float] = None, mass: Optional[float] = None, subject=None,
          like=None, repair: bool = False, config=None, model=None, marker_set=None,
          progress: Progress = None) -> LabelledRecording:
    """Names the points of a recording by the body that wears them, as the command does.

    Parameters
    ----------
    recording : path or Recording
        From a file.
    like : path, optional
        A labelled recording of the person.
    repair : bool
        The recording's own labels are right unless the body says otherwise.
    height, mass, subject, config, model, marker_set, progress : optional
        As of `convert`.
    """
    options = dict(input_options(recording, "label"), **given(
        height=height, mass=mass, subject_file=subject_file(subject), model=model,
        marker_set=marker_set))
    hints = given(like=like, repair=repair, config=config)
    with shown(progress, "frames") as callback:
        return LabelledRecording(_mmmconverter.label(options, hints, callback))


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


def check_dynamics(file, *, motion: Optional[str] = None, height: Optional[float] = None,
                   mass: Optional[float] = None, subject=None, model=None, frames=None,
                   low_pass: float = 6.0,
                   progress: Progress = None) -> Dynamics:
    """Whether a human body can move like an MMM motion, as the command says.

    Parameters
    ----------
    file : path
        Of a finished motion.
    motion : str, optional
        Its name, where the file has several with joint angles.
    low_pass : float
        Cut-off before differentiation in hertz; 0: none.
    height, mass, subject, model, frames : optional
        As of `convert`; default: as the file says.

    Examples
    --------
    >>> check_dynamics("examples/handstand_true.xml").judgement
    'plausible'
    """
    options = given(file=path_text(file), motion=motion, height=height, mass=mass,
                    subject_file=subject_file(subject), model=model, frames=frames)
    with shown(progress, "frames") as callback:
        return Dynamics(_mmmconverter.check_dynamics(options, low_pass, callback))
