#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs libFuzzer's program (cmake --preset fuzz && cmake --build --preset fuzz) on one core.

tests/fuzz/run.py SECONDS [TARGET...]: so many seconds of processor time for each target, all of them
where none is named. What it learns stays in build-fuzz/fuzzing for the next time: TARGET/corpus, TARGET/findings
and TARGET/log. Ends with a table; the exit code is 1 where there are findings.
"""
import argparse
import os
import re
import signal
import struct
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build-fuzz/tests/fuzz_readers"
WORK = ROOT / "build-fuzz/fuzzing"
MEMORY = next(path for path in (Path("/dev/shm"), Path("/tmp")) if path.is_dir())
DATA = ROOT.parent / "shared/data"
MOST_FINDINGS = 20  # of a target: then it ends

C3D, TRC, MMM = "common/io/c3d", "common/io/tables", "common/io/mmm"
# Of each target: the longest input [bytes], the sources whose words are its dictionary, the real
# files that are its seeds, cut short.
TARGETS = {
    "c3d": (8192, [C3D], ["**/*.c3d"]),
    "conversion": (8192, [C3D, TRC, MMM], ["recordings/**/*.c3d", "recordings/**/*.trc"]),
    "converter_config": (4096, ["common/convert", "plugins/s2kf", "plugins/jacobian"], ["**/*.xml"]),
    "journal": (4096, ["MMMConverterS2KF/batch"], []),
    "lcd_samples": (512, [], []),
    "manifest": (4096, ["MMMConverterS2KF/batch"], []),
    "marker_set": (4096, ["common/convert"], ["labels/*.xml"]),
    "mesh": (8192, ["common/io/mesh"], []),
    "mmm_model": (8192, [MMM], ["mmm/models/*.xml"]),
    "mmm_motion": (8192, [MMM], ["mmm/*/*.xml"]),
    "motive_csv": (4096, [TRC], []),
    "natnet": (4096, [], []),
    "nexus_csv": (4096, [TRC], []),
    "osim": (8192, ["common/io/osim"], []),
    "osim_setup": (8192, ["common/io/osim"], ["osim/**/*Setup*.xml"]),
    "person": (4096, [MMM], []),
    "points_csv": (4096, [TRC], []),
    "qtm": (8192, ["common/live/qtm"], []),
    "qtm_tsv": (4096, [TRC], []),
    "recording": (8192, [C3D, TRC, MMM, "common/io/recording"],
                  ["**/*.c3d", "**/*.trc", "mmm/*/*.xml"]),
    "subjects_table": (1024, ["MMMConverterS2KF/batch"], []),
    "trc": (4096, [TRC, "common/io/recording"], ["**/*.trc", "**/*.sto"]),
    "urdf": (8192, ["common/io/urdf"], ["robots/**/*.urdf"]),
}


def thinned(element, most):
    """The first children of each element."""
    for child in element[most:]:
        element.remove(child)
    for child in element:
        thinned(child, most)
    return element


def cut_short(file, longest):
    """A real file as one that may still be read whole: fewer elements, frames or lines."""
    content = file.read_bytes()
    if file.suffix in (".xml", ".urdf"):
        for most in (12, 8, 6, 4, 3, 2):
            text = ElementTree.tostring(thinned(ElementTree.fromstring(content), most))
            if len(text) <= longest:
                return text
    if file.suffix == ".c3d" and len(content) > 516:
        order = ">" if content[515] == 86 else "<"
        first_data_block = struct.unpack_from(order + "H", content, 16)[0]
        return content[:max(512 * first_data_block + 4096, longest)]
    return content[:longest].rpartition(b"\n")[0]


def make_seeds(target, folder):
    longest, _, real = TARGETS[target]
    folder.mkdir(parents=True, exist_ok=True)
    for file in (ROOT / "tests/fuzz/corpus").glob(f"{target}-*"):
        (folder / file.name).write_bytes(file.read_bytes())
    for pattern in real:
        for file in DATA.glob(pattern):
            (folder / f"real-{file.name}").write_bytes(cut_short(file, longest))


def make_dictionary(target, file):
    """The option for the words of the sources, which are written there as libFuzzer wants them."""
    words = set()
    for folder in TARGETS[target][1]:
        for source in (ROOT / folder).glob("*.cc"):
            words |= set(re.findall(r'"[A-Za-z_][A-Za-z_0-9]*"', source.read_text()))
    file.write_text("".join(f"{word}\n" for word in sorted(words)))
    return [f"-dict={file}"] if words else []  # an empty one is an error


def processor_seconds(process):
    """On a busy machine they pass more slowly than others."""
    return int(Path(f"/proc/{process.pid}/schedstat").read_text().split()[0]) / 1e9


def run(command, seconds, log):
    """What it used of the processor [s]. It ends by itself where it has found something."""
    process = subprocess.Popen(command, stderr=log, env=dict(
        os.environ, TMPDIR=str(MEMORY), LSAN_OPTIONS=f"suppressions={ROOT / 'tests/lsan_suppressions.txt'}"))
    used = 0
    while process.poll() is None:
        used = processor_seconds(process)
        if used >= seconds:
            process.send_signal(signal.SIGINT)
            process.wait()
        time.sleep(0.2)
    return used


def fuzz(target, seconds):
    """Executions, edges reached, all edges, findings, processor time [s]."""
    folder = WORK / target
    findings = folder / "findings"
    findings.mkdir(parents=True, exist_ok=True)
    make_seeds(target, folder / "seeds")
    (folder / "corpus").mkdir(exist_ok=True)
    command = [PROGRAM, f"--target={target}", f"-max_len={TARGETS[target][0]}",
               *make_dictionary(target, folder / "dictionary"), f"-artifact_prefix={findings}/",
               "-rss_limit_mb=2048", "-timeout=25", "-report_slow_units=25",
               "-print_final_stats=1", folder / "corpus", folder / "seeds"]
    used = 0
    with open(folder / "log", "wb") as log:
        while used < seconds and len(list(findings.iterdir())) < MOST_FINDINGS:
            used += max(run(command, seconds - used, log), 1)
    said = (folder / "log").read_text(errors="replace")
    executions = sum(map(int, re.findall(r"number_of_executed_units: (\d+)", said)))
    edges = max(map(int, re.findall(r"cov: (\d+)", said)), default=0)
    all_edges = max(map(int, re.findall(r"modules\s+\((\d+) inline", said)), default=0)
    return executions, edges, all_edges, len(list(findings.iterdir())), used


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("seconds", type=int, metavar="SECONDS")
    parser.add_argument("targets", nargs="*", metavar="TARGET", help=", ".join(TARGETS))
    arguments = parser.parse_args()
    for target in arguments.targets:
        if target not in TARGETS:
            parser.error(f"there is no target {target}; use {', '.join(TARGETS)}")
    if not PROGRAM.exists():
        sys.exit(f"{PROGRAM} is not there; build it: cmake --preset fuzz && cmake --build --preset fuzz")
    rows = []
    for target in arguments.targets or TARGETS:
        rows.append((target, *fuzz(target, arguments.seconds)))
        print(f"{target}: {rows[-1][1]} executions", file=sys.stderr)
    print(f"{'target':<17} {'minutes':>7} {'executions':>11} {'edges':>6} {'findings':>8}")
    for target, executions, edges, _, findings, seconds in rows:
        print(f"{target:<17} {seconds / 60:7.1f} {executions:11d} {edges:6d} {findings:8d}")
    print(f"of {max(row[3] for row in rows)} edges in all")
    return 1 if any(row[4] for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
