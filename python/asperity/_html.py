"""What a notebook shows of an object: its main numbers beside a small map, with nothing but numpy."""

from __future__ import annotations

import base64
import html
import struct
import zlib
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._show import Values, largest, look, scale, unit_of, words

_COLOURS = {
    "viridis": "440154 472d7b 3b528b 2c728e 21918c 28ae80 5ec962 addc30 fde725",
    "cividis": "00224e 1a386f 434e6c 61656f 7d7c78 9b9476 bcae6c dec958 fee838",
    "RdBu_r": "053061 2f79b5 90c4dd dbeaf2 f7f6f6 fcd7c2 ee9677 bf3338 67001f",
}
"""Nine colours of each map, at even distances."""

_MAX_FAILURES = 5
"""Largest number of failures of a study that are shown."""

_SIDE = 160
"""Most pixels along a side of a map."""


def _png(pixels: NDArray[np.uint8]) -> bytes:
    """A PNG file of an image ``[row, column, rgb]``."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def _averaged(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Means over squares of cells with values, with at most `_SIDE` squares along each side."""
    step = -(-max(values.shape) // _SIDE)
    if step == 1:
        return values
    starts = [np.arange(0, count, step) for count in values.shape]

    def sums(array: NDArray[Any]) -> NDArray[np.float64]:
        rows: NDArray[np.float64] = np.add.reduceat(array.astype(np.float64), starts[0], axis=0)
        return np.asarray(np.add.reduceat(rows, starts[1], axis=1), dtype=np.float64)

    there = np.isfinite(values)
    with np.errstate(invalid="ignore"):
        return sums(np.where(there, values, 0.0)) / sums(there)


def _map(name: str, values: NDArray[np.float64], unit: str) -> tuple[str, str]:
    """A field as an inline image, x to the right and y upwards; grey where there is no value, white out of contact.

    Its caption has the name of the field and the values at the two ends of the colours.
    """
    values = _averaged(np.asarray(values, dtype=np.float64))
    colours = look(name, values)
    anchors = np.array([list(bytes.fromhex(text)) for text in _COLOURS[colours.colours].split()], dtype=np.float64)
    share = np.clip((np.nan_to_num(values) - colours.low) / (colours.high - colours.low), 0.0, 1.0)
    places = np.linspace(0.0, 1.0, len(anchors))
    pixels = np.stack([np.interp(share, places, anchors[:, channel]) for channel in range(3)], axis=-1)
    if colours.blank is not None:
        pixels[values < 0.0] = (220.0, 20.0, 60.0)
        pixels[colours.is_blank(values)] = 255.0
    pixels[~np.isfinite(values)] = 191.0
    image = np.ascontiguousarray(np.rint(pixels).astype(np.uint8).transpose(1, 0, 2)[::-1])
    data = base64.b64encode(_png(image)).decode()
    longer = max(values.shape)
    width, height = (max(1, round(200 * count / longer)) for count in values.shape)
    style = "image-rendering:pixelated;border:1px solid #888"
    text = html.escape(words(name), quote=True)
    picture = f'<img width="{width}" height="{height}" alt="{text}" style="{style}" src="data:image/png;base64,{data}">'
    value = scale(unit, max(abs(colours.low), abs(colours.high)))
    ends = " … ".join(f"{value.factor * end:.3g}" for end in (colours.low, colours.high))
    return picture, f"{words(name)}, {ends}{'' if value.unit == '1' else ' ' + value.unit}"


def _shown(title: str, rows: list[tuple[str, str]], picture: str, caption: str, remarks: list[str] | None = None) -> str:
    """A table of numbers, and a map with its caption to the right of it."""
    lines = "".join(
        f'<tr><th style="text-align:left">{html.escape(name)}</th><td style="text-align:left">{html.escape(value)}</td></tr>'
        for name, value in rows
    )
    below = "".join(f"<div>⚠ {html.escape(remark)}</div>" for remark in remarks or [])
    beside = f"<figure style=\"margin:0\">{picture}<figcaption>{html.escape(caption)}</figcaption></figure>" if picture else ""
    return (
        f"<div><strong>{html.escape(title)}</strong>"
        f'<div style="display:flex;gap:1.5em;align-items:flex-start"><table>{lines}</table>{beside}</div>{below}</div>'
    )


_DIMENSIONS = {
    "m": "length", "m²": "area", "m³": "volume", "Pa": "pressure", "N": "force", "J": "energy", "s": "time",
}  # fmt: skip


def _quantity(value: float, unit: str) -> str:
    if unit in _DIMENSIONS:
        text: str = _core.format(value, _DIMENSIONS[unit])
        return text
    return f"{value:.4g}" if unit == "1" else f"{value:.4g} {unit}"


def _grid(shape: tuple[int, ...], pitch: tuple[float, ...]) -> list[tuple[str, str]]:
    cells = " × ".join(map(str, shape))
    size = " × ".join(_core.format(step, "length") for step in pitch)
    extent = " × ".join(_core.format(count * step, "length") for count, step in zip(shape, pitch, strict=True))
    return [("cells", f"{cells} of {size}"), ("extent", extent)]


def code(text: str) -> str:
    """A text as code."""
    return f"<div><code>{html.escape(text)}</code></div>"


def surface(heights: NDArray[np.float64], pitch: tuple[float, float]) -> str:
    """A surface: its grid, its heights."""
    rows = _grid(heights.shape, pitch)
    there = heights[np.isfinite(heights)]
    if there.size:
        # Heights of 1e300 have no square.
        with np.errstate(over="ignore", invalid="ignore"):
            sq, sz = float(there.std()), float(np.ptp(there))
        rows += [("Sq", _core.format(sq, "length")), ("Sz", _core.format(sz, "length"))]
    undefined = int(np.isnan(heights).sum())
    if undefined:
        rows.append(("missing", f"{undefined} ({100.0 * undefined / heights.size:.2g} %)"))
    return _shown("Surface", rows, *_map("heights", heights, "m"))


def field(field: Values) -> str:
    """A field: its grid, its least, mean and largest value."""
    values = np.asarray(field.values, dtype=np.float64)
    rows = _grid(values.shape, field.pitch)
    there = values[np.isfinite(values)]
    if there.size:
        value = scale(field.unit, largest(there))
        unit = "" if value.unit == "1" else f" {value.unit}"
        numbers = (("least", there.min()), ("mean", there.mean()), ("largest", there.max()))
        rows += [(name, f"{value.factor * number:.4g}{unit}") for name, number in numbers]
    pictured = _map(field.name, values, field.unit) if values.ndim == 2 else ("", "")
    return _shown(words(field.name), rows, *pictured)


def contact(
    numbers: Mapping[str, Any],
    pressure: Values,
    *,
    fraction: float,
    points: int,
    adhesion: Mapping[str, Any] | None,
    theory: Mapping[str, Any] | None,
    warnings: list[str],
) -> str:
    """A contact: its main numbers and its pressure; of a sweep, the last of its `points`."""
    load, area = numbers["load"], numbers["contact_area"]
    rows = [("load", _quantity(load, "N")), ("approach", _quantity(numbers["approach"], "m"))]
    rows.append(("area of contact", f"{_quantity(area, 'm²')} ({100.0 * fraction:.3g} %)"))
    rows.append(("mean pressure on it", _quantity(load / area if area > 0.0 else 0.0, "Pa")))
    rows.append(("largest pressure", _quantity(numbers["max_pressure"], "Pa")))
    rows.append(("mean gap", _quantity(numbers["mean_gap"], "m")))
    if numbers["plastic_volume"] > 0.0:
        # A point of a sweep has the area of these cells.
        dx, dy = pressure.pitch
        cells = numbers["plastic_cells"] if "plastic_cells" in numbers else round(numbers["plastic_area"] / (dx * dy))
        rows.append(("plastic", f"{cells} cells, {_quantity(numbers['plastic_volume'], 'm³')}"))
    if adhesion is not None:
        rows.append(("adhesive load", _quantity(numbers["adhesive_load"], "N")))
        if adhesion["pull_off"] is not None:
            rows.append(("pull-off", _quantity(adhesion["pull_off"], "N")))
    force = numbers.get("tangential_force")
    if force is not None and any(force):
        share = f" ({numbers['force_ratio']:.3g} of the load)" if load > 0.0 else ""
        rows.append(("tangential force", _quantity(float(np.hypot(*force)), "N") + share))
    if theory is not None:
        names = {"largest pressure": "max_pressure", "approach": "approach"}
        known = [(words, theory[f"{name}_deviation"]) for words, name in names.items() if theory[f"{name}_deviation"] is not None]
        deviations = ", ".join(f"{words} {100.0 * deviation:+.2f} %" for words, deviation in known)
        rows.append((f"deviation from theory ({theory['theory']})", deviations))
    rows.append(("residual", f"{numbers['residual']:.1e}, {numbers['convolutions']:.4g} convolutions"))
    if points > 1:
        rows.insert(0, ("sweep", f"{points} points, this is the last one"))
    return _shown("Contact", rows, *_map("pressure", pressure.values, pressure.unit), warnings)


def run(
    case: Mapping[str, Any], passes: NDArray[np.void], fields: Callable[[], Mapping[str, Values]], warnings: list[str]
) -> str:
    """A motion: its last pass in numbers, and the lower body's mean pressure in it."""
    title = f"Run: {len(passes)} of {case['motion']['passes']} passes"
    if case["title"]:
        title += f", {case['title']}"
    if len(passes) == 0:
        return _shown(title, [], "", "")
    last = passes[-1]
    names = (
        "mean_load", "approach", "mean_contact_area", "max_pressure", "plastic_volume_lower", "plastic_volume_upper",
        "sq_lower", "sq_upper",
    )  # fmt: skip
    rows = [(words(name), _quantity(float(last[name]), unit_of(name))) for name in names if name in (passes.dtype.names or ())]
    found = fields()
    shown = found["mean_pressure_lower" if "mean_pressure_lower" in found else "lower"]
    return _shown(title, [("pass", str(int(last["pass"]))), *rows], *_map(shown.name, shown.values, shown.unit), warnings)


def study(title: str, axes: Mapping[str, NDArray[Any]], units: Mapping[str, str], failures: Mapping[int, str]) -> str:
    """A study: its axes, and why cases have failed."""
    rows = []
    for key, values in axes.items():
        texts = [
            str(value) if values.dtype.kind in "Ui" else _quantity(float(value), units[key] or "1") for value in values[[0, -1]]
        ]
        rows.append((key, texts[0] if len(values) == 1 else f"{len(values)} values, {texts[0]} to {texts[1]}"))
    remarks = [f"case {case}: {message}" for case, message in failures.items()]
    return _shown(title, rows, "", "", remarks[:_MAX_FAILURES])
