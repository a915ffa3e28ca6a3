# SPDX-License-Identifier: MIT
"""ground_test.py FOLDER [unittest arguments]: force plates and strides on a report, in a real browser."""

import statistics

from page_case import PageCase, run_tests


class GroundPage(PageCase):

    def setUp(self):
        super().setUp()
        self.open("ground.html")

    def test_forces_are_told_at_each_frame(self):
        self.assertIn("plate 1, left foot: 700 N (1.00 body weights)", self.text("#now"))
        self.assertNotIn("plate 2", self.text("#now"))
        self.run_script("mmmReport.seek(mmmReport.frames - 1)")
        self.assertIn("plate 2, right foot: 1400 N (2.00 body weights)", self.text("#now"))
        self.assertIn("1 m is a body weight, 700 N (71.4 kg)", self.text("#forces-caption"))
        self.assertIn("window.hacked=1", self.text("#forces-caption"))
        self.check_nothing_was_run()

    def test_strides(self):
        self.assertIn("1 stride of the left foot and 1 of the right; 1 are left out", self.text("#gait-caption"))
        self.assertEqual(self.texts("#gait-table tbody tr:first-child td"), ["1.3 (1)", "60.0 (1)", "steps/min"])
        self.assertEqual(self.texts("#gait-forces-charts b"), ["vertical force"])
        self.assertEqual(self.texts("#gait-angles-charts b"), ["knee flexion"])
        self.assertEqual(len(self.texts("#gait-angles-charts canvas")), 2)
        self.assertEqual(len(self.texts("#gait-more-charts canvas")), 0)
        self.click("#gait-more summary")
        self.assertEqual(len(self.texts("#gait-more-charts canvas")), 2)

    def test_strides_of_several_recordings_are_as_of_one(self):
        # Of 1, 2, 3 and of 4, 6: as of all five.
        pooled = self.run_script("return mmmReport.pool([{mean: 2, sd: 1, count: 3}, {mean: 5, sd: Math.SQRT2, count: 2},"
                                 " {mean: null, sd: null, count: 4}])")
        self.assertEqual(pooled["count"], 5)
        self.assertAlmostEqual(pooled["mean"], 3.2)
        self.assertAlmostEqual(pooled["sd"], statistics.stdev([1, 2, 3, 4, 6]))
        self.assertFalse(self.find("#gait-choice").is_displayed())

    def test_cycle_is_saved_as_shown(self):
        name, data = self.browser.saved(lambda: self.click("#gait-angles-charts .save button:first-child"))
        self.assertEqual(name, "Ground_knee_flexion_over_the_gait_cycle_.csv")
        lines = data.decode().splitlines()
        self.assertEqual(lines[0], '"gait cycle [%]"'.strip('"') + ',left [°],"left, low [°]","left, high [°]"')
        self.assertEqual(lines[1 + 10], "10,10,8,12")
        self.assertEqual(len(lines), 102)

    def test_other_pages_have_none(self):
        self.open("compare.html")
        for selector in ("#gait-part", "#forces-option", "#forces-caption", "#left-force-legend"):
            self.assertFalse(self.find(selector).is_displayed(), selector)

    def test_fits(self):
        self.check_fits(["ground.html"])


class Arrows(PageCase):
    webgl = True

    def test_arrow_is_drawn_where_the_foot_is_loaded(self):
        self.open("ground.html")
        arrow = """
            const [arrow, other] = mmmReport.arrows;
            return [arrow.visible, other.visible, ...arrow.position, arrow.top]"""
        visible, other, x, y, z, top = self.run_script(arrow)
        self.assertTrue(visible)
        self.assertFalse(other)
        for value, wanted in ((x, 1), (y, 0.1), (z, 0), (top, 1)):
            self.assertAlmostEqual(value, wanted, places=3)
        self.click("#show-forces")
        self.assertFalse(self.run_script("return mmmReport.arrows[0].shown"))


if __name__ == "__main__":
    run_tests()
