"""The pages of results and of a study in a browser: `python page.py ASPERITY FOLDER`.

ASPERITY is the command, FOLDER takes the examples that are computed and screenshots of their pages. It needs playwright
(its driver alone), h5py, and Chromium: $CHROMIUM, or `chromium` of the path. $AXE is the file axe.min.js of axe-core; without
it accessibility is not looked at.
"""

import base64
import csv
import hashlib
import html.parser
import json
import os
import shutil
import subprocess
import sys
import time
import zlib
from pathlib import Path

import h5py
import numpy as np
from playwright.sync_api import sync_playwright

EXAMPLES = ["quickstart", "hertz", "friction", "measured"]
# A page of an example, in bytes, and a step of the scrubber, s. Other times are printed, and looked at by whoever runs it on a
# quiet machine.
MAX_SIZE, MAX_STEP = 1 << 20, 0.016

TITLE = "</script><img src=x onerror=alert(1)>"


def case(lower, upper, more, shape=(24, 24), title="a contact"):
    """A case of two bodies."""
    grid = f"shape = [{shape[0]}, {shape[1]}], pitch = 4e-6"
    bodies = "".join(f"{name} = {{ poisson = 0.3, {body}, {grid} }} }}\n" for name, body in (("lower", lower), ("upper", upper)))
    return f"title = '{title}'\n{bodies}{more}\n"


PLANE, RIGID = ('young = %s, topography = { form = "flat"' % young for young in ("210e9", "inf"))
BALL = 'young = 210e9, topography = { form = "sphere", radius = 1e-3'
ROUGH = 'young = 210e9, topography = { generate = "low-pass", sq = 30e-9, cutoff = 30e-6, seed = 1'
# What else has a page, and what has next to nothing to show.
CASES = {
    "flowing": case(
        f"plasticity = {{ yield_stress = 1e9 }}, {PLANE}", BALL,
        "contact = { load = 5 }\nplasticity = { depth = 30e-6, layers = 6, increments = 3 }",
    ),
    "sliding": case(
        PLANE, f"wear = {{ coefficient = 1e-13 }}, {BALL}",
        "contact = { load = 1 }\nfriction = { coefficient = 0.2 }\nsliding = { distance = 4e-3, updates = 4 }",
    ),
    "rolling": case(PLANE, BALL, "contact = { load = 1 }\nfriction = { coefficient = 0.3, rolling_force = 0.1 }"),
    "sweep": case(ROUGH, PLANE, "contact = { loads = [0.01, 0.1, 1], boundary = 'periodic' }"),
    "apart": case(PLANE, BALL, "contact = { approach = -1e-7 }", title=TITLE),
    "cell": case(PLANE, RIGID, "contact = { load = 1e-3 }", shape=(1, 1)),
    "level": case(PLANE, RIGID, "contact = { load = 1e-2 }\nmotion = { passes = 1, stride = 8 }\noutput = { pressure_every = 1 }"),
    "unkept": case(ROUGH, ROUGH, "contact = { load = 1e-2 }\nmotion = { passes = 2 }\noutput = { pressure_every = 0 }"),
}


# Loads over decades, of which the last one is more than the body bears; samples; a title that is no HTML.
STUDY = f"""
title = '{TITLE}'
[base]
lower = {{ poisson = 0.3, hardness = 2e9, {ROUGH}, shape = [24, 24], pitch = 4e-6 }} }}
upper = {{ poisson = 0.3, {PLANE} }} }}
contact = {{ load = 0 }}
[axes]
"contact.load" = {{ from = "0.0001 N", to = "100 N", count = 5, spacing = "log" }}
"lower.topography.sq" = {{ from = "10 nm", to = "100 nm", count = 3, spacing = "log" }}
"lower.topography.seed" = {{ seeds = 2 }}
"""


class Data(html.parser.HTMLParser):
    """The numbers of a page that say what they are, and its data."""

    def __init__(self, text):
        super().__init__()
        self.numbers, self.inside, self.json = {}, None, None
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag == "data":
            self.numbers[attributes["data-key"]] = float(attributes["value"])
        for name, value in attributes.items():
            assert not (value or "").startswith(("http:", "https:", "//")), (tag, name, value)
        self.inside = attributes.get("id") if tag == "script" else None

    def handle_endtag(self, _):
        self.inside = None

    def handle_data(self, text):
        if self.inside == "data":
            self.json = json.loads(text)


