# SPDX-License-Identifier: MIT
"""Faults on purpose: each call of the real program fails or kills it; then every output is the old or the new one.

sweep.py --build DIR            each call, under strace too (an hour), and many allocations
sweep.py --build DIR --coarse   some of them, as ctest does
"""

import argparse
import collections
import json
import re
import shutil
import signal
import sys
import tempfile

from case import Program

ENOSPC = 28
SCRATCH = re.compile(r"\.mmm_converter\.\d+\.\d+\.tmp")
OLD = b"old\n"

# System calls that a disturbed run may meet, and what each then says.
FAILING_CALLS = {"openat": "EIO", "read": "EIO", "pread64": "EIO", "write": "ENOSPC", "pwrite64": "ENOSPC", "close": "EIO",
                 "newfstatat": "EIO", "lseek": "EIO", "getdents64": "EIO", "flock": "ENOLCK", "fdatasync": "EIO",
                 "linkat": "EXDEV", "rename": "EIO", "mkdir": "EIO", "ftruncate": "EIO", "mmap": "ENOMEM", "readlink": "EIO",
                 "unlink": "EIO", "access": "EACCES", "getcwd": "ENOENT", "fsync": "EIO"}


class Conversion:
    """Replaces a motion and a table."""

    name = "convert"
    has_threads = False
    has_json = False

    def __init__(self, program):
        self.program = program
        self.folder = program.folder / "convert"
        self.words = ["convert", str(program.source / "examples/handstand.c3d"), "--height", "1.8", "--frames", ":10",
                      "--plugin", program.plugin(), "-o", "convert/motion.xml", "--export-csv", "convert/motion.csv"]
        self.prepare()
        self.calls = program.run(self.words).counts
        self.new = self.files()

    def files(self):
        return {file.name: file.read_bytes() for file in self.folder.iterdir()}

    def prepare(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir()
        for name in ("motion.xml", "motion.csv"):
            (self.folder / name).write_bytes(OLD)

    def problem(self, run, may_leave):
        """What is wrong with what a run left; None: nothing. may_leave: a temporary file, until the next run."""
        files = self.files()
        left = [name for name in files if SCRATCH.fullmatch(name)]
        if left and not may_leave:
            return f"left {left}"
        for name, content in self.new.items():
            if files.get(name) not in (OLD, content):
                return f"{name} is neither the old nor the new one"
            if run.code == 0 and files[name] != content:
                return f"{name} is the old one of a run that ended well"
        if len(files) - len(left) != len(self.new):
            return f"has files {sorted(files)}"
        if left:  # the next run removes it
            self.program.run(self.words)
            return None if self.files() == self.new else "the next run did not put it right"
        return None


class Batch:
    """Two recordings into a new folder; then the same with --resume."""

    name = "batch"
    has_threads = True
    has_json = True  # of its journal

    def __init__(self, program):
        self.program = program
        self.folder = program.folder / "out"
        recordings = "".join(f"<Recording file='examples/handstand.c3d' id='{i}' frames=':{10 + i}'/>" for i in range(2))
        (program.folder / "manifest.xml").write_text(
            f"<Batch height_m='1.8' folder='{program.source}' config='' plugin='{program.plugin()}'>{recordings}</Batch>")
        self.words = ["batch", "manifest.xml", "-o", "out", "--jobs", "1", "--reports", "none", "--resume"]
        self.prepare()
        self.calls = program.run(self.words).counts
        self.new = self.motions()

    def motions(self):
        return {file.name: file.read_bytes() for file in self.folder.glob("motions/*")}

    def prepare(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def problem(self, run, may_leave):
        for name, content in self.motions().items():
            if not SCRATCH.fullmatch(name) and content != self.new.get(name):
                return f"motions/{name} is not the new one"
        again = self.program.run(self.words)
        if again.code != 0 or self.motions() != self.new:
            return f"--resume did not put it right: {again.error}"
        left = [file.name for file in self.folder.rglob("*") if SCRATCH.fullmatch(file.name)]
        states = [json.loads(line)["state"] for line in (self.folder / "results.jsonl").read_text().splitlines()]
        return f"--resume left {left}" if left else None if states == 2 * ["converted"] else f"results: {states}"


class Sweep:
    def __init__(self):
        self.outcomes = collections.Counter()
        self.problems = []

    @staticmethod
    def numbers(count, points):
        """From 1 to count: so many of them, closer at the beginning; all where points is None."""
        if points is None or count <= points:
            return range(1, count + 1)
        return sorted({max(1, round(count * (i / points) ** 2)) for i in range(1, points + 1)})

    def take(self, case, kind, fault, run, is_early=False):
        """Judges a run. is_early: it ended in the loader, before main."""
        killed = run.code == -signal.SIGKILL and "kill" in kind
        problem = case.problem(run, killed or kind == "change+")
        # The JSON library allocates where it frees, and where it can't it ends the program.
        aborted = run.code == -signal.SIGABRT and (kind == "alloc+" or (kind == "alloc" and case.has_json))
        if problem is None and run.code < 0 and not (killed or aborted or is_early):
            problem = f"ended by signal {-run.code}"
        # What fails may be the write of the message itself.
        says_why = re.search(rb"^error: |error while loading|: error|cannot ", run.error, re.M) or "inject=write" in fault
        if problem is None and run.code > 0 and not says_why:
            problem = f"did not say why it failed: {run.error}"
        outcome = "done" if run.code == 0 else "aborted" if aborted else "killed" if run.code < 0 else "refused"
        self.outcomes[case.name, kind, outcome] += 1
        if problem:
            self.problems.append(f"{case.name} {fault}: {problem}")
            print(self.problems[-1], flush=True)

    def disturb(self, case, kind, points, more=""):
        of = {"kill": "change", "alloc+": "alloc", "change+": "change"}.get(kind, kind)
        for number in self.numbers(case.calls[of], points):
            case.prepare()
            fault = f"{kind}:{number}{more}"
            self.take(case, kind, fault, case.program.run(case.words, fault))

    def trace(self, case):
        """Under strace: each system call on a file kills the program, or fails."""
        case.prepare()
        log = case.program.folder / "strace"
        case.program.run(case.words, before=["strace", "-f", "-o", str(log)])
        lines = log.read_text(errors="replace").splitlines()
        begin = next(i for i, line in enumerate(lines) if "SIGXFSZ" in line)  # main: before, libraries are loaded
        before, after = (collections.Counter(re.findall(r"^\d+ +(\w+)\(", "\n".join(part), re.M))
                         for part in (lines[:begin], lines[begin:]))
        for call, error in FAILING_CALLS.items():
            # strace counts each thread's calls: those of a batch's thread start at 1.
            starts = {before[call] + 1} | ({1} if case.has_threads else set())
            for number in sorted({start + i for start in starts for i in range(after[call])}):
                for kind, inject in (("strace kill", "signal=KILL"), (f"strace {error}", f"error={error}")):
                    case.prepare()
                    fault = f"inject={call}:{inject}:when={number}"
                    run = case.program.run(case.words, before=["strace", "-f", "-o", "/dev/null", "-e", fault])
                    is_early = number <= before[call] and not case.folder.exists()
                    self.take(case, kind, fault, run, is_early)

    def clocks(self, case):
        for step in (-10**8, 10**8):
            for fault in (f"clock:{step}", f"clock+:{step}"):
                case.prepare()
                self.take(case, "clock", fault, case.program.run(case.words, fault))

    def report(self):
        print(f"[ measured ] {sum(self.outcomes.values())} faults, {len(self.problems)} problems")
        return 1 if self.problems else 0

    def say(self, case):
        for (name, kind, outcome), count in sorted(self.outcomes.items()):
            if name == case.name:
                print(f"[ measured ] {name:8} {kind:14} {outcome:8} {count:6}", flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", required=True)
    parser.add_argument("--coarse", action="store_true")
    parser.add_argument("--allocations", type=int, default=1000, help="of the full sweep, in each case")
    parser.add_argument("--case", default="", help="convert or batch; else both")
    options = parser.parse_args()
    sweep = Sweep()
    with tempfile.TemporaryDirectory(prefix="mmm_converter_test_") as folder:
        program = Program(options.build, folder)
        for make, points in ((Conversion, 5), (Batch, 3)):
            if options.case not in make.name:
                continue
            case = make(program)
            some = points if options.coarse else None
            sweep.disturb(case, "change", some, f":{ENOSPC}")
            for kind in ("change+", "read", "kill"):
                sweep.disturb(case, kind, some)
            sweep.clocks(case)
            for kind in ("alloc", "alloc+"):
                sweep.disturb(case, kind, 2 * points if options.coarse else options.allocations)
            if not options.coarse and shutil.which("strace"):
                sweep.trace(case)
            elif not options.coarse:
                print("strace is not there: the faults of system calls are left out")
            sweep.say(case)
    return sweep.report()


if __name__ == "__main__":
    sys.exit(main())
