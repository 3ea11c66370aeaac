"use strict";
// A map on a canvas: images of fields in a plane to scale, its axes, its colour bar, the value under the pointer, PNG.

const MARGIN = { left: 58, right: 84, top: 8, bottom: 40 };
const FONT = "12px system-ui, sans-serif";
/** Length over height from which on a map takes a whole row. */
const STRIP = 3;

/** A canvas in a figure, drawn again where the figure's width or the colours of the page change. */
class Drawing {
  /** `beside` stands in the row of the title, `below` under the canvas. */
  constructor(place, kind, label, beside, ...below) {
    this.canvas = element("canvas", { role: "img", "aria-label": label });
    this.caption = element("span", {}, label);
    this.figure = element("figure", { class: kind }, element("figcaption", {}, this.caption, ...beside), this.canvas, ...below);
    place.append(this.figure);
    this.width = 0;
    new ResizeObserver(([entry]) => { this.width = entry.contentRect.width; this.draw(); }).observe(this.figure);
    redraws.add(() => this.draw(true));
  }

  title(text) {
    if (this.caption.textContent === text) return;
    this.caption.textContent = text;
    this.canvas.setAttribute("aria-label", text);
  }

  show(scene) {
    this.scene = scene;
    this.draw(true);
  }

  /** Draws the scene, if there is room; what is on the canvas may be kept unless it is `stale`. */
  draw(stale = false) {
    if (!this.scene || this.figure.hidden) return;
    this.width = this.width || this.figure.clientWidth;
    if (this.width > 0) this.paint(this.canvas, this.width, window.devicePixelRatio || 1, stale);
  }

  /** A context of that many pixels of the page, each of `ratio`; a canvas that has its size already keeps what is on it. */
  context(canvas, width, height, ratio) {
    const size = [width, height].map((length) => Math.round(length * ratio));
    if (canvas.width !== size[0] || canvas.height !== size[1]) {
      [canvas.width, canvas.height] = size;
      canvas.style.width = `${width}px`;
      canvas.style.height = `${height}px`;
    }
    const c = canvas.getContext("2d");
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    return c;
  }
}

/** Draws the frame of a plane and its axes, in `units`, under `names`: `ticks` apart along each. */
function drawAxes(c, { frame: [left, top, w, h], region, down, units, names, apart }) {
  const [[x0, x1], [y0, y1]] = region;
  const [ink, faint, line] = ["--ink", "--faint", "--line"].map(style);
  c.strokeStyle = line;
  c.lineWidth = 1;
  c.strokeRect(left - 0.5, top - 0.5, w + 1, h + 1);
  c.fillStyle = ink;
  c.strokeStyle = faint;
  c.font = FONT;
  c.textBaseline = "top";
  c.textAlign = "center";
  for (const t of ticks(x0 / units[0].factor, x1 / units[0].factor, w / apart[0])) {
    const at = left + ((t * units[0].factor - x0) / (x1 - x0)) * w;
    c.beginPath(); c.moveTo(at, top + h); c.lineTo(at, top + h + 4); c.stroke();
    c.fillText(round(t), at, top + h + 6);
  }
  c.fillText(`${names[0]} (${units[0].symbol})`, left + w / 2, top + h + 22);
  c.textBaseline = "middle";
  c.textAlign = "right";
  for (const t of ticks(y0 / units[1].factor, y1 / units[1].factor, h / apart[1])) {
    const part = (t * units[1].factor - y0) / (y1 - y0);
    const at = top + (down ? part : 1 - part) * h;
    c.beginPath(); c.moveTo(left, at); c.lineTo(left - 4, at); c.stroke();
    c.fillText(round(t), left - 7, at);
  }
  c.save();
  c.translate(12, top + h / 2);
  c.rotate(-Math.PI / 2);
  c.textAlign = "center";
  c.fillText(`${names[1]} (${units[1].symbol})`, 0, 0);
  c.restore();
}

