#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Which lines and branches of the program the tests have run, by folder (gcovr, a Debian package):

cmake --preset coverage && cmake --build --preset coverage && ctest --preset coverage && tests/coverage.py

Writes build-coverage/coverage.txt, whose table it prints; coverage_lines.txt beside it lists, file
by file, the lines that no test runs.
"""
import json
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BUILD = ROOT / "build-coverage"
PROGRAM = ["common", "plugins", "MMMConverterS2KF"]


def folder_of(path):
    """Rooms of the library, the formats of files, plugins, rooms of the application."""
    parts = path.split("/")[:-1]
    return "/".join(parts[:3] if parts[:2] == ["common", "io"] else parts[:2])


def percent(covered, count):
    return f"{100 * covered / count:5.1f} %" if count else "      -"


def main():
    files = BUILD / "coverage.json"
    subprocess.run(["gcovr", "--root", ROOT, *[BUILD / folder for folder in PROGRAM], "-j", "2",
                    *[argument for folder in PROGRAM for argument in ("--filter", f"{folder}/")],
                    "--exclude", ".*/tools/", "--exclude-throw-branches",
                    "--gcov-ignore-parse-errors", "--json-summary", files,
                    "--txt", BUILD / "coverage_lines.txt"], check=True, cwd=ROOT)
    sums = defaultdict(lambda: [0, 0, 0, 0])
    for file in json.loads(files.read_text())["files"]:
        folder = folder_of(file["filename"])
        for name in {folder, "common/io (all)" if folder.startswith("common/io") else folder, "all"}:
            for i, key in enumerate(("line_covered", "line_total", "branch_covered", "branch_total")):
                sums[name][i] += file[key]
    rows = [f"{'folder':<28} {'lines':>7} {'covered':>8} {'branches':>9} {'covered':>8}"]
    for name in sorted(sums):
        lines, all_lines, branches, all_branches = sums[name]
        rows.append(f"{name:<28} {all_lines:7d} {percent(lines, all_lines):>8} {all_branches:9d} "
                    f"{percent(branches, all_branches):>8}")
    table = "\n".join(rows) + "\n"
    (BUILD / "coverage.txt").write_text(table)
    sys.stdout.write(table)


if __name__ == "__main__":
    main()
