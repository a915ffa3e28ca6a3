# SPDX-License-Identifier: MIT
"""What conversions leave behind. `memory_test.py COUNT` converts so often and prints how much memory is in use after each tenth."""
import gc
import pathlib
import resource
import sys
import unittest

import mmmconverter
from support import SAMPLE


def resident_bytes():
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()


def convert(recording):
    result = mmmconverter.convert(recording, height=1.8, frames=(0, 40), covariances=True,
                                  progress=False)
    result.model.forward(result)
    return result.summary, result.sd, result.covariances, result.residuals, result.incidents


class Memory(unittest.TestCase):

    def test_conversions_leave_nothing(self):
        recording = mmmconverter.read(SAMPLE)
        for _ in range(10):  # caches, and threads' own heaps
            convert(recording)
        gc.collect()
        before = resident_bytes()
        for _ in range(40):
            convert(recording)
        gc.collect()
        # A conversion has some 4 MB of its own. Allocators' heaps may still grow by a few of them.
        self.assertLess(resident_bytes() - before, 16 << 20)


def main(count):
    recording = mmmconverter.read(SAMPLE)
    for i in range(count):
        convert(recording)
        if (i + 1) % max(1, count // 10) == 0:
            print(f"{i + 1} conversions: {resident_bytes() / 1e6:.1f} MB")


if __name__ == "__main__":
    if len(sys.argv) == 2 and sys.argv[1].isdigit():
        main(int(sys.argv[1]))
    else:
        unittest.main()
