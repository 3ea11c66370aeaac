// Curves, drawn with the charts of the report.

/** Units of each quantity as [symbol, factor], the largest first. */
const UNITS = {
  length: [["m", 1], ["mm", 1e-3], ["µm", 1e-6], ["nm", 1e-9], ["pm", 1e-12]],
  area: [["m²", 1], ["mm²", 1e-6], ["µm²", 1e-12]],
  force: [["kN", 1e3], ["N", 1], ["mN", 1e-3], ["µN", 1e-6], ["nN", 1e-9]],
  wavenumber: [["rad/µm", 1e6]],
  power: [["µm⁴", 1e-24]],
  share: [["%", 0.01]],
  count: [["", 1]],
};
const SI = { length: "m", area: "m²", force: "N", wavenumber: "rad/m", power: "m⁴", share: "1", count: "1" };

function axis(label, quantity, values, log = false) {
  const largest = Math.max(0, ...values.map(Math.abs).filter(Number.isFinite));
  const units = UNITS[quantity];
  const [symbol, factor] = units.find(([, size]) => largest >= size) || units[units.length - 1];
  return { label, symbol, factor, si: SI[quantity], log, range: null, whole: quantity === "count" };
}

/** Returns the data of a chart. A series is {name, x, y}, an axis [label, quantity, log]. */
export function chart(name, title, [x, y], series, caption = "") {
  const all = (of) => series.flatMap((each) => each[of]);
  return {
    name, title, caption, right: null, words: [], series: series.map((each) => ({ mark: "lineandpoints", right: false, ...each })),
    x: axis(x[0], x[1], all("x"), x[2]), y: axis(y[0], y[1], all("y"), y[2]),
  };
}

/** A chart that is hidden until it has numbers. */
export class ChartPlace {
  constructor(place, title) {
    this.title = title;
    this.figure = element("figure", { class: "chart", hidden: true }, element("figcaption", {}, element("span", {}, sentence(title))));
    place.append(this.figure);
  }

  show(of) {
    this.figure.hidden = !of.series.some(({ x }) => x.length > 0);
    if (this.figure.hidden) return;
    if (this.view) this.view.show(of);
    else this.view = new ChartView(this.figure, of);
  }
}

/** Charts of a run in progress. For each kind of step: name, title, axes, column along x, and the columns of its series. */
const LIVE = {
  pass: [
    ["running_in", "roughness over the passes", ["pass", "count"], ["Sq", "length"], "pass", { "lower body": "sq_lower", "upper body": "sq_upper" }],
    ["area", "real contact area over the passes", ["pass", "count"], ["real contact area", "area"], "pass", { "": "mean_contact_area" }],
  ],
  point: [["over_load", "real contact area over the load", ["load", "force", true], ["real contact area", "area", true], "load", { "": "contact_area" }]],
  update: [["updates", "real contact area over the distance", ["distance", "length"], ["real contact area", "area"], "distance", { "": "contact_area" }]],
};

export class LiveCharts {
  constructor(place) {
    this.place = place;
    this.clear();
  }

  clear() {
    this.place.replaceChildren();
    this.records = [];
    this.places = null;
  }

  /** Adds a step of the run. */
  add({ step, record }) {
    if (!record || !LIVE[step]) return;
    this.places = this.places || LIVE[step].map(([, title]) => new ChartPlace(this.place, title));
    this.records.push(record);
    LIVE[step].forEach(([name, title, x, y, over, columns], n) => {
      const series = Object.entries(columns).map(([of, column]) => ({ name: of, x: this.records.map((each) => each[over]), y: this.records.map((each) => each[column]) }));
      this.places[n].show(chart(name, title, [x, y], series));
    });
  }
}
