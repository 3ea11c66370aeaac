//! The functions of asperity for a page in a browser.
//!
//! Everything works on named files in memory. A name is a path with `/` between folders, such as
//! `quickstart/results/summary.json`. Paths in a case file are relative to its folder. No function waits or
//! asks for a network: call them from a worker.
//!
//! | group | functions |
//! |---|---|
//! | files | `put`, `get`, `files`, `remove` |
//! | cases | `examples`, `example`, `read_case`, `write_case`, `commands`, `materials` |
//! | surfaces | `scan`, `Surface`, `colours` |
//! | runs | `check`, `run`, `report`, `figures`, `figure` |
//! | program | `version` |
//!
//! Answers are texts of JSON, numbers in SI, unless a function says otherwise. A function fails with an
//! `Error` of JavaScript: `name` is the cause (`Case`, `File`, `CorruptTopography`, `BeyondPlasticLimit`,
//! `Interrupted`, …), `message` a sentence, and, if there is one, `hint` what to do, `key` the key of the
//! case file (`lower.topography.file`), `line` and `column` its place from 1, `available` the channels of a
//! file. If memory cannot be had or the program breaks, the module traps with a `WebAssembly.RuntimeError`
//! and must not be used again: end its worker.
//!
//! ```text
//! put(name: string, bytes: Uint8Array): void                    creates or replaces a file
//! get(name: string): Uint8Array                                 a copy of its bytes
//! files(folder: string): JSON [{name, bytes, version}]          all files below the folder, sorted; "" for all files; the version grows with each change
//! remove(name: string): void                                    a file, or a folder with all in it; nothing if there is none
//!
//! examples(): JSON [{name, about, files: [string]}]             the examples of `asperity example`
//! example(name: string): string                                 writes its files into the folder `name`; returns the name of its case file
//! materials(): JSON [{name, about, young, poisson, hardness, conductivity, …, source}]     as the solids of `asperity materials --json`
//! read_case(text: string): JSON                                 the tables of a text of TOML; an infinite number is the text "inf"
//! write_case(tables: JSON): string                              the text of TOML of these tables; "inf" becomes a number
//! commands(case: string): JSON {shell: string, python: string}  lines that compute the case file of this name elsewhere
//!
//! scan(name: string, reading: TOML): JSON                       what a file says by itself; reading "" or keys such as `channel = "height"`
//!     {format, channel, channels: [string], shape: [nx, ny], pitch: [dx, dy] or null, unit_known: bool, lines: "x", "y" or null, undefined, underside: bool}
//! new Surface(table: TOML)                                      a topography with the keys of [lower.topography]: `file = "disc.x3p"`, or `generate`, or
//!                                                               `form`; `channel`, `unit`, `pitch`, `level`, `fill`, `despike`, `s_filter`, `resample`, …
//!   .about(): JSON {format, channel,                            null unless read from a file
//!       shape, pitch, extent, min, max, mean, undefined,
//!       findings: [string],                                     what was filled or removed
//!       advice: string or null,                                 a tilt or form that should be removed
//!       sections: [{title, rows: [{name, numbers: [string], unit, remark}]}],          the table of `asperity surface info`
//!       numbers: {…},                                           the numbers of `asperity surface info --json`
//!       spectrum: {wavenumber: [rad/m], power: [m⁴]} or null,   radial mean
//!       material_ratio: {ratio: [0 … 1], height: [m]} or null}
//!   .map(): JSON                                                the heights as the page of results has them (`even`): maps.js draws it
//!   .heights(): Float32Array                                    m, index ix * ny + iy, NaN where undefined
//!   .write(name: string): void                                  to a file: the end of its name is .x3p, .sdf, .gwy, .npy, .vtk or .png
//!
//! colours(): JSON {heights, pressure, diverging}                the colours of maps, for maps.js
//!
//! check(case: string): JSON                                     the case file of this name, before it is run
//!     {title, rows: [{name, text}], warnings: [string], shapes: [[nx, ny], [nx, ny]], pitch: [dx, dy], memory: bytes, seconds,
//!      one_increment: bool,                                     whether it is one contact in one increment, and no course of several
//!      coarser: {pitch: [dx, dy], memory} or null}              a pitch that fits into 1.5 GB, if the case does not
//! run(case: string, folder: string, existing: "keep", "overwrite" or "resume", watch: function): JSON      the content of summary.json
//!     watch(event: JSON): anything truthy to stop, then run fails with `Interrupted`; finished steps stay. In it `files` and `get` may be called.
//!       {kind: "progress", part: 0 … 1, text}
//!       {kind: "step", step: "pass", "point", "update" or "increment", number, of, record: {…} or null}      its files are written
//!       {kind: "warning", text}
//! report(folder: string): void                                  writes `folder/report.html` from the results in the folder, finished or not
//! figures(folder: string): JSON [string]                        names of the figures of results
//! figure(folder: string, name: string, format: "png", "svg" or "pdf"): Uint8Array
//!
//! version(): string
//! ```
//!
//! After a worker has been ended, a new one continues: `put` each file of the results, then `run` with
//! `"resume"`.

#[cfg(target_arch = "wasm32")]
#[expect(unreachable_pub, reason = "JavaScript calls them")]
mod bindings;
pub mod cases;
mod failure;
pub mod files;
pub mod runs;
pub mod surfaces;

pub use failure::{Failure, Result};
