# SPDX-License-Identifier: MIT
"""page_test.py FOLDER [unittest arguments]: the reports of make_reports.py in a real browser."""

import base64
import json
from xml.etree import ElementTree

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from page_case import COUNT_DRAWN, PIXELS, PageCase, run_tests

COLOURS = ["--converter-0", "--converter-1"]  # of the converters that have a result

# Of a picture of an element (PNG, base64): its number of shades, or of pixels of a colour.
COUNT_SHOWN = PIXELS + """
const [png, name, done] = arguments;
const image = new Image();
image.onload = () => done(name === null ? shadesOf(image) : countColour([image], name, 10));
image.src = "data:image/png;base64," + png;
"""


class ReportCase(PageCase):

    def frame(self):
        return self.run_script("return mmmReport.frame")

    def pixels(self, selector, colour=None):
        self.browser.settle()
        element = self.find(selector)
        self.run_script("arguments[0].scrollIntoView({block: 'center'})", element)
        self.browser.settle()
        return self.browser.driver.execute_async_script(COUNT_SHOWN, element.screenshot_as_base64, colour)


class Scene(ReportCase):
    """Where pictures are drawn: in software, which takes most of the time."""

    webgl = True

    def test_scene_is_drawn(self):
        for name in ("compare.html", "convert.html"):
            self.open(name)
            self.run_script("mmmReport.seek(mmmReport.frames / 2)")
            # Floor and background alone have some 200 shades.
            self.assertGreater(self.pixels("#scene"), 1000, name)

    def test_player_plays_and_pauses(self):
        self.open("compare.html")
        self.assertEqual(self.run_script("return mmmReport.frames"), 675)
        self.find("#play").click()
        self.browser.wait("return mmmReport.frame > 10")
        self.assertEqual(self.find("#play").get_attribute("aria-label"), "Pause")
        self.find("#play").click()
        frame = self.frame()
        self.browser.settle()
        self.assertEqual(self.frame(), frame)
        self.assertIn(f"frame {frame} of 675", self.text("#now"))

    def test_hidden_markers_are_shown_as_hidden(self):
        self.open("compare.html")
        self.assertTrue(self.find("#hidden-legend").is_displayed())
        self.find("#show-body").click()  # bones blend into many colours
        self.assertIn(" 0 markers hidden", self.text("#now"))
        filled, grey = self.pixels("#scene", "--text"), self.pixels("#scene", "--muted")
        self.run_script("mmmReport.seek(400)")
        self.assertIn(" 26 markers hidden", self.text("#now"))
        filled_then, grey_then = self.pixels("#scene", "--text"), self.pixels("#scene", "--muted")
        # Of 50 full discs 24 are left; the edges of discs have grey pixels too.
        self.assertLess(filled_then, 0.75 * filled)
        self.assertGreater(grey_then / filled_then, 1.5 * grey / filled)
        self.open("convert.html")
        self.assertFalse(self.find("#hidden-legend").is_displayed())

    def test_no_head_is_cut_off_at_first(self):
        for name in ("compare.html", "convert.html", "finished.html"):
            self.open(name)
            low, high = self.run_script("return mmmReport.reach")
            self.assertGreater(low, -1, name)
            self.assertLess(high, 1, name)
            self.assertGreater(high - low, 1.2, name)

    def test_picture_is_saved(self):
        self.open("convert.html")
        name, data = self.browser.saved(lambda: self.click("#save-picture"))
        self.assertRegex(name, r"handstand.*\.png$")
        shown = self.browser.driver.execute_async_script(COUNT_SHOWN, base64.b64encode(data).decode(), None)
        self.assertGreater(shown, 500)