class MapView extends Drawing {
  /** `file` names the picture; `picked(x, y)` hears of clicks. */
  constructor(place, title, file, picked) {
    const readout = element("output", { "aria-live": "off" });
    const legend = element("div", { class: "legend" });
    const png = element("button", { type: "button", "aria-label": `PNG of ${title}`, onclick: () => this.savePng(file) }, "PNG");
    const about = element("p", { class: "caption" });
    super(place, "map", title, [png], legend, about, element("div", { class: "readout" }, readout));
    Object.assign(this, { readout, legend, about, images: [] });
    this.canvas.addEventListener("pointermove", (event) => this.read(event));
    this.canvas.addEventListener("pointerleave", () => { this.readout.textContent = ""; });
    if (picked) {
      this.canvas.className = "pick";
      this.canvas.addEventListener("click", (event) => { const at = this.at(event); if (at) picked(...at); });
    }
  }

  /**
   * Shows a scene: `region` [[x0, x1], [y0, y1]] (m); `length` its unit; `images` of packed maps, each with `kind`,
   * `range`, `corner` (m) and whether it `wraps` in the region; `rects` with `from`, `size`, `colour`, `dashed`;
   * `lines`; `marks`; `caption`; `bar` with `range`, `unit`, `label`, `kind`; `classes`; `down` where y is a depth; `relief`.
   */
  show(scene) {
    this.about.textContent = scene.caption || "";
    const classes = JSON.stringify(scene.classes || []);
    if (classes !== this.classes) {
      this.classes = classes;
      this.legend.replaceChildren(...(scene.classes || []).map(([colour, name]) =>
        element("span", {}, element("i", { class: "box", style: `background:${colour}` }), name)));
    }
    const { parentNode } = this.figure;
    const item = parentNode.matches(".maps") ? this.figure : parentNode;
    item.classList.toggle("strip", this.aspect(scene) > STRIP);
    super.show(scene);
  }

  aspect({ region: [[x0, x1], [y0, y1]] }) { return (x1 - x0) / (y1 - y0); }

  /** Where the plane is on a canvas of a width: [left, top, width, height]. */
  frame(width) {
    const aspect = Math.min(12, Math.max(0.25, this.aspect(this.scene)));
    let w = Math.max(60, width - MARGIN.left - (this.hasBar() ? MARGIN.right : 16));
    const most = Math.max(220, Math.min(520, window.innerHeight * 0.62));
    if (w / aspect > most) w = most * aspect;
    return [MARGIN.left, MARGIN.top + this.spare(w / aspect), w, w / aspect];
  }

  /** Room above and below a plane of a height that the words of its bar need. */
  spare(height) {
    const { bar } = this.scene;
    const letters = this.hasBar() ? bar.label.length + bar.unit.symbol.length + 3 : 0;
    return Math.max(0, (6.8 * letters - height) / 2);
  }

  /** A bar of one value says nothing. */
  hasBar() {
    const { bar } = this.scene;
    return Boolean(bar) && bar.range[1] > (runsFromLowest(bar.kind) ? bar.range[0] : 0);
  }

  paint(canvas, width, ratio, stale) {
    const { region, length, bar, down, names = ["x", "y"] } = this.scene;
    const frame = this.frame(width);
    const [left, top, w, h] = frame;
    const height = top + h + Math.max(MARGIN.bottom, this.spare(h));
    const c = this.context(canvas, width, height, ratio);
    // Around the plane nothing changes from one position to the next.
    const around = JSON.stringify([width, ratio, frame, region, length, bar, names, style("--paper")]);
    if (canvas !== this.canvas || around !== this.around) {
      c.fillStyle = style("--paper");
      c.fillRect(0, 0, width, height);
      drawAxes(c, { frame, region, down, units: [length, length], names, apart: [60, 40] });
      if (this.hasBar()) paintBar(c, bar, [left + w + 12, top, 12, h]);
      if (canvas === this.canvas) this.around = around;
    }
    this.paintPlane(c, frame, ratio, stale);
  }

