"""A headless Chromium that draws in software, driven through chromedriver."""

from __future__ import annotations

import io
import json
import pathlib
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager

from PIL import Image
from processes import PATIENCE

PROGRAMS = ("chromium", "chromedriver")
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--force-device-scale-factor=1",
)
DRAWN = "return performance.getEntriesByName('drawn')[0]?.startTime ?? null"


def missing() -> str:
    """What is not installed here, empty if nothing."""
    absent = [name for name in PROGRAMS if shutil.which(name) is None]
    try:
        import selenium  # noqa: F401
    except ImportError:
        absent.append("selenium")
    return ", ".join(absent)


class Browser:
    """A window on one page at a time."""

    def __init__(self, driver) -> None:
        self.driver = driver

    def size(self, width: int, height: int, dark: bool = False) -> None:
        """Make the page this large, in pixels, and light or dark."""
        self.driver.execute_cdp_cmd(
            "Emulation.setDeviceMetricsOverride",
            {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False},
        )
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme]})

    def open(self, file: pathlib.Path) -> float:
        """Go to a page; milliseconds from navigation until it was completely drawn for the first time."""
        self.driver.get(file.absolute().as_uri())
        return self.until(DRAWN)

    def until(self, script: str):
        """What a script returns, once it is something."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            result = self.driver.execute_script(script)
            if result is not None and result is not False:
                return result
            time.sleep(0.02)
        raise TimeoutError(f"not within {PATIENCE:g} s: {script}; console: {self.console()}")

    def do(self, script: str, *arguments):
        """Run a script that may wait; what it returns."""
        body = "const done = arguments[arguments.length - 1]; const given = arguments;"
        return self.driver.execute_async_script(f"{body} (async () => {{ {script} }})().then(done)", *arguments)

    def picture(self) -> Image.Image:
        """What is seen."""
        return Image.open(io.BytesIO(self.driver.get_screenshot_as_png())).convert("RGB")

    def console(self) -> list[str]:
        """What the page complained of since the last call, without the remarks of the software graphics driver."""
        messages = [entry["message"] for entry in self.driver.get_log("browser")]
        return [message for message in messages if "GL Driver Message" not in message]

    def requests(self) -> list[str]:
        """Addresses that were asked for since the last call."""
        events = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        return [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]


@contextmanager
def browser(width: int = 1400, height: int = 900) -> Iterator[Browser]:
    """A browser of its own, with an empty profile, for the length of the block."""
    from selenium import webdriver

    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        for flag in (*FLAGS, f"--user-data-dir={profile}", f"--window-size={width},{height}"):
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))
        try:
            driver.set_script_timeout(PATIENCE)
            driver.set_page_load_timeout(PATIENCE)
            window = Browser(driver)
            window.size(width, height)
            window.requests()
            yield window
        finally:
            driver.quit()
