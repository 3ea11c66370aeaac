"use strict";
// Curves: uPlot draws axes and zooms, series are drawn here; the nearest point is read, all points saved as CSV.

const SHADE = "rgba(0,114,178,0.16)";
const SERIES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", null];

class ChartView {
  constructor(place, chart) {
    this.place = place;
    this.hidden = new Set();
    this.host = element("div");
    this.legend = element("div", { class: "legend" });
    this.readout = element("output", { "aria-live": "off" });
    const csv = element("button", { type: "button", "aria-label": `CSV of ${chart.title}`, onclick: () => this.saveCsv() }, "CSV");
    place.querySelector("figcaption").append(csv);
    const about = element("p", { class: "caption" }, chart.caption || "");
    place.append(this.host, this.legend, about, element("div", { class: "readout" }, this.readout));
    new ResizeObserver(() => this.resize()).observe(place);
    redraws.add(() => this.show(this.chart));
    this.show(chart);
  }

  show(chart) {
    const curves = ({ title, colours, series }) => [title, colours, series.length].join();
    if (this.chart && curves(this.chart) !== curves(chart)) this.hidden.clear();
    this.chart = chart;
    this.explain();
    this.redraw();
  }

  /** The curve that a series belongs to: its own, or that of its colour. */
  curve(n) {
    const { colour } = this.chart.series[n];
    return colour === undefined ? n : colour;
  }

  colour(n) { return SERIES[this.curve(n) % SERIES.length] || style("--ink"); }

  /** The legend; where it has several names, each is a button that hides and shows its curve. */
  explain() {
    const { series, colours } = this.chart;
    const named = series.map((_, n) => n).filter((n) => series[n].name);
    const entry = (n) => {
      const s = series[n];
      const words = [element("i", { class: s.mark === "dashed" ? "dashed" : "", style: `color:${this.colour(n)}` }), s.name + (s.right ? " (right axis)" : "")];
      if (named.length < 2) return element("span", {}, ...words);
      const shown = () => String(!this.hidden.has(this.curve(n)));
      const button = element("button", { type: "button", "aria-pressed": shown(), onclick: () => {
        if (!this.hidden.delete(this.curve(n))) this.hidden.add(this.curve(n));
        button.setAttribute("aria-pressed", shown());
        this.redraw();
      } }, ...words);
      return button;
    };
    const { shaded } = this.chart;
    const area = shaded && shaded.areas.length ? [element("span", {}, element("i", { class: "box", style: `background:${SHADE}` }), shaded.name)] : [];
    this.legend.replaceChildren(...(colours ? [element("span", {}, `${colours}:`)] : []), ...named.map(entry), ...area);
  }

