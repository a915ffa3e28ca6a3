# SPDX-License-Identifier: MIT
"""index_test.py FOLDER [unittest arguments]: the indices of make_index_cases in a real browser."""

import json

from selenium.webdriver.common.keys import Keys

from page_case import PageCase, run_tests

ROWS_AT_ONCE = 200
DIGITS = {"distance_mm.mean": 2, "distance_mm.p95": 1, "frames": 0, "ms_per_frame.median": 3}


def member(result, path):
    for key in path.split("."):
        result = None if result is None else result.get(key)
    return result


class ReportPage(PageCase):
    def chosen(self):
        return self.run_script("return mmmReport.chosen")

    def search(self, text):
        box = self.find("#search")
        box.clear()
        box.send_keys(text)
        self.browser.settle()

    def results(self):
        return [json.loads(line) for line in (self.folder / "results.jsonl").read_text().splitlines()]

    def check_totals(self, results):
        totals = dict(zip(self.texts("#totals dt"), self.texts("#totals dd")))
        converted = [result for result in results if result["state"] == "converted"]
        for state in ("converted", "failed", "missing"):
            self.assertEqual(int(totals[state]), sum(result["state"] == state for result in results))
        self.assertEqual(int(totals["frames"].replace(",", "")), sum(result["frames"] for result in converted))
        recorded = sum(result["frames"] / result["rate_hz"] for result in converted)
        minutes = int(recorded / 60 + 0.5 / 60)
        self.assertEqual(totals["recorded"], f"{minutes // 60} h {minutes % 60:02} min")
        seconds = sum(result["seconds"] for result in results)
        # Half a unit of the last digit, and the rounding of a sum of doubles.
        self.assertAlmostEqual(float(totals["real-time factor"].split()[0]), recorded / seconds, delta=0.05 + 1e-9)

    def check_rows(self, results):
        rows = self.run_script("""
            return Array.from(document.querySelectorAll("tbody tr:not(.failed)"), (row) =>
              [Number(row.dataset.entry), Object.fromEntries(Array.from(row.querySelectorAll("td[data-key]"),
                (cell) => [cell.dataset.key, cell.textContent]))])""")
        self.assertEqual(len(rows), ROWS_AT_ONCE - 18)  # of 600 entries 18 are not converted
        for entry, cells in rows:
            for path, digits in DIGITS.items():
                # Half a unit of the last digit, and the rounding of a double.
                self.assertAlmostEqual(float(cells[path]), member(results[entry], path),
                                       delta=0.5 * 10**-digits + 1e-9, msg=path)

    def expected_order(self, results, path, descending):
        """Those that are not converted first; then by value, none last; else as in the manifest."""
        def key(entry):
            value = member(results[entry], path)
            is_converted = results[entry]["state"] == "converted"
            return is_converted, value is None, 0 if value is None else (-value if descending else value), entry
        return sorted(range(len(results)), key=key)

    def test_index_shows_what_it_was_given(self):
        results = self.results()
        self.open("index.html")
        self.check_totals(results)
        self.assertEqual(self.chosen(), self.expected_order(results, "distance_mm.mean", True))
        self.check_rows(results)
        # Failures by reason, the most frequent first: 12 of each of 100 entries' 2, 6 of their 1.
        reasons = self.texts("#failures li")
        self.assertEqual(len(reasons), 2)
        self.assertRegex(reasons[0], "failed: no marker of the recording.*12 entries: files_motions_1000/")
        self.assertRegex(reasons[1], "missing: no shard has converted it6 entries: .* and 1 more")
        self.assertIn(results[13]["reason"], self.text("tr.failed"))
        # All about an entry: every member, warnings and links.
        self.search("Recording_000100")
        self.assertEqual(self.chosen(), [100])
        self.click("tr[data-entry='100'] .disclose")
        self.assertEqual(self.find(".disclose").get_attribute("aria-expanded"), "true")
        self.assertEqual(self.texts("tr.details li"), results[100]["warnings"])
        told = dict(zip(self.texts("tr.details dt"), self.texts("tr.details dd")))
        self.assertEqual(told["recording"], results[100]["recording"])
        self.assertEqual(told["metadata session"], "2")
        self.assertEqual(float(told["ms_per_frame.p99"]), results[100]["ms_per_frame"]["p99"])
        links = self.run_script("return Array.from(document.querySelectorAll('tr .links a'), (a) => a.getAttribute('href'))")
        self.assertEqual(links, [results[100]["report"], results[100]["motion"]])
        self.click(".disclose")
        self.assertEqual(self.texts("tr.details"), [])
        self.check_nothing_was_loaded()

    def test_index_sorts_and_filters(self):
        results = self.results()
        self.open("index.html")
        # Headings by mouse and keyboard.
        self.click("th[data-key='distance_mm.mean'] button")
        self.assertEqual(self.chosen(), self.expected_order(results, "distance_mm.mean", False))
        self.find("th[data-key='frames'] button").send_keys(Keys.ENTER)
        self.assertEqual(self.chosen(), self.expected_order(results, "frames", True))
        sorted_by = self.run_script(
            "return Array.from(document.querySelectorAll('[aria-sort]'), (head) => [head.dataset.key, head.ariaSort])")
        self.assertEqual(sorted_by, [["frames", "descending"]])
        self.find("th[data-key='id'] button").send_keys(" ")
        self.assertEqual([i for i in self.chosen() if results[i]["state"] == "converted"],
                         [i for i, result in enumerate(results) if result["state"] == "converted"])
        # Rows come in parts.
        self.assertEqual(len(self.texts("tbody tr")), ROWS_AT_ONCE)
        self.click("#more")
        self.click("#more")
        self.assertEqual(len(self.texts("tbody tr")), 600)
        self.assertFalse(self.find("#more").is_displayed())
        # A bar by keyboard: as many entries as it says, all within its edges; cleared again.
        bars = "figure[data-key='mean'] .bar"
        self.find(f"{bars}[tabindex='0']").send_keys(Keys.ARROW_RIGHT)
        self.browser.driver.switch_to.active_element.send_keys(Keys.ENTER)
        pressed = self.find(f"{bars}[aria-pressed='true']").get_attribute("aria-label")
        low, high, count = (float(pressed.split()[i]) for i in (0, 2, 4))
        within = {i for i, result in enumerate(results) if result["state"] == "converted"
                  and low <= result["distance_mm"]["mean"] < high}
        self.assertEqual(len(within), count)
        self.assertEqual(set(self.chosen()), within)
        self.assertIn(f"mean marker distance {low:.0f} to {high:.0f} mm", self.text("#chips"))
        # With words: each must occur.
        self.search("1002 recording")
        self.assertEqual(set(self.chosen()), {i for i in within if results[i]["group"] == "1002"})
        self.click("#chips button")
        self.assertEqual(len(self.chosen()), 40)
        self.assertEqual(self.texts(f"{bars}[aria-pressed='true']"), [])
        self.search("session=3")
        self.assertEqual(self.chosen(), [])
        self.search("")
        for choice, keep in (("warnings", lambda result: result["warnings"]),
                             ("not-converted", lambda result: result["state"] != "converted")):
            self.click(f"#show option[value='{choice}']")
            self.assertEqual(set(self.chosen()), {i for i, result in enumerate(results) if keep(result)})
        # The entries of a failure.
        self.click("#failures li:last-child button")
        self.assertEqual({results[i]["state"] for i in self.chosen()}, {"missing"})

    def test_the_worst_of_each_level_are_first(self):
        self.open("levels.html")
        told = self.run_script("""
            return mmmReport.chosen.map((entry) => ["state", "verdict.level", "distance_mm.mean"].map(
              (name) => mmmReport.entries.value(name, entry)))""")
        worst = ["failed", "check", "good"]
        ranks = [(worst.index(level), -mean) for state, level, mean in told if state == "converted"]
        self.assertEqual(ranks, sorted(ranks))
        self.assertEqual({rank for rank, _ in ranks}, {0, 1, 2})
        self.assertNotEqual(told[0][0], "converted")

    def test_index_of_odd_batches(self):
        self.check_fits(("hostile.html", "empty.html", "failed.html", "one.html"))
        self.assertEqual(self.texts("#totals dd")[:3], ["1", "0", "0"])
        self.assertEqual(len(self.texts(".distribution")), 4)
        self.open("empty.html")
        self.assertEqual(self.text("#shown"), "0 entries.")
        self.assertFalse(self.find("#distributions-part").is_displayed())
        self.assertFalse(self.find("#failures-part").is_displayed())
        self.open("failed.html")
        self.assertEqual(len(self.texts("#failures li")), 20)
        self.click("#more-failures")
        self.assertEqual(len(self.texts("#failures li")), 30)
        self.assertIn("broken/7.c3d: no such file", self.text("#failures"))
        self.assertEqual(len(self.texts("tr.failed")), 30)
        self.check_hostile_text()

    def check_hostile_text(self):
        self.open("hostile.html")
        for i in range(len(self.texts("tbody tr"))):
            self.run_script("document.querySelectorAll('.disclose')[arguments[0]].click()", i)
        self.search("script")
        self.browser.settle()
        self.check_nothing_was_run()
        for selector in ("h1", "#failures", "tr[data-entry] th", "tr.failed .reason", "tr.details li", "tr.details dl"):
            self.assertIn("<script>window.hacked=1</script>", self.text(selector), selector)
        self.assertIn("metadata __proto__", self.texts("tr.details dt"))
        # Only relative paths become links, each of their segments escaped.
        links = self.run_script("return Array.from(document.links, (link) => link.getAttribute('href'))")
        self.assertEqual(links, ["reports/a%20b/50%25%231%3Fx%3D%5C'%22%3C.html", "motions/a%20b/50%25%231%3Fx%3D%5C'%22%3C.xml"])

    def test_index_of_many_entries(self):
        self.open("large.html")
        self.assertEqual(self.run_script("return mmmReport.chosen.length"), 100_000)
        self.assertEqual(len(self.texts("tbody tr")), ROWS_AT_ONCE)
        self.assertEqual(self.texts("#totals dd")[:3], ["97,000", "2,000", "1,000"])
        self.search("recording_012345")
        self.assertEqual(self.chosen(), [12345])
        print("[ measured ] ms until an index of 100,000 entries is ready:",
              self.run_script("return performance.getEntriesByName('ready')[0].startTime"),
              "bytes an entry:", (self.folder / "large.html").stat().st_size / 100_000)

    def test_injected_scripts_do_not_run(self):
        self.check_injected_scripts_do_not_run("one.html")


if __name__ == "__main__":
    run_tests()
