# SPDX-License-Identifier: MIT
"""Pictures of some frames of a motion, for notebooks."""

import numpy as np

_COUNT = 6
_SHORTEST_BONE = 0.012  # metres
_SIZE = 150  # of a picture
_VIEW = np.radians((215, 10))  # from in front of somebody who looks along y, and from above


def still_frames(root_quaternions, joints):
    """The frames that the report's page shows: between them the posture changes by as much each time, half of it even in time."""
    frames = len(joints)
    if frames < 2:
        return list(range(frames))
    turns = np.abs(np.sum(root_quaternions[1:] * root_quaternions[:-1], axis=1))
    steps = np.sqrt(np.sum(np.diff(joints, axis=0) ** 2, axis=1)
                    + 4 * np.arccos(np.minimum(1, turns)) ** 2)
    even = np.full(frames - 1, 1 / (frames - 1))
    way = np.cumsum(0.5 * (steps / steps.sum() if steps.sum() > 0 else even) + 0.5 * even)
    marks = np.arange(1, _COUNT) / (_COUNT - 1) - 1e-9
    return [0] + sorted({int(k) + 1 for k in np.searchsorted(way, marks) if k < frames - 1})


def _seen(positions):
    """x to the right and y down, in metres."""
    turn, tilt = _VIEW
    right = np.array([np.cos(turn), np.sin(turn), 0])
    back = np.array([-np.sin(turn), np.cos(turn), 0])
    down = -np.cos(tilt) * np.array([0, 0, 1]) - np.sin(tilt) * back
    return np.stack([positions @ right, positions @ down], axis=-1)


def draw_stills(positions, parents, times):
    """An SVG. positions: (frames, segments, 3) in metres; parents: of each segment, -1: none; times: seconds."""
    points = _seen(positions)
    bones = [(i, parent) for i, parent in enumerate(parents) if parent >= 0]
    least, most = points.min(axis=1), points.max(axis=1)
    scale = 0.85 * _SIZE / max(float((most - least).max()), 1e-9)
    places = scale * (points - 0.5 * (least + most)[:, np.newaxis]) + 0.5 * _SIZE
    pictures = []
    for k, time in enumerate(times):
        lines = "".join(
            f"M{places[k, a, 0]:.1f} {places[k, a, 1]:.1f}L{places[k, b, 0]:.1f} {places[k, b, 1]:.1f}"
            for a, b in bones
            if np.linalg.norm(positions[k, a] - positions[k, b]) >= _SHORTEST_BONE)
        pictures.append(f"<g transform='translate({k * _SIZE} 0)'><path d='{lines}'/>"
                        f"<text x='{_SIZE / 2:g}' y='{_SIZE + 14}'>{time:.2f} s</text></g>")
    width, height = _SIZE * len(times), _SIZE + 20
    return (f"<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' "
            "fill='none' stroke='currentColor' stroke-width='2' stroke-linecap='round'>"
            "<style>text {fill: currentColor; stroke: none; font: 12px sans-serif; "
            f"text-anchor: middle}}</style>{''.join(pictures)}</svg>")
