"""Roughness parameters of measured surfaces: asperity beside surfalize and SurfaceTopography.

    python benches/peers/roughness.py FOLDER [--asperity target/release/asperity] [--json FILE]

FOLDER holds measured files without missing heights, of any format that asperity reads. Each is levelled by a plane
once, by asperity, and all programs get the same heights; what differs is how each understands a parameter, which
`README.md` explains.
"""

import argparse
import json
import math
import pathlib
import subprocess
import tempfile
import warnings

import numpy as np
import SurfaceTopography
import surfalize

FILES = ("al3d-1.al3d", "metropro-1.dat", "x3p-2.x3p")
UM = 1e-6
# Parameters of hills and dales: by default surfalize leaves out those at the edge.
FEATURES = ("S5p", "S5v", "S10z", "Spd", "Svd", "Spc", "Svc")
# Of each parameter: the unit of surfalize in SI, where it has the parameter.
SURFALIZE = {
    **dict.fromkeys(("Sa", "Sq", "Sp", "Sv", "Sz", "Sk", "Spk", "Svk", "Spkx", "Svkx", "Sal", "Ssw", "Sxp"), UM),
    **dict.fromkeys(("S5p", "S5v", "S10z", "Vmp", "Vmc", "Vvc", "Vvv"), UM),
    **dict.fromkeys(("Sak1", "Sak2"), 1e-2 * UM),
    **dict.fromkeys(("Ssk", "Sku", "Sdq", "Str"), 1.0),
    **dict.fromkeys(("Sdr", "Smrk1", "Smrk2"), 1e-2),
    **dict.fromkeys(("Spd", "Svd"), UM**-2),
    **dict.fromkeys(("Spc", "Svc"), UM**-1),
    "Std": math.pi / 180,
}


def run(*arguments):
    return subprocess.run([str(a) for a in arguments], check=True, capture_output=True, text=True).stdout


def by_asperity(program, heights_file, pitch):
    size = ",".join(f"{p!r}" for p in pitch)
    info = json.loads(run(program, "surface", "info", heights_file, "--pitch", size, "--json"))
    moments = info["moments"]
    return info["parameters"] | {"√m2": math.sqrt(sum(moments["m2"]))}


def by_surfalize(heights, pitch):
    # Its rows run down the map, and it counts in micrometres.
    surface = surfalize.Surface(heights.T[::-1] / UM, pitch[0] / UM, pitch[1] / UM)
    values = {}
    for symbol, unit in SURFALIZE.items():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            options = {"exclude_edge": False} if symbol in FEATURES else {}
            values[symbol] = float(getattr(surface, symbol)(**options)) * unit
    return values


def by_surface_topography(heights, pitch):
    extent = tuple(n * p for n, p in zip(heights.shape, pitch))
    topography = SurfaceTopography.Topography(heights, extent)
    return {
        "Sq": topography.rms_height_from_area(),
        "Sdq": topography.rms_gradient(),
        "√m2": math.sqrt(topography.moment_power_spectrum(2, window="hann")),
    }


def spectra(program, heights_file, heights, pitch, folder):
    """Ratio of SurfaceTopography's radially averaged spectrum to ours: median and extremes over its wave numbers."""
    size = ",".join(f"{p!r}" for p in pitch)
    run(program, "surface", "plot", heights_file, "--pitch", size, "--out", pathlib.Path(folder, "figures"))
    curves = json.loads(pathlib.Path(folder, "figures", "curves.json").read_text())
    ours = np.array([[point["wave_number"], point["density"]] for point in curves["spectrum"]["radial"]])
    extent = tuple(n * p for n, p in zip(heights.shape, pitch))
    topography = SurfaceTopography.Topography(heights, extent)
    wave_number, density = topography.power_spectrum_from_area(window="hann")
    # Where a ring holds enough waves for the two to bin the same ones.
    known = (density > 0) & (wave_number > ours[4, 0]) & (wave_number < ours[-1, 0])
    at = np.exp(np.interp(np.log(wave_number[known]), *np.log(ours).T))
    return np.quantile(density[known] / at, [0.5, 0, 1])


def row(symbol, ours, others):
    cells = [f"{symbol:8}", f"{ours:12.5g}"]
    for other in others:
        known = other is not None and math.isfinite(other) and math.isfinite(ours)
        share = f"{100 * (other - ours) / abs(ours):+.3g} %" if known and ours else ""
        cells += [f"{other:12.5g}" if other is not None else " " * 12, f"{share:>10}"]
    return "| " + " | ".join(cells) + " |"


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("folder", type=pathlib.Path)
    arguments.add_argument("--asperity", type=pathlib.Path, default="target/release/asperity")
    arguments.add_argument("--json", type=pathlib.Path)
    arguments = arguments.parse_args()
    results = {}
    for name in FILES:
        with tempfile.TemporaryDirectory() as folder:
            heights_file = pathlib.Path(folder, "heights.npy")
            program = arguments.asperity
            pitch = json.loads(run(program, "surface", "info", arguments.folder / name, "--json"))["pitch"]
            run(program, "surface", "convert", arguments.folder / name, heights_file, "--level", "plane")
            heights = np.load(heights_file)
            ours = by_asperity(program, heights_file, pitch)
            ratio = spectra(program, heights_file, heights, pitch, folder)
        peers = by_surfalize(heights, pitch), by_surface_topography(heights, pitch)
        ours = {symbol: math.nan if value is None else value for symbol, value in ours.items()}
        print(f"\n{name}: {heights.shape[0]} × {heights.shape[1]}, pitch {pitch[0]:.4g} m\n")
        print("| | asperity | surfalize | | SurfaceTopography | |\n|---|---|---|---|---|---|")
        for symbol, value in ours.items():
            others = [peer.get(symbol) for peer in peers]
            if any(other is not None for other in others):
                print(row(symbol, value, others))
        print("\nspectrum, SurfaceTopography / asperity: {:.3f} ({:.3f} to {:.3f})".format(*ratio))
        results[name] = {"asperity": ours, "surfalize": peers[0], "SurfaceTopography": peers[1]}
    if arguments.json:
        arguments.json.write_text(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
