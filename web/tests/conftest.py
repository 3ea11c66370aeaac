"""The page in Chromium, from a server of this machine and as one file.

DIST is the folder that `web/build` makes; ASPERITY_BINARY the command, to which the page is compared. $CHROMIUM is Chromium, or `chromium` of the path;
$AXE the file axe.min.js of axe-core, without which accessibility is not looked at.
"""

import functools
import http.server
import json
import os
import shutil
import threading
from pathlib import Path

import pytest
from playwright.sync_api import sync_playwright

ROOT = Path(__file__).parents[2]
DIST = Path(os.environ.get("DIST", ROOT / "web/dist"))


class Quiet(http.server.SimpleHTTPRequestHandler):
    """A plain server of files, without headers of its own."""

    def log_message(self, *_):
        pass


@pytest.fixture(scope="session")
def site():
    """The address of the folder on a server."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=DIST))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()


@pytest.fixture(scope="session")
def browser():
    with sync_playwright() as play:
        chromium = os.environ.get("CHROMIUM") or shutil.which("chromium")
        browser = play.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def asperity():
    """The command."""
    return Path(os.environ.get("ASPERITY_BINARY", ROOT / "target/release/asperity"))


class Page:
    """The page, opened and ready."""

    def __init__(self, browser, url, **options):
        self.context = browser.new_context(viewport={"width": 1280, "height": 900}, accept_downloads=True, **options)
        self.tab = self.context.new_page()
        self.wrong, self.requests = [], []
        self.tab.on("console", lambda message: self.wrong.append(message.text) if message.type in ("error", "warning") else None)
        self.tab.on("pageerror", lambda error: self.wrong.append(str(error)))
        self.tab.on("request", lambda request: self.requests.append(request.url))
        self.tab.goto(url)
        self.ready()

    def ready(self):
        self.tab.wait_for_selector("html[data-ready]", timeout=60_000)

    def at_once(self, on):
        """Whether each change is computed at once; tests that look at something else are faster without."""
        self.tab.set_checked("#at-once", on)

    def drop(self, files, place="body"):
        """Drops files {name: bytes} on a place of the page."""
        given = [[name, list(content)] for name, content in files.items()]
        self.tab.evaluate(
            """([given, place]) => { const all = new DataTransfer();
            for (const [name, bytes] of given) all.items.add(new File([new Uint8Array(bytes)], name));
            document.querySelector(place).dispatchEvent(new DragEvent("drop", { dataTransfer: all, bubbles: true, cancelable: true })); }""",
            [given, place],
        )

    def said(self, place, words):
        """Waits for words in a place."""
        self.tab.wait_for_function("([place, words]) => document.querySelector(place).innerText.includes(words)", arg=[place, words], timeout=30_000)

    def set(self, key, text):
        """Types a value of a key."""
        field = self.tab.locator(f"[data-key='{key}']").first
        field.fill(text)
        field.press("Tab")

    def example(self, name):
        """Opens an example; `Case file` shows its text."""
        self.tab.select_option("#examples", name)
        title = next(line for line in (ROOT / f"crates/asperity-cli/examples/{name}/case.toml").read_text().splitlines() if line.startswith("title"))
        self.tab.wait_for_function("title => document.getElementById('text').value.includes(title)", arg=title, timeout=30_000)

    def result(self, name):
        """Waits for the page of the results of a section; its frame."""
        self.tab.wait_for_selector(f"#{name}-report:not(.old) iframe:not(.coming)", timeout=120_000)
        return self.tab.frame_locator(f"#{name}-report iframe:not(.coming)")


@pytest.fixture
def opened(browser, site):
    """The page from the server; it must have written nothing to the console."""
    page = Page(browser, site)
    yield page
    page.context.close()
    assert not page.wrong, page.wrong


@pytest.fixture(scope="module")
def module(browser, site):
    """The module in a worker of its own: `module(call, *given)` gives its answer, or raises its failure."""
    context = browser.new_context()
    tab = context.new_page()
    tab.goto(site)
    tab.evaluate(
        """async () => {
        const [text, packed] = await Promise.all([fetch("worker.js").then((r) => r.text()), fetch("asperity.bin").then((r) => r.body)]);
        const bytes = await new Response(packed.pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
        const module = await WebAssembly.compile(bytes);
        const worker = new Worker(URL.createObjectURL(new Blob([text])));
        const waiting = new Map();
        worker.onmessage = ({ data }) => { if (waiting.has(data.id)) { waiting.get(data.id)(data); waiting.delete(data.id); } };
        let count = 0;
        window.ask = (call, given) => new Promise((resolve) => { waiting.set(++count, resolve); worker.postMessage({ id: count, call, given }); });
        await ask("start", [module]); }"""
    )

    def call(name, *given):
        parts = [{"bytes": list(each)} if isinstance(each, bytes) else each for each in given]
        answer = tab.evaluate(
            """async ([name, parts]) => { const given = parts.map((part) => (part && part.bytes ? new Uint8Array(part.bytes) : part));
            const { answer, failure } = await ask(name, given);
            return JSON.stringify({ failure, answer: answer instanceof Uint8Array ? { bytes: [...answer] } : answer }); }""",
            [name, parts],
        )
        answer = json.loads(answer)
        if "failure" in answer:
            raise Failure(answer["failure"])
        found = answer.get("answer")
        return bytes(found["bytes"]) if isinstance(found, dict) and "bytes" in found and len(found) == 1 else found

    yield call
    context.close()


class Failure(Exception):
    """A failure of the module."""

    def __init__(self, failure):
        super().__init__(failure.get("message"))
        self.failure = failure


# Words in keys of a summary that the machine, the order of sums or the place of the file decides, and no physics.
OF_THE_MACHINE = ("time", "threads", "version", "identity", "file", "residual", "iterations", "convolutions", "deviation", "error", "position")


def compared(value):
    """A summary without the numbers that depend on the machine."""
    if isinstance(value, dict):
        return {key: compared(each) for key, each in value.items() if not any(word in key for word in OF_THE_MACHINE)}
    return [compared(each) for each in value] if isinstance(value, list) else value


def assert_close(one, other, close, path="", size=0.0):
    """Two summaries are the same within `close`; components of a vector count by its size."""
    if isinstance(one, dict):
        assert one.keys() == other.keys(), (path, one.keys() ^ other.keys())
        for key in one:
            assert_close(one[key], other[key], close, f"{path}.{key}")
    elif isinstance(one, list):
        assert len(one) == len(other), path
        size = max((abs(each) for each in other if isinstance(each, float)), default=0.0)
        for n, (a, b) in enumerate(zip(one, other)):
            assert_close(a, b, close, f"{path}.{n}", size)
    elif isinstance(one, float):
        assert one == pytest.approx(other, rel=close, abs=close * size), (path, one, other)
    else:
        assert one == other, (path, one, other)
