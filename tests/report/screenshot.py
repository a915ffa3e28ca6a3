#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""screenshot.py PAGE.html OUT.png WIDTH [options]: a picture of a report or of a batch's index."""

import argparse
import base64
import pathlib

from browser import Browser


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("report")
    parser.add_argument("picture")
    parser.add_argument("width", type=int)
    parser.add_argument("--height", type=int, help="cut off below; default: the whole page")
    parser.add_argument("--from", dest="start", default="html", help="CSS selector of what is uppermost")
    parser.add_argument("--scheme", choices=["light", "dark"], default="light")
    parser.add_argument("--section", type=int)
    parser.add_argument("--time", type=float, help="share of the motion, 0 to 1")
    parser.add_argument("--script", help="JavaScript to run first")
    options = parser.parse_args()

    with Browser(options.width, 900) as browser:
        browser.prefer(options.scheme)
        browser.open(options.report)
        if options.section is not None:
            browser.run("mmmReport.showSection(arguments[0])", options.section)
        if options.time is not None:
            browser.run("mmmReport.seek(arguments[0] * (mmmReport.frames - 1))", options.time)
        if options.script:
            browser.run(options.script)
        top = browser.run("return document.querySelector(arguments[0]).getBoundingClientRect().top + scrollY",
                          options.start)
        whole = browser.run("return document.documentElement.scrollHeight")
        height = min(options.height or whole, whole - top)
        browser.settle()
        picture = browser.driver.execute_cdp_cmd("Page.captureScreenshot", {
            "captureBeyondViewport": True,
            "clip": {"x": 0, "y": top, "width": options.width, "height": height, "scale": 1}})
        pathlib.Path(options.picture).write_bytes(base64.b64decode(picture["data"]))
        for error in browser.errors():
            print(error)


if __name__ == "__main__":
    main()
