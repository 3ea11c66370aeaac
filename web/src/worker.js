"use strict";
// The program of a worker. It follows the code of wasm-bindgen in the same file, and does one call after the other.

/** Functions that answer with JSON. */
const JSON_CALLS = new Set(["files", "examples", "materials", "pair", "read_case", "commands", "scan", "check", "figures", "colours"]);

/** Version of each file of a run that has been sent to the page. */
const sent = new Map();

/** Returns [name, bytes] of the files below a folder that are new or have changed. */
function news(folder) {
  const fresh = JSON.parse(wasm_bindgen.files(folder)).filter(({ name, version }) => sent.get(name) !== version);
  return fresh.map(({ name, version }) => {
    sent.set(name, version);
    return [name, wasm_bindgen.get(name)];
  });
}

function post(message, files = []) {
  postMessage(message, files.map(([, bytes]) => bytes.buffer));
}

const calls = {
  start(module) {
    wasm_bindgen.initSync({ module });
    return wasm_bindgen.version();
  },

  /** Describes a surface, and returns its map. */
  surface(topography) {
    const surface = new wasm_bindgen.Surface(wasm_bindgen.write_case(JSON.stringify(topography)));
    try {
      return { about: JSON.parse(surface.about()), map: JSON.parse(surface.map()) };
    } finally {
      surface.free();
    }
  },

  /** Returns the bytes of a file with a prepared surface. */
  prepared(topography, name) {
    const surface = new wasm_bindgen.Surface(wasm_bindgen.write_case(JSON.stringify(topography)));
    try {
      surface.write(name);
      return wasm_bindgen.get(name);
    } finally {
      surface.free();
      wasm_bindgen.remove(name);
    }
  },

  /** Runs a case. Its files go to the page after each step. */
  run(name, folder, existing) {
    const hand = (event) => {
      const files = event.kind === "progress" ? [] : news(folder);
      post({ event, files }, files);
    };
    wasm_bindgen.run(name, folder, existing, (event) => hand(JSON.parse(event)));
    return calls.report(folder);
  },

  /** Writes the report, and sends new files to the page. */
  report(folder) {
    wasm_bindgen.report(folder);
    const files = news(folder);
    post({ event: { kind: "end" }, files }, files);
    return null;
  },
};

onmessage = ({ data: { id, call, given } }) => {
  try {
    const plain = () => wasm_bindgen[call](...given);
    const answer = calls[call] ? calls[call](...given) : JSON_CALLS.has(call) ? JSON.parse(plain()) : plain();
    postMessage({ id, answer });
  } catch (error) {
    const { name, message, hint, key, line, column, available } = error;
    const broken = error instanceof WebAssembly.RuntimeError || error instanceof RangeError;
    postMessage({ id, failure: { name, message, hint, key, line, column, available, broken } });
  }
};
