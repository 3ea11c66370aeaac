"use strict";
// The contact over positions and passes: a map with where both bodies are, and a section of them, facing each other.

class Scrubber {
  constructor(place, contact) {
    this.contact = contact;
    this.frames = contact.frames;
    this.groups = contact.groups.map((_, g) => this.frames.map((f, n) => [f, n]).filter(([f]) => f.group === g).map(([, n]) => n));
    this.group = this.groups.length - 1;
    this.layer = contact.layers[0];
    this.row = null;
    const last = this.groups[this.group];
    // First the middle of the pass, or beside it a position whose contact the edge of a periodic map does not cut.
    const middle = Math.floor(last.length / 2);
    const cut = (step) => this.frames[last[step]].seam || 0;
    this.step = last.reduce((best, _, step) => {
      const nearer = Math.abs(step - middle) < Math.abs(best - middle);
      return cut(step) < cut(best) || (cut(step) === cut(best) && nearer) ? step : best;
    }, middle);
    if (contact.begin !== undefined) this.step = contact.begin;
    this.stepName = contact.steps || (contact.groups[0].label ? "position" : "point");
    this.build(place);
  }

  get frame() { return this.frames[this.groups[this.group][this.step]]; }

  build(place) {
    const { layers } = this.contact;
    const range = (label, most, input) => {
      const slider = element("input", { type: "range", min: 0, max: most, step: 1, oninput: () => input(Number(slider.value)) });
      return [slider, element("label", {}, label, slider)];
    };
    const controls = element("div", { class: "controls" });
    if (layers.length > 1) {
      const select = element("select", { onchange: () => { this.layer = layers[select.value]; this.show(); } },
        ...layers.map((layer, k) => element("option", { value: k }, layer.title)));
      controls.append(element("label", {}, "map", select));
    }
    if (this.groups.length > 1) {
      const [slider, label] = range("pass", this.groups.length - 1, (g) => this.to(g, this.step));
      this.passes = slider;
      controls.append(label);
    }
    const most = Math.max(...this.groups.map((g) => g.length)) - 1;
    if (most > 0) {
      const [slider, label] = range(this.stepName, most, (k) => this.to(this.group, k));
      this.positions = slider;
      this.play = element("button", { type: "button", onclick: () => this.toggle() }, "play");
      controls.append(label, this.play);
    }
    this.text = element("p", { id: "frame" });
    const [left, right] = [element("div"), element("div")];
    const views = element("div", { class: "split" }, left, right);
    place.append(controls, this.text, views);
    // A chart that would stand alone in its row stands under the section.
    const beside = place.parentNode.querySelectorAll(".charts > .chart");
    const lone = beside.length === 1 ? beside[0] : null;
    this.map = new MapView(left, "contact", "contact", (_, y) => { this.row = y; this.show(); });
    this.moves = Boolean(this.contact.groups[0].label) && !this.contact.wraps && Boolean(data.bodies);
    if (this.moves) this.places = new PlacesView(right);
    if (data.bodies) this.section = new SectionView(right, this.contact.wraps);
    if (lone) {
      const row = lone.parentNode;
      // Under a wide map there is more room than under the section.
      const [wide, deep] = [0, 1].map((axis) => (data.bodies ? data.bodies[0].before.shape[axis] * data.bodies[0].before.pitch[axis] : 1));
      (wide > 1.4 * deep ? left : right).append(lone);
      row.remove();
    }
    if (most > 0 || this.groups.length > 1) {
      this.map.canvas.tabIndex = 0;
      views.before(element("p", { class: "remark" }, `Keys on the map: ← → ${this.stepName}, ${this.groups.length > 1 ? "↑ ↓ pass, " : ""}Home and End, space plays. A click chooses the section.`));
      this.map.canvas.addEventListener("keydown", (event) => this.key(event));
    }
  }

  key(event) {
    const end = this.groups[this.group].length - 1;
    const keys = {
      ArrowLeft: () => this.to(this.group, this.step - 1), ArrowRight: () => this.to(this.group, this.step + 1),
      ArrowUp: () => this.to(this.group + 1, this.step), ArrowDown: () => this.to(this.group - 1, this.step),
      Home: () => this.to(this.group, 0), End: () => this.to(this.group, end), " ": () => this.toggle(),
    };
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  }

  toggle() {
    if (this.timer) {
      clearInterval(this.timer);
      this.timer = null;
    } else {
      this.timer = setInterval(() => this.to(this.group, (this.step + 1) % this.groups[this.group].length), 120);
    }
    if (this.play) this.play.textContent = this.timer ? "pause" : "play";
  }

  to(group, step) {
    this.group = Math.max(0, Math.min(this.groups.length - 1, group));
    this.step = Math.max(0, Math.min(this.groups[this.group].length - 1, step));
    return this.show();
  }

