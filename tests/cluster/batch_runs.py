# SPDX-License-Identifier: MIT
"""Batches by the engines of examples/batch: shards that are caught at work, and what must come out."""

import contextlib
import filecmp
import json
import os
import pathlib
import shutil
import signal
import sys
import time
import unittest

SHARDS = 4
SECONDS = 120  # until something that does not happen is given up; no bound on speed


def until(condition, what, interval=0.002):
    """The first true value of condition(), asked for every `interval` [s]."""
    deadline = time.monotonic() + SECONDS
    while not (value := condition()):
        if time.monotonic() > deadline:
            raise TimeoutError(f"waited {SECONDS} s for {what}")
        time.sleep(interval)
    return value


def processes(program, *arguments):
    """Numbers of the running processes of a program that have these arguments."""
    wanted = {str(argument).encode() for argument in arguments}
    found = []
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "cmdline").read_bytes().split(b"\0")
        except OSError:
            continue  # ended meanwhile
        if str(program).encode() in words[:2] and wanted <= set(words):
            found.append(int(folder.name))
    return found


def results(folder):
    """results.jsonl without times, and without pages: a merge in between chooses the worst among fewer."""
    lines = []
    for line in (folder / "results.jsonl").read_text().splitlines():
        entry = json.loads(line)
        for name in ("seconds", "ms_per_frame", "report"):
            entry.pop(name, None)
        lines.append(entry)
    return lines


class BatchCase(unittest.TestCase):
    """main() sets these from the command line: PROGRAM EXAMPLES MANIFEST UNDISTURBED."""

    program = examples = manifest = undisturbed = pathlib.Path()
    maxDiff = None

    def setUp(self):
        # Beside the undisturbed one, as motions name their model by a relative path; its space must be quoted.
        self.out = self.undisturbed.with_name(self.id().replace("__main__.", "").replace(".", " "))
        shutil.rmtree(self.out, ignore_errors=True)
        self.out.mkdir()
        self.environment = {**os.environ, "PROGRAM": str(self.program)}

    def entries_of(self, shard):
        """Lines of a shard's journal that are written to their end."""
        journal = self.out / f"journal.{shard}of{SHARDS}.jsonl"
        return journal.read_bytes().count(b"\n") if journal.exists() else 0

    def catch(self, shard):
        """The process of a shard, stopped in the midst of its work."""
        until(lambda: self.entries_of(shard) > 0, f"the first entry of shard {shard}")
        found = processes(self.program, self.out, f"{shard}/{SHARDS}")
        self.assertEqual(len(found), 1, "the shard ended before it could be stopped")
        os.kill(found[0], signal.SIGSTOP)
        self.assertLess(self.entries_of(shard), len(results(self.undisturbed)) / SHARDS,
                        "the shard was done before it could be stopped")
        return found[0]

    def kill(self, shard):
        """Kills a shard as it works."""
        os.kill(self.catch(shard), signal.SIGKILL)

    def cut_power(self, run):
        """Kills an engine, a process group, and all shards, as one of them works."""
        self.catch(2)
        os.killpg(run.pid, signal.SIGKILL)
        run.wait()

        def gone():
            left = processes(self.program, self.out)
            for process in left:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, signal.SIGKILL)
            return not left

        until(gone, "the end of all shards")
        self.assertFalse((self.out / "results.jsonl").exists())

    def motions(self, folder):
        return sorted(file.relative_to(folder) for file in (folder / "motions").rglob("*") if file.is_file())

    def assert_undisturbed(self):
        """The outputs are those of one undisturbed run without shards."""
        expected = results(self.undisturbed)
        self.assertEqual({entry["state"] for entry in expected}, {"converted"})
        self.assertEqual(results(self.out), expected)
        files = self.motions(self.undisturbed)
        self.assertEqual(len(files), len(expected))
        self.assertEqual(self.motions(self.out), files)
        different = [file for file in files
                     if not filecmp.cmp(self.undisturbed / file, self.out / file, shallow=False)]
        self.assertEqual(different, [])
        self.assertTrue((self.out / "index.html").exists())


def main():
    names = ("program", "examples", "manifest", "undisturbed")
    for name, path in zip(names, sys.argv[1:], strict=True):
        setattr(BatchCase, name, pathlib.Path(path))
    unittest.main(argv=sys.argv[:1], verbosity=2)
