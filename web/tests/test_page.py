"""What a user does on the page."""

import io
import json
import os
import subprocess
import time
import zipfile

import pytest

from conftest import DIST, ROOT, Page, assert_close, compared

DISC = (ROOT / "crates/asperity-cli/examples/measured/disc.x3p").read_bytes()
# The page as one file, in bytes: it may not grow unnoticed.
MAX_SIZE = 5_500_000
CORPUS = ROOT / "crates/asperity-surface/fuzz/corpus"
# One pass takes some tenths of a second, all of them far longer than the test waits.
LONG = """
title = "many passes"
lower = { young = 210e9, poisson = 0.3, hardness = 2e9, topography = { generate = "low-pass", sq = 30e-9, cutoff = 30e-6, seed = 1, shape = [32, 32], pitch = 4e-6 } }
upper = { young = 210e9, poisson = 0.3, topography = { generate = "low-pass", sq = 30e-9, cutoff = 30e-6, seed = 2, shape = [32, 32], pitch = 4e-6 } }
contact = { load = 0.05 }
motion = { passes = 2000, stride = 2 }
"""


def waves(n, pitch):
    """A table of points: x, y, z."""
    return "\n".join(f"{i * pitch} {j * pitch} {((i * 7 + j * 3) % 5) * 0.01}" for i in range(n) for j in range(n)).encode()


def test_a_first_picture_is_there_soon(browser, site):
    began = time.time()
    page = Page(browser, site)
    took = time.time() - began
    print(f"ready in {took:.2f} s")
    assert page.tab.locator(".body[data-side=lower] canvas").first.is_visible()
    assert page.tab.locator("#main-parameters tbody tr").count() > 5
    assert took < 10
    page.result("contact")
    assert not page.wrong, page.wrong
    page.context.close()


def test_nothing_is_asked_of_anyone_else(browser, site):
    page = Page(browser, site)
    page.result("contact")
    page.drop({"disc.x3p": DISC})
    page.said(".body[data-side=lower] .summary", "128 × 128 cells")
    asked = {url.split("#")[0] for url in page.requests if not url.startswith(("blob:", "data:"))}
    assert asked <= {site, site + "worker.js", site + "asperity.bin", "about:srcdoc"}, asked
    # Whatever a script on it tries, the policy of the page holds it back: in the page, and in its workers.
    for attempt in ("fetch('https://example.org/')", "fetch('http://127.0.0.1:9/')", "new Promise((y, n) => { const i = new Image(); i.onload = y; i.onerror = n; i.src = 'http://127.0.0.1:9/x.png'; })"):
        assert page.tab.evaluate(f"{attempt}.then(() => 'sent', () => 'held')") == "held"
    inside = "fetch('http://127.0.0.1:9/').then(() => postMessage('sent'), (e) => postMessage(String(e)))"
    page.tab.evaluate(
        """text => new Promise((resolve) => { addEventListener("securitypolicyviolation", () => 0);
        const w = new Worker(URL.createObjectURL(new Blob([text]))); w.onmessage = ({ data }) => resolve(data); w.onerror = () => resolve("held"); })""",
        inside,
    )
    assert any("Content Security Policy" in text for text in page.wrong)
    page.context.close()


def test_one_file_opens_by_a_double_click(browser):
    path = DIST / "asperity.html"
    assert path.stat().st_size < MAX_SIZE, f"{path.stat().st_size} bytes"
    page = Page(browser, path.as_uri())
    page.result("contact")
    assert {url.split("#")[0] for url in page.requests if not url.startswith(("blob:", "data:", "about:"))} == {path.as_uri()}
    assert not page.wrong, page.wrong
    page.context.close()


