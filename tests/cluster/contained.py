# SPDX-License-Identifier: MIT
"""contained.py COMMAND...: runs a command, and ends all that it started, daemons too.

That happens when the command ends, when this process is told to end, and when its own parent is gone.
TMPDIR of the command is a folder that is removed then.
"""

import contextlib
import ctypes
import os
import pathlib
import signal
import subprocess
import sys
import tempfile

PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36  # <linux/prctl.h>


def parents():
    """Of every process: its parent."""
    found = {}
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):  # ended meanwhile
            found[int(stat.parent.name)] = int(stat.read_text().rpartition(")")[2].split()[1])
    return found


def descendants():
    parent = parents()
    found = [os.getpid()]
    for pid in found:  # grows meanwhile
        found += [child for child in parent if parent[child] == pid]
    return found[1:]


def end_descendants():
    """Those whose parents end become this process's children, so none is lost."""
    while True:
        for pid in descendants():
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        try:
            os.waitpid(-1, 0)
        except ChildProcessError:
            return


def main():
    prctl = ctypes.CDLL(None, use_errno=True).prctl
    if prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0) or prctl(PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0):
        sys.exit(f"prctl: {os.strerror(ctypes.get_errno())}")
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(number, lambda number, _: sys.exit(128 + number))
    with tempfile.TemporaryDirectory(prefix="mmm_cluster_") as folder:
        try:
            command = subprocess.Popen(sys.argv[1:], env={**os.environ, "TMPDIR": folder})
            sys.exit(command.wait())
        finally:
            end_descendants()


if __name__ == "__main__":
    main()
