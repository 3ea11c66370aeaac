"use strict";
// A study: a chart whose quantity, axis and colours are chosen, a table that is sorted by its columns, a panel for each case.

/** The numbers of `all` in their order, each once. */
function distinct(all) {
  return [...new Set(all)].sort((a, b) => a - b);
}

/** Mean and standard deviation of a sample; no deviation for one value. */
function spread(all) {
  const mean = all.reduce((a, b) => a + b) / all.length;
  const squares = all.reduce((sum, v) => sum + (v - mean) ** 2, 0);
  return [mean, all.length > 1 ? Math.sqrt(squares / (all.length - 1)) : 0];
}

/** Whether numbers are better spread out on a logarithmic axis: over a decade, or in steps of one ratio. */
function suitsLog(all) {
  const numbers = distinct(all.filter(Number.isFinite));
  if (numbers.length < 2 || !(numbers[0] > 0)) return false;
  const last = numbers[numbers.length - 1];
  const ratios = numbers.slice(1).map((v, k) => v / numbers[k]);
  return last >= 10 * numbers[0] || (numbers.length > 2 && Math.max(...ratios) < 1.1 * Math.min(...ratios) && last > 3 * numbers[0]);
}

/** Whether black is read better than white on a colour #rrggbb. */
function isLight(colour) {
  const [r, g, b] = [1, 3, 5].map((at) => (parseInt(colour.substr(at, 2), 16) / 255) ** 2.2);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b > 0.18;
}

class Explorer {
  constructor(place, study) {
    this.study = study;
    this.over = study.axes.filter((axis) => axis.numbers && axis.numbers.length > 1);
    if (!this.over.length) this.over = study.axes.filter((axis) => axis.numbers);
    this.quantities = study.quantities;
    // The axis with the most numbers lies along x.
    const most = this.over.reduce((best, axis, k) => (axis.numbers.length > this.over[best].numbers.length ? k : best), 0);
    this.chosen = { y: 0, x: most };
    const choice = (label, name, options) => {
      const select = element("select", { onchange: () => { this.chosen[name] = Number(select.value); this.show(); } },
        ...options.map((text, k) => element("option", { value: k }, text)));
      select.value = this.chosen[name];
      return element("label", {}, label, select);
    };
    this.colours = element("select", { onchange: () => this.show() });
    this.form = element("select", { onchange: () => this.show() }, element("option", { value: "curves" }, "curves"), element("option", { value: "map" }, "table in colours"));
    place.append(element("div", { class: "controls" }, choice("quantity", "y", this.quantities.map((q) => q.label)),
      choice("over", "x", this.over.map((axis) => axis.label)), element("label", {}, "colour", this.colours), element("label", {}, "as", this.form)));
    this.only = new Map();
    place.append(this.filters());
    this.figure = element("figure", { class: "chart wide" }, element("figcaption", {}, element("span")));
    this.heat = element("div", { id: "heat", class: "scroll whole", tabindex: 0, role: "region", "aria-label": "means in colours", hidden: true });
    place.append(this.figure, this.heat);
    this.note = element("p", { class: "remark" });
    place.append(this.note);
    this.offerColours();
    this.show();
  }

  /** A choice for each axis: the cases with one of its values, or all. */
  filters() {
    const MOST = 200;
    const axes = this.study.axes.filter((axis) => axis.texts.length > 1 && axis.texts.length <= MOST);
    const choice = (axis) => {
      const select = element("select", { onchange: () => {
        if (select.value === "") this.only.delete(axis);
        else this.only.set(axis, Number(select.value));
        this.show();
        showRows(this);
      } }, element("option", { value: "" }, "all"), ...axis.texts.map((text, k) => element("option", { value: k }, text)));
      return element("label", {}, axis.label, select);
    };
    return element("div", { class: "controls" }, element("span", { class: "remark" }, "only the cases with"), ...axes.map(choice));
  }

  /** Whether a case has the values that are chosen. */
  holds(n) {
    return [...this.only].every(([axis, index]) => axis.indices[n] === index);
  }

  /** The axes that are not drawn over, each with a colour for each of its values. */
  offerColours() {
    const x = this.over[this.chosen.x];
    const others = this.study.axes.filter((axis) => axis !== x && !axis.seed && axis.texts.length > 1);
    const before = this.colours.options.length ? this.colours.value : null;
    this.colours.replaceChildren(...[...others.map((axis) => [axis.key, axis.label]), ["", "none"]].map(([key, label]) => element("option", { value: key }, label)));
    if (before === "" || others.some((axis) => axis.key === before)) this.colours.value = before;
  }

