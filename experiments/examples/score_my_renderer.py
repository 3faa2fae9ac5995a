"""Score my renderer: how many digits are right, level by level?

`my_renderer` stands for yours: here 200 samples and the composition that every textbook prints.
"""

import numpy
import raytruth


def my_renderer(vector, steps=200):
    """A ray in samples, composited front to back."""
    middles = (numpy.arange(steps) + 0.5) / steps
    if "slab" in vector:  # the scalar is linear from front to back
        slab = vector["slab"]
        length, scalars = slab["length"], slab["front"] + middles * (slab["back"] - slab["front"])
    else:
        signal = raytruth.Signal(vector["signal"]["breaks"], vector["signal"]["coefficients"])
        length, scalars = signal.length, signal.at(middles * signal.length)
    extinction, light = raytruth.TransferFunction(vector["transfer_function"]).at(scalars)
    color, transmittance = numpy.zeros(3), 1.0
    for tau, c in zip(extinction, light):
        opacity = 1 - numpy.exp(-tau * length / steps)
        color += transmittance * c * (opacity if vector["emission"] == "associated" else length / steps)
        transmittance *= 1 - opacity
    return [*color, 1 - transmittance]


vectors = raytruth.vectors()
answers = {vector["id"]: my_renderer(vector) for vector in vectors["vectors"]}
for level in raytruth.score(vectors, answers):
    print(f"{level['level']:<22} {level['answered']:>4} rays  {level['digits_median']:5.2f} digits, worst {level['worst']}")
