# SPDX-License-Identifier: MIT
"""What is read: recordings, motions and subjects."""
import gc
import unittest

import numpy as np

import mmmconverter
from support import Case, ROOT, SAMPLE, run_program


class Recordings(Case):

    def test_says_where_it_is_from(self):
        recording = mmmconverter.read(SAMPLE)
        self.assertEqual((recording.format, recording.unit, recording.up_axis), ("C3D", "mm", "+z"))
        self.assertEqual((recording.motion, recording.subjects), ("", []))

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
        with self.assertRaisesRegex(mmmconverter.Error, "markers: infinite"):
            from_arrays(["a"], np.full((5, 1, 3), np.inf), 100)
        with self.assertRaisesRegex(mmmconverter.Error, "labels: a is there twice"):
            from_arrays(["a", "b", "a"], np.zeros((5, 3, 3)), 100)

    def test_errors_have_the_programs_text(self):
        for file in (self.folder / "absent.c3d", ROOT / "README.md"):
            with self.assertRaises(mmmconverter.Error) as raised:
                mmmconverter.read(file)
            run = run_program("convert", file)
            self.assertEqual(run.stderr.strip(), f"error: {raised.exception}")

    def test_what_has_no_analog_channels_says_so(self):
        recording = mmmconverter.read(SAMPLE)
        self.assertEqual(recording.analog["samples"].shape, (0, 0))
        self.assertEqual((recording.analog["labels"], recording.force_plates), ([], []))
        arrays = mmmconverter.Recording.from_arrays(["a"], np.zeros((2, 1, 3)), 100)
        self.assertEqual((arrays.analog, arrays.force_plates, arrays.events), ({}, [], []))

    def test_a_motion_of_the_sample(self):
        motion = mmmconverter.read_motion(ROOT / "examples/handstand_true.xml")
        self.assertEqual(motion.joints.shape, (675, 44))
        self.assertEqual(repr(motion), "<Motion synthetic_subject: frames 675, joints 44, rate 100 Hz>")
        self.assertIn("synthetic_subject", motion._repr_html_())


if __name__ == "__main__":
    unittest.main()
