// Workers that hold the module. A call is a message. Ending the worker ends a long call.

import { through } from "./packing.js";

/** An error of the module or of the page, with `hint`, `key` and `line` if there are any. */
export class Failure extends Error {
  constructor({ message, ...more }) {
    super(message);
    Object.assign(this, more);
  }
}

const BROKEN = {
  name: "Memory",
  message: "This browser tab has not enough memory for that, or the program has failed.",
  hint: "take a coarser pitch or a smaller window, or run the case file with the command on this machine",
};

/** Returns the packed module and the program of the worker. They are files beside the page, or parts of it. */
async function parts() {
  const inside = document.getElementById("module");
  if (!inside) return Promise.all([fetch("asperity.bin").then((r) => r.blob()), fetch("worker.js").then((r) => r.text())]);
  const packed = Uint8Array.from(atob(inside.textContent), (letter) => letter.charCodeAt(0));
  return [packed, document.getElementById("worker").textContent];
}

const compiled = parts().then(async ([packed, text]) => {
  const module = await WebAssembly.compile(await through(packed, new DecompressionStream("deflate")));
  return { module, url: URL.createObjectURL(new Blob([text], { type: "text/javascript" })) };
});

/** A worker with an instance of the module. */
export class Engine {
  #waiting = new Map();
  #ended = false;

  /** `heard(event, files)` gets the events of a call. */
  constructor(heard = () => {}) {
    this.heard = heard;
    this.count = 0;
    this.ready = compiled.then(({ module, url }) => {
      if (this.#ended) throw new Failure({ name: "Stopped", message: "stopped" });
      this.worker = new Worker(url);
      this.worker.onmessage = ({ data: message }) => this.#hear(message);
      this.worker.onerror = () => this.end(BROKEN);
      return this.#send("start", [module]);
    });
    this.ready.catch(() => {});
  }

  /** Calls a function of the module, and returns its answer. */
  async call(call, ...given) {
    await this.ready;
    return this.#send(call, given);
  }

  #send(call, given) {
    if (this.#ended) return Promise.reject(new Failure(BROKEN));
    return new Promise((resolve, reject) => {
      const id = ++this.count;
      this.#waiting.set(id, { resolve, reject });
      this.worker.postMessage({ id, call, given });
    });
  }

  #hear({ id, answer, failure, event, files }) {
    if (event) { this.heard(event, files); return; }
    if (failure && failure.broken) { this.end(BROKEN); return; }
    const { resolve, reject } = this.#waiting.get(id);
    this.#waiting.delete(id);
    if (failure) reject(new Failure(failure));
    else resolve(answer);
  }

  get ended() { return this.#ended; }

  /** Ends the worker. Pending calls fail with the reason. */
  end(reason = { name: "Stopped", message: "stopped" }) {
    this.#ended = true;
    if (this.worker) this.worker.terminate();
    for (const { reject } of this.#waiting.values()) reject(new Failure(reason));
    this.#waiting.clear();
  }
}

/** A worker for short calls. It has the files of the case, and is replaced if it fails. */
export class Desk {
  constructor(files) {
    this.files = files;
    this.engine = new Engine();
    this.has = new Map();
  }

  async call(call, ...given) {
    if (this.engine.ended) {
      this.engine = new Engine();
      this.has.clear();
    }
    const { engine } = this;
    for (const [name, bytes] of this.files) {
      if (this.has.get(name) === bytes) continue;
      this.has.set(name, bytes);
      engine.call("put", name, bytes).catch(() => {});
    }
    return engine.call(call, ...given);
  }
}

/** A run of a case in its own worker. `files` has the finished part, also after a stop. */
export class Run {
  /** `inputs` are the files that the case reads; `heard(event)` gets the events of the run. */
  constructor(inputs, text, folder, heard) {
    Object.assign(this, { inputs, text, folder, heard, files: new Map(), running: false });
  }

  /** Starts the run, or continues it after a stop. */
  async go() {
    const existing = this.files.size > 0 ? "resume" : "keep";
    await this.#with(async (engine) => {
      await engine.call("put", "case.toml", new TextEncoder().encode(this.text));
      await engine.call("run", "case.toml", this.folder, existing);
    });
  }

  stop() {
    this.running = false;
    if (this.engine) this.engine.end();
  }

  /** Writes the report of the finished part. */
  async report() {
    if (this.files.size > 0) await this.#with((engine) => engine.call("report", this.folder));
  }

  /** Returns the report as text; `undefined` if there is none yet. */
  page() {
    const bytes = this.files.get(`${this.folder}/report.html`);
    return bytes && new TextDecoder().decode(bytes);
  }

  async #with(work) {
    const engine = new Engine((event, files) => {
      for (const [name, bytes] of files) this.files.set(name, bytes);
      this.heard(event);
    });
    this.engine = engine;
    this.running = true;
    try {
      for (const [name, bytes] of [...this.inputs, ...this.files]) await engine.call("put", name, bytes);
      await work(engine);
    } finally {
      engine.end();
      if (this.engine === engine) this.running = false;
    }
  }
}
