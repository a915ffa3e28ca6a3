# SPDX-License-Identifier: MIT
"""print_test.py FOLDER [unittest arguments]: reports on paper, as Chromium writes them as PDF."""

import base64
import pathlib
import re
import shutil
import subprocess

from page_case import PageCase, run_tests

PAPERS = {"A4": (8.27, 11.69), "Letter": (8.5, 11)}  # [inches]
LEFT, RIGHT = "#c8553d", "#2a7f9e"
CHARTS = ["hip internal rotation", "knee flexion", "foot progression", "vertical force", "elbow flexion"]  # of ground.html


def run_tool(*words):
    return subprocess.run(words, check=True, capture_output=True).stdout


def texts_of(pdf):
    """The text of each page."""
    return run_tool("pdftotext", "-layout", str(pdf), "-").decode().split("\f")[:-1]


def count_curves(pdf, colour):
    """Paths of several points in a colour that is not transparent, on all pages; dashed lines are areas by then."""
    wanted = [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    count = 0
    for page in range(1, len(texts_of(pdf)) + 1):
        svg = run_tool("pdftocairo", "-svg", "-f", str(page), "-l", str(page), str(pdf), "-").decode()
        for style, path in re.findall(r'<path style="([^"]*)" d="([^"]*)"', svg):
            ink = re.search(r"(?:stroke|fill):rgb\(([\d.]+)%,([\d.]+)%,([\d.]+)%\);(?:stroke|fill)-opacity:(?:1|0\.[4-9])", style)
            if ink and len(re.findall("[LC]", path)) > 10 and all(
                    abs(float(one) / 100 - value) < 0.01 for one, value in zip(ink.groups(), wanted)):
                count += 1
    return count


class Printed(PageCase):

    def printed(self, name, paper):
        """By the browser that shows the page."""
        self.open(name)
        width, height = PAPERS[paper]
        data = self.browser.driver.execute_cdp_cmd("Page.printToPDF", {"paperWidth": width, "paperHeight": height})["data"]
        pdf = pathlib.Path(self.browser.folder.name) / "page.pdf"
        pdf.write_bytes(base64.b64decode(data))
        return pdf

    def test_the_command_prints_curves_of_both_sides(self):
        pdf = pathlib.Path(self.browser.folder.name) / "command.pdf"
        run_tool(shutil.which("chromium"), "--headless", "--no-sandbox", f"--user-data-dir={self.browser.folder.name}/print",
                 f"--print-to-pdf={pdf}", (self.folder / "ground.html").resolve().as_uri())
        for colour in (LEFT, RIGHT):
            # Of each chart the mean; of those of angles two single strides besides.
            self.assertGreaterEqual(count_curves(pdf, colour), len(CHARTS) + 2 * (len(CHARTS) - 1), colour)

    def test_only_the_annex_speaks_of_tracking(self):
        for paper in PAPERS:
            pages = texts_of(self.printed("ground.html", paper))
            annex = next(i for i, page in enumerate(pages) if "Technical annex" in page)
            self.assertGreater(annex, 0)
            for words in ("jitter", "Time per frame", "Marker distance"):
                self.assertNotIn(words, "".join(pages[:annex]), paper)
                self.assertIn(words, "".join(pages[annex:]), paper)

    def test_each_page_says_whose_it_is_and_which(self):
        for paper in PAPERS:
            pages = texts_of(self.printed("ground.html", paper))
            for i, page in enumerate(pages):
                self.assertRegex(page, rf"\b{i + 1} ?/ ?{len(pages)}\b")
                self.assertIn("</script><script>window.hacked=1", page.replace(" ", ""), paper)
        self.assertIn("1.72 ± 0.02 m (given)", pages[0])
        self.assertIn("2010-03-04", pages[0])
        self.assertIn("Step length", pages[0])
        self.check_nothing_was_run()

    def test_no_control_is_printed(self):
        text = "".join(texts_of(self.printed("ground.html", "A4")))
        for words in ("CSV", "SVG", "½×", "Single strides", "Save picture", "Click", "Trunk, neck and arms"):
            self.assertNotIn(words, text)

    def test_comparisons_have_their_curves_too(self):
        pdf = self.printed("compare.html", "A4")
        for colour in ("#0072b2", "#d1570a"):
            self.assertGreaterEqual(count_curves(pdf, colour), 3, colour)  # distance, a joint, times

    def test_paper_is_light(self):
        self.browser.prefer("dark")
        pdf = self.printed("compare.html", "A4")
        self.assertGreaterEqual(count_curves(pdf, "#0072b2"), 3)
        self.assertEqual(count_curves(pdf, "#4fa9e6"), 0)


if __name__ == "__main__":
    run_tests()
