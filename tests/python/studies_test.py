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

    def test_arrays_are_as_good_as_files(self):
        recording = mmmconverter.read(SAMPLE)
        arrays = mmmconverter.Recording.from_arrays(recording.labels, recording.markers[:100], 100,
                                                    recording.first_time, "handstand")
        whole = mmmconverter.Recording.from_arrays(recording.labels, recording.markers, 100)
        of_arrays, of_file = (mmmconverter.calibrate(one, height=1.8, frames=(0, 300)) for one in (whole, SAMPLE))
        self.assertEqual(of_arrays.subject.data["segments"], of_file.subject.data["segments"])
        arrays.save(self.folder / "short.c3d")
        of_arrays, of_file = (mmmconverter.label(one, height=1.8, repair=True)
                              for one in (arrays, self.folder / "short.c3d"))
        self.assertEqual(of_arrays.recording.labels, of_file.recording.labels)
        np.testing.assert_allclose(of_arrays.recording.markers, of_file.recording.markers, atol=1e-6)
        of_arrays.save(self.folder / "labelled.c3d")
        self.assertEqual(len(mmmconverter.read(self.folder / "labelled.c3d")), 100)
        of_arrays, of_file = (mmmconverter.compare(one, ["jacobian_pull"], height=1.8, frames=(0, 100))
                              for one in (arrays, SAMPLE))
        rows = [without_times(one.summary["rows"]) for one in (of_arrays, of_file)]
        self.assertEqual(*[[{**row, "trial": ""} for row in one] for one in rows])

    def test_learn_markers(self):
        recording = mmmconverter.read(SAMPLE)
        arrays = mmmconverter.Recording.from_arrays([f"M{i}" for i in range(53)], recording.markers, 100)
        arrays.save(self.folder / "unknown.c3d")
        self.run_program("learn-markers", self.folder / "unknown.c3d", "--height", "1.8", "--frames", ":300",
                         "-o", self.folder / "ours.xml")
        learned = mmmconverter.learn_markers(self.folder / "unknown.c3d", height=1.8, frames=(0, 300))
        self.assertIsNone(learned.file)
        self.assertNotIn("written", learned.text)
        before = mmmconverter.convert(arrays, height=1.8, marker_set=learned, frames=(0, 20))
        (self.folder / "again").mkdir()
        learned.save(self.folder / "again/ours.xml")
        self.assertEqual(learned.file, str(self.folder / "again/ours.xml"))
        self.assert_same_files(self.folder / "ours.xml", learned.file)
        after = mmmconverter.convert(arrays, height=1.8, marker_set=learned.file, frames=(0, 20))
        np.testing.assert_array_equal(before.joints, after.joints)
        self.assertRegex(repr(learned), r"LearnedMarkers of 1 recordings: markers \d\d, mean distance")
        self.assertIn("written", learned.text)
        self.assertEqual(learned.warnings, learned.summary["warnings"])
        with self.assertRaises(mmmconverter.Error):
            mmmconverter.learn_markers([])

    def test_dynamics_of_arrays(self):
        checks = mmmconverter.check_dynamics(MOTION).summary["checks"]
        motion = mmmconverter.read_motion(MOTION)
        self.assertEqual(mmmconverter.check_dynamics(motion).summary["checks"], checks)
        of_arrays = mmmconverter.Motion.from_arrays(
            motion.joint_names, motion.root_positions, motion.root_quaternions, motion.joints, motion.rate,
            height=motion.height, mass=motion.mass, first_time=motion.first_time)
        self.assertEqual(mmmconverter.check_dynamics(of_arrays).summary["checks"], checks)
        motion.root_positions = motion.root_positions + [0, 0, 9.81 / 2] * (motion.times**2)[:, np.newaxis]
        self.assertEqual(mmmconverter.check_dynamics(motion).judgement, "implausible")  # rises as if thrown
        with self.assertRaisesRegex(mmmconverter.Error, "root_quaternions: has the shape"):
            mmmconverter.check_dynamics(mmmconverter.Motion.from_arrays(
                [], np.zeros((2, 3)), np.zeros((3, 4)), np.zeros((2, 0)), 100, height=1.8))
        result = mmmconverter.convert(SAMPLE, height=1.8, frames=(0, 200))
        result.save(self.folder / "m.xml")
        written, computed = (mmmconverter.check_dynamics(one) for one in (self.folder / "m.xml", result))
        self.assertEqual(computed.judgement, written.judgement)
        for ours, theirs in zip(computed.summary["checks"], written.summary["checks"]):
            self.assertEqual(ours.keys(), theirs.keys())
            for name, value in ours.items():
                if isinstance(value, float):  # the file has eight digits
                    self.assertAlmostEqual(value, theirs[name], delta=1e-3 * (1 + abs(value)), msg=name)

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

    def test_retarget(self):
        robot = ROOT / "examples/robot/biped.urdf"
        self.run_program("retarget", MOTION, "--robot", robot, "--frames", ":60", "-o", self.folder / "p.xml",
                         "--summary", self.folder / "p.json", "--export-lafan1", self.folder / "p.csv")
        # A page tells of the files at other rates that were asked for with it: here of none.
        self.run_program("retarget", MOTION, "--robot", robot, "--frames", ":60", "-o", self.folder / "p.xml",
                         "--report", self.folder / "p.html")
        moved = mmmconverter.retarget(MOTION, robot, frames=(None, 60))
        moved.save(self.folder / "p.xml")
        moved.report(self.folder / "o.html")
        self.assert_same_files(self.folder / "p.html", self.folder / "o.html")
        moved.export("lafan1", self.folder / "o.csv")
        self.assert_same_files(self.folder / "p.csv", self.folder / "o.csv")
        self.assertEqual(moved.summary["limbs"], self.summary("p.json")["limbs"])
        self.assertEqual(moved.verdict, self.summary("p.json")["verdict"]["level"])
        self.assertEqual(moved.rate, 100)
        self.assertEqual((moved.root_positions.shape, moved.root_quaternions.shape), ((60, 3), (60, 4)))
        self.assertEqual(moved.joints.shape, (60, len(moved.joint_names)))
        self.assertIn("left_knee", moved.joint_names)
        self.assertEqual(moved.warnings, moved.summary["warnings"])
        self.assertIn("verdict", moved.text)
        self.assertIn("biped", repr(moved))
        held = mmmconverter.retarget(MOTION, robot, frames=(None, 60), hold={"*_elbow": -30})
        for side in ("left_elbow", "right_elbow"):
            np.testing.assert_array_equal(held.joints[:, held.joint_names.index(side)], np.radians(-30.0))
        with self.assertRaisesRegex(mmmconverter.Error, "no motion|none"):
            mmmconverter.retarget(MOTION, robot, objects=MOTION)
        with self.assertRaisesRegex(mmmconverter.Error, "lafan1"):
            moved.export("lafan2", self.folder / "o.csv")
        for save in (moved.save, moved.report, lambda file: moved.export("lafan1", file)):
            with self.assertRaises(mmmconverter.Error):
                save(MOTION)
        with self.assertRaisesRegex(ValueError, "export"):
            moved.save(self.folder / "o.csv")
        with self.assertRaisesRegex(mmmconverter.Error, "isaac"):
            moved.export("beyondmimic", self.folder / "o.npz")
        arrays = mmmconverter.Recording.from_arrays(
            mmmconverter.read(SAMPLE).labels, mmmconverter.read(SAMPLE).markers[:40], 100)
        self.assertEqual(len(mmmconverter.retarget(arrays, robot, height=1.8).joints), 40)
        converted = mmmconverter.convert(arrays, height=1.8)
        of_conversion = mmmconverter.retarget(converted, robot)
        self.assertEqual(len(of_conversion.joints), 40)
        with self.assertRaisesRegex(mmmconverter.Error, "height: a conversion is taken as it is"):
            mmmconverter.retarget(converted, robot, height=1.8)
        of_motion = mmmconverter.retarget(mmmconverter.read_motion(MOTION), robot, frames=(None, 60))
        np.testing.assert_array_equal(of_motion.joints, moved.joints)


if __name__ == "__main__":
    unittest.main()
