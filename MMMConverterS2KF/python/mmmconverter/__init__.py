# SPDX-License-Identifier: MIT
"""Motion capture markers to MMM motions: MMMConverterS2KF from Python.

Everything is what the program ``MMMConverterS2KF`` computes, with the same numbers. Lengths are
metres, angles radians, times seconds; quaternions are ``w, x, y, z``; z is up. What was not seen is
NaN. Arrays have frames first.

>>> import mmmconverter
>>> recording = mmmconverter.read("examples/handstand.c3d")
>>> result = mmmconverter.convert(recording, height=1.8, self_calibrate=True)
>>> result.joints.shape
(675, 44)
>>> result.verdict
'good'
"""

from ._angles import Angles
from ._batch import Batch, batch
from ._conversions import Conversion, convert
from ._ground import Ground, Strides, strides
from ._live import Live, LiveBody, LivePosture, live
from ._mmmconverter import Error, version_text as _version_text
from ._models import Estimate, Model, Poses, Tracker, read_model
from ._recordings import Motion, Recording, Subject, read, read_motion, read_motions, read_subject
from ._robots import Retargeted, retarget
from ._studies import (Calibration, Comparison, Dynamics, LabelledRecording, LearnedMarkers, calibrate,
                       check_dynamics, compare, label, learn_markers)

Error.__module__ = __name__

__version__ = _version_text().split()[1]

__all__ = [
    "Angles", "Batch", "Calibration", "Comparison", "Conversion", "Dynamics", "Error", "Estimate", "Ground", "LabelledRecording",
    "LearnedMarkers", "Live", "LiveBody", "LivePosture", "Model", "Motion", "Poses", "Recording", "Retargeted", "Strides", "Subject", "Tracker", "batch", "calibrate",
    "check_dynamics", "compare", "convert", "label", "learn_markers", "live", "read", "read_model", "read_motion", "read_motions",
    "read_subject", "retarget", "strides"]
