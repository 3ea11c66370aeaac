// Sources of topographies, and steps of their preparation, as keys of the case file with labels.

const STATISTICS = [["ssk", "skewness"], ["sku", "kurtosis"]];

/** Generators and forms: key, title, parameters, first values. */
export const SOURCES = {
  "low-pass": { key: "generate", title: "random, low-pass", keys: [["sq", "rms height Sq"], ["cutoff", "shortest wavelength"], ["seed", "seed"], ...STATISTICS],
    given: { sq: "35 nm", cutoff: "8 um", seed: 1 } },
  "self-affine": { key: "generate", title: "random, self-affine", keys: [["sq", "rms height Sq"], ["sdq", "or rms slope Sdq"], ["hurst", "Hurst exponent"], ["rolloff", "roll-off wavelength"], ["shortest", "shortest wavelength"], ["seed", "seed"]],
    given: { sq: "40 nm", hurst: 0.8, rolloff: "32 um", shortest: "8 um", seed: 1 } },
  autocorrelation: { key: "generate", title: "random, as ground", keys: [["sq", "rms height Sq"], ["correlation_length", "correlation length"], ["lay", "lay"], ["seed", "seed"], ...STATISTICS],
    given: { sq: "0.2 um", correlation_length: ["80 um", "6 um"], lay: "90 deg", seed: 1 } },
  flat: { key: "form", title: "a plane", keys: [], given: {} },
  sphere: { key: "form", title: "a sphere", keys: [["radius", "radius"]], given: { radius: "1 mm" } },
  ellipsoid: { key: "form", title: "an ellipsoid", keys: [["radius", "radii along x and y"]], given: { radius: ["1 mm", "2 mm"] } },
  cylinder: { key: "form", title: "a cylinder", keys: [["radius", "radius"], ["axis", "crest along", ["x", "y"]]], given: { radius: "1 mm" } },
  cone: { key: "form", title: "a cone", keys: [["angle", "slope angle"]], given: { angle: "5 deg" } },
  sinusoid: { key: "form", title: "a sinusoid", keys: [["amplitude", "amplitude"], ["wavelength", "wavelength"]], given: { amplitude: "0.1 um", wavelength: ["16 um", "16 um"] } },
  grooves: { key: "form", title: "turned grooves", keys: [["period", "period"], ["depth", "depth"], ["profile", "profile", ["parabolic", "triangular"]], ["lay", "lay"]],
    given: { period: "16 um", depth: "0.2 um" } },
};

/** Keys of the grid of a generator or form. */
export const GRID = [["shape", "cells along x and y"], ["pitch", "size of a cell"]];

/** Steps of the preparation in their order: key, label, first value, words of a menu. */
export const STEPS = [
  ["despike", "spikes beyond so many σ become missing", 6],
  ["fill", "fill missing heights", "harmonic", ["harmonic", "nearest"]],
  ["window", "keep a window [x0, y0, nx, ny]", [0, 0, 128, 128]],
  ["level", "subtract a form", "plane", ["mean", "plane", "quadratic", "polynomial-3", "polynomial-4", "sphere", "cylinder"]],
  ["mirror", "mirror", "x", ["x", "y"]],
  ["rotate", "rotate", "90 deg"],
  ["s_filter", "S-filter: remove shorter waves", "4 um"],
  ["l_filter", "L-filter: remove longer waves", "0.1 mm"],
  ["filter", "kind of the filters", "robust", ["gaussian", "robust"]],
  ["resample", "resample to [nx, ny] cells", [128, 128]],
  ["taper", "taper a rim to the mean", "8 um"],
];

/** Returns the source of a topography: `file`, or a key of SOURCES. */
export function sourceOf(topography) {
  return topography.file !== undefined ? "file" : topography.generate || topography.form || "flat";
}
