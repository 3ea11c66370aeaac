"""The page at its budget: `python budget.py ASPERITY FOLDER`, on a quiet machine.

FOLDER takes the results of case.toml, which take a minute or two. It needs playwright (its driver alone) and Chromium: $CHROMIUM, or
`chromium` of the path.
"""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

from playwright.sync_api import sync_playwright

# Bytes; seconds to write it, until it is ready, and for a step of the scrubber.
SIZE, WRITTEN, READY, STEP = 5e6, 5.0, 2.0, 0.016

STEPS = """async () => { const all = []; for (let k = 0; k < 101; k++) { const began = performance.now();
    await scrubber.to(k % scrubber.groups.length, (7 * k) % scrubber.groups[0].length); all.push(performance.now() - began);
    await new Promise((shown) => requestAnimationFrame(() => setTimeout(shown))); }
    return all.sort((a, b) => a - b).map((ms) => ms / 1000); }"""


def main(asperity, folder):
    results, page = folder / "results", folder / "page.html"
    if not (results / "summary.json").exists():
        subprocess.run([asperity, "run", Path(__file__).with_name("case.toml"), "--out", results, "--quiet"], check=True)
    began = time.time()
    subprocess.run([asperity, "report", results, "--out", page], check=True, stdout=subprocess.DEVNULL)
    told = {"bytes": (page.stat().st_size, SIZE), "written, s": (time.time() - began, WRITTEN)}
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=os.environ.get("CHROMIUM") or shutil.which("chromium"), args=["--no-sandbox"])
        tab = browser.new_page(viewport={"width": 1280, "height": 900})
        began = time.time()
        tab.goto(page.resolve().as_uri())
        tab.wait_for_selector("[data-ready]")
        told["ready, s"] = (time.time() - began, READY)
        tab.wait_for_selector("[data-unpacked]", timeout=60_000)
        steps = tab.evaluate(STEPS)
        told["a step in the middle, s"] = (steps[len(steps) // 2], STEP)
        told["one of 20 longer than, s"] = (steps[len(steps) * 19 // 20], STEP)
        browser.close()
    for name, (value, most) in told.items():
        print(f"{name:26} {value:12.4g} of {most:g}")
    sys.exit(any(value > most for value, most in told.values()))


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
