# SPDX-License-Identifier: MIT
"""The bar that long work shows where somebody sees it."""

import contextlib
import sys
import time

_QUIET = 1.0  # seconds: what is done sooner shows nothing
_WIDTH = 30


class Bar:
    """A line on a stream, drawn over again; called with (done, all)."""

    def __init__(self, what, stream):
        self._what = what
        self._stream = stream
        self._began = time.monotonic()
        self._length = 0

    def __call__(self, done, all):
        seconds = time.monotonic() - self._began
        if seconds < _QUIET or all <= 0:
            return
        filled = _WIDTH * done // all
        left = f", {seconds * (all - done) / done:.0f} s left" if 0 < done < all else ""
        self._draw(f"{100 * done // all:3d} % |{'#' * filled}{' ' * (_WIDTH - filled)}| "
                   f"{done} of {all} {self._what}{left}")

    def _draw(self, line):
        self._stream.write("\r" + line.ljust(self._length))
        self._stream.flush()
        self._length = len(line)

    def close(self):
        if self._length > 0:
            self._draw("")
            self._stream.write("\r")
            self._stream.flush()


def _is_watched(stream):
    return stream is not None and (stream.isatty() or "ipykernel" in sys.modules)


@contextlib.contextmanager
def shown(progress, what):
    """What the compiled part is to call: `progress`; where that is None a bar, if somebody sees it; where it is False, nothing."""
    if progress is not None or not _is_watched(sys.stderr):
        yield progress or None
        return
    bar = Bar(what, sys.stderr)
    try:
        yield bar
    finally:
        bar.close()
