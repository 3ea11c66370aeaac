// The page as a whole: the case, its files, and the four sections.

import { Case } from "./case.js";
import { ContactSection } from "./contact.js";
import { Desk } from "./engine.js";
import { isCase, listen, taken } from "./files.js";
import { bind, say } from "./form.js";
import { MotionSection } from "./motion.js";
import { unpacked } from "./packing.js";
import { SIDES, SurfaceSection } from "./surface.js";
import { TakeSection } from "./take.js";

/** Example with which the page opens. */
const FIRST = "measured";

class App {
  constructor() {
    this.kase = new Case();
    this.files = new Map();
    this.versions = new Map();
    this.desk = new Desk(this.files);
    this.said = document.getElementById("said");
    this.undo = document.getElementById("undo");
    this.surface = new SurfaceSection(this);
    this.contact = new ContactSection(this);
    this.motion = new MotionSection(this);
    this.take = new TakeSection(this);
    this.changes = Promise.resolve();
  }

  async open() {
    const [version, colours, materials, examples] = await Promise.all(["version", "colours", "materials", "examples"].map((call) => this.desk.call(call)));
    document.getElementById("version").textContent = version;
    for (const [name, text] of Object.entries(colours)) palettes[name] = palette(text);
    this.contact.build(materials);
    this.take.offer();
    bind(this.kase);
    this.kase.addEventListener("change", () => this.changed());
    this.undo.addEventListener("click", () => this.kase.undo());
    const select = document.getElementById("examples");
    select.append(element("option", { value: "" }, "–"), ...examples.map(({ name, about }) => element("option", { value: name }, `${name}: ${about}`)));
    select.addEventListener("change", () => select.value && this.example(select.value));
    listen((files, isFolder, side) => this.drop(files, isFolder, side));
    document.getElementById("files").addEventListener("change", async ({ target }) => {
      await this.drop(target.files);
      // Without this, choosing the same file again would be no change.
      target.value = "";
    });
    addEventListener("beforeunload", (event) => { if (this.runs().some((run) => run.running)) event.preventDefault(); });
    addEventListener("hashchange", () => { if (location.hash !== this.take.hash) this.address(); });
    for (const link of document.querySelectorAll(".bar nav a, .skip")) link.addEventListener("click", (event) => this.go(event, link.hash));
    if (!(await this.address())) await this.example(FIRST);
    document.documentElement.dataset.ready = "true";
  }

  /** Goes to a section, but keeps the case in the address. */
  go(event, hash) {
    event.preventDefault();
    const section = document.querySelector(hash);
    section.tabIndex = -1;
    section.focus({ preventScroll: true });
    section.scrollIntoView();
  }

  /** Opens the case in the address. Returns whether there is one. */
  async address() {
    const [, part] = location.hash.match(/^#case=([\w-]+)$/) || [];
    if (!part) return false;
    try {
      const text = await unpacked(part);
      this.kase.replace(await this.desk.call("read_case", text), text);
    } catch {
      await this.example(FIRST);
      say(this.said, ["The case in the address of this page is not whole: it may have been cut. Here is an example instead."]);
      return true;
    }
    const missing = this.kase.files().filter((name) => !this.files.has(name));
    if (missing.length) say(this.said, [`The case of this address reads ${missing.map((name) => `\`${name}\``).join(" and ")}: drop ${missing.length === 1 ? "that file" : "these files"} here.`]);
    return true;
  }

  async example(name) {
    const file = await this.desk.call("example", name);
    const folder = file.slice(0, file.lastIndexOf("/") + 1);
    const bytes = async (path) => [path.slice(folder.length), await this.desk.call("get", path)];
    const files = new Map(await Promise.all((await this.desk.call("files", folder.slice(0, -1))).map(({ name: path }) => bytes(path))));
    await this.load(new TextDecoder().decode(files.get(file.slice(folder.length))), files);
  }

  /** Opens a case from its text and its files. */
  async load(text, files) {
    const tables = await this.desk.call("read_case", text);
    for (const [name, content] of files) this.put(name, content);
    say(this.said);
    this.kase.replace(tables, text);
    await this.changes;
  }

  /** Stores a file, or another version of it. */
  put(name, content) {
    this.files.set(name, content);
    this.versions.set(name, (this.versions.get(name) || 0) + 1);
  }

  /** Opens files: surfaces, or a case. */
  async drop(list, isFolder, side) {
    const { files, sentences } = await taken(list, isFolder);
    say(this.said, sentences);
    const given = files.find(([name]) => isCase(name));
    const surfaces = files.filter((file) => file !== given);
    try {
      if (given) await this.load(new TextDecoder().decode(given[1]), surfaces);
      else if (surfaces.length) this.press(surfaces, side);
    } catch (failure) {
      say(this.said, [...sentences, failure]);
    }
  }

  /** Makes a case of one or two surfaces. If the case lacks files of these names, it gets them instead. */
  press(surfaces, side) {
    const awaited = this.kase.files().filter((path) => !this.files.has(path));
    const placed = surfaces.map(([name, content]) => [awaited.find((path) => path.split("/").pop() === name) ?? name, content]);
    for (const [name, content] of placed) this.put(name, content);
    const names = placed.map(([name]) => name);
    if (names.every((name) => awaited.includes(name))) { this.changed(); return; }
    const topography = (file) => ({ file, fill: "harmonic", level: "plane" });
    if (side && names.length === 1) {
      this.kase.change({ [`${side}.topography`]: topography(names[0]), "contact.grid": "common" });
      return;
    }
    const bodies = SIDES.map((of, n) => ({ material: this.kase.get(`${of}.material`) || "steel", topography: names[n] ? topography(names[n]) : { form: "flat" } }));
    const stem = (name) => name.replace(/\.[^.]*$/, "");
    const title = `${names[1] ? stem(names[1]) : "a plane"} on ${stem(names[0])}`;
    this.kase.replace({ title, lower: bodies[0], upper: bodies[1], contact: { mean_pressure: "20 MPa", grid: "common" } });
  }

  /** Brings all sections up to date. A later change ends the update of an earlier one. */
  changed() {
    const count = this.count = (this.count || 0) + 1;
    this.undo.disabled = !this.kase.canUndo;
    this.surface.arrange();
    this.changes = this.changes.then(async () => {
      for (const section of [this.take, this.surface, this.contact, this.motion]) {
        if (count !== this.count) return;
        await section.update();
      }
    }).catch((failure) => say(this.said, [failure]));
  }

  /** Returns the files that the case reads, as far as there are any. */
  inputs() {
    return this.kase.files().filter((name) => this.files.has(name)).map((name) => [name, this.files.get(name)]);
  }

  /** Brings both bodies, with these shapes and this pitch, to another pitch. */
  resample(shapes, pitch, coarser) {
    const changes = {};
    SIDES.forEach((side, n) => {
      const { file, shape } = this.kase.get(`${side}.topography`) || {};
      if (file === undefined && shape === undefined) return;
      changes[`${side}.topography.pitch`] = coarser;
      if (shape) changes[`${side}.topography.shape`] = shapes[n].map((cells, axis) => Math.max(1, Math.round((cells * pitch[axis]) / coarser[axis])));
    });
    this.kase.change(changes);
  }

  /** Returns all runs, finished or not. */
  runs() {
    return [this.contact, this.contact.sweep, this.motion].map(({ run }) => run).filter(Boolean);
  }

  finished() { this.take.offer(); }

  busy() {
    document.getElementById("over-load-section").hidden = !this.contact.sweep.run;
  }
}

const app = new App();
app.open().catch((failure) => say(app.said, [failure]));
