# SPDX-License-Identifier: MIT
"""ground_test.py FOLDER [unittest arguments]: force plates and strides on a report, in a real browser."""

import statistics
from xml.etree import ElementTree

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
        # 200 (60 - 1.25) / (60 + 1.25) is the symmetry index.
        self.assertEqual(self.texts("#gait-table tbody tr:first-child td"),
                         ["1.3", "", "1", "60.0", "", "1", "+191.8", "steps/min"])
        self.assertEqual(self.texts("#gait-table tbody th")[-1], "Double support")
        self.assertEqual(self.texts("#gait-forces-charts b"), ["vertical force"])
        self.assertEqual(self.texts("#gait-emg-charts b"), ["TA EMG"])
        self.assertEqual(self.texts("#gait-angles-charts b"), ["hip internal rotation", "knee flexion", "foot progression"])
        self.assertEqual(self.texts("#gait-more-charts b"), ["elbow flexion"])
        self.assertIn("nothing in the recording tells them: wrist flexion", self.text("#gait-untold"))
        self.assertIn("1.72 ± 0.02 m (given)", self.text("#patient"))

    def test_each_chart_has_curves_of_both_sides_and_says_their_extremes(self):
        for chart in self.browser.driver.find_elements("css selector", "#cycles-part svg.chart"):
            for side in ("left", "right"):
                self.assertEqual(len(chart.find_elements("css selector", f"[data-line={side}]")), 1)
        self.assertEqual(self.run_script("return document.querySelector(\"#gait-angles-charts [aria-label^='knee']\").ariaLabel"),
                         "knee flexion, °: left from 0 at 0 % of the cycle to 100 at 100 %; "
                         "right from 0 at 0 % of the cycle to 100 at 100 %")

    def test_single_strides_can_be_switched_off(self):
        count = "return document.querySelectorAll('#gait-angles-charts .single').length"
        self.assertEqual(self.run_script(count), 3 * 2 * 2)
        self.click("#gait-singles")
        self.assertEqual(self.run_script(count), 0)

    def test_an_angle_that_is_badly_known_says_so(self):
        self.assertEqual(self.texts("#gait-angles-charts .doubtful"), ["Badly known: left ±17°, right ±17°"])
        self.assertEqual(self.run_script("return document.querySelectorAll('#gait-angles-charts .doubt').length"), 4)

    def test_normal_bands_and_scores(self):
        self.assertIn("window.hacked=1", self.text("#normal-source"))
        self.assertEqual(len(self.texts("#gait-angles-charts .cycle:nth-child(2) .band")), 3)  # normal, left, right
        self.assertEqual(len(self.texts("#profile tbody tr")), 10)
        # Nine of 6 and, without the pelvis, six of 8 degrees.
        self.assertIn("of both sides: 6.9°", self.text("#profile"))

    def test_strides_of_several_recordings_are_as_of_one(self):
        # Of 1, 2, 3 and of 4, 6: as of all five.
        pooled = self.run_script("return mmmReport.pool([{mean: 2, sd: 1, count: 3}, {mean: 5, sd: Math.SQRT2, count: 2},"
                                 " {mean: null, sd: null, count: 4}])")
        self.assertEqual(pooled["count"], 5)
        self.assertAlmostEqual(pooled["mean"], 3.2)
        self.assertAlmostEqual(pooled["sd"], statistics.stdev([1, 2, 3, 4, 6]))
        self.assertFalse(self.find("#gait-choice").is_displayed())

    def test_cycle_is_saved_as_shown(self):
        knee = "#gait-angles-charts .cycle:nth-child(2) .save button"
        name, data = self.browser.saved(lambda: self.click(f"{knee}:first-child"))
        self.assertEqual(name, "Ground_knee_flexion_over_the_gait_cycle_.csv")
        lines = data.decode().splitlines()
        self.assertEqual(lines[0], 'gait cycle [%],left [°],"left, low [°]","left, high [°]",right [°],"right, low [°]","right, high [°]"')
        self.assertEqual(lines[1 + 10], "10,10,8,12,10,8,12")
        self.assertEqual(len(lines), 102)
        name, data = self.browser.saved(lambda: self.click(f"{knee}:last-child"))
        self.assertNotIn(b"var(--", data)  # a file has no style sheet
        self.assertEqual(len(ElementTree.fromstring(data).findall(".//{http://www.w3.org/2000/svg}polyline")), 6)

    def test_other_pages_have_none(self):
        self.open("compare.html")
        for selector in ("#gait-part", "#cycles-part", "#patient-part", "#forces-option", "#forces-caption", "#left-force-legend"):
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
