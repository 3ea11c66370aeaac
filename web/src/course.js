// A case that is checked and run: cost, warnings, progress, growing curves, results.

import { LiveCharts } from "./charts.js";
import { Run } from "./engine.js";
import { coded, mark, say } from "./form.js";
import { ReportFrame } from "./report.js";

/** Cells along a side beyond which the page recommends the command. */
const MANY = 1024;

/** Returns a number of bytes in MB or GB. */
export function bytes(count) {
  return count >= 1e9 ? `${digits(Number((count / 1e9).toPrecision(2)))} GB` : `${Math.max(1, Math.round(count / 1e6))} MB`;
}

function seconds(time) {
  if (time < 1) return "less than a second";
  return time < 90 ? `about ${Math.round(time)} s` : time < 5400 ? `about ${Math.round(time / 60)} min` : `about ${Math.round(time / 3600)} h`;
}

export class Course {
  /** `name` is the name of the elements of the section, and of the folder of the results. */
  constructor(app, name, title) {
    Object.assign(this, { app, name, run: null });
    const part = (what) => document.getElementById(`${name}-${what}`);
    [this.checked, this.said, this.stopButton, this.bar] = ["check", "said", "stop", "progress"].map(part);
    this.live = new LiveCharts(part("live"));
    this.report = new ReportFrame(part("report"), title);
    this.meter = element("progress", { max: 1, value: 0, "aria-label": `progress: ${title}` });
    this.text = element("span");
    this.bar.append(this.meter, this.text);
    this.stopButton.addEventListener("click", () => this.stop());
  }

  get running() { return Boolean(this.run && this.run.running); }

  /** Shows cost and warnings of tables before they are run. Returns the answer of the module, or `null` for a mistake. */
  async check(tables) {
    const { app } = this;
    try {
      const text = await app.desk.call("write_case", JSON.stringify(tables));
      await app.desk.call("put", `${this.name}.toml`, new TextEncoder().encode(text));
      const found = await app.desk.call("check", `${this.name}.toml`);
      this.checked.replaceChildren(...this.#words(found));
      say(this.said);
      return this.found = found;
    } catch (failure) {
      this.checked.replaceChildren();
      this.fail(failure);
      return this.found = null;
    }
  }

  #words({ shapes, pitch, memory, seconds: time, warnings, rows, coarser }) {
    const cells = shapes.map(([nx, ny]) => `${nx} × ${ny}`);
    const lines = [element("p", {}, `${cells[0] === cells[1] ? cells[0] : cells.join(" and ")} cells, ${bytes(memory)} of memory, ${seconds(time)} in this browser.`)];
    if (coarser) {
      lines.push(element("p", { class: "warning" }, `This needs ${bytes(memory)}, and a browser tab has 1.5 GB for sure. Cells of ${written(coarser.pitch[0], lengthUnit(coarser.pitch[0]))} need ${bytes(coarser.memory)}. `,
        element("button", { type: "button", onclick: () => this.app.resample(shapes, pitch, coarser.pitch) }, "Take these cells")));
    }
    if (shapes.some((shape) => Math.max(...shape) > MANY)) {
      lines.push(element("p", { class: "warning" }, `Beyond ${MANY} × ${MANY} cells the command is the better place: it uses all cores of this machine. Its lines stand under `, element("a", { href: "#take" }, "Take away"), "."));
    }
    if (warnings.length) lines.push(element("div", { class: "warning" }, element("ul", {}, ...warnings.map((text) => element("li", {}, ...coded(text))))));
    const facts = element("table", { class: "facts" }, element("tbody", {}, ...rows.map(({ name, text }) => element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, text)))));
    lines.push(element("details", {}, element("summary", {}, "What asperity check says"), facts));
    return lines;
  }

  /** Returns whether the results belong to other tables than these, and fades them if so. */
  outdated(tables) {
    this.present = tables;
    const old = this.computed !== this.#identity(tables);
    this.report.old = old;
    return old;
  }

  /** Returns a text that is the same for the same tables and the same files. */
  #identity(tables) {
    return JSON.stringify([tables, this.app.inputs().map(([name]) => [name, this.app.versions.get(name)])]);
  }

  /** Runs tables from the beginning, in place of a run in progress. */
  async start(tables) {
    this.present = tables;
    const identity = this.computed = this.#identity(tables);
    const text = await this.app.desk.call("write_case", JSON.stringify(tables));
    if (identity !== this.computed) return;
    if (this.running) this.run.stop();
    const inputs = this.app.inputs();
    this.live.clear();
    this.run = new Run(inputs, text, this.name, (event) => this.hear(event));
    await this.#go(this.run);
  }

  /** Continues a stopped run. */
  async resume() { await this.#go(this.run); }

  async #go(run) {
    this.meter.value = 0;
    this.text.textContent = "";
    this.#busy(true);
    try {
      await run.go();
      if (run === this.run) {
        say(this.said);
        this.show();
      }
    } catch (failure) {
      if (run === this.run && failure.name !== "Stopped") {
        this.computed = null;
        this.fail(failure);
      }
    } finally {
      if (run === this.run) this.#busy(false);
    }
  }

  /** Stops the run, and shows its finished part. */
  async stop() {
    const { run } = this;
    run.stop();
    this.#busy(false);
    try {
      await run.report();
      if (run.page()) this.show();
      say(this.said, [run.page() ? "Stopped. The finished part is below." : "Stopped before anything was finished."]);
    } catch (failure) {
      say(this.said, ["Stopped.", failure]);
    }
  }

  show() {
    this.report.show(this.run.page(), () => {
      // The report has these curves too.
      this.live.clear();
      // The case may have changed since the run began.
      this.outdated(this.present);
    });
    this.app.finished();
  }

  hear(event) {
    if (event.kind === "progress") {
      this.meter.value = event.part;
      this.text.textContent = event.text;
    }
    if (event.kind === "step") {
      this.text.textContent = `${event.step} ${event.number}${event.of ? ` of ${event.of}` : ""}`;
      this.live.add(event);
    }
  }

  fail(failure) {
    say(this.said, [failure]);
    mark(failure);
  }

  #busy(busy) {
    this.stopButton.hidden = this.bar.hidden = !busy;
    this.app.busy();
  }
}
