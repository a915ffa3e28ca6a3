# SPDX-License-Identifier: MIT
"""calibrate, compare, label and check_dynamics beside the commands of these names."""
import json
import unittest

import numpy as np

import mmmconverter
from support import Case, ROOT, SAMPLE

MOTION = ROOT / "examples/handstand_true.xml"


def without_times(json_value):
    """What two runs have alike."""
    if isinstance(json_value, dict):
        return {name: without_times(value) for name, value in json_value.items()
                if name != "ms_per_frame"}
    return [without_times(one) for one in json_value] if isinstance(json_value, list) else json_value


class Studies(Case):

    def summary(self, name):
        return json.loads((self.folder / name).read_text())

    def test_calibrate(self):
        self.run_program("calibrate", SAMPLE, "--height", "1.8", "--name", "anna", "--frames", ":300",
                         "-o", self.folder / "program.xml", "--model-out", self.folder / "p_model.xml")
        calibration = mmmconverter.calibrate(SAMPLE, height=1.8, name="anna", frames=(None, 300))
        before = mmmconverter.convert(SAMPLE, subject=calibration, frames=(0, 30))
        calibration.save(self.folder / "python.xml")
        self.assert_same_files(self.folder / "program.xml", self.folder / "python.xml")
        calibration.save_model(self.folder / "model.xml")
        self.assert_same_files(self.folder / "p_model.xml", self.folder / "model.xml")
        self.assertEqual(calibration.subject.name, "anna")
        self.assertEqual(calibration.subject.file, str(self.folder / "python.xml"))
        read = mmmconverter.read_subject(self.folder / "python.xml")
        self.assertEqual(read.height, 1.8)
        self.assertEqual(read.data["segments"], calibration.subject.data["segments"])
        after = mmmconverter.convert(SAMPLE, subject=read, frames=(0, 30))
        np.testing.assert_array_equal(before.joints, after.joints)
        model = mmmconverter.read_model(subject=read)
        np.testing.assert_array_equal(model.forward(after).markers,
                                      after.model.forward(after).markers)
        self.assertIn(calibration.verdict, ("good", "check"))
        self.assertEqual(calibration.warnings, calibration.summary["warnings"])
        self.assertIn("anna", repr(calibration))
        self.assertIn("anna", calibration.text)
        with self.assertRaises(mmmconverter.Error):
            calibration.save(SAMPLE)
        with self.assertRaises(mmmconverter.Error):
            mmmconverter.calibrate([])

    def test_what_progress_raises_ends_every_study(self):
        def stop(done, all):
            raise RuntimeError("enough")

        for study, arguments in ((mmmconverter.calibrate, {"recordings": SAMPLE, "height": 1.8}),
                                 (mmmconverter.check_dynamics, {"file": MOTION})):
            with self.assertRaisesRegex(RuntimeError, "enough"):
                study(progress=stop, **arguments)

    def test_calibrate_says_when_all_is_read(self):
        said = []
        mmmconverter.calibrate(SAMPLE, height=1.8, frames=(0, 200),
                               progress=lambda *now: said.append(now))
        self.assertEqual(said[-1], (1, 1))

    def test_compare(self):
        self.run_program("compare", SAMPLE, "--height", "1.8", "--frames", ":40", "-c",
                         "jacobian_pull", "--json", self.folder / "program.json")
        comparison = mmmconverter.compare([SAMPLE], ["jacobian_pull"], height=1.8, frames=(None, 40))
        ours, theirs = comparison.summary, self.summary("program.json")
        self.assertEqual(set(ours), set(theirs))
        self.assertEqual(without_times(ours["rows"]), without_times(theirs["rows"]))
        comparison.report(self.folder / "page.html")
        self.assertIn("handstand", (self.folder / "page.html").read_text())
        self.assertIn("jacobian_pull", comparison.text)
        self.assertIn("recordings 1", repr(comparison))
        self.assertEqual(comparison.warnings, [])
        for keywords in ({"hide": 2}, {"repeat": 0}, {"truths": [None, None]}):
            with self.assertRaises(mmmconverter.Error):
                mmmconverter.compare(SAMPLE, **keywords)

    def test_label(self):
        recording = mmmconverter.read(SAMPLE)
        labels = list(recording.labels)
        labels[3], labels[20] = labels[20], labels[3]
        wrong = self.folder / "wrong.c3d"
        mmmconverter.Recording.from_arrays(labels, recording.markers[:100], 100).save(wrong)
        self.run_program("label", wrong, "--height", "1.8", "--repair", "-o",
                         self.folder / "program.c3d", "--summary", self.folder / "program.json")
        labelled = mmmconverter.label(mmmconverter.read(wrong), height=1.8, repair=True)
        labelled.save(self.folder / "python.c3d")
        self.assert_same_files(self.folder / "program.c3d", self.folder / "python.c3d")
        summary = self.summary("program.json")
        ours = labelled.summary
        for one in (summary, ours):
            one.pop("output", None)
        self.assertEqual(ours, summary)
        repaired = labelled.recording
        for i in (3, 20):
            column = repaired.labels.index(recording.labels[i])
            np.testing.assert_allclose(repaired.markers[:, column], recording.markers[:100, i],
                                       atol=1e-6)
        labelled.report(self.folder / "page.html")
        self.assertIn("points 53", repr(labelled))
        self.assertTrue(labelled.text)
        with self.assertRaisesRegex(mmmconverter.Error, "reads its recordings from files"):
            mmmconverter.label(labelled.recording)

    def test_check_dynamics(self):
        self.run_program("check-dynamics", MOTION, "--summary", self.folder / "program.json")
        said = []
        dynamics = mmmconverter.check_dynamics(MOTION, progress=lambda *now: said.append(now))
        self.assertEqual(dynamics.summary["checks"], self.summary("program.json")["checks"])
        self.assertEqual(dynamics.judgement, "plausible")
        dynamics.report(self.folder / "page.html")
        self.assertIn("handstand", (self.folder / "page.html").read_text())
        self.assertIn("plausible", repr(dynamics))
        self.assertTrue(dynamics.text)
        with self.assertRaisesRegex(mmmconverter.Error, "convert it first"):
            mmmconverter.check_dynamics(SAMPLE)
        with self.assertRaisesRegex(mmmconverter.Error, "low_pass"):
            mmmconverter.check_dynamics(MOTION, low_pass=-1)


if __name__ == "__main__":
    unittest.main()
