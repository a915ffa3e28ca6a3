# SPDX-License-Identifier: MIT
"""The compiled part; the package's functions say what arguments and results are."""
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

import numpy as np

Progress = Optional[Callable[[int, int], None]]

class Error(Exception): ...

def version_text() -> str: ...

class Recording:
    file: str
    format: str
    labels: List[str]
    rate: float
    first_time: float
    unit: str
    up_axis: str
    subjects: List[str]
    motion: str
    height: Optional[float]
    mass: Optional[float]
    warnings: List[str]
    markers: np.ndarray
    events: List[Dict[str, Any]]
    analog: Dict[str, Any]
    force_plates: List[Dict[str, Any]]
    forces: Dict[str, Any]
    def save_c3d(self, file: str) -> None: ...
    def save_trc(self, file: str) -> None: ...

def read(options: Dict[str, Any]) -> Recording: ...
def from_arrays(labels: List[str], markers: Any, rate: float, first_time: float,
                name: str) -> Recording: ...
def read_motions(file: str) -> List[Dict[str, Any]]: ...

class Model:
    file: str
    name: str
    segments: List[str]
    parents: List[int]
    markers: List[str]
    joint_names: List[str]
    limits: np.ndarray
    mass: float
    height: Optional[float]
    def forward(self, root_positions: Any, root_quaternions: Any, joints: Any,
                joint_names: List[str]) -> Tuple[np.ndarray, np.ndarray, np.ndarray]: ...
    def place_markers(self, root_positions: Any, root_quaternions: Any, joints: Any,
                      joint_names: List[str]) -> np.ndarray: ...
    def angles(self, root_positions: Any, root_quaternions: Any, joints: Any, joint_names: List[str],
               sd: Any) -> Tuple[List[Tuple[str, str, str]], np.ndarray, Optional[np.ndarray]]: ...

class Tracker:
    joint_names: List[str]
    marker_labels: List[str]
    warnings: List[str]
    def __init__(self, model: Model, labels: List[str], options: Dict[str, Any]) -> None: ...
    def assemble(self, frame: Any) -> Dict[str, Any]: ...
    def track(self, frame: Any, dt: float) -> Dict[str, Any]: ...

def read_model(options: Dict[str, Any]) -> Model: ...
def read_subject(file: str, model: Model) -> Dict[str, Any]: ...

class Conversion:
    rate: float
    times: np.ndarray
    joint_names: List[str]
    postures: Tuple[np.ndarray, np.ndarray, np.ndarray]
    sd: Optional[np.ndarray]
    velocities: Optional[np.ndarray]
    accelerations: Optional[np.ndarray]
    residuals: np.ndarray
    covariances: Optional[Tuple[np.ndarray, np.ndarray]]
    angles: Tuple[List[Tuple[str, str, str]], np.ndarray, Optional[np.ndarray]]
    ground: Optional[Dict[str, Any]]
    marker_labels: List[str]
    incidents: List[Dict[str, Any]]
    frames: Dict[str, np.ndarray]
    model: Model
    summary: Dict[str, Any]
    text: str
    verdict: str
    reasons: List[str]
    warnings: List[str]
    def save(self, file: str) -> None: ...
    def export(self, name: str, file: str) -> None: ...
    def report(self, file: str) -> None: ...

def convert(options: Dict[str, Any], progress: Progress) -> Conversion: ...
def exporters() -> List[Tuple[str, str]]: ...

class LiveBody:
    name: str
    labels: List[str]
    marker_labels: List[str]
    rate: float
    is_calibrated: bool
    model: Model

class Live:
    stage: str
    frames: int
    dropped: int
    def __init__(self, options: Dict[str, Any], loop: bool, calibrate_seconds: float, seconds: float,
                 sole_height: Optional[float], tell: Callable[[bool, str], None]) -> None: ...
    def next(self) -> Optional[Dict[str, Any]]: ...
    def close(self) -> None: ...

class Calibration:
    summary: Dict[str, Any]
    text: str
    verdict: str
    warnings: List[str]
    def save(self, file: str) -> None: ...
    def save_model(self, file: str) -> None: ...

class Comparison:
    summary: Dict[str, Any]
    text: str
    def report(self, file: str) -> None: ...

class LabelledRecording:
    summary: Dict[str, Any]
    text: str
    warnings: List[str]
    recording: Recording
    def save(self, file: str) -> None: ...
    def report(self, file: str) -> None: ...

class LearnedMarkers:
    summary: Dict[str, Any]
    text: str
    warnings: List[str]
    def save(self, file: str) -> None: ...

class Dynamics:
    summary: Dict[str, Any]
    text: str
    judgement: str
    warnings: List[str]
    def report(self, file: str) -> None: ...

class Retargeted:
    summary: Dict[str, Any]
    text: str
    verdict: str
    warnings: List[str]
    rate: float
    first_time: float
    joint_names: List[str]
    arrays: Tuple[Any, Any, Any]
    def save(self, file: str) -> None: ...
    def export(self, format: str, file: str, rate: Optional[float], order: Optional[str]) -> None: ...
    def report(self, file: str) -> None: ...

def calibrate(inputs: List[Dict[str, Any]], options: Dict[str, Any],
              progress: Progress) -> Calibration: ...
def compare(inputs: List[Dict[str, Any]], configs: Sequence[str], truths: Sequence[str],
            options: Dict[str, Any], progress: Progress) -> Comparison: ...
def learn_markers(inputs: List[Dict[str, Any]], options: Dict[str, Any],
                  progress: Progress) -> LearnedMarkers: ...
def label(options: Dict[str, Any], progress: Progress) -> LabelledRecording: ...
def check_dynamics(motion: Any, options: Dict[str, Any], progress: Progress) -> Dynamics: ...
def retarget(motion: Any, options: Dict[str, Any], map: str, sole_height: Optional[float],
             progress: Progress) -> Retargeted: ...
def options(task: str) -> List[Tuple[str, str, str, str]]: ...
def tasks() -> List[str]: ...
