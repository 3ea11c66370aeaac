import asperity as asp


def press(heights, side, mean_pressure, tolerance):
    steel = asp.Material(young=210e9, poisson=0.3)
    rigid = asp.Material(young=float("inf"), poisson=0.3)
    rough = asp.Surface(heights, pitch=side / len(heights))
    c = asp.contact(
        rough, asp.form.flat(), steel, rigid,
        mean_pressure=mean_pressure, boundary="periodic", tolerance=tolerance, threads=1, progress=False,
    )
    return c.pressure
