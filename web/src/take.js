// 4 Take away: case file, results, figures, prepared surfaces, and how to compute the case elsewhere.

import { Engine } from "./engine.js";
import { say } from "./form.js";
import { packed } from "./packing.js";
import { SIDES } from "./surface.js";
import { zipped } from "./zip.js";

const FORMATS = ["png", "svg", "pdf"];

export class TakeSection {
  constructor(app) {
    this.app = app;
    const part = (id) => document.getElementById(id);
    [this.text, this.apply, this.said, this.downloads, this.shell, this.python] = ["text", "apply", "case-said", "downloads", "shell", "python"].map(part);
    this.text.addEventListener("input", () => { this.apply.disabled = this.text.value === this.written; });
    this.apply.addEventListener("click", () => this.read());
    part("save-case").addEventListener("click", () => save("case.toml", new Blob([this.text.value])));
    part("share").addEventListener("click", () => this.share(part("share")));
  }

  /** Makes the text the case. */
  async read() {
    try {
      this.app.kase.replace(await this.app.desk.call("read_case", this.text.value), this.text.value);
      say(this.said);
    } catch (failure) {
      say(this.said, [failure]);
    }
  }

  async update() {
    const { kase, desk } = this.app;
    const text = kase.text ?? await desk.call("write_case", JSON.stringify(kase.tables));
    this.text.value = this.written = text;
    this.apply.disabled = true;
    try {
      await desk.call("put", "case.toml", new TextEncoder().encode(text));
      const { shell, python } = await desk.call("commands", "case.toml");
      [this.shell.textContent, this.python.textContent] = [shell, python];
    } catch {
      // The sections above show the mistake.
      this.shell.textContent = this.python.textContent = "";
    }
    this.hash = `#case=${await packed(text)}`;
    location.replace(this.hash);
  }

  async share(button) {
    const address = location.href.replace(/#.*/, "") + this.hash;
    try {
      await navigator.clipboard.writeText(address);
      button.textContent = "Copied";
      setTimeout(() => { button.textContent = "Copy address"; }, 1500);
    } catch {
      say(this.said, [`The browser does not let this page copy. The address is: ${address}`]);
    }
  }

  /** Offers the files that can be saved now. */
  offer() {
    const { app } = this;
    const runs = app.runs().filter((run) => run.page());
    const button = (title, act) => element("button", { type: "button", onclick: act }, title);
    const each = runs.flatMap((run) => {
      const tables = [...run.files.keys()].filter((name) => name.endsWith(".csv"));
      const words = { contact: "contact", motion: "motion", "over-load": "contact over the load" }[run.folder];
      return [element("p", {}, `Results of the ${words}:`), button("all files as zip", () => this.zip(run)),
        button("page", () => save(`${run.folder}.html`, new Blob([run.page()], { type: "text/html" }))),
        ...tables.map((name) => button(name.split("/").pop(), () => save(name.split("/").pop(), new Blob([run.files.get(name)], { type: "text/csv" })))),
        this.pictures(run)];
    });
    const surfaces = SIDES.map((side) => button(`${side} surface as x3p`, () => this.surface(side)));
    this.downloads.replaceChildren(...each, element("p", {}, "Prepared surfaces:"), ...surfaces);
  }

  /** Returns a button that lists the figures of a run. A figure is drawn when it is saved. */
  pictures(run) {
    const select = element("select", { "aria-label": "figure" });
    const format = element("select", { "aria-label": "format" }, ...FORMATS.map((name) => element("option", {}, name)));
    const draw = (work) => this.#with(run, work).catch((failure) => say(this.said, [failure]));
    const list = element("button", { type: "button", onclick: () => draw(async (engine) => {
      select.replaceChildren(...(await engine.call("figures", run.folder)).map((name) => element("option", {}, name)));
      list.replaceWith(select, format, saver);
      select.focus();
    }) }, "figures …");
    const saver = element("button", { type: "button", onclick: () => draw(async (engine) => {
      const bytes = await engine.call("figure", run.folder, select.value, format.value);
      save(`${select.value}.${format.value}`, new Blob([bytes]));
    }) }, "save figure");
    return list;
  }

  async #with(run, work) {
    const engine = new Engine();
    try {
      for (const [name, bytes] of run.files) await engine.call("put", name, bytes);
      await work(engine);
    } finally {
      engine.end();
    }
  }

  /** Saves the case, the files that it reads, and its results. */
  async zip(run) {
    const files = [["case.toml", new TextEncoder().encode(run.text)], ...run.inputs, ...run.files];
    save(`${run.folder}.zip`, await zipped(files));
  }

  async surface(side) {
    try {
      const table = this.app.surface.whole(side);
      save(`${side}.x3p`, new Blob([await this.app.desk.call("prepared", table, `${side}.x3p`)]));
    } catch (failure) {
      say(this.said, [failure]);
    }
  }
}
