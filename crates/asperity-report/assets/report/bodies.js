"use strict";
// The bodies: before, after, difference; relief; profiles through a point that is clicked.

/** What is left of a body, packed as its heights are. */
function remaining(body) {
  const { before } = body;
  const levels = new Uint16Array(before.levels.length);
  const [low, high] = [before.low - 0.5 * (before.high - before.low), before.high + 0.5 * (before.high - before.low)];
  const [, ny] = before.shape;
  for (let n = 0; n < levels.length; n++) {
    const z = after(body, Math.floor(n / ny), n % ny);
    levels[n] = Number.isFinite(z) ? Math.max(0, Math.min(65534, Math.round(((z - low) / (high - low || 1)) * 65534))) : 65535;
  }
  return { ...before, low, high, levels };
}

async function showBody(place, body) {
  await Promise.all([unpack(body.before), body.change && unpack(body.change), ...body.kept.map((state) => unpack(state.map))]);
  const region = [0, 1].map((axis) => [0, body.before.shape[axis] * body.before.pitch[axis]]);
  let relief = false;
  let at = region.map(([, end]) => end / 2);
  const views = [];
  if (!body.flat) views.push({ title: body.change ? `Heights of the ${body.title} before the first pass.` : `Heights of the ${body.title}.`, file: `${body.name}-before`, packed: body.before, heights: true });
  if (body.change) {
    views.push({ title: `Heights of the ${body.title} after the last pass.`, file: `${body.name}-after`, packed: remaining(body), heights: true });
    views.push({ title: `Change of height of the ${body.title.split(",")[0]}: negative where material is gone.`, file: `${body.name}-change`, packed: body.change, change: true });
  }
  for (const { name, title, quantity, map, unit } of body.kept) {
    views.push({ title, file: `${body.name}-${name}`, packed: map, quantity, unit });
  }
  const pick = body.flat ? null : (x, y) => { at = [x, y]; draw(); shown.show(x, y); };
  for (const view of views) view.map = new MapView(place, view.title, view.file, pick);
  // Beside the maps, in the same grid.
  const shown = body.flat ? null : new Profiles(place, body);
  function draw() {
    const cross = body.flat ? [] : [{ from: [region[0][0], at[1]], to: [region[0][1], at[1]] }, { from: [at[0], region[1][0]], to: [at[0], region[1][1]] }];
    for (const { map, packed, heights, change, quantity, unit: own } of views) {
      const most = Math.max(packed.high, -packed.low);
      const range = heights ? body.range : change ? [-most, most] : [0, Math.max(packed.high, 0)];
      const unit = heights ? body.unit : own || body.change_unit;
      const kind = heights ? "heights" : change ? "diverging" : "signed";
      map.show({
        region, length: body.length, lines: cross,
        images: [{ packed, kind, range, corner: [0, 0], relief: relief && heights, told: (v) => written(v, unit) }],
        bar: { range, unit, label: heights ? "height" : change ? "change" : quantity, kind },
        classes: heights || change ? null : [["var(--blank)", `zero ${quantity}`]],
      });
    }
  }
  if (!views.length) return;
  const light = element("input", { type: "checkbox", onchange: () => { relief = light.checked; draw(); } });
  if (!body.flat) {
    place.before(element("div", { class: "controls" }, element("label", {}, light, "light from the upper left"),
      element("span", { class: "remark" }, "click a map for profiles through that point")));
  }
  draw();
  if (!body.flat) shown.show(...at);
}

const bodiesReady = Promise.all([...document.querySelectorAll("[data-body]")].map((place) =>
  showBody(place, data.bodies[Number(place.dataset.body)])));
