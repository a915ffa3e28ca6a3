# SPDX-License-Identifier: MIT
"""What a user sees: the bar of long work, the pictures of a notebook."""
import io
import sys
import unittest
import unittest.mock
import xml.etree.ElementTree as ET

import numpy as np

import mmmconverter
from mmmconverter import _progress, _stills
from support import Case, SAMPLE


class Terminal(io.StringIO):

    def isatty(self):
        return True


class Presentation(Case):

    def bar(self, *calls):
        """What a bar writes that is called with (seconds, done, all)."""
        terminal = Terminal()
        with unittest.mock.patch.object(_progress.time, "monotonic") as clock:
            clock.return_value = 0
            bar = _progress.Bar("frames", terminal)
            for seconds, done, all in calls:
                clock.return_value = seconds
                bar(done, all)
            bar.close()
        return terminal.getvalue().split("\r")

    def test_a_bar_tells_how_far_the_work_is(self):
        _, half, end, cleared, _ = self.bar((2, 50, 100), (4, 100, 100))
        self.assertEqual(half, f" 50 % |{15 * '#'}{15 * ' '}| 50 of 100 frames, 2 s left")
        self.assertEqual(end.rstrip(), f"100 % |{30 * '#'}| 100 of 100 frames")
        self.assertEqual(len(end), len(half))  # nothing of what was longer stays
        self.assertEqual(cleared.strip(), "")

    def test_short_work_shows_nothing(self):
        self.assertEqual(self.bar((0.5, 50, 100), (0.9, 100, 100)), [""])

    def test_a_bar_is_shown_where_somebody_sees_it(self):
        with unittest.mock.patch.object(sys, "stderr", Terminal()):
            with _progress.shown(None, "frames") as callback:
                self.assertIsInstance(callback, _progress.Bar)
            for none in (False, None):
                with unittest.mock.patch.object(sys, "stderr", Terminal() if none is False else None):
                    with _progress.shown(none, "frames") as callback:
                        self.assertIsNone(callback)
        with unittest.mock.patch.object(sys, "stderr", io.StringIO()):
            with _progress.shown(None, "frames") as callback:
                self.assertIsNone(callback)
        with _progress.shown(print, "frames") as callback:
            self.assertIs(callback, print)

    def test_long_work_shows_its_bar(self):
        terminal = Terminal()
        with unittest.mock.patch.object(sys, "stderr", terminal), \
                unittest.mock.patch.object(_progress, "_QUIET", 0):
            mmmconverter.convert(SAMPLE, height=1.8)
        self.assertIn("of 675 frames", terminal.getvalue())
        self.assertTrue(terminal.getvalue().endswith("\r"))

    def test_a_conversion_shows_still_frames(self):
        result = mmmconverter.convert(SAMPLE, height=1.8, progress=False)
        html = result._repr_html_()
        self.assertIn("<caption>Conversion", html)
        svg = ET.fromstring(html[html.index("<svg"):])
        figures = svg.findall("{*}g")
        self.assertEqual(len(figures), 6)
        frames = _stills.still_frames(result.root_quaternions, result.joints)
        self.assertEqual([figure.find("{*}text").text for figure in figures],
                         [f"{time:.2f} s" for time in result.times[frames]])
        # Upright at first, upside down in the middle: the head is above the hips, then below.
        model = result.model
        poses = model.forward(result)
        head, hips = (model.segments.index(name) for name in ("BUNx_joint", "LHx_joint"))
        for k in (0, 337):
            seen = _stills._seen(poses.positions[k])
            self.assertEqual(seen[head, 1] < seen[hips, 1],
                             poses.positions[k, head, 2] > poses.positions[k, hips, 2])
        for path in (figure.find("{*}path").get("d") for figure in figures):
            self.assertGreater(path.count("L"), 20)
            places = [float(word) for word in path.replace("M", " ").replace("L", " ").split()]
            self.assertTrue(all(0 <= place <= 150 for place in places))

    def test_stills_of_motions_that_hardly_are_one(self):
        upright = np.tile([1.0, 0, 0, 0], (20, 1))
        self.assertEqual(_stills.still_frames(upright[:1], np.zeros((1, 3))), [0])
        self.assertEqual(_stills.still_frames(upright[:0], np.zeros((0, 3))), [])
        still = _stills.still_frames(upright, np.zeros((20, 3)))
        self.assertEqual((still[0], still[-1], len(still)), (0, 19, 6))
        quick = np.zeros((20, 1))
        quick[10:] = 1  # all of the movement is here
        self.assertIn(10, _stills.still_frames(upright, quick))


if __name__ == "__main__":
    unittest.main()
