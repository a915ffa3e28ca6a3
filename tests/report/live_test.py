# SPDX-License-Identifier: MIT
"""live_test.py PROGRAM RECORDING [unittest arguments]: the page that `live --view` serves, in a real browser."""

import re
import subprocess
import sys
import unittest
import urllib.error
import urllib.request

from browser import Browser
from page_case import PIXELS

PROGRAM, RECORDING = sys.argv[1:3]


class LivePage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.live = subprocess.Popen(
            [PROGRAM, "live", f"replay:{RECORDING}", "--loop", "--height", "1.8", "--view"],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        for line in cls.live.stderr:
            found = re.search(r"http://\S+", line)
            if found:
                cls.address = found.group()
                break
        cls.browser = Browser()
        cls.browser.driver.get(cls.address)

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.live.terminate()
        cls.live.communicate()

    def test_1_the_body_moves(self):
        browser = self.browser
        browser.wait("return mmmLive.posture && mmmLive.posture.tracking && mmmLive.drawn > 0")
        first = browser.run("return mmmLive.posture.frame")
        browser.wait(f"return mmmLive.posture.frame > {first} + 20")
        self.assertEqual(len(browser.run("return mmmLive.body.labels")), 53)
        self.assertEqual(len(browser.run("return mmmLive.posture.angles")), 44)
        browser.wait("return document.getElementById('stage-text').textContent === 'tracking'")
        self.assertIn("handstand", browser.run("return document.getElementById('figures').textContent"))
        self.assertEqual(browser.run("return document.querySelectorAll('#marker-bars > div').length"), 53)
        self.assertGreater(browser.run(PIXELS + "mmmLive.drawNow(); return shadesOf(document.getElementById('scene'))"), 20)
        browser.wait("return document.querySelectorAll('#angle-charts canvas').length > 0")
        self.assertRegex(browser.run("return document.querySelector('#angle-charts h3').textContent"),
                         r"^knee flexion left -?\d+° · right -?\d+°$")
        browser.run("document.querySelector('#joint-picker [data-joint=elbow]').dispatchEvent(new Event('click'))")
        self.assertIn("elbow flexion", browser.run("return document.getElementById('angle-charts').textContent"))
        self.assertNotRegex(browser.run("return document.getElementById('wrong').textContent"), "marker|nobody")
        self.assertEqual(browser.errors(), [])

    def test_2_nothing_else_is_served(self):
        for path in ("../", "x", "../../../../etc/passwd", "?a"):
            with self.assertRaises(urllib.error.HTTPError) as refused:
                urllib.request.urlopen(self.address + path)
            self.assertEqual(refused.exception.code, 404)
        self.assertTrue(self.address.startswith("http://127.0.0.1:"))

    def test_3_injected_scripts_do_not_run(self):
        self.browser.run("const s = document.createElement('script'); s.textContent = 'window.hacked = 1';"
                         "document.body.append(s);")
        self.assertIsNone(self.browser.run("return window.hacked || null"))
        self.browser.errors()

    def test_4_the_end_of_the_program_is_shown(self):
        self.live.terminate()
        self.browser.wait("return document.getElementById('stage-text').classList.contains('lost')")
        self.browser.errors()


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]] + sys.argv[3:])
