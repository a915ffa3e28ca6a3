# SPDX-License-Identifier: MIT
"""Many recordings, by the program beside this package."""

import os
import pathlib
import re
from typing import Any, Dict, List, Optional

from ._mmmconverter import Error
from ._present import MissingFile, WrongValue, input_text, path_text
from ._progress import shown
from ._studies import Progress

_PROGRAM = "MMMConverterS2KF"
_COUNT = re.compile(r"\[(\d+)/(\d+)\]")
_WRONG_USE = 2  # exit code


class Batch(List[Dict[str, Any]]):
    """What `batch` returns: a dict for each recording of the manifest, what needs a look first.

    Keys are "id", "state" ("converted", "failed" or "missing"), "reason", "verdict", "motion" and the
    others that results.jsonl has.

    Attributes
    ----------
    output : str
        The folder. index.html in it is the page of the batch.
    """

    output = ""

    def to_dataframe(self):
        """A pandas.DataFrame by id; columns as of results.csv, such as "distance_mm.mean"."""
        import pandas
        return pandas.json_normalize(list(self)).set_index("id")


def _find_program():
    """Beside the package, as build trees, packages and wheels have it, else on the PATH."""
    import shutil
    beside = pathlib.Path(__file__).absolute().parents[4] / "bin" / _PROGRAM
    program = str(beside) if beside.is_file() else shutil.which(_PROGRAM)
    if program is None:
        raise MissingFile(f"{beside}: no such file, nor is {_PROGRAM} on the PATH; batch runs the program")
    return program


def _watch(lines, progress):
    """What the program says: progress is called with counts; errors are returned."""
    errors = []
    for line in lines:
        count = _COUNT.search(line)
        if count is None and not line.startswith(("info: ", "warning: ")):
            errors.append(line)
        elif count is not None and progress is not None:
            progress(int(count[1]), int(count[2]))
    return "".join(errors).strip().removeprefix("error: ")


def batch(manifest, output, *, resume: bool = False, retry_crashed: bool = False, fail_fast: bool = False,
          jobs: Optional[int] = None, memory: Optional[str] = None, reports: Optional[str] = None,
          progress: Progress = None) -> Batch:
    """Converts the recordings of a manifest, as the command batch does: it runs the program.

    A recording that can't be converted does not stop the others: its "state" is "failed", its "reason"
    says why.

    Parameters
    ----------
    manifest : path
        An XML file; ``MMMConverterS2KF print-config batch`` prints an example.
    output : path
        Folder of the motions and results.
    resume : bool
        Keep what an earlier run has done, if nothing that it depends on has changed.
    retry_crashed : bool
        With resume: try those again, too, that ended the process of an earlier run.
    fail_fast : bool
        End with the first recording that can't be converted, which is then raised.
    jobs : int, optional
        Recordings at a time; default: all cores.
    memory : str, optional
        For all jobs together: "8G"; default: three quarters of what is free.
    reports : str, optional
        Pages: "worst:N", "all" or "none"; default: "worst:20".
    progress : optional
        As of `convert`, with recordings. What it raises, and Ctrl-C, end the program; what is done
        stays for resume.
    """
    import json
    import signal
    import subprocess
    words = [_find_program(), "batch", input_text(manifest), "-o", path_text(output)]
    for name, is_asked in (("resume", resume), ("retry-crashed", retry_crashed), ("fail-fast", fail_fast)):
        words += [f"--{name}"] if is_asked else []
    for name, value in (("jobs", jobs), ("memory", memory), ("reports", reports)):
        words += [f"--{name}={value}"] if value is not None else []
    with shown(progress, "recordings") as callback, subprocess.Popen(
            words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            errors="replace") as run:
        try:
            error = _watch(run.stderr, callback)
            said = run.stdout.read() if run.stdout else ""
        except BaseException:
            run.send_signal(signal.SIGINT)
            run.communicate()
            raise
    if run.returncode == _WRONG_USE:
        raise WrongValue(error)
    if run.returncode < 0 or not said.startswith("batch "):  # no results were made
        raise Error(error or f"{_PROGRAM} ended with {run.returncode}")
    with open(os.path.join(path_text(output), "results.jsonl"), encoding="utf-8") as lines:
        results = Batch(json.loads(line) for line in lines)
    results.output = path_text(output)
    return results
