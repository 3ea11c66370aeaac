// 1 Surface: source, preparation, map, profiles and roughness of both bodies.

import { chart, ChartPlace } from "./charts.js";
import { coded, field, mark, refill, say } from "./form.js";
import { GRID, SOURCES, sourceOf, STEPS } from "./sources.js";

export const SIDES = ["lower", "upper"];
/** Parameters that are always shown. */
const MAIN = ["Sa", "Sq", "Sz", "Ssk", "Sku", "Sdq", "Sal", "Str", "Sk", "Spk", "Svk"];

/** Largest number of cells of a surface that the page describes, and the side of the part that it proposes instead. */
const MAX_CELLS = 2048 * 2048;
const PART = 1024;

/** Source, preparation, map and profiles of one body. */
class BodyView {
  constructor(app, side) {
    Object.assign(this, { app, side, key: `${side}.topography`, scan: null, asked: null, about: null });
    this.place = document.querySelector(`.body[data-side="${side}"]`);
    this.source = element("select", { "aria-label": `source of the ${side} surface`, onchange: () => this.choose(this.source.value) });
    this.fields = element("div", { class: "fields" });
    this.steps = element("ol", { class: "steps" });
    this.more = element("select", { "aria-label": `add a step of the preparation of the ${side} surface`, onchange: () => this.add(this.more.value) });
    this.said = element("div", { class: "said", role: "status" });
    this.summary = element("p", { class: "summary" });
    this.found = element("ul", { class: "summary" });
    this.maps = element("div");
    this.charts = element("div");
    const title = element("h3", {}, `${side === "lower" ? "Lower" : "Upper"} body`);
    // Each of these four parts is in one row with that of the other body.
    this.place.append(element("div", {}, title, element("div", { class: "controls" }, this.source, this.more), this.fields, this.steps),
      element("div", {}, this.said, this.summary, this.found), this.maps, this.charts);
  }

  get topography() { return this.app.kase.get(this.key) || { form: "flat" }; }

  /** Changes the source. */
  choose(name) {
    if (name === "file") return;
    const { key, given } = SOURCES[name];
    const other = this.app.kase.get(`${SIDES.find((side) => side !== this.side)}.topography`) || {};
    const { shape, pitch } = this.topography;
    const grid = name === "flat" || (!shape && other.file) ? {} : { shape: shape || other.shape || [128, 128], pitch: pitch || other.pitch || "1 um" };
    this.app.kase.set(this.key, { [key]: name, ...grid, ...given });
  }

  add(name) {
    const step = STEPS.find(([key]) => key === name);
    if (step) this.app.kase.set(`${this.key}.${name}`, step[2]);
    this.steps.querySelector(`[data-key="${this.key}.${name}"]`)?.focus();
  }

  /** Returns the keys that say what a file does not say itself. */
  reading() {
    const { scan, topography } = this;
    if (!scan) return this.unread ? [["unit", "unit of the numbers"], ["pitch", "size of a cell"], ["skip", "lines above the numbers"]] : [];
    return [
      ...(scan.channels.length > 1 ? [["channel", "channel", scan.channels]] : []),
      ...(scan.unit_known ? [] : [["unit", "unit of the numbers"]]),
      ...(scan.pitch && topography.pitch === undefined ? [] : [["pitch", "size of a cell"]]),
      ...(scan.lines ? [["lines", "lines along", ["x", "y"]]] : []),
    ];
  }

  /** Arranges the fields of the source and the steps, if they have changed. */
  arrange() {
    const { topography } = this;
    const name = sourceOf(topography);
    const plain = topography.file !== undefined;
    const steps = STEPS.filter(([key]) => topography[key] !== undefined);
    const keys = plain ? this.reading() : [...SOURCES[name].keys, ...GRID];
    const signature = JSON.stringify([name, topography.file, keys, steps.map(([key]) => key)]);
    if (signature === this.signature) return;
    this.signature = signature;
    const options = Object.entries(SOURCES).map(([word, { title }]) => element("option", { value: word }, title));
    this.source.replaceChildren(...(plain ? [element("option", { value: "file" }, topography.file)] : []), ...options);
    this.source.value = name;
    const choices = (words) => (words ? { choices: [["", "–"], ...words.map((word) => [word, word])] } : {});
    this.fields.replaceChildren(...keys.map(([key, label, words]) => field(`${this.key}.${key}`, label, choices(words))));
    this.steps.replaceChildren(...steps.map(([key, label, , words]) => element("li", {},
      field(`${this.key}.${key}`, label, words ? { choices: words.map((word) => [word, word]) } : {}),
      element("button", { type: "button", "aria-label": `remove: ${label}, ${this.side} body`, onclick: () => { this.app.kase.set(`${this.key}.${key}`, undefined); this.more.focus(); } }, "remove"))));
    const left = STEPS.filter((step) => !steps.includes(step) && (plain || !["despike", "fill"].includes(step[0])));
    this.more.replaceChildren(element("option", { value: "" }, "prepare …"), ...left.map(([key, label]) => element("option", { value: key }, label)));
    refill(this.app.kase, this.place);
  }