  paintPlane(c, [left, top, w, h], ratio, stale) {
    const { region, images, rects = [], lines = [], marks = [], down } = this.scene;
    const [[x0, x1], [y0, y1]] = region;
    const px = (x) => left + ((x - x0) / (x1 - x0)) * w;
    const py = (y) => (down ? top + ((y - y0) / (y1 - y0)) * h : top + h - ((y - y0) / (y1 - y0)) * h);
    c.save();
    c.beginPath();
    c.rect(left, top, w, h);
    c.clip();
    c.fillStyle = style("--paper");
    c.fillRect(left, top, w, h);
    images.forEach((image, n) => {
      const { packed, corner, wraps } = image;
      if (stale || !this.images[n]) this.images[n] = pixels(image, down, this.images[n]);
      const size = [0, 1].map((axis) => packed.shape[axis] * packed.pitch[axis]);
      c.imageSmoothingEnabled = packed.shape[0] > w * ratio;
      for (const shift of wraps ? [0, -(x1 - x0), x1 - x0] : [0]) {
        const [a, b] = [px(corner[0] + shift), px(corner[0] + shift + size[0])];
        const [lower, upper] = [py(corner[1]), py(corner[1] + size[1])];
        c.drawImage(this.images[n].canvas, a, Math.min(lower, upper), b - a, Math.abs(lower - upper));
      }
    });
    for (const { from, size, colour, dashed } of rects) {
      const [a, b] = [px(from[0]), px(from[0] + size[0])];
      const [lower, upper] = [py(from[1]), py(from[1] + size[1])];
      c.setLineDash(dashed ? [6, 4] : []);
      c.strokeStyle = colour;
      c.lineWidth = 1.5;
      c.strokeRect(a + 0.75, Math.min(lower, upper) + 0.75, b - a - 1.5, Math.abs(lower - upper) - 1.5);
    }
    c.setLineDash([]);
    for (const { from, to, colour, width } of lines) {
      c.strokeStyle = colour || "#d55e00";
      c.lineWidth = width || 1;
      c.beginPath();
      c.moveTo(px(from[0]), py(from[1]));
      c.lineTo(px(to[0]), py(to[1]));
      c.stroke();
    }
    for (const [x, y] of marks) {
      for (const [colour, thick] of [["#ffffff", 3.4], ["#d02020", 1.6]]) {
        c.strokeStyle = colour;
        c.lineWidth = thick;
        c.beginPath();
        for (const [sx, sy] of [[1, 1], [1, -1]]) { c.moveTo(px(x) - 5 * sx, py(y) - 5 * sy); c.lineTo(px(x) + 5 * sx, py(y) + 5 * sy); }
        c.stroke();
      }
    }
    c.restore();
  }

  /** The place under the pointer, m. */
  at(event) {
    if (!this.scene) return null;
    const box = this.canvas.getBoundingClientRect();
    const { region, down } = this.scene;
    const [left, top, w, h] = this.frame(this.width);
    const s = (event.clientX - box.left - left) / w;
    const t = (event.clientY - box.top - top) / h;
    if (s < 0 || s > 1 || t < 0 || t > 1) return null;
    return [region[0][0] + s * (region[0][1] - region[0][0]), region[1][0] + (down ? t : 1 - t) * (region[1][1] - region[1][0])];
  }

  read(event) {
    const at = this.at(event);
    if (!at) { this.readout.textContent = ""; return; }
    const { length, images, names = ["x", "y"] } = this.scene;
    const where = `${names[0]} ${written(at[0], length)}, ${names[1]} ${written(at[1], length)}`;
    const texts = images.map((image) => {
      const { packed, corner, wraps, told } = image;
      if (!told) return "";
      let i = Math.floor((at[0] - corner[0]) / packed.pitch[0]);
      const j = Math.floor((at[1] - corner[1]) / packed.pitch[1]);
      if (wraps) i = ((i % packed.shape[0]) + packed.shape[0]) % packed.shape[0];
      return i >= 0 && j >= 0 && i < packed.shape[0] && j < packed.shape[1] ? told(cell(packed, i, j), packed.levels[i * packed.shape[1] + j]) : "";
    });
    const told = texts.filter(Boolean).join(", ");
    this.readout.textContent = told ? `${where}: ${told}` : where;
  }