  async show() {
    const { frame, layer } = this;
    const { groups } = this.contact;
    if (this.passes) this.passes.value = this.group;
    if (this.positions) this.positions.value = this.step;
    const packed = frame.maps[layer.name];
    const pressure = frame.maps.pressure;
    const { changes } = groups[this.group];
    await Promise.all([packed && unpack(packed), unpack(pressure), ...(changes || []).map(unpack), ...(data.bodies || []).map((body) => unpack(body.before))]);
    // Another frame may have been asked for meanwhile.
    if (frame !== this.frame || layer !== this.layer) return;
    const label = [groups[this.group].label, frame.label].filter(Boolean).join(", ");
    this.text.innerHTML = [label && `<strong>${label}</strong>`, frame.text].filter(Boolean).join(": ");
    const [lower, upper] = data.bodies ? data.bodies.map((body) => [0, 1].map((axis) => body.before.shape[axis] * body.before.pitch[axis]))
      : [0, 1].map(() => [0, 1].map((axis) => pressure.shape[axis] * pressure.pitch[axis]));
    const region = [[0, lower[0]], [0, lower[1]]];
    const length = data.bodies ? data.bodies[0].length : { factor: 1e-6, symbol: "µm" };
    const corner = pressure.corner.map((v, axis) => v * pressure.pitch[axis]);
    const row = this.row === null ? busiest(pressure) + corner[1] : Math.min(Math.max(this.row, 0), lower[1]);
    const rects = this.moves ? [{ from: [frame.offset, 0], size: upper, colour: "#d02020", dashed: true }] : [];
    const classes = layer.kind === "class" ? layer.classes.map((name, k) => [["var(--blank)", "rgb(0,114,178)", "rgb(213,94,0)"][k], name])
      : layer.kind === "diverging" ? [["rgb(67,147,195)", "tension"], ["rgb(214,96,77)", "compression"]]
      : layer.kind === "positive" ? [["var(--blank)", layer.name === "pressure" ? "no contact" : "zero"]]
        : layer.name === "displacement" ? []
        : layer.kind === "between" ? [["var(--missing)", "no contact"]]
        : [["var(--blank)", "in contact"], ...(layer.range[0] < 0 ? [["rgb(213,94,0)", "in contact and flattened"]] : [])];
    if (this.moves) classes.push(["#d02020", "edge of the upper body"]);
    const told = layer.kind === "class" ? (v) => layer.classes[v] || "" : (v, level) =>
      (level === 0 && layer.kind === "positive" ? (layer.name === "pressure" ? "no contact" : "0") : `${layer.title} ${written(v, layer.unit)}`);
    this.map.title(sentence([layer.title, label].filter(Boolean).join(", ")));
    const range = layer.ranges[this.group];
    this.map.show({
      caption: layer.caption, region, length, rects, classes,
      images: packed ? [{ packed, kind: layer.kind, range, corner, wraps: this.contact.wraps, told }] : [],
      lines: [{ from: [region[0][0], row], to: [region[0][1], row], colour: "#8a8f98" }],
      bar: layer.kind === "class" ? null : { range, unit: layer.unit, label: layer.title, kind: layer.kind },
    });
    charts.filter((view) => view.chart.name === "force_distance").forEach((view) => view.point(frame.mark));
    if (this.places) this.places.show({ lower, upper, offset: frame.offset, length });
    if (this.section) this.section.show({ known: groups[this.group].known !== false, frame, changes, row, region: region[0], length });
  }
}

/** Where along y a row of cells bears the most, the middle where none does, from the corner of the map, m. */
function busiest(packed) {
  if (packed.busiest === undefined) {
    const [[nx, ny], { levels }] = [packed.shape, packed];
    const rows = new Float64Array(ny);
    for (let i = 0, n = 0; i < nx; i++) for (let j = 0; j < ny; j++, n++) rows[j] += Math.abs(value(packed, levels[n])) || 0;
    const most = rows.reduce((a, b) => Math.max(a, b));
    packed.busiest = ((most > 0 ? rows.indexOf(most) : Math.floor(ny / 2)) + 0.5) * packed.pitch[1];
  }
  return packed.busiest;
}

/** Draws both bodies from above and to scale; the part where they face each other is shaded. */
class PlacesView extends Drawing {
  constructor(place) {
    super(place, "places", "where both bodies are, from above", []);
  }

  paint(canvas, width, ratio) {
    const { lower, upper, offset, length } = this.scene;
    const deep = Math.max(lower[1], upper[1]);
    const scale = Math.min((width - 8) / (lower[0] + 2 * upper[0]), 150 / deep);
    const tall = Math.max(8, deep * scale);
    const overlap = Math.max(0, Math.min(lower[0], offset + upper[0]) - Math.max(0, offset));
    this.title(`From above, to scale: ${written(overlap, length)} overlap, offset ${written(offset, length)}.`);
    const c = this.context(canvas, width, tall + 8, ratio);
    c.clearRect(0, 0, width, tall + 8);
    const px = (x) => 4 + (x + upper[0]) * scale;
    c.fillStyle = "rgba(230,159,0,0.55)";
    c.fillRect(px(Math.max(0, offset)), 4, overlap * scale, tall);
    c.lineWidth = 1.5;
    c.strokeStyle = "#3a86c8";
    c.strokeRect(px(0), 4, lower[0] * scale, tall);
    c.setLineDash([6, 4]);
    c.strokeStyle = "#e05050";
    c.strokeRect(px(offset), 4, upper[0] * scale, tall);
    c.setLineDash([]);
    c.fillStyle = style("--ink");
    c.font = FONT;
    c.textBaseline = "middle";
    c.textAlign = "center";
    if (tall > 40) {
      c.fillStyle = "#3a86c8";
      c.fillText("lower", px(lower[0] / 2), 4 + tall * 0.72);
      c.fillStyle = "#e05050";
      c.fillText("upper", px(offset + upper[0] / 2), 4 + tall * 0.32);
    }
  }
}