  redraw() {
    const { chart } = this;
    if (this.plot) this.plot.destroy();
    const [ink, line] = [style("--ink"), style("--line")];
    const bounds = (s) => [s.y, s.low || [], s.high || []].map((all) => all.map((y) => plotted(y, axisOf(s))));
    const all = chart.series.map((_, n) => n);
    const visible = all.filter((n) => !this.hidden.has(this.curve(n)));
    this.shown = visible.map((n) => chart.series[n]);
    // uPlot needs a series. Where all curves are hidden, their axes stay.
    const place = visible.length ? visible : all;
    const series = place.map((n) => chart.series[n]);
    const colour = (k) => this.colour(place[k]);
    const axisOf = (s) => (s.right ? chart.right : chart.y);
    const points = series.map((s) => [s.x.map((x) => plotted(x, chart.x)), s.y.map((y) => plotted(y, axisOf(s)))]);
    const spans = {
      x: span(points.map((p) => p[0]), chart.x, false),
      y: span(series.filter((s) => !s.right).flatMap(bounds), chart.y, series.some((s) => s.mark === "bars")),
    };
    // Words beside the lowest and the highest point have room.
    if (chart.words.length) { const room = 0.08 * (spans.y[1] - spans.y[0]); spans.y = [spans.y[0] - room, spans.y[1] + room]; }
    if (chart.right) spans.right = span(points.filter((_, n) => series[n].right).map((p) => p[1]), chart.right, false);
    const scale = (name) => ({
      time: false,
      range: (_, min, max) => (Number.isFinite(min) && max > min && this.zoomed ? [min, max] : spans[name]),
    });
    const axis = (name, of, side) => ({
      scale: name, side, stroke: ink, grid: { stroke: line, width: 1, show: name !== "right" }, ticks: { stroke: line, width: 1 },
      label: of.symbol ? `${of.label} (${of.symbol})` : of.label, labelSize: 22, labelFont: FONT, font: FONT,
      size: name === "x" ? 34 : labelsWidth, space: name === "x" ? 55 : 34,
      ...(of.log ? { splits: (u, _, min, max) => decades(min, max) } : {}),
      ...(of.whole ? { incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1e3, 2e3, 5e3, 1e4, 2e4, 5e4, 1e5] } : {}),
      values: (_, all) => labels(all, of.log),
    });
    const options = {
      mode: 2, width: this.width(), height: this.height(), legend: { show: false },
      scales: { x: scale("x"), y: scale("y"), ...(chart.right ? { right: scale("right") } : {}) },
      axes: [axis("x", chart.x, 2), axis("y", chart.y, 3), ...(chart.right ? [axis("right", chart.right, 1)] : [])],
      series: [{}, ...series.map((s, n) => ({
        facets: [{ scale: "x", auto: true }, { scale: s.right ? "right" : "y", auto: true }],
        stroke: colour(n), paths: (u) => { if (visible.length) drawSeries(u, s, points[n], colour(n), chart); return null; },
      }))],
      cursor: { points: { show: false }, drag: { x: true, y: false, setScale: false }, dataIdx: () => null },
      hooks: {
        setCursor: [(u) => this.read(u, points)],
        setSelect: [(u) => this.zoom(u)],
        drawClear: [(u) => { if (chart.shaded) drawShaded(u, chart); }],
        draw: [(u) => { drawWords(u, chart, ink); if (this.marked) drawMark(u, this.marked, chart, ink); }],
      },
    };
    this.zoomed = false;
    this.plot = new uPlot(options, [null, ...points], this.host);
    this.plot.over.addEventListener("dblclick", () => { this.zoomed = false; this.plot.setScale("x", { min: null, max: null }); });
    const canvas = this.host.querySelector("canvas");
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${chart.title}: ${chart.y.label} over ${chart.x.label}`);
  }

  /** Marks the place of a state on the curve; none for null. */
  point(at) {
    this.marked = at;
    this.plot.redraw(false);
  }

  width() { return Math.max(200, this.place.clientWidth); }
  /** So high that the words at the axes have room. */
  height() {
    const letters = Math.max(...[this.chart.y, this.chart.right].map((axis) => (axis ? axis.label.length + axis.symbol.length + 3 : 0)));
    return Math.max(Math.min(340, Math.max(220, 0.62 * this.width())), 80 + 6.6 * letters);
  }

  resize() {
    if (this.plot && this.plot.width !== this.width()) this.plot.setSize({ width: this.width(), height: this.height() });
  }

  zoom(u) {
    const { left, width } = u.select;
    if (width < 4) return;
    this.zoomed = true;
    u.setScale("x", { min: u.posToVal(left, "x"), max: u.posToVal(left + width, "x") });
    u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  }

  /** The point nearest to the cursor. */
  read(u, points) {
    const { left, top } = u.cursor;
    if (this.shown.length === 0 || left === undefined || left < 0) { this.readout.textContent = ""; return; }
    let [nearest, best] = [Infinity, null];
    points.forEach(([xs, ys], n) => {
      const s = this.shown[n];
      for (let k = 0; k < xs.length; k++) {
        const d = Math.hypot(u.valToPos(xs[k], "x") - left, 0.5 * (u.valToPos(ys[k], s.right ? "right" : "y") - top));
        if (d < nearest) [nearest, best] = [d, [s, xs[k], ys[k]]];
      }
    });
    if (!best) return;
    const [s, x, y] = best;
    const { x: horizontal } = this.chart;
    const vertical = s.right ? this.chart.right : this.chart.y;
    const number = (v, of) => `${digits(of.log ? 10 ** v : v)} ${of.symbol}`.trim();
    this.readout.textContent = `${s.name ? `${s.name}: ` : ""}${number(x, horizontal)}, ${number(y, vertical)}`;
  }

  /** All points, SI, to the last digit; series over the same numbers share their column. */
  csv() {
    const { x, series } = this.chart;
    const columns = [];
    const same = (a, b) => a.length === b.length && a.every((v, k) => v === b[k]);
    const head = (label, unit) => `"${`${label} (${unit})`.replaceAll('"', '""')}"`;
    let over = null;
    for (const s of series) {
      const axis = s.right ? this.chart.right : this.chart.y;
      if (!over || !same(over, s.x)) columns.push([head(x.label, x.si || "1"), s.x]);
      over = s.x;
      const named = (what) => head([axis.label, s.name, what].filter(Boolean).join(", "), axis.si || "1");
      columns.push([head(s.name ? `${axis.label}, ${s.name}` : axis.label, axis.si || "1"), s.y]);
      if (s.low) columns.push([named("standard deviation"), s.deviation], [head(s.name ? `cases, ${s.name}` : "cases", "1"), s.count]);
    }
    const rows = Math.max(0, ...columns.map(([, values]) => values.length));
    const lines = [columns.map(([name]) => name).join(",")];
    for (let k = 0; k < rows; k++) lines.push(columns.map(([, values]) => (values[k] === null || values[k] === undefined ? "" : String(values[k]))).join(","));
    return `${lines.join("\n")}\n`;
  }

  saveCsv() {
    save(`${this.chart.name}.csv`, new Blob([this.csv()], { type: "text/csv" }));
  }
}

