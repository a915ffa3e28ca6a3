# SPDX-License-Identifier: MIT
"""What the tests of all pages share: a browser, a tab for each test, and an empty console at its end."""

import pathlib
import sys
import unittest

from selenium.webdriver.common.by import By

from browser import Browser

# Pixels of a picture or canvas, read from a copy, as reading slows a canvas down.
PIXELS = """
function pixelsOf(picture) {
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [picture.width, picture.height];
  const pen = copy.getContext("2d", {willReadFrequently: true});
  pen.drawImage(picture, 0, 0);
  return pen.getImageData(0, 0, copy.width, copy.height).data;
}
function shadesOf(picture) {
  return new Set(new Uint32Array(pixelsOf(picture).buffer)).size;
}
// Opaque pixels of a colour of the style sheet.
function countColour(pictures, name, tolerance) {
  const hex = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const rgb = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
  let count = 0;
  for (const picture of pictures) {
    const data = pixelsOf(picture);
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] > 200 && rgb.every((value, j) => Math.abs(data[i + j] - value) <= tolerance)) ++count;
    }
  }
  return count;
}
"""

# Numbers of pixels of a colour in the canvases of an element.
COUNT_DRAWN = PIXELS + """
return countColour(document.querySelectorAll(arguments[0] + " canvas"), arguments[1], 8);
"""


class PageCase(unittest.TestCase):
    """Each test opens pages of `folder` in a tab of its own; all of a class share a browser."""

    folder = pathlib.Path()
    webgl = False

    @classmethod
    def setUpClass(cls):
        cls.browser = cls.enterClassContext(Browser(webgl=cls.webgl))

    def setUp(self):
        self.browser.start_anew()

    def tearDown(self):
        self.assertEqual(self.browser.errors(), [])

    def open(self, name):
        self.browser.open(self.folder / name)

    def run_script(self, script, *arguments):
        return self.browser.run(script, *arguments)

    def find(self, selector):
        return self.browser.driver.find_element(By.CSS_SELECTOR, selector)

    def click(self, selector):
        self.run_script("document.querySelector(arguments[0]).scrollIntoView({block: 'center'})", selector)
        self.find(selector).click()
        self.browser.settle()

    def text(self, selector):
        return self.run_script("return document.querySelector(arguments[0]).textContent", selector)

    def texts(self, selector):
        return self.run_script(
            "return Array.from(document.querySelectorAll(arguments[0]), (one) => one.textContent)", selector)

    def check_nothing_was_run(self):
        """That text of kHostileText stayed text."""
        self.assertIsNone(self.run_script("return window.hacked === undefined ? null : window.hacked"))
        self.assertEqual(self.run_script("return document.images.length"), 0)

    def check_injected_scripts_do_not_run(self, name):
        """A page into which somebody wrote scripts: it works, and they are blocked."""
        text = (self.folder / name).read_text()
        self.assertEqual(text.count("<header"), 1)
        injected = ("<script>window.hacked = 1</script><script src='data:text/javascript,window.hacked=2'></script>"
                    "<img id='injected' src='data:,' onerror='window.hacked = 3' onclick='window.hacked = 4'><header")
        page = pathlib.Path(self.browser.folder.name) / "injected.html"
        page.write_text(text.replace("<header", injected))
        self.browser.open(page)
        self.run_script("""
            document.querySelector("#injected").click();
            const script = document.createElement("script");
            script.textContent = "window.hacked = 5";
            document.body.append(script);""")
        self.browser.settle()
        self.assertIsNone(self.run_script("return window.hacked === undefined ? null : window.hacked"))
        blocked = self.browser.errors()
        self.assertGreaterEqual(len(blocked), 5)
        for message in blocked:
            self.assertIn("Content Security Policy", message)

    def check_nothing_was_loaded(self):
        self.assertEqual(self.run_script("return performance.getEntriesByType('resource').length"), 0)

    def check_fits(self, names):
        """Pages that do not scroll sideways, on a desk and on a phone, light and dark."""
        shown = {}
        for width, scheme in ((1200, "light"), (400, "dark")):
            self.browser.resize(width, 800)
            self.browser.prefer(scheme)
            for name in names:
                self.open(name)
                self.assertEqual(self.run_script("return document.documentElement.scrollWidth"), width, name)
            shown[scheme] = self.run_script("return getComputedStyle(document.body).backgroundColor")
        self.assertNotEqual(shown["light"], shown["dark"])


def run_tests():
    """SCRIPT FOLDER [unittest arguments]"""
    PageCase.folder = pathlib.Path(sys.argv.pop(1))
    unittest.main()
