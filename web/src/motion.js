// 3 Motion: passes of the upper body over the lower one.

import { Course } from "./course.js";
import { field } from "./form.js";

/** Number of positions of a proposed pass. */
const POSITIONS = 32;
const PASSES = 3;

export class MotionSection extends Course {
  constructor(app) {
    super(app, "motion", "results of the motion");
    const { kase } = app;
    const words = (...all) => ({ choices: [["", "–"], ...all] });
    document.getElementById("passes").append(
      field("motion.passes", "passes", { placeholder: String(PASSES) }), field("motion.stride", "stride, cells", { placeholder: "1" }),
      field("motion.strategy", "motion", { choices: [["", "overlap: one passes over the other"], ["shift", "shift: both are periodic"]] }),
      field("motion.control", "prescribed", words(["pass-load", "mean load of a pass"], ["step-load", "load at each position"], ["approach", "approach"])),
      field("motion.path", "path", { choices: [["", "one way"], ["reciprocating", "reciprocating"]] }),
      field("motion.speed", "speed", { placeholder: "0.5 m/s" }),
      field("friction.coefficient", "coefficient of friction", { placeholder: "none" }),
      field("lower.wear.coefficient", "wear of the lower body", { placeholder: "1e-7 mm3/(N m)" }), field("upper.wear.coefficient", "wear of the upper body", { placeholder: "1e-7 mm3/(N m)" }),
      field("output.pressure_every", "keep each n-th position"));
    this.button = document.getElementById("run");
    this.again = document.getElementById("continue");
    this.button.addEventListener("click", () => (kase.moves ? this.start(kase.tables) : this.propose()));
    this.again.addEventListener("click", () => { this.again.hidden = true; this.resume(); });
  }

  /** Adds passes with a coarse stride to a static case, and runs it. */
  async propose() {
    const { kase } = this.app;
    const found = await this.app.contact.check(kase.atRest());
    if (!found) return;
    const stride = Math.max(1, Math.round((found.shapes[0][0] + found.shapes[1][0]) / POSITIONS));
    // Only bodies that are free along x pass over each other.
    const along = [kase.get("contact.boundary")].flat()[0];
    const motion = { passes: PASSES, stride, ...(along === "periodic" && { strategy: "shift" }) };
    kase.change({ motion, output: { pressure_every: 1 } });
    await this.start(kase.tables);
  }

  async update() {
    const { kase, contact } = this.app;
    const isOld = this.outdated(kase.tables);
    // The contact has been checked before. A case with a course of its own takes no passes.
    const isCourse = !kase.moves && contact.found?.one_increment === false;
    this.button.hidden = isCourse;
    this.button.textContent = kase.moves ? "Run" : "Propose passes and run";
    if (isOld) this.again.hidden = true;
    if (kase.moves) await this.check(kase.tables);
    else this.checked.replaceChildren(isCourse ? "This case has a course of its own, without passes. Press computes it." : "");
  }

  async stop() {
    await super.stop();
    this.again.hidden = false;
  }
}
