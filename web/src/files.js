// Files that are chosen or dropped, and the reasons why some are refused.

const MB = 1e6;
/** Largest file that the page reads, bytes. */
const MAX_FILE = 200 * MB;
/** Number of surfaces of a contact. */
const MAX_SURFACES = 2;

/** Reads the files of a drop. Returns [name, bytes] of each, and a sentence for each file that is refused. */
export async function taken(list, isFolder = () => false) {
  const sentences = [];
  let files = [...list].filter((file, n) => {
    const refusal = isFolder(n) ? `\`${file.name}\` is a folder: drop the files in it.` : refused(file);
    if (refusal) sentences.push(refusal);
    return !refusal;
  });
  const surfaces = files.filter(({ name }) => !isCase(name));
  if (surfaces.length > MAX_SURFACES) {
    const names = surfaces.map(({ name }) => `\`${name}\``).join(", ");
    sentences.push(`These are ${surfaces.length} surfaces: ${names}. A contact has two: drop one or two of them.`);
    files = [];
  }
  const read = await Promise.all(files.map(async (file) => {
    try {
      return [file.name, new Uint8Array(await file.arrayBuffer())];
    } catch {
      sentences.push(`\`${file.name}\` cannot be read by the browser: it may have been moved, or be a folder.`);
      return null;
    }
  }));
  return { files: read.filter(Boolean), sentences };
}

function refused({ name, size }) {
  if (size === 0) return `\`${name}\` is empty.`;
  if (size <= MAX_FILE) return null;
  return `\`${name}\` has ${Math.round(size / MB)} MB, and this page reads up to ${MAX_FILE / MB} MB. Take a part of it, \`asperity surface convert ${name} part.x3p --window 0,0,1024,1024\`, or compute with the command.`;
}

/** Returns whether a file is a case. */
export function isCase(name) { return name.endsWith(".toml"); }

/** Calls `dropped(files, isFolder, side)` for each drop; `side` is the body under the pointer. */
export function listen(dropped) {
  const root = document.documentElement;
  addEventListener("dragover", (event) => { event.preventDefault(); root.classList.add("over"); });
  addEventListener("dragleave", (event) => { if (!event.relatedTarget) root.classList.remove("over"); });
  addEventListener("drop", (event) => {
    event.preventDefault();
    root.classList.remove("over");
    const items = [...event.dataTransfer.items].filter((item) => item.kind === "file");
    const folders = items.map((item) => { const entry = item.webkitGetAsEntry(); return Boolean(entry && entry.isDirectory); });
    const side = event.target.closest ? event.target.closest("[data-side]") : null;
    dropped(event.dataTransfer.files, (n) => folders[n], side && side.dataset.side);
  });
}