/** The room that the labels of an axis of y need. */
function labelsWidth(u, all) {
  const longest = Math.max(0, ...(all || []).map((text) => text.length));
  return Math.max(44, 24 + 7.2 * longest);
}

/** A number, SI, as it is plotted on an axis: in its unit, or the decimal logarithm of that; NaN where it cannot be. */
function plotted(v, axis) {
  if (v === null) return NaN;
  const shown = v / axis.factor;
  return axis.log ? (shown > 0 ? Math.log10(shown) : NaN) : shown;
}

/** First and last number of an axis as plotted, with some room; of a logarithmic one at most so many decades. */
function span(all, axis, fromZero) {
  const DECADES = 14;
  if (axis.range && !axis.log) return axis.range.map((v) => v / axis.factor);
  let [low, high] = [Infinity, -Infinity];
  for (const values of all) for (const v of values) if (Number.isFinite(v)) { low = Math.min(low, v); high = Math.max(high, v); }
  if (low > high) return axis.log ? [-1, 0] : [0, 1];
  if (axis.log) {
    low = Math.max(low, high - DECADES);
    const room = Math.max(0.05 * (high - low), high - low < 0.3 ? 0.2 : 0.04);
    return [low - room, high + room];
  }
  if (fromZero) low = Math.min(0, low);
  const room = 0.04 * (high - low) || 0.05 * Math.abs(high) || 1;
  return [fromZero && low === 0 ? 0 : low - room, high + room];
}