  show() {
    this.offerColours();
    const isMap = this.form.value === "map";
    this.figure.hidden = isMap;
    this.heat.hidden = !isMap;
    if (isMap) { this.tabulate(); return; }
    const chart = this.chart();
    this.figure.querySelector("figcaption span").textContent = chart.title;
    if (this.view) this.view.show(chart);
    else this.view = new ChartView(this.figure, chart);
  }

  /** The means as a table: a column for each value drawn over, a row for each value of the other axis. */
  tabulate() {
    const { study } = this;
    const [y, x] = [this.quantities[this.chosen.y], this.over[this.chosen.x]];
    const by = study.axes.find((axis) => axis.key === this.colours.value);
    const cells = new Map();
    study.cases.forEach((_, n) => {
      const value = y.values[n];
      if (!this.holds(n) || value === null || !Number.isFinite(value)) return;
      const key = `${by ? by.indices[n] : 0} ${x.indices[n]}`;
      if (!cells.has(key)) cells.set(key, []);
      cells.get(key).push(value);
    });
    const means = [...cells.values()].map((all) => spread(all)[0]);
    const log = suitsLog(means);
    const shade = (v) => (log ? Math.log(v) : v);
    const [low, high] = [Math.min(...means.map(shade)), Math.max(...means.map(shade))];
    const palette = palettes.pressure.css;
    const places = (axis) => axis.texts.map((_, k) => k).filter((k) => !this.only.has(axis) || this.only.get(axis) === k);
    const row = (group) => places(x).map((at) => {
      const all = cells.get(`${group} ${at}`);
      if (!all) return element("td", {}, "–");
      const [value, deviation] = spread(all);
      const colour = palette[high > low ? Math.round((255 * (shade(value) - low)) / (high - low)) : 128];
      const title = all.length > 1 ? `mean of ${all.length} cases, standard deviation ${digits(deviation / y.unit.factor)}` : "one case";
      return element("td", { style: `background:${colour};color:${isLight(colour) ? "#000000" : "#ffffff"}`, title }, digits(value / y.unit.factor));
    });
    const head = element("thead", {}, element("tr", {}, element("th", { scope: "col" }, by ? `${by.label} ↓, ${x.label} →` : x.label),
      ...places(x).map((at) => element("th", { scope: "col" }, x.texts[at]))));
    const rows = (by ? places(by) : [0]).map((group) => element("tr", {}, element("th", { scope: "row" }, by ? by.texts[group] : "all"), ...row(group)));
    const unit = y.unit.symbol ? ` (${y.unit.symbol})` : "";
    this.heat.replaceChildren(element("h3", {}, sentence(`${y.label}${unit} versus ${x.label}${by ? ` and ${by.label}` : ""}`)), element("table", {}, head, element("tbody", {}, ...rows)));
    this.note.textContent = `Means of the cases at a place${log ? ", colours by the logarithm" : ""}; point at a number for its deviation.`;
  }

  /** A curve of means for each colour, with the standard deviation as a band, and each case as a point. */
  chart() {
    const { study } = this;
    const [y, x] = [this.quantities[this.chosen.y], this.over[this.chosen.x]];
    const by = study.axes.find((axis) => axis.key === this.colours.value);
    const groups = new Map();
    study.cases.forEach((_, n) => {
      const [at, value] = [x.numbers[x.indices[n]], y.values[n]];
      if (!this.holds(n)) return;
      if (!Number.isFinite(at) || value === null || !Number.isFinite(value)) return;
      const group = by ? by.indices[n] : 0;
      if (!groups.has(group)) groups.set(group, []);
      groups.get(group).push([at, value]);
    });
    const MOST = 12;
    const shown = [...groups].sort(([a], [b]) => a - b).slice(0, MOST);
    let most = 0;
    const series = shown.flatMap(([group, points], n) => {
      const xs = distinct(points.map(([at]) => at));
      const of = (at) => points.filter(([other]) => other === at).map(([, value]) => value);
      const samples = xs.map(of);
      most = Math.max(most, ...samples.map((all) => all.length));
      const spreads = samples.map(spread);
      const lines = { name: by ? by.texts[group] : "mean", mark: "lineandpoints", right: false, colour: n, x: xs, y: spreads.map(([mean]) => mean) };
      if (samples.every((all) => all.length === 1)) return [lines];
      // A logarithmic axis has no place for what is not above 0.
      const low = spreads.map(([mean, deviation], k) => (mean > deviation ? mean - deviation : Math.min(...samples[k])));
      return [{ ...lines, mark: "line", low, high: spreads.map(([mean, deviation]) => mean + deviation), deviation: spreads.map(([, deviation]) => deviation),
        count: samples.map((all) => all.length) },
        { name: "", mark: "points", right: false, colour: n, x: points.map(([at]) => at), y: points.map(([, value]) => value) }];
    });
    const all = shown.flatMap(([, points]) => points);
    const axis = (of, values) => ({ ...of.unit, label: of.label, log: suitsLog(values), range: null });
    this.note.textContent = [most > 1 ? `Lines are means of up to ${most} cases at a point, bands one standard deviation to either side, and each case is a point.` : "", series.length > 1 ? "A click on a name in the legend hides its curve." : "",
      groups.size > MOST ? `Only the first ${MOST} of ${groups.size} values have a curve.` : "",
      study.cases.length < study.all ? `${study.cases.length} of ${study.all} cases, evenly chosen.` : ""].filter(Boolean).join(" ");
    return {
      name: "study", title: sentence(`${y.label} versus ${x.label}${by ? `, by ${by.label}` : ""}`), words: [], right: null, series, colours: by ? by.label : "",
      x: axis(x, all.map(([at]) => at)), y: axis(y, all.map(([, value]) => value)),
    };
  }
}

