// The case: its tables, as in a case file, and its earlier tables for undo.

/** Returns the value that the text of a field means in a case file; `undefined` if the field is empty. */
export function parsed(text) {
  const trimmed = text.trim();
  if (trimmed === "") return undefined;
  if (/^\[.*\]$/.test(trimmed)) return trimmed.slice(1, -1).split(",").map(parsed).filter((value) => value !== undefined);
  if (trimmed === "true" || trimmed === "false") return trimmed === "true";
  return /^[-+]?(\d[\d_]*\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(trimmed) ? Number(trimmed.replaceAll("_", "")) : trimmed;
}

/** Returns the text of a field for a value. */
export function shown(value) {
  if (value === undefined || value === null) return "";
  return Array.isArray(value) ? `[${value.map(shown).join(", ")}]` : String(value);
}

/** Returns the value under a dotted key. */
export function valueAt(tables, key) {
  return key.split(".").reduce((table, name) => (table === undefined || table === null ? undefined : table[name]), tables);
}

/** Returns a copy of tables with another value under a key. Empty tables are removed. */
function withValue(tables, [name, ...rest], value) {
  const copy = { ...tables };
  const own = rest.length ? withValue(copy[name] || {}, rest, value) : value;
  if (own === undefined) delete copy[name];
  else copy[name] = own;
  return Object.keys(copy).length ? copy : undefined;
}

export class Case extends EventTarget {
  tables = {};
  /** Text from which the tables were read; `null` after a change. */
  text = null;
  #past = [];

  get(key) { return valueAt(this.tables, key); }

  set(key, value) { this.change({ [key]: value }); }

  /** Sets several keys in one step. */
  change(values) {
    let { tables } = this;
    for (const [key, value] of Object.entries(values)) tables = withValue(tables, key.split("."), value) || {};
    if (JSON.stringify(tables) === JSON.stringify(this.tables)) return;
    this.replace(tables);
  }

  /** Replaces all tables. */
  replace(tables, text = null) {
    this.#past.push([this.tables, this.text]);
    [this.tables, this.text] = [tables, text];
    this.dispatchEvent(new Event("change"));
  }

  get canUndo() { return this.#past.length > 1; }

  undo() {
    if (!this.canUndo) return;
    [this.tables, this.text] = this.#past.pop();
    this.dispatchEvent(new Event("change"));
  }

  get moves() { return Boolean(this.tables.motion); }

  /** Returns the names of the files that the case reads. */
  files() {
    const found = new Set();
    const search = (table) => {
      for (const [name, value] of Object.entries(table || {})) {
        if (name === "file" && typeof value === "string") found.add(value);
        else if (typeof value === "object") search(value);
      }
    };
    search(this.tables);
    return [...found];
  }

  /** Returns the tables of the static contact of the same bodies, without the keys that need a motion. */
  atRest() {
    if (!this.moves) return this.tables;
    const { title, lower, upper, contact, adhesion, conductance, flow } = this.tables;
    const pressed = (body = {}) => without(body, conductance ? OF_PASSES : [...OF_PASSES, ...THERMAL]);
    const tables = { title, lower: pressed(lower), upper: pressed(upper), contact: { ...contact, grid: "common" }, conductance, flow,
      adhesion: adhesion && without(adhesion, ["history"]) };
    return without(tables, Object.keys(tables).filter((name) => tables[name] === undefined));
  }
}

/** Tables of a body that need a motion. */
const OF_PASSES = ["wear", "film", "fatigue", "viscoelastic", "plasticity"];
/** Constants of a body that need a temperature. */
const THERMAL = ["conductivity", "heat_capacity", "density"];

/** Returns a table without some of its keys. */
function without(table, names) {
  return Object.fromEntries(Object.entries(table).filter(([name]) => !names.includes(name)));
}