/** Decimal logarithms of powers of ten, some of them where there are many, and of numbers between where there are few. */
function decades(min, max) {
  const [first, last] = [Math.floor(min + 1e-9), Math.ceil(max - 1e-9)];
  const stride = Math.max(1, Math.ceil((last - first) / 6));
  const between = max - min > 2.2 ? [1] : [1, 2, 5];
  const all = [];
  for (let e = first; e <= last; e += stride) for (const m of between) all.push(e + Math.log10(m));
  return all.filter((v) => v >= min - 1e-9 && v <= max + 1e-9);
}

/** What stands at the ticks; of a logarithmic axis these are decimal logarithms, said as powers of ten where one of them is far from 1. */
function labels(all, log) {
  const plain = all.every((v) => v === null || (v >= -3 - 1e-9 && v < 5));
  const one = (v) => (log ? (plain ? digits(10 ** v) : power(v)) : round(v));
  return all.map((v) => (v === null ? "" : one(v)));
}

/** A number by its decimal logarithm: 2·10⁻⁷. */
function power(v) {
  const exponent = Math.floor(v + 1e-9);
  const mantissa = 10 ** (v - exponent);
  const raised = String(exponent).replace(/./g, (d) => (d === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[d]));
  return `${Math.abs(mantissa - 1) > 1e-6 ? `${digits(mantissa)}·` : ""}10${raised}`;
}

function drawSeries(u, s, [xs, ys], colour, chart) {
  const c = u.ctx;
  const ratio = devicePixelRatio || 1;
  const scale = s.right ? "right" : "y";
  const place = (k) => {
    const ok = Number.isFinite(xs[k]) && Number.isFinite(ys[k]);
    return ok ? [u.valToPos(xs[k], "x", true), u.valToPos(ys[k], scale, true)] : null;
  };
  c.save();
  // A marker at the edge is drawn in full.
  const room = 4 * ratio;
  c.beginPath();
  c.rect(u.bbox.left - room, u.bbox.top - room, u.bbox.width + 2 * room, u.bbox.height + 2 * room);
  c.clip();
  c.strokeStyle = c.fillStyle = colour;
  c.lineWidth = 1.6 * ratio;
  if (s.low) band(c, u, s, xs, scale, chart);
  if (s.mark === "bars") {
    const width = xs.length > 1 ? u.valToPos(xs[1], "x", true) - u.valToPos(xs[0], "x", true) : 8 * ratio;
    const zero = u.valToPos(0, scale, true);
    for (let k = 0; k < xs.length; k++) { const at = place(k); if (at) c.fillRect(at[0] - 0.46 * width, at[1], 0.92 * width, zero - at[1]); }
  } else if (s.mark !== "points") {
    c.setLineDash(s.mark === "dashed" ? [6 * ratio, 4 * ratio] : []);
    c.beginPath();
    let drawn = false;
    for (let k = 0; k < xs.length; k++) {
      const at = place(k);
      if (at && drawn) c.lineTo(...at);
      else if (at) c.moveTo(...at);
      drawn = at !== null;
    }
    c.stroke();
  }
  if (s.mark === "points" || (s.mark === "lineandpoints" && xs.length <= 60)) {
    for (let k = 0; k < xs.length; k++) { const at = place(k); if (at) { c.beginPath(); c.arc(at[0], at[1], 3 * ratio, 0, 7); c.fill(); } }
  }
  if (s.mark === "arrows") arrows(c, xs.map((_, k) => place(k)).filter(Boolean), ratio);
  c.restore();
}

/** The range of values around a line. */
function band(c, u, s, xs, scale, chart) {
  const edge = (values) => values.map((y, k) => [u.valToPos(xs[k], "x", true), u.valToPos(plotted(y, chart.y), scale, true)]);
  c.save();
  c.globalAlpha = 0.18;
  c.beginPath();
  for (const at of [...edge(s.high), ...edge(s.low).reverse()]) c.lineTo(...at);
  c.fill();
  c.restore();
}