/** The rows of the cases that an explorer shows. */
function showRows(explorer) {
  const { cases } = explorer.study;
  const shown = new Set(cases.map((one, n) => [one.case, n]).filter(([, n]) => explorer.holds(n)).map(([name]) => name));
  const known = new Set(cases.map((one) => one.case));
  for (const row of document.querySelectorAll("#cases tbody tr")) {
    const name = row.cells[0].textContent;
    row.hidden = known.has(name) && !shown.has(name);
  }
}

/** What is known of a case, beside the table. */
function openCase(study, n) {
  const { case: name, folder, failure, page } = study.cases[n];
  const rows = [...study.axes.map((axis) => [axis.label, axis.texts[axis.indices[n]] ?? "–"]),
    ...(failure ? [] : study.quantities.map((q) => [q.label, q.values[n] === null ? "–" : written(q.values[n], q.unit)]))];
  const table = element("table", { class: "facts" }, element("tbody", {}, ...rows.map(([label, text]) =>
    element("tr", {}, element("th", { scope: "row" }, label), element("td", {}, text)))));
  const more = page ? element("a", { href: page }, "page of this case")
    : element("span", {}, "Its page is made by ", element("code", {}, `asperity report ${study.folder}/${folder}`));
  const close = element("button", { type: "button", onclick: () => panel.replaceChildren() }, "close");
  const panel = document.getElementById("panel");
  panel.replaceChildren(element("h3", {}, `Case ${name}`), close, ...(failure ? [element("p", {}, failure)] : []), table, element("p", {}, more));
}

/** Sorts the rows of a table by a column; once more, the other way. */
function sortBy(table, column, head) {
  const up = head.getAttribute("aria-sort") !== "ascending";
  for (const other of head.parentNode.cells) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", up ? "ascending" : "descending");
  const number = (row) => {
    const text = row.cells[column] ? row.cells[column].textContent : "";
    const value = parseFloat(text.replace("−", "-"));
    return Number.isFinite(value) ? value : Infinity;
  };
  const body = table.tBodies[0];
  const rows = [...body.rows].map((row) => [number(row), row]);
  rows.sort(([a], [b]) => (a === b ? 0 : a < b === up ? -1 : 1));
  body.append(...rows.map(([, row]) => row));
}

/** Makes the table of cases answer to clicks. */
function prepareCases(study) {
  const table = document.querySelector("#cases table");
  document.querySelector("#cases .scroll").before(element("div", { id: "panel", "aria-live": "polite" }));
  const place = new Map(study.cases.map((one, n) => [one.case, n]));
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    const button = element("button", { type: "button", class: "sort", onclick: () => sortBy(table, column, head) });
    button.append(...head.childNodes);
    head.append(button);
  });
  for (const row of table.tBodies[0].rows) {
    const head = row.cells[0];
    const n = place.get(head.textContent);
    if (n === undefined) continue;
    if (!head.querySelector("a")) head.replaceChildren(element("button", { type: "button", class: "sort" }, head.textContent));
    row.addEventListener("click", (event) => { if (!event.target.closest("a")) openCase(study, n); });
  }
}

const explorer = data.study && document.getElementById("explorer") ? new Explorer(document.getElementById("explorer"), data.study) : null;
if (data.study) prepareCases(data.study);
