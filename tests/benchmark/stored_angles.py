#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Angles of recordings beside those that Plug-in Gait stored in the same files.

    stored_angles.py PROGRAM FOLDER [OPTIONS OF convert ...]

For each angle the medians over the sides of all recordings: the size of the constant difference, what is left of the
difference without it (rms), the correlation, and the range over that of the stored angle. FOLDER has the recordings.
The last row is what the ankle's markers alone say: the angle between the lines KNE-ANK and ANK-TOE.
"""
import collections
import csv
import pathlib
import struct
import subprocess
import sys
import tempfile

import numpy as np

RECORDINGS = ["btk_FunctionalWalk", "c3dio_2198928", "c3dio_Vicon_analysis", "c3dio_gait-pig", "c3dio_sub_labels"]
# Our angle, the stored points and their coordinate, and the sign of the right side's.
ANGLES = [("knee flexion", "KneeAngles", 0, 1), ("hip flexion", "HipAngles", 0, 1), ("hip adduction", "HipAngles", 1, 1),
          ("hip internal rotation", "HipAngles", 2, 1), ("ankle dorsiflexion", "AnkleAngles", 0, 1),
          ("pelvis obliquity", "PelvisAngles", 1, -1), ("pelvis tilt", "PelvisAngles", 0, 1)]


def floats(data, is_dec):
    """DEC's have their halves exchanged, and an exponent of 2 more."""
    if not is_dec:
        return np.frombuffer(data, "<f4")
    return np.frombuffer(data, "<u2").reshape(-1, 2)[:, ::-1].copy().view("<f4").ravel() / 4


def points(path):
    """The points of a C3D of an Intel or DEC processor, by label without subject: frames x 3, NaN where not stored."""
    data = path.read_bytes()
    is_dec = data[(data[0] - 1) * 512 + 3] == 85
    header = struct.unpack("<256H", data[:512])
    count, analog, first, last, start = header[1], header[2], header[3], header[4], header[8]
    scale = floats(data[12:16], is_dec)[0]
    groups, parameters = {}, collections.defaultdict(dict)
    at = (data[0] - 1) * 512 + 4
    while True:
        length, group = struct.unpack("bb", data[at:at + 2])
        if length == 0:
            break
        name = data[at + 2:at + 2 + abs(length)].decode("latin1").upper()
        offset_at = at + 2 + abs(length)
        offset = struct.unpack("<H", data[offset_at:offset_at + 2])[0]
        if group < 0:
            groups[-group] = name
        elif struct.unpack("b", data[offset_at + 2:offset_at + 3])[0] == -1:
            dimensions = list(data[offset_at + 4:offset_at + 4 + data[offset_at + 3]])
            text = offset_at + 4 + len(dimensions)
            width = dimensions[0] if dimensions else 0
            rows = int(np.prod(dimensions[1:]))
            parameters[group][name] = [data[text + i * width:text + (i + 1) * width].decode("latin1").strip()
                                       for i in range(rows)]
        if offset == 0:
            break
        at = offset_at + offset
    of_points = next(parameters[key] for key, name in groups.items() if name == "POINT")
    labels = [label for key in sorted(k for k in of_points if k.startswith("LABELS")) for label in of_points[key]]
    row, size = 4 * count + analog, 4 if scale < 0 else 2
    stored = data[(start - 1) * 512:]
    frames = min(last - first + 1, len(stored) // (row * size))
    stored = stored[:frames * row * size]
    values = floats(stored, is_dec) if scale < 0 else np.frombuffer(stored, "<i2")
    values = values.reshape(frames, row)
    values = values[:, :4 * count].reshape(frames, count, 4).astype(float)
    places = values[:, :, :3] * (1 if scale < 0 else scale)
    places[(values[:, :, 3] < 0) | np.all(places == 0, axis=2)] = np.nan
    return {label.split(":")[-1]: places[:, i] for i, label in enumerate(labels[:count])}


def angles(path):
    """Of a table of --export-angles, in degrees by name."""
    series = collections.defaultdict(list)
    with open(path, encoding="utf-8") as table:
        for row in csv.DictReader(table):
            name = f"{row['side']} {row['joint']} {row['angle']}".strip()
            series[name].append(float(row["degrees"] or "nan"))
    return {name: np.array(values) for name, values in series.items()}


def by_lines(markers, side):
    knee, ankle, toe = (markers[side + name] for name in ("KNE", "ANK", "TOE"))
    shank, foot = knee - ankle, toe - ankle
    cosine = (shank * foot).sum(1) / np.linalg.norm(shank, axis=1) / np.linalg.norm(foot, axis=1)
    return 90 - np.degrees(np.arccos(cosine))


def compared(mine, theirs):
    mine, theirs = mine[:len(theirs)], theirs[:len(mine)]
    both = np.isfinite(mine) & np.isfinite(theirs)
    mine, theirs = mine[both], theirs[both]
    difference = mine - theirs
    ranges = [np.ptp(np.percentile(values, [2.5, 97.5])) for values in (mine, theirs)]
    return [abs(difference.mean()), difference.std(), np.corrcoef(mine, theirs)[0, 1], ranges[0] / ranges[1]]


def main():
    program, folder, options = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:]
    found = collections.defaultdict(list)
    with tempfile.TemporaryDirectory() as work:
        for name in RECORDINGS:
            recording = folder / f"{name}.c3d"
            subprocess.run([program, "convert", recording, *options, "-o", f"{work}/{name}.xml", "--export-angles",
                            f"{work}/{name}.csv"], check=True, capture_output=True)
            ours, stored = angles(f"{work}/{name}.csv"), points(recording)
            for angle, label, coordinate, right in ANGLES:
                for side, sign in (("left", 1), ("right", right)):
                    mine = ours[angle if angle.startswith("pelvis") else f"{side} {angle}"]
                    found[angle].append(compared(mine, sign * stored[side[0].upper() + label][:, coordinate]))
            for side in "LR":
                found["ankle by its markers"].append(compared(by_lines(stored, side), stored[side + "AnkleAngles"][:, 0]))
    print(f"{'angle':24}{'offset':>8}{'rms':>8}{'r':>8}{'range':>8}")
    for angle, rows in found.items():
        print(f"{angle:24}" + "".join(f"{value:8.2f}" for value in np.median(rows, axis=0)))


if __name__ == "__main__":
    main()
