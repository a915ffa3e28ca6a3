# SPDX-License-Identifier: MIT
"""label_test.py FOLDER [unittest arguments]: the page of a recording's labels in a real browser."""

import json

from page_case import COUNT_DRAWN, PageCase, run_tests

PLOTS = ("#x-plot", "#y-plot", "#z-plot")


class LabelPage(PageCase):
    def test_changes_and_tracks_are_shown(self):
        self.open("label.html")
        figures = json.loads((self.folder / "label.json").read_text())
        names = [one["name"] for one in figures["names"] if one["frames"] > 0]
        self.assertRegex(self.text("#sentence"), r"Verdict: .*[^.]\.$")
        self.assertCountEqual(self.texts("#name option"), names)
        self.assertEqual(len(self.texts("table.changes tbody tr")), len(figures["changes"]))
        for plot in PLOTS:
            self.assertGreater(self.run_script(COUNT_DRAWN, plot, "--converter-0"), 30, plot)
        self.click("table.changes tbody tr:last-child button")
        last = figures["changes"][-1]
        self.assertEqual(self.run_script("return mmmReport.name"), last["to"])
        self.assertEqual(self.run_script("return mmmReport.frame"), last["first_frame"])
        words = ("after it", "after the repair") if figures["repair"] else ("found", "names that were found")
        self.assertIn(words[0], self.text("#x-plot .readout"))
        self.assertIn(words[1], self.text("#player-heading"))
        self.check_sticks(len(names))
        self.check_nothing_was_loaded()

    # Between all names; crosses where the last change begins.
    def check_sticks(self, names):
        self.assertRegex(self.text("#now"), "(changed|newly named): ")
        for drawn in self.run_script("return mmmReport.drawn"):
            self.assertGreater(drawn["crosses"], 0, drawn)
            self.assertGreater(drawn["ends"], 0, drawn)
            self.assertLessEqual(drawn["ends"], 2 * (names - 1), drawn)

    def test_it_fits(self):
        self.check_fits(("label.html", "hostile_label.html"))
        self.check_nothing_was_run()
        self.assertIn("<script>window.hacked=1</script>", self.text("#name"))

    def test_injected_scripts_do_not_run(self):
        self.check_injected_scripts_do_not_run("label.html")


if __name__ == "__main__":
    run_tests()