def test_one_file_lies_under_a_plane(opened):
    opened.drop({"mine.x3p": DISC})
    opened.said(".body[data-side=lower] .summary", "128 × 128 cells")
    opened.said(".body[data-side=upper] .summary", "A smooth plane")
    assert opened.tab.locator("#main-parameters th[scope=row]").all_inner_texts()[:2] == ["Sa", "Sq"]
    frame = opened.result("contact")
    assert "touch on" in frame.locator(".verdict").inner_text()


def test_two_files_of_different_pitch_come_to_one_grid(opened):
    opened.drop({"disc.x3p": DISC, "other.txt": waves(40, 2.0)})
    # The second file does not say its unit.
    opened.said(".body[data-side=upper] .said", "unit")
    assert opened.tab.locator("[data-key='upper.topography.unit'][aria-invalid]").count() == 1
    opened.set("upper.topography.unit", "um")
    opened.said(".body[data-side=upper] .summary", "40 × 40 cells")
    opened.said("#contact-check", "cells")
    assert 'grid = "common"' in opened.tab.input_value("#text")
    assert opened.result("contact").locator(".verdict").inner_text()


def test_a_file_on_a_body_is_that_body(opened):
    opened.drop({"plate.x3p": DISC}, ".body[data-side=upper]")
    opened.said(".body[data-side=upper] .summary", "128 × 128 cells")
    assert "disc.x3p" in opened.tab.input_value("#text") and "plate.x3p" in opened.tab.input_value("#text")


def corrupt():
    """A file of each corpus that no reader takes."""
    picked = []
    for folder in sorted(CORPUS.iterdir()):
        picked += [path for path in sorted(folder.iterdir()) if path.stat().st_size > 0][:1]
    return picked


def test_each_bad_file_is_a_sentence_and_the_rest_works(opened):
    """Readers may take what is in a corpus; then it is a surface, too small or not."""
    opened.at_once(False)
    for path in corrupt():
        opened.drop({f"bad-{path.parent.name}": path.read_bytes()})
        opened.tab.wait_for_function(
            """name => { const body = document.querySelector(".body[data-side=lower]");
            return body.innerText.includes(name) && (body.querySelector(".said").innerText || body.querySelector(".summary").innerText); }""",
            arg=f"bad-{path.parent.name}", timeout=30_000,
        )  # fmt: skip
    opened.drop({"disc.x3p": DISC})
    opened.said(".body[data-side=lower] .summary", "128 × 128 cells")
    opened.tab.click("#press")
    opened.result("contact")


@pytest.mark.parametrize(
    ("files", "words"),
    [
        ({"none.x3p": b""}, "none.x3p is empty"),
        ({f"{n}.x3p": DISC for n in "abc"}, "These are 3 surfaces"),
    ],
)
def test_drops_that_are_not_taken(opened, files, words):
    before = opened.tab.input_value("#text")
    opened.drop(files)
    opened.said("#said", words)
    assert opened.tab.input_value("#text") == before


def test_a_folder_and_a_large_file_are_not_read(opened):
    drop = """([name, size, folder]) => { const event = new Event("drop", { bubbles: true, cancelable: true });
        const file = { name, size, arrayBuffer: () => { throw new Error("read"); } };
        event.dataTransfer = { files: [file], items: [{ kind: "file", webkitGetAsEntry: () => ({ isDirectory: folder }) }] };
        document.body.dispatchEvent(event); }"""
    opened.tab.evaluate(drop, ["scans", 4096, True])
    opened.said("#said", "scans is a folder")
    opened.tab.evaluate(drop, ["large.x3p", 500_000_000, False])
    opened.said("#said", "large.x3p has 500 MB, and this page reads up to 200 MB")


def test_mistakes_are_said_where_they_are(opened):
    opened.example("quickstart")
    opened.result("contact")
    opened.set("contact.load", "-1 N")
    opened.said("#contact-said", "load")
    assert opened.tab.locator("[data-key='contact.load'][aria-invalid]").count() == 1
    opened.set("contact.load", "1 MN")
    opened.said("#contact-said", "plastic limit")
    opened.set("contact.load", "180 mN")
    opened.tab.wait_for_function("() => document.getElementById('contact-said').innerText === ''")
    opened.result("contact")
    opened.tab.fill("#text", "load = ")
    opened.tab.click("#apply")
    opened.said("#case-said", "line 1")


