import numpy as np
import slippy
from slippy import contact, surface


def press(heights, side, mean_pressure, tolerance):
    slippy.CORES = 1
    spacing = side / len(heights)
    # In frequency, with a mean of zero, the kernel is the periodic half-space.
    steel = contact.Elastic("steel", {"E": 210e9, "v": 0.3}, use_frequency_domain=True, zero_frequency_value=0.0)
    rough = surface.Surface(profile=heights, grid_spacing=spacing)
    flat = surface.FlatSurface(shape=heights.shape, grid_spacing=spacing, generate=True)
    rough.material, flat.material = contact.rigid, steel
    model = contact.ContactModel("contact", rough, flat)
    model.add_step(
        contact.StaticStep(
            "load", normal_load=mean_pressure * side**2, periodic_geometry=True, periodic_axes=(True, True),
            max_it=100_000, tolerance=tolerance, tolerance_outer=1e-12,
        )
    )
    return np.asarray(model.solve()["loads_z"])