def flat(value, key):
    """All numbers of JSON, under dotted keys."""
    if isinstance(value, dict):
        return {k: v for name, each in value.items() for k, v in flat(each, f"{key}.{name}").items()}
    if isinstance(value, list):
        return {k: v for n, each in enumerate(value) for k, v in flat(each, f"{key}.{n}").items()}
    return {key: value} if isinstance(value, (int, float)) and not isinstance(value, bool) else {}


def numbers_are_those_of_the_summary(page, results):
    summary = json.loads((results / "summary.json").read_text())
    key = next(k for k in ("static", "sweep", "passes") if k in summary)
    expected = flat(summary[key], key)
    assert len(expected) > 5
    for name, value in expected.items():
        assert page.numbers.get(name) == value, (name, value, page.numbers.get(name))


def unpacked(packed):
    """The values of a packed map, worked out here and not by the page."""
    raw = np.frombuffer(zlib.decompress(base64.b64decode(packed["data"])), np.uint8)
    shape = packed["shape"]
    if packed["code"] == "even":
        steps = (raw[: raw.size // 2].astype(np.uint16) << 8) | raw[raw.size // 2 :]
        levels = np.cumsum(steps.reshape(shape), axis=1, dtype=np.uint16)
        return packed["low"] + levels / 65534 * (packed["high"] - packed["low"])
    levels = raw.reshape(shape)
    return np.where(levels == 0, 0, (levels - 1.0) / 254) * packed["high"]


def maps_are_the_fields(tab, data, results):
    """What the browser unpacks is what is packed, and that is the fields within half a level."""
    checked = 0
    seen = tab.evaluate(
        """async () => { const all = [];
        for (const frame of data.contact.frames) { const p = await unpack(frame.maps.pressure);
          let sum = 0, weighted = 0; p.levels.forEach((_, n) => { const v = cell(p, Math.floor(n / p.shape[1]), n % p.shape[1]);
            sum += v; weighted += v * (n % 97); }); all.push([sum, weighted]); }
        return all; }"""
    )
    passes = sorted(results.glob("fields/pass-*.h5"))
    points = sorted(results.glob("fields/point-*.h5"))
    for frame, (total, weighted) in zip(data["contact"]["frames"], seen):
        packed = frame["maps"]["pressure"]
        if passes:
            number = int(data["contact"]["groups"][frame["group"]]["label"].split()[1])
            name = f"pressure_{int(frame['label'].split()[1]):05}"
            file = results / f"fields/pass-{number:04}.h5"
        elif points:
            _, point, _, last = frame["label"].split()
            name, file = "pressure", results / f"fields/point-{int(point):04}.h5"
            # The last point of a sweep is also the contact at rest.
            if point == last and not file.exists():
                file = results / "fields.h5"
        else:
            name, file = "pressure", results / "fields.h5"
        with h5py.File(file) as fields:
            field = fields[name][:]
        values = unpacked(packed)
        assert np.abs(values - field).max() <= 0.5001 * packed["high"] / 254, name
        assert ((values > 0) <= (field > 0)).all()
        assert packed["high"] == field.max()
        places = np.arange(values.size) % 97
        assert np.isclose(total, values.sum()) and np.isclose(weighted, (values.ravel() * places).sum())
        checked += 1
    first = results / ("fields/initial.h5" if passes else "fields.h5")
    with h5py.File(first) as fields:
        for body in data["bodies"]:
            heights = fields[body["name"]][:]
            level = (body["before"]["high"] - body["before"]["low"]) / 65534
            assert np.abs(unpacked(body["before"]) - heights).max() <= 0.5001 * level, body["name"]
    assert checked > 0


def curves_are_the_tables(tab, data, results):
    """The CSV of a curve over the positions holds the numbers of steps.csv."""
    if not (results / "steps.csv").exists():
        return
    steps = list(csv.DictReader(open(results / "steps.csv")))
    for column in ("load", "contact_area", "max_pressure"):
        text = tab.evaluate("name => charts.find((view) => view.chart.name === name).csv()", column)
        rows = list(csv.reader(text.splitlines()))
        head = rows[0]
        assert head[0] == "offset of the upper body (m)" and head[1].endswith((" (N)", " (m²)", " (Pa)")), head
        number = head[1].split("pass ")[1].split(" ")[0]
        of_pass = [step for step in steps if step["pass"] == number]
        assert len(rows) == len(of_pass) + 1
        for row, step in zip(rows[1:], of_pass):
            assert float(row[0]) == float(step["offset"]) and float(row[1]) == float(step[column]), (row, step)


def downloads(tab, folder):
    """A map saves as PNG, a curve as CSV."""
    tab.evaluate("document.querySelectorAll('details').forEach((d) => (d.open = true))")
    for label, begin in (("PNG of", b"\x89PNG"), ("CSV of", b'"')):
        buttons = tab.locator(f"button[aria-label^='{label}']:visible")
        if buttons.count() == 0:
            continue
        with tab.expect_download() as download:
            buttons.first.click()
        path = folder / download.value.suggested_filename
        download.value.save_as(path)
        assert path.read_bytes().startswith(begin), path


def picture(tab):
    """What the map of the contact shows."""
    tab.evaluate("scrubber.show()")
    return hashlib.sha256(tab.evaluate("scrubber.map.canvas.toDataURL()").encode()).hexdigest()


def keys_change_the_picture(tab, data):
    frames = data["contact"]["frames"]
    if len(frames) == 1:
        assert tab.locator("#scrubber input[type=range]").count() == 0
        return
    tab.wait_for_selector("[data-unpacked]", timeout=120_000)
    canvas = tab.locator("#scrubber canvas").first
    canvas.focus()
    # A page opens on the frame that the answers describe, which may be the first or the last one.
    tab.keyboard.press("Home")
    keys = ["ArrowRight", "ArrowLeft", "End", "Home"]
    if len(data["contact"]["groups"]) > 1:
        keys += ["ArrowDown", "ArrowUp"]
    before = picture(tab)
    for key in keys:
        tab.keyboard.press(key)
        now = picture(tab)
        assert now != before, key
        before = now
    tab.keyboard.press("Space")
    for _ in range(50):
        tab.wait_for_timeout(200)
        if picture(tab) != before:
            break
    else:
        raise AssertionError("it does not play")
    tab.keyboard.press("Space")
    assert tab.locator("#scrubber button", has_text="play").count() == 1
    took = tab.evaluate(
        """async () => { const all = []; for (let k = 0; k < 20; k++) { const began = performance.now();
        await scrubber.to(scrubber.group, k % scrubber.groups[scrubber.group].length); all.push(performance.now() - began); }
        return all.sort((a, b) => a - b)[10] / 1000; }"""
    )
    print(f"  a step of the scrubber takes {1000 * took:.1f} ms")
    assert took < MAX_STEP


def nothing_is_empty(tab):
    """Each place for a chart or a map has one, and nothing on the page is a number that is none."""
    empty = tab.evaluate("[...document.querySelectorAll('[data-chart], [data-plane]')].filter((p) => !p.querySelector('canvas')).length")
    text = tab.evaluate("document.body.innerText")
    assert empty == 0 and not any(word in text for word in ("NaN", "undefined", "Infinity", "−0 ", "-0 ")), empty


def legends_hide(tab):
    """A click on a name in a legend hides its curve and nothing else; a second one shows it again. The CSV has all."""
    view = "charts.find((view) => view.legend.querySelectorAll('button').length > 1)"
    if not tab.evaluate(f"Boolean({view})"):
        return
    shown, csv_text = (f"{view}.{what}" for what in ("shown.length", "csv()"))
    before = tab.evaluate(shown), tab.evaluate(csv_text)
    for expected in (before[0] - 1, before[0]):
        tab.evaluate(f"{view}.legend.querySelector('button').click()")
        assert (tab.evaluate(shown), tab.evaluate(csv_text)) == (expected, before[1])
    # Without any curve the axes stay.
    for expected in (0, before[0]):
        tab.evaluate(f"{view}.legend.querySelectorAll('button').forEach((button) => button.click())")
        assert (tab.evaluate(shown), tab.evaluate(f"Boolean({view}.plot.axes.length)")) == (expected, True)


def is_accessible(tab, axe):
    if not axe:
        return
    for scheme in ("light", "dark"):
        tab.emulate_media(color_scheme=scheme)
        tab.wait_for_timeout(200)
        # An element, not a request; the page's policy lets inline scripts run.
        tab.evaluate(axe)
        found = tab.evaluate("axe.run().then((r) => r.violations.map((v) => [v.id, v.nodes.map((n) => n.html + ' ' + n.failureSummary)]))")
        assert not found, (scheme, found)
    tab.emulate_media(color_scheme="light")


def fits(tab, width):
    """The page is no wider than a window of that width."""
    tab.set_viewport_size({"width": width, "height": 900})
    tab.wait_for_timeout(400)
    beyond = tab.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    assert beyond <= 0, f"{beyond} pixels beyond {width}"


def look_at(browser, path, results, folder, axe):
    text = path.read_text()
    page = Data(text)
    numbers_are_those_of_the_summary(page, results)
    context = browser.new_context(viewport={"width": 1280, "height": 900}, accept_downloads=True)
    tab = context.new_page()
    wrong, requests = [], []
    tab.on("console", lambda message: wrong.append(message.text) if message.type in ("error", "warning") else None)
    tab.on("pageerror", lambda error: wrong.append(str(error)))
    tab.on("request", lambda request: requests.append(request.url))
    began = time.time()
    tab.goto(path.as_uri())
    tab.wait_for_selector("[data-ready]", timeout=120_000)
    took = time.time() - began
    print(f"{path.stem}: {len(text.encode()) / 1e6:.2f} MB, ready in {took:.1f} s")
    assert tab.title() == json.loads((results / "case.json").read_text()).get("title", "a contact")
    if page.json.get("contact"):
        maps_are_the_fields(tab, page.json, results)
        keys_change_the_picture(tab, page.json)
    curves_are_the_tables(tab, page.json, results)
    nothing_is_empty(tab)
    legends_hide(tab)
    downloads(tab, folder)
    is_accessible(tab, axe)
    for width in (1280, 400):
        fits(tab, width)
        tab.screenshot(path=folder / f"{path.stem}-{width}.png", full_page=True)
    assert not wrong, wrong
    assert [url for url in requests if not url.startswith(("blob:", "data:"))] == [path.as_uri()], requests
    context.close()

    context = browser.new_context(java_script_enabled=False)
    tab = context.new_page()
    tab.goto(path.as_uri())
    assert tab.locator("table tbody tr").count() > 3 and tab.locator("noscript img, img").count() > 0
    context.close()


def computed_study(asperity, folder):
    """A study whose last loads fail, with the page of one case; its directory."""
    directory = folder / "study"
    (folder / "study.toml").write_text(STUDY)
    command = [asperity, "study", folder / "study.toml", "--quiet"]
    assert subprocess.run(command, stderr=subprocess.DEVNULL).returncode == 1
    subprocess.run([asperity, "report", directory / "cases/0003"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([*command, "--collect"], check=True, stderr=subprocess.DEVNULL)
    return directory


def rows_are_the_table(tab, table):
    """A row per case, each with its values, its numbers and its warnings, or with why it failed."""
    heads = [head.inner_text().split("\n") for head in tab.locator("#cases thead th").all()]
    rows = tab.evaluate("[...document.querySelectorAll('#cases tbody tr')].map((r) => [...r.cells].map((c) => [c.innerText, c.colSpan]))")
    assert len(rows) == len(table) and any(row["state"] == "failed" for row in table)
    units = {"N": 1, "mN": 1e-3, "µN": 1e-6, "mm²": 1e-6, "µm²": 1e-12, "µm": 1e-6, "nm": 1e-9, "pm": 1e-12, "GPa": 1e9, "MPa": 1e6, "J": 1,
             "mJ": 1e-3, "µJ": 1e-6, "nJ": 1e-9, "pJ": 1e-12, "mm³": 1e-9, "µm³": 1e-18, "MN/m": 1e6, "kN/m": 1e3}  # fmt: skip
    number = lambda text: float(text.replace("−", "-"))
    for cells, row in zip(rows, table):
        assert sum(span for _, span in cells) == len(heads) and cells[0][0] == row["case"]
        for [text, _], [_, *unit], key in zip(cells[1:4], heads[1:4], ("contact.load (N)", "lower.topography.sq (m)", "lower.topography.seed")):
            assert np.isclose(number(text) * (units[unit[0]] if unit else 1), float(row[key]), rtol=6e-3), (text, row[key])
            assert len(text.lstrip("0.").replace(".", "")) <= 4, text
        if row["state"] == "failed":
            assert cells[4][0] == row["message"] and "exceeds the plastic limit" in row["message"]
            continue
        for [text, _], [name, *unit] in zip(cells[4:-1], heads[4:-1]):
            column = {"real area of contact": "contact_area", "largest pressure": "max_pressure"}.get(name, name.replace(" ", "_"))
            expected = float(row["contact_area"]) / float(row["apparent_area"]) if column == "contact_fraction" else float(row[column])
            shown = number(text) * units[unit[0]] if unit else number(text)
            assert np.isclose(shown, expected, rtol=6e-4, atol=0), (name, text, expected)
        assert cells[-1][0] == row["warnings"]


def answers_are_means_of_the_table(tab, table):
    """The page opens with mean, deviation and number of the samples of each load and roughness."""
    assert tab.locator("section[aria-labelledby] h2").first.inner_text() == "Answers" and tab.locator("#head .cards > div").count() == 3
    done = [row for row in table if row["state"] == "done"]
    rows = [[cell.inner_text() for cell in row.locator("td").all()] for row in tab.locator("#answers tbody tr").all()]
    groups = sorted({(float(row["contact.load (N)"]), float(row["lower.topography.sq (m)"])) for row in done})
    for (load, sq), cells in zip(groups, rows, strict=True):
        areas = [1e12 * float(row["contact_area"]) for row in done if (float(row["contact.load (N)"]), float(row["lower.topography.sq (m)"])) == (load, sq)]
        mean, deviation = map(float, cells[2].split(" ± "))
        assert np.isclose(mean, np.mean(areas), rtol=6e-4) and np.isclose(deviation, np.std(areas, ddof=1), rtol=6e-2), (cells, areas)
        assert cells[-1] == str(len(areas))


def curves_are_means_of_the_table(tab, table):
    """Whatever is chosen, a curve for each value of the other axis: means of the samples to the last digit, with their standard deviation and number."""
    done = [row for row in table if row["state"] == "done"]
    keys = {"contact.load": "contact.load (N)", "lower.topography.sq": "lower.topography.sq (m)"}
    selects = tab.locator("#explorer select")
    for place, (key, column) in enumerate(keys.items()):
        [other_key, other] = next((each, of) for each, of in keys.items() if each != key)
        selects.nth(1).select_option(str(place))
        assert selects.nth(2).input_value() == other_key
        for quantity, name in enumerate(tab.evaluate("explorer.quantities.map((q) => q.name)")):
            if name == "contact_fraction":
                continue
            selects.nth(0).select_option(str(quantity))
            rows = list(csv.reader(tab.evaluate("explorer.view.csv()").splitlines()))
            values = sorted({float(row[other]) for row in done})
            first = [n - 1 for n, head in enumerate(rows[0]) if "standard deviation" in head]
            assert len(first) == len(values), rows[0]
            for n, value in zip(first, values):
                of_curve = [row for row in done if float(row[other]) == value]
                for k, at in enumerate(sorted({float(row[column]) for row in of_curve}), 1):
                    numbers = [float(row[name]) for row in of_curve if float(row[column]) == at]
                    mean, deviation, count = (float(rows[k][n + j]) for j in range(3))
                    assert count == len(numbers) == 2 and np.isclose(deviation, np.std(numbers, ddof=1), rtol=1e-9, atol=1e-300)
                    assert np.isclose(mean, np.mean(numbers), rtol=1e-15)
    selects.nth(2).select_option("")
    assert tab.evaluate("explorer.chart().series.filter((s) => s.mark === 'points').length") == 1
    # All ticks of an axis are said in one way.
    said = tab.evaluate("[[0, 1, 2], [-4, -3, -2, -1, 0, 1], [-7, Math.log10(2e-7)]].map((all) => labels(all, true))")
    assert said == [["1", "10", "100"], ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹"], ["10⁻⁷", "2·10⁻⁷"]], said


def means_are_coloured_and_filtered(tab, table):
    """The table in colours has the mean of the cases at each place; a choice leaves the cases that have its value."""
    done = [row for row in table if row["state"] == "done"]
    load, sq, seed = "contact.load (N)", "lower.topography.sq (m)", "lower.topography.seed"
    selects = tab.locator("#explorer select")
    for place, option in ((0, "0"), (1, "0"), (2, "lower.topography.sq"), (3, "map")):
        selects.nth(place).select_option(option)
    factor = tab.evaluate("explorer.quantities[0].unit.factor")
    name = tab.evaluate("explorer.quantities[0].name")
    seeds = sorted({row[seed] for row in table}, key=float)
    for chosen in ("", "0"):
        selects.nth(6).select_option(chosen)
        of_choice = [row for row in done if chosen == "" or row[seed] == seeds[0]]
        cells = [[cell.inner_text() for cell in row.locator("td").all()] for row in tab.locator("#heat tbody tr").all()]
        for cell_row, b in zip(cells, sorted({float(row[sq]) for row in table}), strict=True):
            for cell, a in zip(cell_row, sorted({float(row[load]) for row in table}), strict=True):
                numbers = [float(row[name]) for row in of_choice if (float(row[load]), float(row[sq])) == (a, b)]
                assert (cell == "–") == (not numbers), (cell, numbers)
                assert not numbers or np.isclose(float(cell), np.mean(numbers) / factor, rtol=6e-4), (cell, numbers)
        rows = tab.locator("#cases tbody tr:visible").count()
        assert rows == sum(chosen == "" or row[seed] == seeds[0] for row in table)
    selects.nth(6).select_option("")
    selects.nth(3).select_option("curves")


def keys_reach_the_cases(tab):
    """Tab comes to each button and link in its turn and shows where it is; the table scrolls by keys; a link leads on by Enter."""
    seen = []
    for _ in range(200):
        tab.keyboard.press("Tab")
        at = tab.evaluate("""() => { const e = document.activeElement; const s = getComputedStyle(e);
            return [e.tagName, e.getAttribute("href") || e.getAttribute("aria-label") || e.innerText, s.outlineStyle !== "none"]; }""")
        if at[0] == "BODY":
            break
        assert at[2], f"nothing shows that {at} has the focus"
        seen.append(at[:2])
    assert ["A", "cases/0003/report.html"] in seen and ["BUTTON", "0001"] in seen and ["DIV", "table of cases"] in seen, seen
    assert sum(name.startswith("CSV of") for _, name in seen) == tab.locator("[data-chart], #explorer").count()
    assert len({name for _, name in seen}) == len(seen), "two of one name"


def clicks_sort_and_open(tab, table):
    """A click on a head sorts, a second one turns the order round; a click on a row describes its case."""
    cases = lambda: [cell.inner_text() for cell in tab.locator("#cases tbody tr th").all()]
    before = cases()
    head = tab.locator("#cases thead button").first
    head.click()
    assert cases() == before and tab.locator("#cases thead th[aria-sort=ascending]").count() == 1
    head.click()
    assert cases() == before[::-1]
    head.click()
    tab.locator("#cases tbody tr", has_text="0001").first.locator("td").first.click()
    panel = tab.locator("#panel")
    assert panel.locator("h3").inner_text() == "Case 0001" and "asperity report" in panel.inner_text()
    failed = next(row for row in table if row["state"] == "failed")
    tab.locator("#cases tbody tr button", has_text=failed["case"]).first.click()
    assert failed["message"] in panel.inner_text()
    panel.locator("button", has_text="close").click()
    assert panel.inner_text() == ""


def heads_stay(tab):
    """However far the table of cases is scrolled, the heads of columns and rows are seen."""
    seen = tab.evaluate("""() => { const box = document.querySelector("#cases .scroll"); box.scrollTo(1e6, 1e6);
        const at = (e) => e.getBoundingClientRect(), o = at(box), s = [box.scrollTop, box.scrollLeft];
        const found = [at(box.querySelector("thead th:last-child")).top - o.top, at(box.querySelector("tbody tr:last-child th")).left - o.left];
        box.scrollTo(0, 0); return [s, found]; }""")
    [scrolled, found] = seen
    assert max(scrolled) > 0 and max(map(abs, found)) <= 1, seen


def look_at_study(browser, directory, folder, axe):
    path = directory / "study.html"
    table = list(csv.DictReader(open(directory / "table.csv", encoding="utf-8-sig")))
    # Also under their names alone, without a unit.
    for row in table:
        row.update({head.split(" (")[0]: value for head, value in row.items()})
    context = browser.new_context(viewport={"width": 1280, "height": 900}, accept_downloads=True)
    tab = context.new_page()
    wrong = []
    tab.on("console", lambda message: wrong.append(message.text) if message.type in ("error", "warning") else None)
    tab.on("pageerror", lambda error: wrong.append(str(error)))
    tab.goto(path.as_uri())
    tab.wait_for_selector("[data-ready]", timeout=120_000)
    failed = [row for row in table if row["state"] == "failed"]
    assert tab.title() == TITLE and tab.locator("h1").inner_text() == TITLE
    assert tab.locator(".verdict").inner_text() == f"{len(table) - len(failed)} of {len(table)} cases are done, {len(failed)} have failed."
    told = [item.inner_text() for item in tab.locator(".warning li").all()]
    assert told == [f"case {row['case']}: {row['message']}" for row in failed]
    keys_reach_the_cases(tab)
    rows_are_the_table(tab, table)
    answers_are_means_of_the_table(tab, table)
    curves_are_means_of_the_table(tab, table)
    means_are_coloured_and_filtered(tab, table)
    clicks_sort_and_open(tab, table)
    nothing_is_empty(tab)
    downloads(tab, folder)
    for width in (1280, 400):
        fits(tab, width)
        is_accessible(tab, axe)
        heads_stay(tab)
        tab.evaluate("scrollTo(0, 0)")
        tab.screenshot(path=folder / f"study-{width}.png", full_page=True)
    tab.locator("#cases a", has_text="0003").focus()
    tab.keyboard.press("Enter")
    tab.wait_for_selector("[data-ready]", timeout=120_000)
    assert tab.url == (directory / "cases/0003/report.html").as_uri() and "case 3" in tab.locator("h1").inner_text()
    assert not wrong, wrong
    context.close()

    context = browser.new_context(java_script_enabled=False)
    tab = context.new_page()
    tab.goto(path.as_uri())
    rows_are_the_table(tab, table)
    context.close()
    print(f"study: {len(table)} cases, {len(failed)} of them failed")


def main(asperity, folder):
    folder.mkdir(parents=True, exist_ok=True)
    axe = Path(os.environ["AXE"]).read_text() if os.environ.get("AXE") else None
    chromium = os.environ.get("CHROMIUM") or shutil.which("chromium")
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        for example in [*EXAMPLES, *CASES]:
            results = folder / example / "results"
            if not (results / "summary.json").exists():
                what = ["--example", example, "--out", folder / example]
                if example in CASES:
                    (folder / f"{example}.toml").write_text(CASES[example])
                    what = [folder / f"{example}.toml", "--out", results]
                subprocess.run([asperity, "run", *what, "--quiet"], check=True, stderr=subprocess.DEVNULL)
            path = folder / f"{example}.html"
            subprocess.run([asperity, "report", results, "--out", path], check=True, stdout=subprocess.DEVNULL)
            look_at(browser, path, results, folder, axe)
        assert (folder / "quickstart.html").stat().st_size < MAX_SIZE
        look_at_study(browser, computed_study(asperity, folder), folder, axe)
        browser.close()


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
