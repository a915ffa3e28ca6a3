# SPDX-License-Identifier: MIT
"""The real program, disturbed: what the tests of faults and of growth share."""

import os
import pathlib
import subprocess

SECONDS = 120  # until a run is given up as one that hangs; no bound on speed


class Run:
    """How a run ended. counts: calls and bytes, by name, where it reached its end."""

    def __init__(self, process, report):
        self.code = process.returncode  # -N: killed by signal N
        self.out = process.stdout
        self.error = process.stderr
        self.counts = {}
        if report.exists():
            self.counts = {name: int(count) for name, count in map(str.split, report.read_text().splitlines())}
            report.unlink()


class Program:
    def __init__(self, build, folder):
        self.build = pathlib.Path(build).resolve()
        self.source = self.build.parent
        self.folder = pathlib.Path(folder)
        self.report = self.folder / "report"
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith("MMM_")}

    def plugin(self):
        """A converter that is quick."""
        return str(self.build / "tests/plugins/test_converter/test_converter.so")

    def run(self, words, fault=None, before=()):
        """fault: see interposed.cc; before: words of a command that runs the program, such as strace."""
        environment = dict(self.environment)
        if not before:
            environment |= {"LD_PRELOAD": str(self.build / "tests/interposed.so"), "MMM_FAULT_REPORT": str(self.report)}
        if fault:
            environment["MMM_FAULT"] = fault
        process = subprocess.run([*before, self.build / "bin/MMMConverterS2KF", *words], cwd=self.folder, env=environment,
                                 stdin=subprocess.DEVNULL, capture_output=True, timeout=SECONDS, check=False)
        return Run(process, self.report)
