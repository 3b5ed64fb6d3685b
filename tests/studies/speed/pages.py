"""Pages of results in headless Chromium: what is loaded, what does not fit, how they look.

    python -m tests.studies.speed.pages PAGE.html ... [--out FOLDER]

For each page: messages of the console, requests beyond the file itself, what is wider than a
screen of 400 px or than A4 paper, figures whose letters are lower than 8 px there, and text whose
contrast is below 4.5 in the light or the dark scheme. With --out the pages as they look: screen,
small screen, dark scheme (PNG) and A4 (PDF, and PNG where pdftoppm is installed). Exit code 1
where a page fails, 2 where no Chromium is installed (Debian: `apt-get install chromium`).
"""

import argparse
import base64
import shutil
import subprocess
import sys
from pathlib import Path

from tests.studies.speed.browser import Browser, installed

SCREEN_PX, SMALL_PX, A4_PX = 1200, 400, 718  # A4 less margins of 1 cm, at 96 px per inch
A4_IN, MARGIN_IN = (8.27, 11.69), 0.394
LEAST_LETTER_PX = 8.0
CONTRAST = 4.5  # WCAG 2.1, 1.4.3

# What sticks out of the page, and out of a box that does not scroll (paper does not).
WIDE = """
(() => {
  const width = document.documentElement.clientWidth, paper = %s, found = [];
  for (const element of document.querySelectorAll('body *')) {
    const right = element.getBoundingClientRect().right;
    const scrolls = !paper && element.closest('.scroll');
    if (right > width + 1 && !scrolls) found.push(`${element.tagName} ${Math.round(right)} px`);
  }
  return found;
})()
"""

# Figures whose smallest letters, of 8.5 pt at 150 dots per inch, are too small.
TINY = """
[...document.images].map(i => 8.5 / 72 * 150 * i.width / i.naturalWidth)
  .filter(px => px < %s).map(px => `${px.toFixed(1)} px`)
"""

# Contrast of every text with the background behind it (WCAG 2.1), opacity included.
PALE = """
(() => {
  const numbers = text => text.match(/[\\d.]+/g).map(Number);
  const over = (top, below) => below.map((c, i) => c + (top[i] - c) * (top[3] ?? 1));
  const light = rgb => rgb.slice(0, 3).map(c => c / 255)
    .map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const dark = matchMedia('(prefers-color-scheme: dark)').matches;
  const canvas = dark ? [18, 18, 18] : [255, 255, 255];
  const found = new Set();
  for (const element of document.querySelectorAll('body *')) {
    if (![...element.childNodes].some(n => n.nodeType === 3 && n.data.trim())) continue;
    let behind = canvas, seen = 1, chain = [];
    for (let e = element; e; e = e.parentElement) chain.unshift(e);
    for (const e of chain) {
      const style = getComputedStyle(e), colour = numbers(style.backgroundColor);
      behind = over(colour.length === 4 ? colour : [...colour, 1], behind);
      seen *= Number(style.opacity);
    }
    const colour = numbers(getComputedStyle(element).color);
    const ink = over([...colour.slice(0, 3), (colour[3] ?? 1) * seen], behind);
    const [high, low] = [light(ink), light(behind)].sort((a, b) => b - a);
    const ratio = (high + 0.05) / (low + 0.05);
    if (ratio < %s) found.add(`${element.tagName} ${ratio.toFixed(1)}`);
  }
  return [...found];
})()
"""


def faults(browser: Browser, page: Path, out: Path | None) -> list[str]:
    """What is wrong with a page, in words."""
    found = []
    shapes = {"screen": SCREEN_PX, "small": SMALL_PX, "dark": SCREEN_PX, "paper": A4_PX}
    for shape, width_px in shapes.items():
        _show(browser, shape, width_px)
        browser.open(page)
        found += [f"{shape}: {fault}" for fault in _messages(browser, page)]
        wide = browser.value(WIDE % str(shape == "paper").lower())
        found += [f"{shape}: sticks out of {width_px} px: {element}" for element in wide[:5]]
        tiny = browser.value(TINY % LEAST_LETTER_PX)
        found += [f"{shape}: letters of a figure: {height}" for height in tiny[:5]]
        pale = browser.value(PALE % CONTRAST)
        found += [f"{shape}: contrast: {element}" for element in pale[:5]]
        if out is not None:
            _take(browser, out / f"{page.parent.name}_{shape}")
    return found


def _show(browser: Browser, shape: str, width_px: int) -> None:
    """Set width, colour scheme and medium."""
    scheme = {"name": "prefers-color-scheme", "value": "dark" if shape == "dark" else "light"}
    browser("Emulation.setEmulatedMedia", media="print" if shape == "paper" else "screen",
            features=[scheme])  # fmt: skip
    browser("Emulation.setDeviceMetricsOverride", width=width_px, height=900,
            deviceScaleFactor=1, mobile=shape in {"small", "paper"})  # fmt: skip


def _messages(browser: Browser, page: Path) -> list[str]:
    """What the console says, and what is asked for beyond the page itself."""
    found = []
    for event in browser.events:
        about = event.get("params", {})
        if event.get("method") == "Log.entryAdded":
            found.append(f"console: {about['entry']['text']}")
        elif event.get("method") in {"Runtime.consoleAPICalled", "Runtime.exceptionThrown"}:
            found.append(f"console: {str(about)[:200]}")
        elif event.get("method") == "Network.requestWillBeSent":
            url = about["request"]["url"]
            if not url.startswith("data:") and url != page.resolve().as_uri():
                found.append(f"request: {url}")
    return found


def _take(browser: Browser, stem: Path) -> None:
    """Write how the page looks."""
    stem.parent.mkdir(parents=True, exist_ok=True)
    if not stem.name.endswith("paper"):
        picture = browser("Page.captureScreenshot", captureBeyondViewport=True)
        stem.with_suffix(".png").write_bytes(base64.b64decode(picture["data"]))
        return
    margins = dict.fromkeys(("marginTop", "marginBottom", "marginLeft", "marginRight"), MARGIN_IN)
    printed = browser("Page.printToPDF", paperWidth=A4_IN[0], paperHeight=A4_IN[1], **margins)
    stem.with_suffix(".pdf").write_bytes(base64.b64decode(printed["data"]))
    if converter := shutil.which("pdftoppm"):
        command = [converter, "-r", "70", "-png", str(stem.with_suffix(".pdf")), str(stem)]
        subprocess.run(command, check=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pages", type=Path, nargs="+", metavar="PAGE.html")
    parser.add_argument("--out", type=Path, metavar="FOLDER")
    given = parser.parse_args()
    program = installed()
    if program is None:
        print("No Chromium is installed, so no page was checked. Debian: apt-get install chromium")
        sys.exit(2)
    if missing := [str(page) for page in given.pages if not page.is_file()]:
        parser.error(f"there is no {', '.join(missing)}")
    failed = False
    with Browser(program) as browser:
        for page in given.pages:
            found = faults(browser, page, given.out)
            failed |= bool(found)
            print(f"{page}: {'nothing wrong' if not found else ''}")
            print("".join(f"  {fault}\n" for fault in found), end="")
    sys.exit(failed)


if __name__ == "__main__":
    main()
