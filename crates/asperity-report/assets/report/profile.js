"use strict";
// Profiles of a body through a point: before and after, along x and along y.

class Profiles {
  constructor(place, body) {
    this.place = place;
    this.body = body;
    // Along an axis with a single cell there is none.
    this.axes = [0, 1].filter((axis) => body.before.shape[axis] > 1);
    this.views = [0, 1].map(() => element("figure", { class: "chart" }, element("figcaption", {}, element("span"))));
    place.append(...this.axes.map((axis) => this.views[axis]));
    this.charts = [null, null];
  }

  /** Shows the profiles through (x, y), m. */
  show(x, y) {
    const { before } = this.body;
    const at = [x, y].map((v, axis) => Math.max(0, Math.min(before.shape[axis] - 1, Math.floor(v / before.pitch[axis]))));
    this.axes.forEach((axis) => {
      const other = (at[1 - axis] + 0.5) * before.pitch[1 - axis];
      const title = `Profile of the ${this.body.title} along ${"xy"[axis]} at ${"yx"[axis]} = ${written(other, this.body.length)}.`;
      const chart = this.chart(axis, at, title);
      this.views[axis].querySelector("figcaption span").textContent = title;
      if (this.charts[axis]) this.charts[axis].show(chart);
      else this.charts[axis] = new ChartView(this.views[axis], chart);
    });
  }

  chart(axis, at, title) {
    const { before, change, unit, length, name } = this.body;
    const n = before.shape[axis];
    const along = (value) => Array.from({ length: n }, (_, k) => value(...(axis === 0 ? [k, at[1]] : [at[0], k])));
    const x = Array.from({ length: n }, (_, k) => (k + 0.5) * before.pitch[axis]);
    const series = [{ name: change ? "before" : "", mark: change ? "dashed" : "line", right: false, x, y: along((i, j) => cell(before, i, j)) }];
    if (change) series.push({ name: "after", mark: "line", right: false, x, y: along((i, j) => after(this.body, i, j)) });
    return {
      name: `profile_${name}_${"xy"[axis]}`, title, words: [], right: null, series,
      x: { ...length, label: "xy"[axis], si: "m", log: false, range: null },
      y: { ...unit, label: "height", si: "m", log: false, range: null },
    };
  }
}

/** The height of a cell after the last pass. */
function after(body, i, j) {
  return cell(body.before, i, j) + body.sign * cell(body.change, i, j);
}