  /** The map as a picture of its own, with its title. */
  savePng(file) {
    const map = document.createElement("canvas");
    // The lines that choose a section are the page's own.
    const { scene } = this;
    this.scene = { ...scene, lines: (scene.lines || []).filter((line) => line.width) };
    this.paint(map, Math.max(560, this.width), 2, false);
    this.scene = scene;
    const sheet = document.createElement("canvas");
    [sheet.width, sheet.height] = [map.width, map.height + 88];
    const c = sheet.getContext("2d");
    c.fillStyle = style("--paper");
    c.fillRect(0, 0, sheet.width, sheet.height);
    c.fillStyle = style("--ink");
    c.font = "26px system-ui, sans-serif";
    c.fillText(this.caption.textContent, 20, 38, sheet.width - 40);
    c.fillStyle = style("--faint");
    c.font = "20px system-ui, sans-serif";
    c.fillText(document.title, 20, 68, sheet.width - 40);
    c.drawImage(map, 0, 88);
    sheet.toBlob((blob) => save(`${file}.png`, blob));
  }
}

function paintBar(c, { range, unit, label, kind }, [left, top, w, h]) {
  const palette = palettes[paletteOf(kind)].css;
  const [low, high] = runsFromLowest(kind) ? range : [0, range[1]];
  for (let k = 0; k < 256; k++) {
    c.fillStyle = palette[255 - k];
    c.fillRect(left, top + (k * h) / 256, w, h / 256 + 1);
  }
  c.strokeStyle = style("--line");
  c.strokeRect(left - 0.5, top - 0.5, w + 1, h + 1);
  c.fillStyle = style("--ink");
  c.textAlign = "left";
  c.textBaseline = "middle";
  const log = kind === "logarithmic";
  const [first, last] = [low, high].map((v) => (log ? Math.log10(v / unit.factor) : v / unit.factor));
  const marks = log ? decades(first, last) : ticks(first, last, Math.max(4, h / 40));
  labels(marks, log).forEach((text, k) => c.fillText(text, left + w + 5, top + h - ((marks[k] - first) / (last - first)) * h));
  c.save();
  c.translate(left + w + 46, top + h / 2);
  c.rotate(Math.PI / 2);
  c.textAlign = "center";
  c.fillText(unit.symbol ? `${label} (${unit.symbol})` : label, 0, 0);
  c.restore();
}

/** A packed map as pixels on a canvas of its own, y upwards, or downwards where it is a depth; `used` is one of before. */
function pixels({ packed, kind, range, relief }, down, used) {
  const [nx, ny] = packed.shape;
  const kept = used && used.image.width === nx && used.image.height === ny ? used : blankPixels(nx, ny);
  const { canvas, image } = kept;
  const out = new Uint32Array(image.data.buffer);
  const colours = colouring(packed, kind, range);
  const { levels } = packed;
  for (let j = 0; j < ny; j++) {
    const begin = (down ? j : ny - 1 - j) * nx;
    for (let i = 0, n = j; i < nx; i++, n += ny) out[begin + i] = colours[levels[n]];
  }
  if (relief) shade(image, packed, range);
  canvas.getContext("2d").putImageData(image, 0, 0);
  return kept;
}

function blankPixels(nx, ny) {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [nx, ny];
  return { canvas, image: new ImageData(nx, ny) };
}

/** Light from the upper left over heights. */
function shade(image, packed, range) {
  const [nx, ny] = packed.shape;
  const steep = 12 / (range[1] - range[0] || 1);
  for (let i = 0; i < nx; i++) {
    for (let j = 0; j < ny; j++) {
      const slope = (di, dj) => cell(packed, Math.min(nx - 1, i + di), Math.min(ny - 1, j + dj)) - cell(packed, Math.max(0, i - di), Math.max(0, j - dj));
      const [sx, sy] = [slope(1, 0) * steep, slope(0, 1) * steep];
      const light = (0.6 - 0.5 * sx + 0.5 * sy) / Math.hypot(1, sx, sy);
      const factor = Math.max(0.35, Math.min(1.6, 0.55 + 0.75 * light));
      const at = 4 * ((ny - 1 - j) * nx + i);
      for (let k = 0; k < 3; k++) image.data[at + k] = Math.min(255, image.data[at + k] * factor);
    }
  }
}
