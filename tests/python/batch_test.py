# SPDX-License-Identifier: MIT
"""batch beside the command of its name."""
import json
import shutil
import unittest

import mmmconverter
from support import Case, SAMPLE

try:
    import pandas
except ImportError:
    pandas = None


class Batches(Case):

    def setUp(self):
        super().setUp()
        shutil.copy(SAMPLE, self.folder / "walk.c3d")
        self.manifest = self.folder / "manifest.xml"
        self.out = self.folder / "out"
        self.write("<Recording file='walk.c3d' id='a'/><Recording file='none.c3d'/>")

    def write(self, recordings):
        self.manifest.write_text(f"<Batch height_m='1.8' frames=':40'>{recordings}</Batch>")

    def batch(self, **options):
        return mmmconverter.batch(self.manifest, self.out, reports="none", **options)

    def test_results_are_those_of_the_program(self):
        seen = []
        results = self.batch(jobs=1, progress=lambda done, all: seen.append((done, all)))
        self.assertEqual(seen, [(1, 2), (2, 2)])
        self.assertEqual([one["state"] for one in results], ["failed", "converted"])
        self.assertIn("none.c3d", results[0]["reason"])
        self.assertEqual(list(results),
                         [json.loads(line) for line in (self.out / "results.jsonl").read_text().splitlines()])
        motion = mmmconverter.read_motion(self.out / results[1]["motion"])
        self.assertEqual(len(motion.times), 40)
        self.assertEqual(results.output, str(self.out))

    @unittest.skipIf(pandas is None, "needs pandas")
    def test_they_are_a_table(self):
        table = self.batch().to_dataframe()
        self.assertEqual(table.loc["a", "frames"], 40)
        self.assertGreater(table.loc["a", "distance_mm.mean"], 0)

    def test_resume_keeps_what_is_done(self):
        self.batch()
        before = (self.out / "motions/a.xml").stat().st_mtime_ns
        results = self.batch(resume=True)
        self.assertEqual(results[1]["state"], "converted")
        self.assertEqual((self.out / "motions/a.xml").stat().st_mtime_ns, before)

    def test_what_is_wrong_is_raised(self):
        with self.assertRaises(FileNotFoundError):
            mmmconverter.batch(self.folder / "none.xml", self.out)
        with self.assertRaises(ValueError):
            self.batch(jobs=0)
        with self.assertRaisesRegex(mmmconverter.Error, "ended by the first failure"):
            self.batch(fail_fast=True, jobs=1)
        self.write("<Recording file='walk.c3d' heigth_m='1.7'/>")
        with self.assertRaisesRegex(mmmconverter.Error, "^/.*manifest.xml:1: <Recording>: unknown attribute"):
            self.batch()

    def test_what_progress_raises_ends_the_program(self):
        self.write("".join(f"<Recording file='walk.c3d' id='{i}'/>" for i in range(60)))

        def stop(done, all):
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            self.batch(jobs=1, progress=stop)
        self.assertFalse((self.out / "results.jsonl").exists())
        self.assertLess(len((self.out / "journal.jsonl").read_text().splitlines()), 60)


if __name__ == "__main__":
    unittest.main()
