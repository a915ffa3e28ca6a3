# SPDX-License-Identifier: MIT
"""A report in headless Chromium."""

import os
import pathlib
import shutil
import tempfile

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.ui import WebDriverWait

SECONDS = 60  # until a page that does not come is given up; no bound on speed


class Browser:
    """Opens one report at a time. with Browser() as browser: browser.open("report.html")"""

    def __init__(self, width=1200, height=900, webgl=True):
        self.size = (width, height)
        self.folder = tempfile.TemporaryDirectory(prefix="mmm_converter_test_")  # all that a browser leaves
        options = webdriver.ChromeOptions()
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        # Containers have neither a sandbox nor much shared memory; pictures are drawn in software.
        arguments = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars",
                     "--force-device-scale-factor=1", f"--user-data-dir={self.folder.name}/profile"]
        if webgl:
            arguments += ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
        else:
            arguments += ["--disable-3d-apis"]
        for argument in arguments:
            options.add_argument(argument)
        service = Service(shutil.which("chromedriver"), env={**os.environ, "TMPDIR": self.folder.name})
        self.driver = webdriver.Chrome(options=options, service=service)
        self.driver.set_page_load_timeout(SECONDS)
        self.driver.set_script_timeout(SECONDS)
        self.resize(*self.size)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.driver.quit()
        self.folder.cleanup()

    def start_anew(self):
        """A tab of its own, with nothing of what the last one was told: size, colours, focus, messages."""
        last = self.driver.current_window_handle
        self.driver.switch_to.new_window("tab")
        tab = self.driver.current_window_handle
        self.driver.switch_to.window(last)
        self.driver.close()
        self.driver.switch_to.window(tab)
        self.errors()
        self.resize(*self.size)

    def resize(self, width, height):
        """The page's own width and height, also below the least width of a window."""
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def prefer(self, scheme):
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def open(self, file):
        self.driver.get(pathlib.Path(file).resolve().as_uri())
        self.wait("return Boolean(window.mmmReport)")
        self.settle()

    def saved(self, click):
        """The file that a click saves: its name and its bytes."""
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.folder.name))
        self.driver.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(folder)})
        click()
        def whole(_):
            files = [file for file in folder.iterdir() if file.suffix != ".crdownload"]
            return files[0] if files and files[0].stat().st_size > 0 else None
        file = WebDriverWait(self.driver, SECONDS, 0.05).until(whole)
        return file.name, file.read_bytes()

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def wait(self, script, *arguments):
        return WebDriverWait(self.driver, SECONDS, 0.05).until(lambda _: self.run(script, *arguments))

    def settle(self):
        """Until what was asked for is drawn: two pictures later."""
        self.driver.execute_async_script(
            "const done = arguments[0];"
            "requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done)));")

    def errors(self):
        """What the console says, other than information."""
        return [entry["message"] for entry in self.driver.get_log("browser")
                if entry["level"] in ("SEVERE", "WARNING")]
