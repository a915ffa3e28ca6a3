# SPDX-License-Identifier: MIT
"""What is read: recordings, motions and subjects."""
import gc
import os
import unittest

import numpy as np

import mmmconverter
from support import Case, ROOT, SAMPLE, SHARED, needs_shared_data, run_program


class Recordings(Case):

    def test_markers_are_the_recordings_own_memory(self):
        recording = mmmconverter.read(SAMPLE)
        markers = recording.markers
        self.assertEqual(markers.shape, (675, 53, 3))
        self.assertTrue(np.shares_memory(markers, recording.markers))
        self.assertFalse(markers.flags.owndata)
        self.assertFalse(markers.flags.writeable)
        with self.assertRaises(ValueError):
            markers[0, 0, 0] = 1
        first = markers[:, 0].copy()
        del recording
        gc.collect()
        np.testing.assert_array_equal(markers[:, 0], first)  # the view keeps its memory

    def test_a_recording_says_what_it_is(self):
        recording = mmmconverter.read(SAMPLE)
        self.assertEqual((recording.rate, recording.format, recording.unit), (100, "C3D", "mm"))
        self.assertEqual(len(recording), 675)
        self.assertEqual(len(recording.labels), 53)
        self.assertAlmostEqual(recording.times[-1] - recording.times[0], 6.74)
        self.assertEqual(
            repr(recording),
            "<Recording handstand.c3d: frames 675, markers 53, rate 100 Hz, format C3D>")
        self.assertIn("<td", recording._repr_html_())
        self.assertEqual(recording.events, [])
        with self.assertRaises(AttributeError):
            recording.nothing

    def test_missing_markers_are_nan(self):
        markers = np.array(mmmconverter.read(SAMPLE).markers[:20])
        markers[3, 5] = np.nan
        recording = mmmconverter.Recording.from_arrays(
            mmmconverter.read(SAMPLE).labels, markers, 100, first_time=0.5)
        recording.save(self.folder / "gap.c3d")
        read = mmmconverter.read(self.folder / "gap.c3d")
        self.assertTrue(np.isnan(read.markers[3, 5]).all())
        self.assertFalse(np.isnan(read.markers[4]).any())
        np.testing.assert_allclose(read.markers, markers, atol=1e-6)

    def test_arrays_are_checked(self):
        from_arrays = mmmconverter.Recording.from_arrays
        with self.assertRaisesRegex(mmmconverter.Error, r"markers: has the shape \(5, 2\); "
                                    r"\(n, 2, 3\) is expected"):
            from_arrays(["a", "b"], np.zeros((5, 2)), 100)
        with self.assertRaisesRegex(mmmconverter.Error, "rate: "):
            from_arrays(["a"], np.zeros((5, 1, 3)), 0)
        with self.assertRaisesRegex(mmmconverter.Error, "there are none"):
            from_arrays([], np.zeros((5, 0, 3)), 100)

    def test_errors_have_the_programs_text(self):
        for file in (self.folder / "absent.c3d", ROOT / "README.md"):
            with self.assertRaises(mmmconverter.Error) as raised:
                mmmconverter.read(file)
            run = run_program("convert", file)
            self.assertEqual(run.stderr.strip(), f"error: {raised.exception}")

    @needs_shared_data
    def test_analog_samples_are_the_forces_that_another_program_read(self):
        recording = mmmconverter.read(SHARED / "forces/walking2.c3d")
        analog = recording.analog
        self.assertEqual((analog["rate"], analog["labels"][2], analog["units"][2]), (2000, "Fz1", "N"))
        self.assertEqual(analog["samples"].shape, (8 * len(recording), 12))
        # BTK's, 20 a second, as OpenSim has them: what acts on the person, in the world's axes.
        text = (SHARED / "forces/std_cop_walking2_grfs.sto").read_text().split("endheader")[1]
        there = np.array([line.split() for line in text.strip().splitlines()[1:]], float)
        here = analog["samples"][::100]
        rows = min(len(there), len(here))
        self.assertGreater(rows, 50)
        for column, sign, channel in ((1, -1, "Fy1"), (2, -1, "Fx1"), (3, -1, "Fz1"),
                                      (10, -1, "Fx2"), (11, 1, "Fy2"), (12, -1, "Fz2")):
            # Eight decimals are written.
            np.testing.assert_allclose(sign * here[:rows, analog["labels"].index(channel)],
                                       there[:rows, column], atol=1e-8)

    @needs_shared_data
    def test_force_plates_lie_where_the_markers_are(self):
        plates = mmmconverter.read(SHARED / "forces/walking2.c3d").force_plates
        self.assertEqual([plate["type"] for plate in plates], [2, 2])
        np.testing.assert_array_equal(plates[1]["channels"], range(6, 12))
        # What the file says in millimetres, z up.
        np.testing.assert_allclose(
            plates[0]["corners"], [[0.6646, 0.37932, 0], [0.6646, 0.84287, 0],
                                   [1.1726, 0.84287, 0], [1.1726, 0.37932, 0]], atol=1e-7)
        np.testing.assert_allclose(plates[1]["origin"], [0, 0, 0.05715], atol=1e-7)

    @needs_shared_data
    def test_events_of_a_file(self):
        before = os.getcwd()
        os.chdir(SHARED)
        try:
            recording = mmmconverter.read("recordings/conformance/Eb015pr.c3d")
        finally:
            os.chdir(before)
        self.assertEqual(len(recording.events), 3)  # wherever the program is by now
        for event in recording.events:
            self.assertGreaterEqual(event["time"], 0)
            self.assertEqual(set(event), {"time", "label", "context", "subject"})

    def test_what_has_no_analog_channels_says_so(self):
        recording = mmmconverter.read(SAMPLE)
        self.assertEqual(recording.analog["samples"].shape, (0, 0))
        self.assertEqual((recording.analog["labels"], recording.force_plates), ([], []))
        arrays = mmmconverter.Recording.from_arrays(["a"], np.zeros((2, 1, 3)), 100)
        self.assertEqual((arrays.analog, arrays.force_plates, arrays.events), ({}, [], []))

    @needs_shared_data
    def test_motions_of_a_file(self):
        file = SHARED / "mmm/kit_bimanual_10hz/Close_files_motions_3072_Close1_aj_180_30h_08.xml"
        motions = mmmconverter.read_motions(file)
        self.assertEqual([one.name for one in motions][3:5], ["true_1723", "pred_1723"])
        with self.assertRaisesRegex(mmmconverter.Error, "true_apple_juice"):
            mmmconverter.read_motion(file)
        motion = mmmconverter.read_motion(file, "true_1723")
        frames = len(motion.times)
        self.assertEqual(motion.joints.shape, (frames, len(motion.joint_names)))
        self.assertEqual(motion.root_quaternions.shape, (frames, 4))
        np.testing.assert_allclose(np.linalg.norm(motion.root_quaternions, axis=1), 1)
        self.assertGreater(len(motion.labels), 3)
        self.assertEqual(motion.markers.shape[1:], (len(motion.labels), 3))

    def test_a_motion_of_the_sample(self):
        motion = mmmconverter.read_motion(ROOT / "examples/handstand_true.xml")
        self.assertEqual(motion.joints.shape, (675, 44))
        self.assertEqual(repr(motion), "<Motion synthetic_subject: frames 675, joints 44, rate 100 Hz>")
        self.assertIn("synthetic_subject", motion._repr_html_())


if __name__ == "__main__":
    unittest.main()
