import numpy as np
import tamaas as tm


def press(heights, side, mean_pressure, tolerance):
    tm.initialize(1)
    model = tm.Model(tm.model_type.basic_2d, [side, side], heights.shape)
    model.E, model.nu = 210e9, 0.3                            # before the operator is made
    tm.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tm.PolonskyKeerRey(model, heights, tolerance)
    solver.setIntegralOperator("dcfft")                       # else it is the periodic problem
    solver.max_iter = 20_000
    solver.solve(mean_pressure)
    return np.array(model.traction)
