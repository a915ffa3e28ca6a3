# SPDX-License-Identifier: MIT
"""What the tests share."""
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SAMPLE = str(ROOT / "examples/handstand.c3d")
SHARED = pathlib.Path(os.environ.get("MMM_CONVERTER_SHARED_DATA", ROOT / "../shared")) / "data"


def run_program(*arguments):
    """What the program prints; its errors as an exception."""
    program = os.environ.get("MMM_CONVERTER_PROGRAM", ROOT / "build/bin/MMMConverterS2KF")
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)


class Case(unittest.TestCase):
    """Has a folder of its own."""

    maxDiff = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_program(self, *arguments):
        run = run_program(*arguments)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout

    def assert_same_files(self, a, b):
        self.assertTrue(pathlib.Path(a).read_bytes() == pathlib.Path(b).read_bytes(), f"{a}, {b}")
