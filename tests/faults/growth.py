# SPDX-License-Identifier: MIT
"""growth.py --build DIR: `info` of the worst files in two sizes. Memory and allocations grow as the file does."""

import argparse
import resource
import sys
import tempfile

from case import Program
from worst_files import WORST

LARGER = 8  # times, the second size
# Of a count that is proportional to the size, and of one that is quadratic 8 times as much.
MOST_GROWTH = 1.5 * LARGER
# Processor time is no count: others use the caches too. What is quadratic grows 64 times.
MOST_TIME_GROWTH = 3 * LARGER
FREE_SECONDS = 0.5  # to start, whatever the machine does


def processor_seconds():
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def measure(program, name, content):
    (program.folder / name).write_bytes(content)
    before = processor_seconds()
    run = program.run(["info", name])
    return run, processor_seconds() - before


def problems_of(name, small, large, bytes_more, is_read, most_memory):
    (run, seconds), (large_run, large_seconds) = small, large
    problems = []
    if (large_run.code == 0) != is_read or large_run.code not in (0, 1):
        problems.append(f"ended with {large_run.code}: {large_run.error[:200]}")
    memory = (large_run.counts["peak"] - run.counts["peak"]) / bytes_more
    allocations = large_run.counts["alloc"] / run.counts["alloc"]
    print(f"[ measured ] {name:18} {bytes_more * 1e-6:6.2f} MB more: {memory:6.1f} bytes a byte, "
          f"allocations x {allocations:4.1f}, {1e9 * (large_seconds - seconds) / bytes_more:6.0f} ns a byte"
          f"{'' if is_read else ', refused'}")
    if memory > most_memory:
        problems.append(f"takes {memory:.1f} bytes of memory for each of its own, more than {most_memory}")
    if allocations > MOST_GROWTH:
        problems.append(f"of {LARGER} times the size makes {allocations:.1f} times the allocations")
    if large_seconds > MOST_TIME_GROWTH * seconds + FREE_SECONDS:
        problems.append(f"of {LARGER} times the size takes {large_seconds / seconds:.0f} times the time")
    return [f"{name}: {problem}" for problem in problems]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", required=True)
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    problems = []
    with tempfile.TemporaryDirectory(prefix="mmm_converter_test_") as folder:
        program = Program(options.build, folder)
        for name, content_of, is_read, most_memory in WORST:
            if options.only not in name:
                continue
            small, large = content_of(1), content_of(LARGER)
            problems += problems_of(name, measure(program, name, small), measure(program, name, large),
                                    len(large) - len(small), is_read, most_memory)
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
