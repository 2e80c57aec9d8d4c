"""A report in headless Chromium, without a network: what it asks for and what goes wrong."""

import os
import tempfile
from contextlib import contextmanager

from playwright.sync_api import sync_playwright

CHROMIUM = os.environ.get("CHROMIUM", "/usr/bin/chromium")
ARGUMENTS = [
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
]  # fmt: skip
PATIENCE = 300_000  # ms, of a machine that has other things to do
WINDOW = {"width": 1500, "height": 950}
# of the libraries in Snakemake's wheel, about themselves: nothing here can be done about them
KNOWN = ("cdn.tailwindcss.com should not be used", "input spec uses Vega-Lite v3")


class Report:
    """An open report.

    Attributes:
        page: Playwright's.
        outside: addresses that were asked for and are neither files nor data.
        wrong: script errors, and what was printed as an error or a warning.
    """

    def __init__(self, page):
        self.page, self.outside, self.wrong = page, [], []
        page.on("request", self._asked)
        page.on("pageerror", lambda error: self.wrong.append(str(error)))
        page.on("console", self._printed)

    def results(self):
        """What Snakemake says of each result, by path."""
        return self.page.evaluate("results")

    def menu(self, name):
        """Press an entry of the menu."""
        home = self.page.locator("nav ol a")
        if home.count():
            home.first.click()
        self.page.locator("nav").get_by_text(name, exact=True).click()

    def rows(self):
        """The results that the menu lists, each with an eye and an i to press."""
        return self.page.locator("nav tbody tr")

    def press(self, row, button):
        """Press the eye (0) or the i (1) of a row."""
        row.locator("a[type=button]").nth(button).click()

    def content(self):
        """What is beside the menu."""
        return self.page.locator("div.h-screen.overflow-auto")

    def _asked(self, request):
        if not request.url.startswith(("file:", "data:", "blob:", "about:")):
            self.outside.append(request.url)

    def _printed(self, message):
        text = message.text
        if message.type in ("error", "warning") and not any(known in text for known in KNOWN):
            self.wrong.append(text)


@contextmanager
def opened(path):
    """The report in a file, as `Report`."""
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as profile:
        context = playwright.chromium.launch_persistent_context(
            profile, executable_path=CHROMIUM, args=ARGUMENTS, viewport=WINDOW, offline=True
        )
        context.set_default_timeout(PATIENCE)
        try:
            report = Report(context.new_page())
            report.page.goto(path.resolve().as_uri())
            report.page.locator("#loading-screen").wait_for(state="hidden")
            yield report
        finally:
            context.close()