def test_what_does_not_fit_is_said_before_and_a_coarser_pitch_is_taken(opened):
    opened.at_once(False)
    opened.example("quickstart")
    opened.tab.fill("#text", opened.tab.input_value("#text").replace("[64, 64]", "[8192, 8192]").replace("[motion]", "[none]").split("[none]")[0])
    opened.tab.click("#apply")
    button = opened.tab.locator("#contact-check button", has_text="Take these cells")
    button.wait_for(timeout=120_000)
    assert "the command is the better place" in opened.tab.inner_text("#contact-check")
    assert "This surface has 8192 × 8192 cells" in opened.tab.inner_text(".body[data-side=lower] .said")
    button.click()
    opened.tab.wait_for_function("() => !document.getElementById('text').value.includes('8192')")


def test_memory_that_is_not_there_is_a_sentence(opened):
    opened.at_once(False)
    opened.example("quickstart")
    opened.tab.fill("#text", opened.tab.input_value("#text").replace("[64, 64]", "[32768, 32768]").split("[motion]")[0])
    opened.tab.click("#apply")
    opened.said("#contact-check", "the command is the better place")
    opened.tab.click("#press")
    opened.said("#contact-said", "memory")
    opened.tab.click("#undo")
    opened.said("#contact-check", "64 × 64 cells")
    opened.tab.click("#press")
    opened.result("contact")


def test_steps_of_the_preparation_are_undone(opened):
    opened.at_once(False)
    opened.drop({"disc.x3p": DISC})
    opened.said(".body[data-side=lower] .summary", "128 × 128 cells")
    sq = lambda: opened.tab.locator("#main-parameters tr", has=opened.tab.locator("th", has_text="Sq")).locator("td").first.inner_text()
    level = sq()
    opened.tab.select_option(".body[data-side=lower] select[aria-label^='add a step']", "s_filter")
    opened.tab.wait_for_function("before => document.querySelector('#main-parameters').innerText.includes('Sq') && !document.querySelector('#main-parameters').innerText.includes(before)", arg=level)
    smooth = sq()
    opened.tab.click("#undo")
    opened.tab.wait_for_function("before => document.querySelector('#main-parameters').innerText.includes(before)", arg=level)
    opened.tab.locator("button[aria-label^='remove: subtract a form']").first.click()
    opened.tab.wait_for_function("before => !document.querySelector('#main-parameters').innerText.includes(before)", arg=level)
    assert len({level, smooth, sq()}) == 3


def test_area_over_load_is_drawn_while_it_is_computed(opened):
    opened.result("contact")
    opened.tab.click("#over-load")
    opened.tab.wait_for_selector("#over-load-live canvas", timeout=60_000)
    assert opened.result("over-load").locator("#head .verdict").count() == 1


def test_results_of_a_case_that_has_changed_meanwhile_are_faded(opened):
    opened.at_once(False)
    opened.tab.fill("#text", LONG.replace("32, 32", "512, 512").split("motion")[0])
    opened.tab.click("#apply")
    opened.said("#contact-check", "512 × 512 cells")
    opened.tab.wait_for_selector("#contact-report.old iframe:not(.coming)")
    opened.tab.click("#press")
    opened.tab.wait_for_selector("#contact-stop:visible")
    opened.set("contact.load", "60 mN")
    opened.tab.wait_for_selector("#contact-stop", state="hidden", timeout=120_000)
    opened.tab.wait_for_function("() => document.querySelector('#contact-report iframe:not(.coming)').contentDocument.querySelector('.verdict').innerText.includes('50 mN')")
    assert opened.tab.locator("#contact-report.old").count() == 1
    opened.set("contact.load", "0.05")
    opened.result("contact")