/** Arrows along a line, some way from each other. */
function arrows(c, points, ratio) {
  let since = 0;
  for (let k = 1; k < points.length; k++) {
    const [[x0, y0], [x1, y1]] = [points[k - 1], points[k]];
    const length = Math.hypot(x1 - x0, y1 - y0);
    since += length;
    if (since < 60 * ratio || length === 0) continue;
    since = 0;
    const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length];
    const [mx, my, a] = [(x0 + x1) / 2, (y0 + y1) / 2, 7 * ratio];
    c.beginPath();
    c.moveTo(mx + a * ux, my + a * uy);
    c.lineTo(mx - 0.5 * a * uy, my + 0.5 * a * ux);
    c.lineTo(mx + 0.5 * a * uy, my - 0.5 * a * ux);
    c.fill();
  }
}

/** Areas under the curves, each within a line of points. */
function drawShaded(u, chart) {
  const c = u.ctx;
  c.save();
  c.beginPath();
  c.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
  c.clip();
  c.fillStyle = SHADE;
  for (const area of chart.shaded.areas) {
    c.beginPath();
    for (const [x, y] of area) c.lineTo(u.valToPos(plotted(x, chart.x), "x", true), u.valToPos(plotted(y, chart.y), "y", true));
    c.fill();
  }
  c.restore();
}

function drawWords(u, chart, ink) {
  const c = u.ctx;
  const ratio = devicePixelRatio || 1;
  c.save();
  c.fillStyle = ink;
  c.font = `${11 * ratio}px system-ui, sans-serif`;
  const line = 13 * ratio;
  const placed = [];
  for (const [[x, y], words] of chart.words) {
    const [px, py] = [u.valToPos(plotted(x, chart.x), "x", true), u.valToPos(plotted(y, chart.y), "y", true)];
    const right = px > u.bbox.left + u.bbox.width / 2;
    c.textAlign = right ? "right" : "left";
    const at = [px + (right ? -8 : 8) * ratio, py + (right ? -8 : 16) * ratio];
    const wide = c.measureText(words).width;
    const left = right ? at[0] - wide : at[0];
    // Words of neighbours stand below each other.
    while (placed.some(([l, w, b]) => left < l + w && l < left + wide && Math.abs(b - at[1]) < line)) at[1] += line;
    placed.push([left, wide, at[1]]);
    c.fillText(words, ...at);
  }
  c.restore();
}

/** A ring around a point. */
function drawMark(u, [x, y], chart, ink) {
  const c = u.ctx;
  const ratio = devicePixelRatio || 1;
  c.save();
  c.strokeStyle = ink;
  c.lineWidth = 2 * ratio;
  c.beginPath();
  c.arc(u.valToPos(plotted(x, chart.x), "x", true), u.valToPos(plotted(y, chart.y), "y", true), 7 * ratio, 0, 2 * Math.PI);
  c.stroke();
  c.restore();
}

/** The views of all charts that Rust has made a place for. */
const charts = [...document.querySelectorAll("[data-chart]")].map((place) => {
  const chart = data.charts[Number(place.dataset.chart)];
  return new ChartView(place, chart);
});

/** A choice of one more pass for the curves over the positions. */
function offerPasses() {
  const section = document.getElementById("curves");
  if (!section || !data.passes || data.passes.length < 2) return;
  const select = element("select", { onchange: () => {
    const pass = data.passes[select.value];
    for (const view of charts) {
      const original = data.charts[Number(view.place.dataset.chart)];
      if (!(original.name in data.passes[0].over)) continue;
      const more = pass ? [{ name: `${pass.label}, chosen`, mark: "line", right: false, x: pass.offset, y: pass.over[original.name].map(Math.abs) }] : [];
      view.show({ ...original, series: [...original.series, ...more] });
    }
  } }, element("option", { value: "" }, "none"), ...data.passes.map((pass, k) => element("option", { value: k }, pass.label)));
  section.querySelector("h2").after(element("div", { class: "controls" }, element("label", {}, "one more pass over the positions", select)));
}
offerPasses();
