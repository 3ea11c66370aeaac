"use strict";
// The page as a whole: dark or light, the case to the clipboard, stress below the surface, what is unpacked ahead.

const theme = document.getElementById("theme");
const prefersDark = window.matchMedia("(prefers-color-scheme: dark)");
const isDark = () => (document.documentElement.dataset.theme || (prefersDark.matches ? "dark" : "light")) === "dark";

function themed() {
  theme.textContent = isDark() ? "light" : "dark";
  theme.setAttribute("aria-label", `colours: ${theme.textContent}`);
  redraws.forEach((redraw) => redraw());
}

theme.hidden = false;
theme.addEventListener("click", () => {
  document.documentElement.dataset.theme = isDark() ? "light" : "dark";
  themed();
});
prefersDark.addEventListener("change", themed);
theme.textContent = isDark() ? "light" : "dark";

for (const button of document.querySelectorAll(".copy")) {
  button.hidden = false;
  button.addEventListener("click", async () => {
    const text = document.getElementById("case").textContent;
    try {
      await navigator.clipboard.writeText(text);
      button.textContent = "copied";
    } catch {
      getSelection().selectAllChildren(document.getElementById("case"));
    }
  });
}

async function showBelow(place, below) {
  await unpack(below.map);
  const { shape, pitch } = below.map;
  const view = new MapView(place, below.title, "subsurface");
  view.show({
    region: [[below.x, below.x + shape[0] * pitch[0]], [0, shape[1] * pitch[1]]], length: below.length, down: true, names: ["x", "depth"],
    images: [{ packed: below.map, kind: "positive", range: below.range, corner: [below.x, 0], told: (v) => written(v, below.unit) }],
    bar: { range: below.range, unit: below.unit, label: "von Mises stress", kind: "positive" },
    marks: below.mark ? [below.mark] : [],
    classes: below.mark ? [["#d02020", "most stressed point"]] : null,
  });
}

/** Resolved once all is drawn. */
const ready = (async () => {
  await bodiesReady;
  if (scrubber) await scrubber.show();
  if (data.below) await showBelow(document.getElementById("below"), data.below);
  document.documentElement.dataset.ready = "true";
  // The other positions, so that none keeps the hand waiting.
  for (const frame of scrubber ? scrubber.frames : []) await Promise.all(Object.values(frame.maps).map(unpack));
  document.documentElement.dataset.unpacked = "true";
})();