def test_proposed_passes_of_periodic_bodies_shift(opened):
    opened.at_once(False)
    opened.tab.fill("#text", LONG.replace("load = 0.05", 'load = 0.05, boundary = "periodic"').split("motion")[0])
    opened.tab.click("#apply")
    opened.said("#contact-check", "32 × 32 cells")
    opened.tab.click("#run")
    opened.result("motion")
    assert 'strategy = "shift"' in opened.tab.input_value("#text")


@pytest.mark.parametrize("name", ["seal", "viscoelastic", "friction"])
def test_passes_are_not_proposed_for_a_course_without_them(opened, name):
    opened.at_once(False)
    opened.example(name)
    opened.said("#motion-check", "Press computes it")
    assert not opened.tab.is_visible("#run")
    opened.example("quickstart")
    opened.tab.wait_for_selector("#run")


def watched_passes(page):
    """Watches the numbers of the passes that are computed: a function that waits for one, and returns all so far.

    A continued run first reports the passes that it does not compute again; these do not count.
    """
    page.tab.evaluate(
        """() => { const text = document.getElementById("motion-progress"); const seen = window.seen = []; text.lastChild.textContent = "";
        const look = () => { const found = text.innerText.match(/pass (\\d+)\\//); if (found && window.seen === seen) seen.push(Number(found[1])); };
        new MutationObserver(look).observe(text, { childList: true, characterData: true, subtree: true }); }"""
    )

    def wait(number):
        page.tab.wait_for_function("number => seen.some((pass) => pass >= number)", arg=number, timeout=60_000)
        return page.tab.evaluate("seen")

    return wait


def test_a_stopped_run_keeps_its_passes_and_goes_on(opened):
    opened.at_once(False)
    opened.tab.fill("#text", LONG)
    opened.tab.click("#apply")
    opened.said("#motion-check", "cells")
    opened.tab.click("#run")
    opened.tab.wait_for_selector("#motion-live canvas", timeout=60_000)
    passes = watched_passes(opened)
    passes(3)
    # A tab that is closed in a run asks first.
    asked = []
    opened.tab.once("dialog", lambda dialog: (asked.append(dialog.type), dialog.dismiss()))
    opened.tab.close(run_before_unload=True)
    for _ in range(50):
        opened.tab.wait_for_timeout(100)
        if asked:
            break
    assert asked == ["beforeunload"]
    opened.tab.click("#motion-stop")
    opened.said("#motion-said", "Stopped")
    frame = opened.result("motion")
    banner = frame.locator(".banner").inner_text()
    done = int(banner.split(" of 2000")[0].split()[-1])
    assert done >= 3
    passes = watched_passes(opened)
    opened.tab.click("#continue")
    assert min(passes(done + 1)) > done
    opened.tab.click("#motion-stop")
    opened.said("#motion-said", "Stopped")


def test_the_zip_holds_what_the_command_computes(opened, asperity, tmp_path):
    opened.result("contact")
    # Sums in another order end at other pressures within the tolerance.
    text = opened.tab.input_value("#text")
    assert "[contact]" in text and "[motion]" in text
    closely = text.replace("[contact]", "[contact]\ntolerance = 1e-10").replace("[motion]", "[motion]\nload_tolerance = 1e-9")
    opened.tab.fill("#text", closely)
    opened.tab.click("#apply")
    opened.tab.wait_for_function("() => document.getElementById('apply').disabled")
    opened.tab.click("#run")
    opened.result("motion")
    with opened.tab.expect_download() as download:
        opened.tab.locator("#downloads p", has_text="Results of the motion").locator("xpath=following-sibling::button[1]").click()
    archive = zipfile.ZipFile(io.BytesIO(open(download.value.path(), "rb").read()))
    assert archive.testzip() is None
    archive.extractall(tmp_path)
    assert {"case.toml", "disc.x3p", "motion/summary.json", "motion/report.html", "motion/passes.csv", "motion/steps.csv"} <= set(archive.namelist())
    subprocess.run([asperity, "run", tmp_path / "case.toml", "--out", tmp_path / "again", "--quiet"], check=True)
    here, there = (json.loads((tmp_path / folder / "summary.json").read_text()) for folder in ("motion", "again"))
    assert here["passes"]
    assert_close(compared(here), compared(there), 1e-6)