  /** Shows the surface, if it has changed, and returns its `shape` and `pitch` if they are known. `grid` is that of the other body. */
  async describe(grid) {
    const { topography } = this;
    if (topography.form === "flat" && !topography.plus) return this.plane({ ...grid, ...topography });
    const whole = this.whole = topography.file !== undefined || topography.shape ? topography : { ...grid, ...topography };
    const asked = JSON.stringify(whole);
    const version = this.app.versions.get(topography.file);
    if (asked === this.asked && version === this.version) return this.about;
    Object.assign(this, { asked, version });
    try {
      if (topography.file !== undefined) await this.read(topography);
      const shape = topography.window || topography.resample ? null : topography.file === undefined ? whole.shape : this.scan.shape;
      if (shape?.[0] * shape?.[1] > MAX_CELLS) return this.refuse(shape);
      const { about, map } = await this.app.desk.call("surface", whole);
      await unpack(map);
      if (asked !== this.asked) return this.about;
      this.about = about;
      say(this.said);
      this.draw(about, map);
    } catch (failure) {
      if (asked !== this.asked) return this.about;
      this.blank("");
      // The module names keys of the topography without the body.
      if (failure.key && !failure.key.startsWith(this.key)) failure.key = `${this.key}.${failure.key}`;
      say(this.said, [failure]);
      mark(failure);
    }
    return this.about;
  }

  /** Finds out what the file says by itself. */
  async read({ file, channel, unit, lines, skip, pitch }) {
    if (!this.app.files.has(file)) throw new Error(`This case reads \`${file}\`: drop that file on this page.`);
    const reading = Object.fromEntries(Object.entries({ channel, unit, lines, skip }).filter(([, value]) => value !== undefined));
    try {
      this.scan = await this.app.desk.call("scan", file, await this.app.desk.call("write_case", JSON.stringify(reading)));
      this.unread = false;
    } catch (failure) {
      this.scan = null;
      this.unread = true;
      if (failure.available?.length) this.scan = { channels: failure.available, unit_known: true, pitch: [1, 1], lines: null };
      this.arrange();
      throw failure;
    }
    this.arrange();
    if (!this.scan.pitch && pitch === undefined) throw Object.assign(new Error(`\`${file}\` does not say how far its samples are apart. Give the size of a cell, such as 0.5 um.`), { key: `${this.key}.pitch` });
    if (!this.scan.unit_known && unit === undefined) throw Object.assign(new Error(`\`${file}\` does not say the unit of its numbers. Give it, such as um.`), { key: `${this.key}.unit` });
  }

  plane(whole) {
    Object.assign(this, { whole, asked: null });
    say(this.said);
    this.blank("A smooth plane.");
    return whole.shape ? whole : null;
  }

  /** Says that a surface is too large, and proposes a part of it. */
  refuse(shape) {
    const [nx, ny] = shape.map((cells) => Math.min(cells, PART));
    const isFile = this.topography.file !== undefined;
    const take = () => this.app.kase.set(`${this.key}.${isFile ? "window" : "shape"}`, isFile ? [Math.floor((shape[0] - nx) / 2), Math.floor((shape[1] - ny) / 2), nx, ny] : [nx, ny]);
    this.blank(`${shape[0]} × ${shape[1]} cells`);
    say(this.said, [`This surface has ${shape[0]} × ${shape[1]} cells. The page describes up to ${Math.sqrt(MAX_CELLS)} × ${Math.sqrt(MAX_CELLS)}.`],
      [[`Take ${nx} × ${ny} cells${isFile ? " in the middle" : ""}`, take]]);
    return null;
  }

  /** Removes map, profiles and numbers. */
  blank(summary) {
    this.about = null;
    this.maps.hidden = this.charts.hidden = true;
    this.summary.textContent = summary;
    this.found.replaceChildren();
  }

