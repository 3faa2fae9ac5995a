"""Score my renderer: how many digits are right, level by level?

`my_renderer` stands for yours: here 200 samples and the composition that every textbook prints.
"""

import numpy
import raytruth


def my_renderer(vector, steps=200):
    """A ray in samples, composited front to back."""
    points = vector["transfer_function"]["points"]
    s_of = [point["s"] for point in points]
    if "slab" in vector:
        length, scalars = vector["slab"]["length"], numpy.linspace(vector["slab"]["front"], vector["slab"]["back"], steps)
    else:
        signal = raytruth.Signal(vector["signal"]["breaks"], vector["signal"]["coefficients"])
        length, scalars = signal.length, signal.at((numpy.arange(steps) + 0.5) / steps * signal.length)
    color, transmittance = numpy.zeros(3), 1.0
    for s in scalars:
        extinction = numpy.interp(s, s_of, [point["extinction"] for point in points])
        light = numpy.array([numpy.interp(s, s_of, [point["color"][c] for point in points]) for c in range(3)])
        opacity = 1 - numpy.exp(-extinction * length / steps)
        color += transmittance * light * (opacity if vector["emission"] == "associated" else length / steps)
        transmittance *= 1 - opacity
    return [*color, 1 - transmittance]


vectors = raytruth.vectors()
answers = {vector["id"]: my_renderer(vector) for vector in vectors["vectors"]}
for level in raytruth.score(vectors, answers):
    print(f"{level['level']:<22} {level['answered']:>4} rays  {level['digits_median']:5.2f} digits, worst {level['worst']}")
