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
    // First what bears the most.
    this.step = Math.floor(last.length / 2);
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
      const [slider, label] = range(this.contact.groups[0].label ? "position" : "point", most, (k) => this.to(this.group, k));
      this.positions = slider;
      this.play = element("button", { type: "button", onclick: () => this.toggle() }, "play");
      controls.append(label, this.play);
    }
    this.text = element("p", { id: "frame" });
    const [left, right] = [element("div"), element("div")];
    const views = element("div", { class: "split" }, left, right);
    place.append(controls, this.text, views);
    this.map = new MapView(left, "contact", "contact", (_, y) => { this.row = y; this.show(); });
    this.moves = Boolean(this.contact.groups[0].label) && !this.contact.wraps && Boolean(data.bodies);
    if (this.moves) this.places = new PlacesView(right);
    this.section = new SectionView(right, this.contact);
    if (most > 0 || this.groups.length > 1) {
      this.map.canvas.tabIndex = 0;
      views.before(element("p", { class: "remark" }, "Keys on the map: ← → position, ↑ ↓ pass, Home and End, space plays. A click chooses the section."));
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
    const lost = groups[this.group].lost;
    await Promise.all([packed && unpack(packed), unpack(pressure), ...(lost || []).map(unpack)]);
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
      : layer.kind === "positive" ? [["var(--blank)", layer.name === "pressure" ? "no contact" : "none"]]
        : layer.kind === "between" ? [["var(--missing)", "no contact"]]
        : [["var(--blank)", "in contact"], ...(layer.range[0] < 0 ? [["rgb(213,94,0)", "in contact and flattened"]] : [])];
    if (this.moves) classes.push(["#d02020", "edge of the upper body"]);
    const told = layer.kind === "class" ? (v) => layer.classes[v] || "" : (v, level) =>
      (level === 0 && layer.kind === "positive" ? (layer.name === "pressure" ? "no contact" : "0") : `${layer.title} ${written(v, layer.unit)}`);
    this.map.title([layer.title, label].filter(Boolean).join(", "));
    this.map.show({
      region, length, rects, classes,
      images: packed ? [{ packed, kind: layer.kind, range: layer.range, corner, wraps: this.contact.wraps, told }] : [],
      lines: [{ from: [region[0][0], row], to: [region[0][1], row], colour: "#8a8f98" }],
      bar: layer.kind === "class" ? null : { range: layer.range, unit: layer.unit, label: layer.title, kind: layer.kind },
    });
    if (this.places) this.places.show({ lower, upper, offset: frame.offset, length });
    this.section.show({ known: groups[this.group].known !== false, frame, lost, row, region: region[0], length });
  }
}

/** Where along y a row of cells bears the most, from the corner of the map, m. */
function busiest(packed) {
  const ny = packed.shape[1];
  const rows = new Float64Array(ny);
  packed.levels.forEach((level, n) => { rows[n % ny] += level; });
  return (rows.indexOf(Math.max(...rows)) + 0.5) * packed.pitch[1];
}

/** Where both bodies are, seen from above and to scale; what faces is shaded. */
class PlacesView {
  constructor(place) {
    this.caption = element("figcaption");
    this.canvas = element("canvas", { role: "img", "aria-label": "where both bodies are, from above" });
    place.append(element("figure", {}, this.caption, this.canvas));
    new ResizeObserver(() => this.draw()).observe(place);
    redraws.add(() => this.draw());
  }

  show(state) {
    this.state = state;
    this.draw();
  }

  draw() {
    if (!this.state) return;
    const { lower, upper, offset, length } = this.state;
    const width = this.canvas.parentElement.clientWidth;
    if (!(width > 0)) return;
    const deep = Math.max(lower[1], upper[1]);
    const scale = Math.min((width - 8) / (lower[0] + 2 * upper[0]), 150 / deep);
    const height = Math.max(12, deep * scale) + 8;
    const ratio = window.devicePixelRatio || 1;
    [this.canvas.width, this.canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    this.canvas.style.width = `${width}px`;
    this.canvas.style.height = `${height}px`;
    const overlap = Math.max(0, Math.min(lower[0], offset + upper[0]) - Math.max(0, offset));
    this.caption.textContent = `from above, to scale: ${written(overlap, length)} overlap, offset ${written(offset, length)}`;
    const c = this.canvas.getContext("2d");
    c.scale(ratio, ratio);
    const px = (x) => 4 + (x + upper[0]) * scale;
    const tall = Math.max(8, deep * scale);
    c.fillStyle = "rgba(230,159,0,0.55)";
    c.fillRect(px(Math.max(0, offset)), 4, overlap * scale, tall);
    c.lineWidth = 1.5;
    c.strokeStyle = "#3a86c8";
    c.strokeRect(px(0), 4, lower[0] * scale, tall);
    c.setLineDash([6, 4]);
    c.strokeStyle = "#e05050";
    c.strokeRect(px(offset), 4, upper[0] * scale, tall);
    c.setLineDash([]);
    c.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--ink").trim();
    c.font = FONT;
    c.textBaseline = "middle";
    c.textAlign = "center";
    if (tall > 40) {
      c.fillText("lower", px(lower[0] / 2), 4 + tall * 0.72);
      c.fillText("upper", px(offset + upper[0] / 2), 4 + tall * 0.32);
    }
  }
}

/** Both bodies in a section along x, undeformed and together as far as they are; where they overlap is marked. */
class SectionView {
  constructor(place, contact) {
    this.contact = contact;
    if (!data.bodies) return;
    this.caption = element("figcaption");
    this.canvas = element("canvas", { role: "img", "aria-label": "both bodies in a section" });
    place.append(element("figure", { class: "section" }, this.caption, this.canvas, element("div", { class: "legend" },
      ...[["#0072b2", "lower body"], ["#c04040", "upper body"], ["#e69f00", "where they would overlap undeformed"]].map(([colour, name]) =>
        element("span", {}, element("i", { class: "box", style: `background:${colour}` }), name)))));
    new ResizeObserver(() => this.draw()).observe(place);
    redraws.add(() => this.draw());
  }