def test_the_address_holds_the_case(opened, browser, site):
    opened.at_once(False)
    opened.example("hertz")
    opened.set("contact.load", "2.5 N")
    opened.tab.wait_for_function("() => document.getElementById('text').value.includes('2.5 N')")
    opened.tab.wait_for_timeout(300)
    url = opened.tab.url
    assert "#case=" in url
    other = Page(browser, url)
    assert other.tab.input_value("#text") == opened.tab.input_value("#text")
    other.context.close()
    cut = Page(browser, url[:-40])
    cut.said("#said", "not whole")
    cut.context.close()


def test_an_address_whose_file_is_missing_waits_for_it(opened, browser):
    opened.tab.wait_for_function("() => location.hash.length > 20")
    other = Page(browser, opened.tab.url)
    other.said("#said", "drop that file here")
    other.drop({"disc.x3p": DISC})
    other.said(".body[data-side=lower] .summary", "96 × 128 cells")
    other.context.close()


def test_keys_alone_suffice(opened):
    opened.result("contact")
    opened.at_once(False)
    seen = []
    opened.tab.evaluate("document.querySelector('.skip').focus()")
    for _ in range(250):
        opened.tab.keyboard.press("Tab")
        tag, name, visible = opened.tab.evaluate(
            """() => { const e = document.activeElement, s = getComputedStyle(e), label = e.closest("label");
            return [e.tagName, e.dataset.key || e.id || e.getAttribute("aria-label") || e.innerText || "", s.outlineStyle !== "none" || (label && getComputedStyle(label).outlineStyle !== "none")]; }"""
        )
        if tag == "BODY":
            break
        if tag != "IFRAME":
            assert visible, f"nothing shows that {tag} {name} has the focus"
            seen.append(name)
    for each in ("files", "examples", "press", "over-load", "run", "text", "save-case", "contact.load", "motion.passes", "Heights of the lower body."):
        assert each in seen, (each, seen)
    canvas = opened.tab.locator(".body[data-side=lower] .map canvas")
    canvas.focus()
    title = lambda: opened.tab.locator(".body[data-side=lower] .chart figcaption").first.inner_text()
    before = title()
    opened.tab.keyboard.press("ArrowUp")
    assert title() != before
    opened.tab.locator("#press").focus()
    opened.set("contact.load", "0.3 N")
    opened.tab.locator("#press").focus()
    opened.tab.keyboard.press("Enter")
    opened.result("contact")


@pytest.mark.parametrize("width", [1280, 400])
def test_it_is_accessible_and_fits(opened, width, tmp_path):
    opened.result("contact")
    opened.tab.click("#over-load")
    opened.result("over-load")
    opened.tab.set_viewport_size({"width": width, "height": 900})
    opened.tab.wait_for_timeout(500)
    beyond = opened.tab.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    assert beyond <= 0, f"{beyond} pixels beyond {width}"
    if "AXE" not in os.environ:
        pytest.skip("no axe-core")
    axe = open(os.environ["AXE"]).read()
    for scheme in ("light", "dark"):
        opened.tab.emulate_media(color_scheme=scheme)
        opened.tab.wait_for_timeout(300)
        opened.tab.evaluate(axe)
        found = opened.tab.evaluate("axe.run().then((r) => r.violations.map((v) => [v.id, v.nodes.map((n) => n.html.slice(0, 300) + ' ' + n.failureSummary)]))")
        assert not found, (scheme, found)
