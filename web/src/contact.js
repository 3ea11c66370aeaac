// 2 Contact: materials, the load, and both bodies pressed together.

import { shown } from "./case.js";
import { Course } from "./course.js";
import { field } from "./form.js";
import { SIDES } from "./surface.js";

/** Quantities that may be prescribed, each with its title and its first value. */
const LOADS = { load: ["load", "0.5 N"], mean_pressure: ["mean pressure", "20 MPa"], approach: ["approach", "0 nm"] };
const SWEEPS = ["loads", "mean_pressures", "approaches"];
/** Longest estimated time of a contact that is computed after each change, s. */
const AT_ONCE = 5;
/** Decades of the slider on either side of the load that was typed. */
const DECADES = 2;
/** Number of loads of a sweep. */
const POINTS = 10;

export class ContactSection extends Course {
  constructor(app) {
    super(app, "contact", "results of the contact");
    this.sweep = new Course(app, "over-load", "results over the load");
    this.press = document.getElementById("press");
    this.atOnce = document.getElementById("at-once");
    this.overLoad = document.getElementById("over-load");
    this.press.addEventListener("click", () => this.start(app.kase.atRest()));
    this.overLoad.addEventListener("click", () => this.sweep.start(this.#swept()));
    this.atOnce.addEventListener("change", () => this.update());
  }

  /** Adds the fields of both materials and of the load. */
  build(materials) {
    const { kase } = this.app;
    this.materials = new Map(materials.map((material) => [material.name, material]));
    const names = [["", "custom"], ...materials.map(({ name, about }) => [name, about ? `${name}, ${about}` : name])];
    document.getElementById("materials").append(...SIDES.map((side) => {
      const select = element("select", { "aria-label": `material of the ${side} body`, onchange: () => this.#choose(side, select.value) }, ...names.map(([word, title]) => element("option", { value: word }, title)));
      select.dataset.material = side;
      return element("div", {}, element("h3", {}, `${side === "lower" ? "Lower" : "Upper"} body`), element("div", { class: "fields" },
        element("label", {}, "material", select), field(`${side}.young`, "Young's modulus"), field(`${side}.poisson`, "Poisson's ratio"), field(`${side}.hardness`, "hardness")));
    }));
    this.kind = element("select", { "aria-label": "what is prescribed", onchange: () => this.#prescribe(this.kind.value) });
    this.value = element("span");
    this.slider = element("input", { type: "range", min: -DECADES, max: DECADES, step: 0.02, "aria-label": "load, over decades", oninput: () => this.#slide() });
    document.getElementById("load").append(element("label", {}, "prescribed", this.kind), this.value, this.slider,
      field("contact.boundary", "edges", { choices: [["", "free"], ["periodic", "periodic"]] }));
    kase.addEventListener("change", () => this.arrange());
  }

  #choose(side, name) {
    const of = this.materials.get(name) || this.materials.get(this.app.kase.get(`${side}.material`)) || {};
    const own = name ? { young: undefined, poisson: undefined, hardness: undefined } : Object.fromEntries(["young", "poisson", "hardness"].map((key) => [key, of[key] ?? undefined]));
    this.app.kase.change({ [`${side}.material`]: name || undefined, ...Object.fromEntries(Object.entries(own).map(([key, value]) => [`${side}.${key}`, value])) });
  }

  #prescribe(word) {
    const all = [...Object.keys(LOADS), ...SWEEPS];
    this.app.kase.change({ ...Object.fromEntries(all.map((key) => [`contact.${key}`, undefined])), [`contact.${word}`]: LOADS[word][1] });
  }

  /** Brings the fields up to date with the case. */
  arrange() {
    const { kase } = this.app;
    for (const side of SIDES) {
      const name = kase.get(`${side}.material`) || "";
      document.querySelector(`[data-material="${side}"]`).value = name;
      const of = this.materials.get(name) || {};
      for (const [key, digitsOf] of [["young", (v) => `${digits(v / 1e9)} GPa`], ["poisson", digits], ["hardness", (v) => `${digits(v / 1e9)} GPa`]]) {
        document.querySelector(`[data-key="${side}.${key}"]`).placeholder = of[key] ? digitsOf(of[key]) : key === "hardness" ? "inf: elastic" : "";
      }
    }
    const swept = SWEEPS.find((key) => kase.get(`contact.${key}`) !== undefined);
    const word = swept || Object.keys(LOADS).find((key) => kase.get(`contact.${key}`) !== undefined) || "load";
    if (this.word !== word) {
      this.word = word;
      const options = [...Object.entries(LOADS).map(([key, [title]]) => [key, title]), ...(swept ? [[swept, `several ${swept.replace("_", " ")}`]] : [])];
      this.kind.replaceChildren(...options.map(([key, title]) => element("option", { value: key }, title)));
      this.kind.value = word;
      const plain = element("input", { type: "text", "data-key": `contact.${word}`, "aria-label": swept ? "values" : LOADS[word][0], autocomplete: "off" });
      this.value.replaceChildren(swept ? "as the case file lists them" : plain);
      this.input = swept ? null : plain;
      if (this.input) this.input.value = shown(kase.get(`contact.${word}`));
    }
    const text = shown(kase.get(`contact.${word}`));
    this.slider.hidden = !/^\s*\d/.test(text) || word === "approach" || Boolean(swept);
    if (text !== this.slid) {
      this.origin = text;
      this.slider.value = 0;
    }
    this.slider.setAttribute("aria-valuetext", text);
    this.overLoad.hidden = Boolean(swept) || word === "approach" || !kase.moves && ["friction", "history", "sliding", "steady", "plasticity"].some((table) => kase.get(table));
  }

  /** Sets the load by the slider, in decades from the load that was typed. */
  #slide() {
    const [, number, unit] = this.origin.match(/^\s*([\d.eE+_-]+)\s*(.*)$/);
    const scaled = Number((Number(number.replaceAll("_", "")) * 10 ** Number(this.slider.value)).toPrecision(3));
    this.input.value = this.slid = unit ? `${scaled} ${unit}` : String(scaled);
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.app.kase.set(this.input.dataset.key, unit ? this.slid : scaled), 150);
  }

  /** Returns the tables of a sweep of loads up to the prescribed load. */
  #swept() {
    const tables = this.app.kase.atRest();
    const { [this.word]: last, ...contact } = tables.contact;
    const [, number, unit] = shown(last).match(/^\s*([\d.eE+_-]+)\s*(.*)$/);
    const first = Number((Number(number) * 1e-2).toPrecision(6));
    return { ...tables, contact: { ...contact, [`${this.word}s`]: { from: unit ? `${first} ${unit}` : first, to: last, points: POINTS } } };
  }

  /** Checks the case, and computes a small contact. */
  async update() {
    const tables = this.app.kase.atRest();
    const isOld = this.outdated(tables);
    if (this.sweep.run && !this.overLoad.hidden) this.sweep.outdated(this.#swept());
    const found = await this.check(tables);
    if (isOld && found && this.atOnce.checked && found.seconds <= AT_ONCE && !found.coarser) this.start(tables).catch((failure) => this.fail(failure));
  }
}