  draw(about, packed) {
    const { shape, pitch, extent, undefined: missing, findings, advice, format, channel } = about;
    const length = lengthUnit(Math.max(...extent));
    const unit = lengthUnit(Math.max(Math.abs(packed.low), Math.abs(packed.high)));
    const size = (values) => `${digits(values[0] / length.factor)} × ${digits(values[1] / length.factor)} ${length.symbol}`;
    const cell = lengthUnit(pitch[0]);
    this.summary.textContent = [format && `${format}${channel ? `, channel ${channel}` : ""}`, `${shape[0]} × ${shape[1]} cells of ${written(pitch[0], cell)}${pitch[1] === pitch[0] ? "" : ` × ${written(pitch[1], cell)}`}`,
      size(extent), missing > 0 && `${missing} heights missing`].filter(Boolean).join(", ");
    this.found.replaceChildren(...[...findings, advice].filter(Boolean).map((text) => element("li", {}, ...coded(text))));
    this.maps.hidden = this.charts.hidden = false;
    const title = `${this.side} body`;
    const region = shape.map((cells, k) => [0, cells * pitch[k]]);
    const body = { name: this.side, title, before: packed, change: null, unit, length };
    let at = region.map(([, end]) => end / 2);
    const range = [packed.low, packed.high];
    const scene = () => ({ region, length, lines: [{ from: [0, at[1]], to: [region[0][1], at[1]] }, { from: [at[0], 0], to: [at[0], region[1][1]] }],
      images: [{ packed, kind: "heights", range, corner: [0, 0], told: (v) => written(v, unit) }], bar: { range, unit, label: "height", kind: "heights" } });
    this.picked = (x, y) => { at = [x, y]; this.map.show(scene()); this.profiles.show(x, y); };
    this.map = this.map || this.#keyed(new MapView(this.maps, `Heights of the ${title}.`, `${this.side}-heights`, (x, y) => this.picked(x, y)));
    this.profiles = this.profiles || new Profiles(this.charts, body);
    this.profiles.body = body;
    this.moved = (dx, dy) => this.picked(...[dx, dy].map((d, k) => Math.min(region[k][1], Math.max(0, at[k] + (d * region[k][1]) / 32))));
    this.picked(...at);
  }

  /** Lets the arrow keys move the point of the profiles. */
  #keyed(map) {
    const keys = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] };
    map.canvas.tabIndex = 0;
    map.canvas.addEventListener("keydown", (event) => {
      if (!keys[event.key]) return;
      event.preventDefault();
      this.moved(...keys[event.key]);
    });
    return map;
  }
}

export class SurfaceSection {
  constructor(app) {
    this.app = app;
    this.bodies = SIDES.map((side) => new BodyView(app, side));
    const charts = document.getElementById("surface-charts");
    this.spectrum = new ChartPlace(charts, "power spectrum");
    this.ratio = new ChartPlace(charts, "material ratio");
    this.main = document.getElementById("main-parameters");
    this.table = document.querySelector("#parameters > div");
  }

  arrange() { this.bodies.forEach((body) => body.arrange()); }

  async update() {
    // A body without a grid takes that of the other body.
    const [lower, upper] = this.bodies;
    const isWhole = ({ topography }) => topography.file !== undefined || topography.shape;
    const order = isWhole(lower) ? [lower, upper] : [upper, lower];
    let grid = {};
    for (const body of order) {
      const about = await body.describe(grid);
      if (about) grid = { shape: about.shape, pitch: about.pitch };
    }
    this.compare();
  }

  /** Returns the table of the topography of a body, with its grid. */
  whole(side) { return this.bodies[SIDES.indexOf(side)].whole; }

  /** Shows curves and numbers of both bodies side by side. */
  compare() {
    const known = this.bodies.filter(({ about }) => about);
    const series = (of) => known.filter(({ about }) => about[of[0]]).map(({ side, about }) => ({ name: `${side} body`, mark: "line", x: about[of[0]][of[1]], y: about[of[0]][of[2]] }));
    this.spectrum.show(chart("spectrum", "power spectrum", [["wave number", "wavenumber", true], ["power", "power", true]], series(["spectrum", "wavenumber", "power"]), "Mean over all directions."));
    this.ratio.show(chart("material_ratio", "material ratio", [["material ratio", "share"], ["height", "length"]], series(["material_ratio", "ratio", "height"]), "Share of the surface above a height."));
    document.getElementById("parameters").hidden = known.length === 0;
    this.main.replaceChildren(...(known.length ? [parameters(known, (name) => MAIN.includes(name))] : []));
    this.table.replaceChildren(parameters(known));
  }
}

/** Returns the table of parameters with a column for each body. With `wanted`, only some parameters, and no titles. */
function parameters(known, wanted) {
  const sections = new Map();
  known.forEach(({ about }, column) => {
    for (const { title: whole, rows } of about.sections) {
      const title = wanted ? "" : whole;
      if (!sections.has(title)) sections.set(title, new Map());
      for (const { name, numbers, unit, remark } of rows.filter((row) => !wanted || wanted(row.name))) {
        const of = sections.get(title);
        if (!of.has(name)) of.set(name, { remark, values: known.map(() => "") });
        of.get(name).values[column] = `${numbers.join(" | ")} ${unit || ""}`.trim().replace(/(^|[ |e])-/g, "$1−");
      }
    }
  });
  const head = element("tr", {}, element("th", { scope: "col" }, "parameter"), ...known.map(({ side }) => element("th", { scope: "col" }, `${side} body`)), element("th", { scope: "col", class: "words" }, "meaning"));
  const body = [...sections].flatMap(([title, rows]) => [
    ...(title ? [element("tr", {}, element("th", { scope: "colgroup", colspan: known.length + 2 }, title))] : []),
    ...[...rows].map(([name, { values, remark }]) => element("tr", {}, element("th", { scope: "row" }, name), ...values.map((value) => element("td", {}, value)), element("td", { class: "words" }, remark || ""))),
  ]);
  return element("table", {}, element("thead", {}, head), element("tbody", {}, ...body));
}
