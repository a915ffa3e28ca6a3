# SPDX-License-Identifier: MIT
"""dynamics_test.py FOLDER [unittest arguments]: the page of a motion's dynamics in a real browser."""

import json

from selenium.webdriver.common.action_chains import ActionChains

from page_case import COUNT_DRAWN, PageCase, run_tests

PLOTS = ("#force-plot", "#contact-plot", "#support-plot", "#height-plot", "#acceleration-plot", "#momentum-plot",
         "#torque-plot", "#power-plot")


class ReportPage(PageCase):
    def test_dynamics_are_shown(self):
        self.open("dynamics.html")
        figures = json.loads((self.folder / "dynamics.json").read_text())
        self.assertEqual(self.run_script("return mmmReport.figures"), figures)
        self.assertEqual(self.text("#sentence"), figures["sentence"])
        rows = self.run_script("""
            return Array.from(document.querySelectorAll("table.checks tbody tr"), (row) =>
              Array.from(row.children, (cell) => cell.textContent))""")
        self.assertEqual(rows, [[check["check"], check["measured"], check["expected"],
                                 check["verdict"] + (f": {check['reason']}" if check["reason"] else "")]
                                for check in figures["checks"]])
        for plot in PLOTS:
            self.assertGreater(self.run_script(COUNT_DRAWN, plot, "--converter-0"), 30, plot)
        self.assertFalse(self.find("#flight-part").is_displayed())
        # One cursor for all plots.
        ActionChains(self.browser.driver).move_to_element(self.find("#height-plot .plot-area")).click().perform()
        # The middle of the element; the axis takes some of its left side.
        self.assertAlmostEqual(self.run_script("return mmmReport.frame"), 337, delta=40)
        self.run_script("mmmReport.seek(300)")
        self.assertIn("3.00 s", self.text("#force-plot .readout"))
        self.assertRegex(self.text("#contact-plot .readout"), r"left foot (touches|–).*right hand (touches|–)")
        self.check_nothing_was_loaded()

    def test_hostile_dynamics(self):
        self.check_fits(("dynamics.html", "hostile_dynamics.html"))
        self.assertEqual(len(self.texts("table.flights tbody tr")), 2)
        # A flight is shaded.
        self.assertGreater(self.run_script(COUNT_DRAWN, "#force-plot", "--shade"), 1000)
        self.run_script("mmmReport.seek(3)")
        ActionChains(self.browser.driver).move_to_element(self.find("#torque-plot .plot-area")).perform()
        self.check_nothing_was_run()
        for selector in ("h1", "#sentence", "table.checks", "#about", "#contact-plot .readout",
                         "#torque-plot .readout", "#notes"):
            self.assertIn("<script>window.hacked=1</script>", self.text(selector), selector)

    def test_injected_scripts_do_not_run(self):
        self.check_injected_scripts_do_not_run("dynamics.html")


if __name__ == "__main__":
    run_tests()