/** Both bodies in a section along x, undeformed and together as far as they are; where they overlap is marked. */
class SectionView extends Drawing {
  constructor(place, wraps) {
    super(place, "section", "both bodies in a section", [], element("div", { class: "legend" },
      ...[["#0072b2", "lower body"], ["#c04040", "upper body"], ["#e69f00", "where they would overlap undeformed"]].map(([colour, name]) =>
        element("span", {}, element("i", { class: "box", style: `background:${colour}` }), name))));
    this.wraps = wraps;
  }

  /** Both bodies, unless what the upper one was then is not known. */
  show(scene) {
    this.figure.hidden = !scene.known || scene.frame.approach === null;
    super.show(scene);
  }

  /** Heights of a body along the section, as they are then. */
  profile(b) {
    const { frame, changes, row } = this.scene;
    const { before, sign } = data.bodies[b];
    const [[nx, ny], dy] = [before.shape, before.pitch[1]];
    // What is displaced across comes in on the other side.
    const across = b === 1 ? Math.round((frame.across || 0) / dy) : 0;
    const j = (((Math.max(0, Math.min(ny - 1, Math.floor(row / dy))) - across) % ny) + ny) % ny;
    const [change, down] = [changes && changes[b], b === 1 ? frame.approach : 0];
    return Float64Array.from({ length: nx }, (_, i) => cell(before, i, j) - (change ? -sign * cell(change, i, j) : 0) - down);
  }

  paint(canvas, width, ratio) {
    const { frame, row, region, length } = this.scene;
    const pitch = data.bodies[0].before.pitch[0];
    const [lower, upper] = [this.profile(0), this.profile(1)];
    let [low, high] = [Infinity, -Infinity];
    for (const z of [...lower, ...upper]) { if (z < low) low = z; if (z > high) high = z; }
    const room = 0.06 * (high - low) || Math.abs(high) || 1e-9;
    [low, high] = [low - room, high + room];
    const unit = lengthUnit(high - low);
    this.title(`Both bodies, undeformed, at y = ${written(row, length)}, approach ${frame.together}.`);
    const [left, top, h] = [MARGIN.left, 8, 170];
    const w = Math.max(60, width - left - MARGIN.right);
    const c = this.context(canvas, width, h + top + 40, ratio);
    c.clearRect(0, 0, width, h + top + 40);
    const shift = Math.round(frame.offset / pitch);
    const facing = (i) => upper[this.wraps ? (((i - shift) % upper.length) + upper.length) % upper.length : i - shift];
    const px = (i) => left + ((i * pitch - region[0]) / (region[1] - region[0])) * w;
    const py = (z) => top + h - ((z - low) / (high - low)) * h;
    const end = Math.ceil(region[1] / pitch - 1e-6);
    // The body on one side of its heights, which are lines between the middles of cells.
    const body = (from, edge) => {
      const path = new Path2D();
      for (let i = 0; i < end; i++) {
        const first = i;
        const tops = [];
        for (; i < end && Number.isFinite(from(i)); i++) tops.push(py(from(i)));
        if (!tops.length) continue;
        path.moveTo(px(first), edge);
        path.lineTo(px(first), tops[0]);
        tops.forEach((at, k) => path.lineTo(px(first + k + 0.5), at));
        path.lineTo(px(i), tops[tops.length - 1]);
        path.lineTo(px(i), edge);
        path.closePath();
      }
      return path;
    };
    c.save();
    c.beginPath();
    c.rect(left, top, w, h);
    c.clip();
    const [below, above] = [body((i) => lower[i], top + h + 1), body(facing, top - 1)];
    c.fillStyle = "rgba(0,114,178,0.75)";
    c.fill(below);
    c.fillStyle = "rgba(192,64,64,0.7)";
    c.fill(above);
    c.save();
    c.clip(below);
    c.fillStyle = "#e69f00";
    c.fill(above);
    c.restore();
    // However little they overlap, it is seen.
    c.strokeStyle = "#e69f00";
    c.lineWidth = 1.4;
    c.beginPath();
    for (let i = 0; i < end; i++) {
      if (!(facing(i) < lower[i])) continue;
      c.moveTo(px(i + 0.5), py(lower[i]) - 0.7);
      c.lineTo(px(i + 0.5), py(facing(i)) + 0.7);
    }
    c.stroke();
    c.restore();
    drawAxes(c, { frame: [left, top, w, h], region: [region, [low, high]], units: [length, unit], names: ["x", "height"], apart: [60, 43] });
  }
}

const scrubber = data.contact && document.getElementById("scrubber") ? new Scrubber(document.getElementById("scrubber"), data.contact) : null;
