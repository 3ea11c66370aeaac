"use strict";
// What the page holds, numbers as people read them, maps unpacked, colours.

const data = JSON.parse(document.getElementById("data").textContent);

/** Four digits, as the tables have them. */
function digits(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-4 || size >= 1e6) ? value.toExponential(3) : String(Number(value.toPrecision(4)));
  return text.replace("-", "−");
}

/** A round number in full, as it stands at a tick. */
function round(value) {
  const size = Math.abs(value);
  return size !== 0 && (size < 1e-4 || size >= 1e6) ? digits(value) : String(Number(value.toPrecision(10))).replace("-", "−");
}

/** The multiple of the metre that suits lengths up to `size`. */
function lengthUnit(size) {
  return [["m", 1], ["mm", 1e-3], ["µm", 1e-6], ["nm", 1e-9]].map(([symbol, factor]) => ({ symbol, factor })).find(({ factor }) => size >= factor)
    || { symbol: "pm", factor: 1e-12 };
}

/** A title as a caption: it begins with a capital and ends with a full stop. */
function sentence(title) {
  return `${title.charAt(0).toUpperCase()}${title.slice(1)}.`;
}

/** A value, SI, in a unit { factor, symbol }. */
function written(value, unit) {
  return `${digits(value / unit.factor)} ${unit.symbol}`.trim();
}

/** About `most` round numbers between two. */
function ticks(low, high, most) {
  const least = (high - low) / Math.max(1, most);
  if (!(least > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(least));
  const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= least * 0.999);
  const all = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) all.push(Number((i * step).toPrecision(12)));
  return all;
}

const unpacking = new WeakMap();

/** The levels of a packed map; the browser's own stream inflates them. Asked twice, it is done once. */
function unpack(packed) {
  if (!unpacking.has(packed)) {
    unpacking.set(packed, inflate(packed).then((levels) => {
      packed.levels = levels;
      return packed;
    }));
  }
  return unpacking.get(packed);
}

async function inflate(packed) {
  const text = atob(packed.data);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const inflated = new Uint8Array(await new Response(stream).arrayBuffer());
  if (packed.code !== "even") return inflated;
  const [nx, ny] = packed.shape;
  const levels = new Uint16Array(nx * ny);
  for (let i = 0, n = 0; i < nx; i++) {
    let level = 0;
    for (let j = 0; j < ny; j++, n++) levels[n] = level = (level + inflated[n] * 256 + inflated[nx * ny + n]) & 0xffff;
  }
  return levels;
}

/** The value of a level, SI; NaN where nothing is defined. */
function value(packed, level) {
  switch (packed.code) {
    case "positive": return level === 0 ? 0 : ((level - 1) / 254) * packed.high;
    case "logarithmic": return level === 0 ? 0 : packed.low * (packed.high / packed.low) ** ((level - 1) / 254);
    case "class": return level === 255 ? NaN : level;
    default: return level === 65535 ? NaN : packed.low + (level / 65534) * (packed.high - packed.low);
  }
}

/** The value of a cell, SI. */
function cell(packed, i, j) {
  return value(packed, packed.levels[i * packed.shape[1] + j]);
}

/** A colour as `#rrggbb`, as a pixel. */
function pixel(text) {
  const [r, g, b] = [1, 3, 5].map((at) => parseInt(text.substr(at, 2), 16));
  return ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
}

/** The 256 colours of a table, as they are written and as pixels. */
function palette(text) {
  const css = Array.from({ length: 256 }, (_, i) => `#${text.substr(6 * i, 6)}`);
  return { css, pixels: Uint32Array.from(css, pixel) };
}

const palettes = Object.fromEntries(Object.entries(data.colours).map(([name, text]) => [name, palette(text)]));
const CLASSES = [null, "#0072b2", "#d55e00"];

/** Colours of the page's own style, as long as they hold. */
const styles = new Map();

/** One of them. */
function style(name) {
  if (!styles.has(name)) styles.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim());
  return styles.get(name);
}

/** The colours of all levels of a map, as pixels: `range` SI, `kind` heights, between, diverging, positive, signed or class. */
function colouring(packed, kind, range) {
  const levels = packed.code === "even" ? 65536 : 256;
  const pixels = new Uint32Array(levels);
  const [blank, missing] = [style("--blank"), style("--missing")].map(pixel);
  const classes = [blank, ...CLASSES.slice(1).map(pixel)];
  const palette = palettes[paletteOf(kind)].pixels;
  const [low, high] = runsFromLowest(kind) ? range : [0, range[1]];
  for (let level = 0; level < levels; level++) {
    const v = value(packed, level);
    if (Number.isNaN(v)) pixels[level] = missing;
    else if (kind === "class") pixels[level] = classes[Math.min(v, 2)];
    else if ((packed.code === "positive" || packed.code === "logarithmic") && level === 0) pixels[level] = blank;
    else if (kind === "logarithmic") pixels[level] = palette[level];
    else if (kind === "signed" && v <= 0) pixels[level] = v < -1e-9 * high ? classes[2] : blank;
    else pixels[level] = palette[high > low ? Math.max(0, Math.min(255, Math.round((255 * (v - low)) / (high - low)))) : 128];
  }
  return pixels;
}

function paletteOf(kind) {
  return kind === "heights" || kind === "diverging" ? kind : "pressure";
}

/** Whether the colours of a kind run from the lowest value on, and not from 0. */
function runsFromLowest(kind) {
  return kind === "heights" || kind === "between" || kind === "diverging" || kind === "logarithmic";
}

/** Offers bytes as a file. */
function save(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** An element with attributes and children. */
function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value !== false && value !== null) made.setAttribute(key, value === true ? "" : value);
  }
  made.append(...children);
  return made;
}

/** What is to be drawn again when the colours of the page change. */
const redraws = new Set();
