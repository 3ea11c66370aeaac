"use strict";
// A study: a chart whose quantity, axis and colours are chosen, a table that is sorted by its columns, a panel for each case.

/** The numbers of `all` in their order, each once. */
function distinct(all) {
  return [...new Set(all)].sort((a, b) => a - b);
}

/** Whether numbers are better spread out on a logarithmic axis: over a decade, or in steps of one ratio. */
function suitsLog(all) {
  const numbers = distinct(all.filter(Number.isFinite));
  if (numbers.length < 2 || !(numbers[0] > 0)) return false;
  const last = numbers[numbers.length - 1];
  const ratios = numbers.slice(1).map((v, k) => v / numbers[k]);
  return last >= 10 * numbers[0] || (numbers.length > 2 && Math.max(...ratios) < 1.1 * Math.min(...ratios) && last > 3 * numbers[0]);
}

class Explorer {
  constructor(place, study) {
    this.study = study;
    this.over = study.axes.filter((axis) => axis.numbers && axis.numbers.length > 1);
    if (!this.over.length) this.over = study.axes.filter((axis) => axis.numbers);
    this.quantities = study.quantities;
    this.chosen = { y: 0, x: 0 };
    const choice = (label, name, options) => {
      const select = element("select", { onchange: () => { this.chosen[name] = Number(select.value); this.show(); } },
        ...options.map((text, k) => element("option", { value: k }, text)));
      return element("label", {}, label, select);
    };
    this.colours = element("select", { onchange: () => this.show() });
    place.append(element("div", { class: "controls" }, choice("quantity", "y", this.quantities.map((q) => q.label)),
      choice("over", "x", this.over.map((axis) => axis.label)), element("label", {}, "colour", this.colours)));
    this.figure = element("figure", { class: "chart wide" }, element("figcaption", {}, element("span")));
    place.append(this.figure);
    this.note = element("p", { class: "remark" });
    place.append(this.note);
    this.offerColours();
    this.show();
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
    const chart = this.chart();
    this.figure.querySelector("figcaption span").textContent = chart.title;
    if (this.view) this.view.show(chart);
    else this.view = new ChartView(this.figure, chart);
  }

  /** A curve of means for each colour, with the range of its cases as a band, and each case as a point. */
  chart() {
    const { study } = this;
    const [y, x] = [this.quantities[this.chosen.y], this.over[this.chosen.x]];
    const by = study.axes.find((axis) => axis.key === this.colours.value);
    const groups = new Map();
    study.cases.forEach((_, n) => {
      const [at, value] = [x.numbers[x.indices[n]], y.values[n]];
      if (!Number.isFinite(at) || value === null || !Number.isFinite(value)) return;
      const group = by ? by.indices[n] : 0;
      if (!groups.has(group)) groups.set(group, []);
      groups.get(group).push([at, value]);
    });
    const MOST = 12;
    const shown = [...groups].sort(([a], [b]) => a - b).slice(0, MOST);
    let spread = 0;
    const series = shown.flatMap(([group, points], n) => {
      const xs = distinct(points.map(([at]) => at));
      const of = (at) => points.filter(([other]) => other === at).map(([, value]) => value);
      const samples = xs.map(of);
      spread = Math.max(spread, ...samples.map((all) => all.length));
      const lines = { name: by ? by.texts[group] : "mean", mark: "lineandpoints", right: false, colour: n, x: xs, y: samples.map((all) => all.reduce((a, b) => a + b) / all.length) };
      if (samples.every((all) => all.length === 1)) return [lines];
      return [{ ...lines, mark: "line", low: samples.map((all) => Math.min(...all)), high: samples.map((all) => Math.max(...all)) },
        { name: "", mark: "points", right: false, colour: n, x: points.map(([at]) => at), y: points.map(([, value]) => value) }];
    });
    const all = shown.flatMap(([, points]) => points);
    const axis = (of, values) => ({ ...of.unit, label: of.label, log: suitsLog(values), range: null });
    this.note.textContent = [spread > 1 ? `Lines are means, bands reach from the least to the largest of up to ${spread} cases at a point, and each case is a point.` : "",
      groups.size > MOST ? `Only the first ${MOST} of ${groups.size} values have a curve.` : "",
      study.cases.length < study.all ? `${study.cases.length} of ${study.all} cases, evenly chosen.` : ""].filter(Boolean).join(" ");
    return {
      name: "study", title: sentence(`${y.label} over ${x.label}${by ? `, by ${by.label}` : ""}`), words: [], right: null, series, colours: by ? by.label : "",
      x: axis(x, all.map(([at]) => at)), y: axis(y, all.map(([, value]) => value)),
    };
  }
}

/** What is known of a case, beside the table. */
function openCase(study, n) {
  const { case: name, failure, page } = study.cases[n];
  const rows = [...study.axes.map((axis) => [axis.label, axis.texts[axis.indices[n]]]),
    ...(failure ? [] : study.quantities.map((q) => [q.label, q.values[n] === null ? "–" : written(q.values[n], q.unit)]))];
  const table = element("table", { class: "facts" }, element("tbody", {}, ...rows.map(([label, text]) =>
    element("tr", {}, element("th", { scope: "row" }, label), element("td", {}, text)))));
  const more = page ? element("a", { href: page }, "page of this case")
    : element("span", {}, "Its page is made by ", element("code", {}, `asperity report ${study.folder}/cases/${name}`));
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