class ReportPage(ReportCase):
    """What needs no picture of the body, in a browser without WebGL."""

    def test_stills_jump(self):
        self.open("compare.html")
        stills = self.browser.driver.find_elements(By.CSS_SELECTOR, ".still")
        self.assertEqual(len(stills), 6)
        for still in stills:
            still.click()
            self.assertIn(f"frame {self.frame()}", still.get_attribute("aria-label"))
        self.assertGreater(self.frame(), 674 * 0.9)
        lines = "return Array.from(document.querySelectorAll('.still svg'), (one) => one.querySelectorAll('line').length)"
        both = self.run_script(lines)
        self.assertGreater(min(both), 40)
        self.click("#converters input")
        self.assertEqual(self.run_script(lines), [count // 2 for count in both])

    def test_player_stops_at_the_end_and_starts_anew(self):
        self.open("convert.html")
        self.run_script("mmmReport.seek(670); mmmReport.play()")
        self.browser.wait("return !mmmReport.playing")
        self.assertEqual(self.frame(), 674)
        self.run_script("mmmReport.play()")
        self.assertLess(self.frame(), 674)

    def test_keys(self):
        self.open("compare.html")
        player = self.find("#player")
        for keys, frame in (((Keys.ARROW_RIGHT,), 1), ((Keys.ARROW_LEFT,), 0), ((Keys.END,), 674),
                            ((Keys.HOME,), 0), ((Keys.SHIFT, Keys.ARROW_RIGHT), 10)):
            player.send_keys(*keys)
            self.assertEqual(self.frame(), frame, keys)
        player.send_keys(Keys.NULL, " ")
        self.browser.wait("return mmmReport.frame > 12")
        player.send_keys(" ")
        self.assertFalse(self.run_script("return mmmReport.playing"))
        self.assertEqual(self.run_script("return document.activeElement.id"), "player")

    def test_keyboard_reaches_every_control(self):
        self.open("compare.html")
        reached = set()
        for _ in range(60):
            ActionChains(self.browser.driver).send_keys(Keys.TAB).perform()
            reached.add(self.run_script("return document.activeElement.id"))
        self.assertLessEqual({"trial", "player", "play", "scrub", "speed", "show-body", "heat-order", "joint"},
                             reached)

    def test_calibrated_person_is_shown(self):
        self.open("convert.html")
        self.assertFalse(self.find("#person-part").is_displayed())  # height and mass only
        self.open("hostile.html")
        self.assertTrue(self.find("#person-part").is_displayed())
        self.assertIn("1.800 m, 75.0 kg", self.text("#person-caption"))
        rows = self.run_script("""
            return Array.from(document.querySelectorAll("#person-segments tbody tr"), (row) =>
              Array.from(row.querySelectorAll("td"), (cell) => cell.textContent))""")
        # Largest change first; 1 - (5/6)^2 and 1 - (0.5/6)^2 of what was assumed is replaced.
        self.assertEqual(rows, [["+5.0", "", "5.0", "31 %"], ["-2.0", "", "0.5", "99 %"]])
        moved = self.run_script("""
            return Array.from(document.querySelectorAll("#person-markers tbody tr"), (row) =>
              parseFloat(row.querySelector("td").textContent))""")
        self.assertEqual(moved, [30, 20, 10, 10])
        self.assertGreater(self.pixels("#person-markers .bar"), 1)

    def test_plots_are_saved(self):
        self.open("compare.html")
        name, data = self.browser.saved(lambda: self.click("#distance-plot .save button:first-child"))
        self.assertRegex(name, "Marker_distance_over_time.*csv$")
        rows = [line.split(",") for line in data.decode().splitlines()]
        self.assertEqual(len(rows), 676)
        self.assertEqual(rows[0][0], "time [s]")
        shown = self.run_script("return mmmReport.figures[0].rows[0].distance_mm.mean")
        mean = sum(float(row[1]) for row in rows[1:]) / 675
        self.assertAlmostEqual(mean, shown, delta=0.1 * shown)
        name, data = self.browser.saved(lambda: self.click("#joint-plot .save button:last-child"))
        picture = ElementTree.fromstring(data)
        svg = "{http://www.w3.org/2000/svg}"
        self.assertGreaterEqual(len(picture.findall(f".//{svg}polyline")), 3)
        self.assertGreater(len(picture.findall(f".//{svg}text")), 8)
        name, data = self.browser.saved(lambda: self.click("#heat-save button:first-child"))
        self.assertEqual(len(data.decode().splitlines()), 676)
        name, data = self.browser.saved(lambda: self.click("#heat-save button:last-child"))
        self.assertTrue(data.startswith(b"\x89PNG"))

    def test_scrubbing(self):
        self.open("compare.html")
        scrub = self.find("#scrub")
        ActionChains(self.browser.driver).move_to_element(scrub).click().perform()
        self.assertAlmostEqual(self.frame(), 337, delta=4)  # the slider's middle, to a few pixels
        self.assertIn(f"frame {self.frame()}", scrub.get_attribute("aria-valuetext"))

    def test_figures_equal_the_json(self):
        self.open("compare.html")
        figures = json.loads((self.folder / "compare.json").read_text())
        self.assertEqual(self.run_script("return mmmReport.figures"), [figures])
        compared = 0
        for row in figures["rows"]:
            cells = self.run_script(
                "return Array.from(document.querySelectorAll(`tr[data-contender='${arguments[0]}'] td[data-figure]`),"
                "  (cell) => [cell.dataset.figure, cell.firstChild.textContent])", row["contender"])
            for path, shown in cells:
                value = row
                for key in path.split("."):
                    value = value[key]
                if path in ("limit_share", "within_1_sd", "within_2_sd"):
                    value *= 100  # shown in per cent
                digits = len(shown.partition(".")[2])
                # Half a unit of the last digit, and the rounding of a double.
                self.assertAlmostEqual(float(shown), value, delta=0.5 * 10**-digits + 1e-9, msg=path)
                compared += 1
        self.assertEqual(compared, 2 * 19)

    def test_failure_is_a_row_with_its_reason(self):
        self.open("compare.html")
        failed = [row for row in json.loads((self.folder / "compare.json").read_text())["rows"] if row["failure"]]
        self.assertEqual(len(failed), 1)
        self.assertIn(failed[0]["failure"], self.text("tr.failed"))
        self.assertRegex(self.text(".verdict"), r"s2kf_default \d\d\.\d\d mm.* 1 of 3 failed")
        self.assertIn(failed[0]["failure"], self.text("#notes"))

    def test_plots_are_drawn(self):
        self.open("compare.html")
        for plot in ("#distance-plot", "#joint-plot", "#time-plot"):
            for colour in COLOURS:
                self.assertGreater(self.run_script(COUNT_DRAWN, plot, colour), 30, plot + colour)
        self.assertGreater(self.run_script(COUNT_DRAWN, "#hidden-plot", "--text"), 100)

    def test_a_hidden_converter_is_in_no_plot(self):
        self.open("compare.html")
        self.find(".converter input").click()
        self.browser.settle()
        self.assertEqual(self.run_script(COUNT_DRAWN, "#distance-plot", COLOURS[0]), 0)
        self.assertGreater(self.run_script(COUNT_DRAWN, "#distance-plot", COLOURS[1]), 100)

    def test_all_converters_hidden(self):
        self.open("compare.html")
        for box in self.browser.driver.find_elements(By.CSS_SELECTOR, ".converter input"):
            box.click()
        self.browser.settle()
        self.assertGreater(self.run_script(COUNT_DRAWN, "#distance-plot", "--muted"), 30)  # the optimum
        self.run_script("mmmReport.seek(100)")
        self.assertEqual(self.frame(), 100)

    def test_value_axes_have_a_scale(self):
        for page in ("compare.html", "finished.html"):
            self.open(page)
            counts = self.run_script(
                "return [...document.querySelectorAll('.plot-area')].filter((plot) => plot.offsetHeight > 0)"
                ".map((plot) => [...plot.querySelectorAll('.dygraph-axis-label-y')]"
                ".filter((label) => label.textContent).length)")
            self.assertGreater(len(counts), 2)
            self.assertGreaterEqual(min(counts), 2, page)

    def test_click_in_a_plot_jumps_there(self):
        self.open("compare.html")
        plot = self.find("#distance-plot .plot-area")
        ActionChains(self.browser.driver).move_to_element(plot).click().perform()
        # The middle of the element; the axis takes some of its left side.
        self.assertAlmostEqual(self.frame(), 337, delta=40)

    def test_finished_motions_have_no_times(self):
        self.open("finished.html")
        self.assertTrue(self.find("#distance-plot").is_displayed())
        self.assertFalse(self.find("#time-part").is_displayed())
        self.assertNotIn("Time a frame", self.text("table.figures"))

    def test_reliability_of_the_deviations(self):
        self.open("compare.html")
        curves = self.run_script("return [...document.querySelectorAll('#reliability-plot .curve')]"
                                 ".map((curve) => curve.getAttribute('points').split(' ').length)")
        points = len(json.loads((self.folder / "compare.json").read_text())["rows"][0]["reliability"])
        self.assertEqual(curves, [points + 1] * 2)  # of those that have a result, from the origin
        self.assertIn("in 2 sd, %", self.text("table.figures"))
        self.open("finished.html")
        self.assertFalse(self.find("#reliability-part").is_displayed())

    def test_joint_can_be_chosen(self):
        self.open("compare.html")
        before = self.text("#joint-caption")
        self.run_script("const joint = document.querySelector('#joint'); joint.value = '0';"
                        "joint.dispatchEvent(new Event('change'))")
        self.browser.settle()
        self.assertNotEqual(self.text("#joint-caption"), before)
        self.assertIn("true angle", self.text("#joint-caption"))
        self.assertGreater(self.run_script(COUNT_DRAWN, "#joint-plot", COLOURS[0]), 30)
        # On the body: all angles of a joint, also after another converter is shown.
        self.click("#joint-picker [data-joint=elbow]")
        angles = ["elbow flexion", "elbow pronation"]
        self.assertEqual(self.texts("#joint-plot h3"), angles)
        self.assertEqual(self.run_script("return document.querySelector('#joint').value"), "elbow")
        self.assertEqual(len(self.texts("#joint-picker .chosen")), 2)
        self.click("#converters input")
        self.assertEqual(self.texts("#joint-plot h3"), angles)
        self.assertEqual(len(self.texts("#joint-plot .plot-area")), 2)

    def test_heat_map(self):
        self.open("compare.html")
        self.assertGreater(self.run_script(PIXELS + "return shadesOf(document.querySelector('#heat-map'))"), 100)
        means = [float(text) for text in self.run_script(
            "return Array.from(document.querySelectorAll('#heat-names .mean'), (one) => one.textContent)")]
        self.assertEqual(len(means), 53)
        self.assertEqual(means, sorted(means, reverse=True))
        ActionChains(self.browser.driver).move_to_element(self.find("#heat-map")).click().perform()
        self.assertAlmostEqual(self.frame(), 337, delta=4)
        names = self.run_script(
            "return Array.from(document.querySelectorAll('#heat-names .name'), (one) => one.textContent)")
        self.assertRegex(self.text("#heat-readout"), rf"^{names[26]} · 3\.\d\d s · \d+\.\d mm")

    def test_light_and_dark(self):
        shown = {}
        for scheme in ("light", "dark"):
            self.browser.prefer(scheme)
            self.open("compare.html")
            shown[scheme] = self.run_script("return getComputedStyle(document.body).backgroundColor")
            self.assertGreater(self.run_script(COUNT_DRAWN, "#distance-plot", COLOURS[0]), 100)
        self.assertNotEqual(shown["light"], shown["dark"])
        # The change of a page that is open: plots take the other colours.
        self.browser.prefer("light")
        self.browser.settle()
        self.assertGreater(self.run_script(COUNT_DRAWN, "#distance-plot", COLOURS[0]), 100)

    def test_no_page_scrolls_sideways(self):
        self.check_fits(("compare.html", "convert.html", "finished.html", "hostile.html"))

    def test_hostile_text_stays_text(self):
        self.open("hostile.html")
        self.run_script("mmmReport.seek(20); document.querySelectorAll('details').forEach((one) => one.open = true)")
        ActionChains(self.browser.driver).move_to_element(self.find("#heat-map")).perform()
        ActionChains(self.browser.driver).move_to_element(self.find("#distance-plot .plot-area")).perform()
        self.browser.settle()
        self.check_nothing_was_run()
        for selector in ("h1", "#sections", "tr.failed", "#converters", "#heat-names", "#heat-readout",
                         "#configurations pre", "#notes", "#joint", "#trial", "#distance-plot .readout"):
            self.assertIn("<script>window.hacked=1</script>", self.text(selector), selector)

    def test_parts_of_a_report(self):
        self.open("hostile.html")
        buttons = self.browser.driver.find_elements(By.CSS_SELECTOR, "#sections button")
        self.assertEqual(len(buttons), 2)
        self.assertTrue(self.find("#view").is_displayed())
        buttons[1].click()
        # Nothing can be drawn of a part in which all failed, but its reason.
        self.assertFalse(self.find("#view").is_displayed())
        self.assertIn("no such file", self.text(".summary:not(.other)"))
        buttons[0].click()
        self.assertTrue(self.find("#view").is_displayed())

    def test_long_recording(self):
        self.assertLess((self.folder / "long.html").stat().st_size, 15_000_000)
        self.open("long.html")
        self.assertEqual(self.run_script("return mmmReport.frames"), 6000)
        self.run_script("mmmReport.seek(5999)")
        self.assertGreater(self.run_script(COUNT_DRAWN, "#distance-plot", COLOURS[0]), 30)
        print("[ measured ] ms until the report is ready:",
              self.run_script("return performance.getEntriesByName('ready')[0].startTime"))

    def test_a_page_of_many_frames_says_what_it_draws(self):
        self.open("thinned.html")
        self.assertEqual(self.run_script("return mmmReport.frames"), 4334)
        self.assertIn("Of the 13000 frames one in 3 is drawn", self.text("#thinned"))
        self.assertTrue(self.find("#thinned").is_displayed())
        self.run_script("mmmReport.seek(2167)")
        self.assertIn("65.01 s · frame 6501 of 13000", self.text("#now"))
        # The peak between two drawn frames is in the band and in the figures.
        worst = self.text("td[data-figure='distance_mm.worst_frame']")
        self.assertIn(f"the largest value is {worst} mm", self.text("#distance-peak"))
        self.open("long.html")
        self.assertIn("The optimum is computed for one frame in 3", self.text("#thinned"))
        self.open("convert.html")
        self.assertFalse(self.find("#thinned").is_displayed())

    def test_nothing_is_loaded(self):
        self.open("compare.html")
        self.check_nothing_was_loaded()

    def test_injected_scripts_do_not_run(self):
        self.check_injected_scripts_do_not_run("finished.html")

    def test_what_needs_no_webgl_works_without(self):
        self.open("compare.html")
        self.assertIn("WebGL", self.text("#no-webgl"))
        self.assertTrue(self.find("#no-webgl").is_displayed())
        for plot in ("#distance-plot", "#joint-plot", "#time-plot"):
            self.assertGreater(self.run_script(COUNT_DRAWN, plot, COLOURS[0]), 30, plot)
        self.find("#play").click()
        self.browser.wait("return mmmReport.frame > 5")


if __name__ == "__main__":
    run_tests()
