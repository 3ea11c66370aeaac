"use strict";
// The page as a whole: the case to the clipboard, maps below the surface, what is unpacked ahead.

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

/** A map that does not change, such as one below the surface. */
async function showPlane(place) {
  const { file, title, caption, map, x, down, length, quantity, unit, kind, range, mark, spans, interfaces } = data.planes[Number(place.dataset.plane)];
  await unpack(map);
  const extent = map.shape.map((cells, axis) => cells * map.pitch[axis]);
  new MapView(place, title, file).show({
    caption, region: [[x, x + extent[0]], [0, extent[1]]], length, down, names: ["x", down ? "depth" : "y"],
    images: [{ packed: map, kind, range, corner: [x, 0], told: (v) => written(v, unit) }],
    bar: { range, unit, label: quantity, kind },
    marks: mark ? [mark.at] : [],
    lines: [
      ...interfaces.map((depth) => ({ from: [x, depth], to: [x + extent[0], depth], colour: "#5a96ff", width: 1.5 })),
      ...spans.map(([from, to]) => ({ from: [from, 0], to: [to, 0], colour: "#d55e00", width: 6 })),
    ],
    classes: [...(spans.length ? [["#d55e00", "contact"]] : []), ...(interfaces.length ? [["#5a96ff", "interface"]] : []), ...(mark ? [["#d02020", mark.what]] : [])],
  });
}

/** Resolved once all is drawn. */
const ready = (async () => {
  await bodiesReady;
  if (scrubber) await scrubber.show();
  await Promise.all([...document.querySelectorAll("[data-plane]")].map(showPlane));
  document.documentElement.dataset.ready = "true";
  // The other positions, so that none keeps the hand waiting.
  for (const frame of scrubber ? scrubber.frames : []) await Promise.all(Object.values(frame.maps).map(unpack));
  document.documentElement.dataset.unpacked = "true";
})();