  show(state) {
    this.state = state;
    this.draw();
  }

  draw() {
    if (!this.state || !data.bodies) return;
    const { frame, lost, row, region, length } = this.state;
    this.canvas.parentElement.hidden = !this.state.known;
    if (!this.state.known || frame.approach === null || !data.bodies.every((body) => body.before.levels)) return;
    const width = this.canvas.parentElement.clientWidth;
    if (!(width > 0)) return;
    const unit = data.bodies[0].unit.symbol && data.bodies[0].before.high > data.bodies[0].before.low ? data.bodies[0].unit : data.bodies[1].unit;
    this.caption.textContent = `both bodies, undeformed, at y = ${written(row, length)}, approach ${written(frame.approach, unit)}`;
    const profiles = data.bodies.map((body, b) => {
      const { before } = body;
      const [ny, dy] = [before.shape[1], before.pitch[1]];
      // What is displaced across comes in on the other side.
      const across = b === 1 ? Math.round((frame.across || 0) / dy) : 0;
      const j = (((Math.max(0, Math.min(ny - 1, Math.floor(row / dy))) - across) % ny) + ny) % ny;
      const gone = lost && lost[b];
      return Array.from({ length: before.shape[0] }, (_, i) =>
        cell(before, i, j) - (gone ? body.sign * cell(gone, i, j) : 0) - (b === 1 ? frame.approach : 0));
    });
    const pitch = data.bodies[0].before.pitch[0];
    const nx = profiles[0].length;
    const shift = Math.round(frame.offset / pitch);
    const at = (b, i) => {
      if (b === 0) return profiles[0][i];
      const k = i - shift;
      return this.contact.wraps ? profiles[1][((k % profiles[1].length) + profiles[1].length) % profiles[1].length] : profiles[1][k];
    };
    const finite = profiles.flat().filter(Number.isFinite);
    let [low, high] = [Math.min(...finite), Math.max(...finite)];
    const room = 0.06 * (high - low) || Math.abs(high) || 1e-9;
    [low, high] = [low - room, high + room];
    const ratio = window.devicePixelRatio || 1;
    const [left, top, h] = [MARGIN.left, 8, 170];
    const w = Math.max(60, width - left - MARGIN.right);
    [this.canvas.width, this.canvas.height] = [Math.round(width * ratio), Math.round((h + top + 40) * ratio)];
    this.canvas.style.width = `${width}px`;
    this.canvas.style.height = `${h + top + 40}px`;
    const c = this.canvas.getContext("2d");
    c.scale(ratio, ratio);
    const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    const px = (x) => left + ((x - region[0]) / (region[1] - region[0])) * w;
    const py = (z) => top + h - ((z - low) / (high - low)) * h;
    c.save();
    c.beginPath();
    c.rect(left, top, w, h);
    c.clip();
    const first = Math.min(0, Math.floor(region[0] / pitch));
    const end = Math.ceil(region[1] / pitch);
    const runs = (value, draw) => {
      let run = [];
      for (let i = first; i <= end; i++) {
        const z = i < end ? value(i) : undefined;
        if (z !== undefined && Number.isFinite(Array.isArray(z) ? z[0] : z)) run.push([i, z]);
        else { if (run.length) draw(run); run = []; }
      }
    };
    const fill = (b, colour, edge) => runs((i) => at(b, i), (run) => {
      c.beginPath();
      c.moveTo(px(run[0][0] * pitch), edge);
      for (const [i, z] of run) { c.lineTo(px(i * pitch), py(z)); c.lineTo(px((i + 1) * pitch), py(z)); }
      c.lineTo(px((run.at(-1)[0] + 1) * pitch), edge);
      c.fillStyle = colour;
      c.fill();
    });
    fill(0, "rgba(0,114,178,0.75)", top + h + 1);
    fill(1, "rgba(192,64,64,0.7)", top - 1);
    c.fillStyle = "#e69f00";
    for (let i = Math.max(first, 0); i < Math.min(end, nx); i++) {
      const [z1, z2] = [at(0, i), at(1, i)];
      if (z2 < z1) c.fillRect(px(i * pitch), py(z1), px((i + 1) * pitch) - px(i * pitch) + 0.5, Math.max(1.2, py(z2) - py(z1)));
    }
    c.restore();
    c.strokeStyle = css("--line");
    c.strokeRect(left - 0.5, top - 0.5, w + 1, h + 1);
    c.fillStyle = css("--ink");
    c.font = FONT;
    c.textAlign = "center";
    c.textBaseline = "top";
    for (const t of ticks(region[0] / length.factor, region[1] / length.factor, w / 60)) c.fillText(digits(t), px(t * length.factor), top + h + 6);
    c.fillText(`x (${length.symbol})`, left + w / 2, top + h + 22);
    c.textAlign = "right";
    c.textBaseline = "middle";
    for (const t of ticks(low / unit.factor, high / unit.factor, 4)) c.fillText(digits(t), left - 7, py(t * unit.factor));
    c.save();
    c.translate(12, top + h / 2);
    c.rotate(-Math.PI / 2);
    c.textAlign = "center";
    c.fillText(`height (${unit.symbol})`, 0, 0);
    c.restore();
  }
}

const scrubber = data.contact && document.getElementById("scrubber") ? new Scrubber(document.getElementById("scrubber"), data.contact) : null;
