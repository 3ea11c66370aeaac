"""Makes ground.x3p: a generated ground surface as an instrument might deliver it, with tilt, noise, spikes and holes."""

from pathlib import Path

import numpy as np

import asperity as asp

shape, pitch = (128, 128), 0.5e-6
ground = asp.generate.autocorrelation(
    shape, pitch, sq="50 nm", correlation_length=("14 um", "4 um"), decay="gaussian", ssk=-0.6, sku=3.6, seed=11
)
rng = np.random.default_rng(12)
heights = ground.heights + 2.5e-9 * rng.standard_normal(shape)
x, y = np.meshgrid(*(pitch * np.arange(count) for count in shape), indexing="ij")
heights = heights + 0.03 * x - 0.012 * y

# Light that does not come back: ragged patches, and single samples.
for centre in rng.uniform(0, shape[0] * pitch, (5, 2)):
    distance = np.hypot(x - centre[0], 1.5 * (y - centre[1])) * rng.uniform(0.85, 1.15, shape)
    heights[distance < rng.uniform(0.8e-6, 2e-6)] = np.nan
heights[rng.random(shape) < 0.004] = np.nan
spikes = rng.random(shape) < 0.001
heights[spikes] += rng.uniform(0.3e-6, 1.5e-6, spikes.sum()) * rng.choice([-1, 1], spikes.sum())

# Steps of 58 pm, as of an instrument, which packs well.
asp.Surface(np.round(heights * 2.0**34) / 2.0**34, pitch).write(Path(__file__).with_name("ground.x3p"))
