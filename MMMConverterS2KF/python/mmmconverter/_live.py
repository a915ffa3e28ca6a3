# SPDX-License-Identifier: MIT
"""Postures while frames come, as the command live has them."""

from __future__ import annotations

import dataclasses
import warnings
from typing import TYPE_CHECKING, Iterator, List, Mapping, Optional, Sequence, Union

import numpy as np

from . import _mmmconverter
from ._models import Estimate, Model
from ._options import with_options
from ._present import Presented, WrongValue, of_raw, path_text
from ._recordings import keywords
from ._robots import robot_options

if TYPE_CHECKING:
    from typing_extensions import Unpack
    from ._options import LiveOptions


class LiveBody(Presented):
    """Whose postures a stream has: another one with each person, calibration and set of labels.

    Attributes
    ----------
    name : str
    labels, marker_labels : list of str
        Of `LivePosture.markers`, and of those of them that are tracked.
    rate : float
        Of the source, in frames a second; 0: not known.
    is_calibrated : bool
    model : Model
        Scaled to the person.
    """

    def __init__(self, raw):
        self._raw = raw

    name, labels, marker_labels, rate, is_calibrated = map(of_raw, (
        "name", "labels", "marker_labels", "rate", "is_calibrated"))

    @property
    def model(self) -> Model:
        return Model(self._raw.model)

    def _facts(self):
        return [("body", self.name), ("labels", len(self.labels)),
                ("calibrated", "yes" if self.is_calibrated else "no")]


@dataclasses.dataclass(repr=False, eq=False)
class LivePosture(Estimate):
    """A posture of a `Live` stream: an `Estimate`, and

    Attributes
    ----------
    frame : int
        The source's number.
    time : float
        By the source's clock, in seconds; it goes on where the source was away.
    markers : numpy.ndarray, shape (labels, 3)
        In metres, z up; NaN: not seen.
    delay : float
        From the frame's arrival until it was tracked, in seconds.
    stage : str
        What the tracker is at, in words.
    body : LiveBody
    """

    frame: int
    time: float
    markers: np.ndarray
    delay: float
    stage: str
    body: LiveBody

    def _facts(self):
        return [("posture", f"of frame {self.frame}"), ("time", f"{self.time:.3f} s"),
                *super()._facts()[1:]]


class Live(Presented):
    """Postures of a stream, one after the other. Made by `live`; ``with`` closes it at its end.

    Attributes
    ----------
    messages : list of str
        What there was to say until now, as the program's log has it.
    stage : str
        What the tracker is at, in words.
    frames, dropped : int
        Taken of the source until now, and those of them that a newer one took the place of.
    """

    def __init__(self, source, options, loop, calibrate_seconds, seconds, sole_height):
        self.source = source
        self.messages: List[str] = []
        self._bodies: dict = {}  # by name, each with what it is made of
        messages = self.messages  # not self: the compiled part lives no longer than this

        def tell(is_warning, text):
            messages.append(text)
            if is_warning:
                warnings.warn(text, RuntimeWarning, stacklevel=4)

        self._raw = _mmmconverter.Live(options, loop, calibrate_seconds, seconds, sole_height, tell)

    stage, frames, dropped = map(of_raw, ("stage", "frames", "dropped"))

    def __iter__(self) -> Iterator[LivePosture]:
        return self

    def __next__(self) -> LivePosture:
        found = self._raw.next()
        if found is None:
            raise StopIteration
        raw = found["body"]
        known = self._bodies.get(raw.name)
        if known is None or known[0] is not raw:
            known = self._bodies[raw.name] = (raw, LiveBody(raw))
        return LivePosture(**{**found, "body": known[1]})

    def close(self) -> None:
        """Ends tracking and leaves the source; then there are no more postures."""
        self._raw.close()

    def __enter__(self) -> Live:
        return self

    def __exit__(self, *_) -> None:
        self.close()

    def _facts(self):
        return [("stream", self.source), ("frames", self.frames), ("stage", self.stage)]


@with_options("live")
def live(source: str, *, robot=None, map=None, sole_height: Optional[float] = None,
         sole: Union[str, Sequence[float], None] = None,
         hold: Optional[Mapping[str, float]] = None,
         weights: Optional[Mapping[str, float]] = None, loop: bool = False,
         seconds: Optional[float] = None, calibrate_seconds: Optional[float] = None,
         **options: Unpack[LiveOptions]) -> Live:
    """Tracks a person while frames come, as the command ``live`` does; the postures are an iterator.

    Reading and tracking run in threads of their own from the first posture that is asked for, until
    the source ends, the stream is closed or nobody has it any more; Ctrl-C and errors close it. Where
    a loop is slower than the source, postures that wait give way to newer ones; a replay ``@max``
    waits for the loop. Frames without a person have no posture. With `and_models` a frame has a posture
    of each body, one after the other; `LivePosture.body` says whose it is.

    Parameters
    ----------
    source : str
        "qtm://HOST", "natnet://HOST" or "replay:FILE@SPEED", as of the command.
    robot : path, optional
        A robot, URDF or MJCF, that follows the person: the postures are its.
    map, sole_height, sole, hold, weights
        Of the robot, as of `retarget`.
    loop : bool
        A replay begins again at its end.
    seconds : float, optional
        End after so many.
    calibrate_seconds : float, optional
        Of movement that `self_calibrate` gathers; default: 15.
    **options

    Raises
    ------
    Error
        Here where the source's address is wrong; from the iterator where the source can't be reached
        or tells neither labels nor a person.

    Examples
    --------
    >>> with live("replay:examples/handstand.c3d@max", height=1.8) as postures:
    ...     for posture in postures:
    ...         if posture.time > 0.5:
    ...             break
    >>> posture.joints.shape, posture.body
    ((44,), <LiveBody handstand: labels 53, calibrated no>)
    """
    if not isinstance(source, str):
        raise TypeError(f"source: {source!r} is not allowed; it is an address, such as \"replay:walk.c3d\"")
    for name, value in (("seconds", seconds), ("calibrate_seconds", calibrate_seconds)):
        if value is not None and not value > 0:
            raise WrongValue(f"{name}: is above 0")
    request = keywords(options, file=source)
    if calibrate_seconds is not None and "self_calibrate" not in request:
        raise WrongValue("calibrate_seconds: is of self_calibrate")
    if robot is None and (map is not None or sole_height is not None or sole is not None or hold or weights):
        raise WrongValue("map, sole_height, sole, hold and weights: are of robot")
    request.update({name: path_text(file) for name, file in (("robot", robot), ("map", map)) if file is not None})
    request.update(robot_options(hold, sole, weights))
    return Live(source, request, loop, calibrate_seconds or 0.0, seconds or 0.0, sole_height)
