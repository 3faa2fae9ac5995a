"""My scheme against all others: errors of the same samples, on the same rays, against certified values.

`mine` is given the samples of a ray at a constant step, and gives colour and opacity: here Simpson's rule on the optical
depth, with the colour at the middle of two intervals.
"""

import numpy
import raytruth

STEP = 0.5

x, y, z = numpy.mgrid[-1:1:32j, -1:1:32j, -1:1:32j]
volume = raytruth.Volume(numpy.sin(5 * x * y + 3 * z) * 0.5 + 0.5)
transfer = raytruth.TransferFunction.from_extinctions(
    s=[0, 0.3, 1], extinction=[0, 0.1, 1.5], color=[(0, 0, 0), (1, 0.5, 0.2), (1, 1, 0.9)]
)


def mine(scalars, step):
    """Two intervals at a time; a last one alone counts as a slab of its middle."""
    extinction, light = transfer.at(scalars)
    color, transmittance = numpy.zeros(3), 1.0
    for i in range(0, len(scalars) - 2, 2):
        depth = step / 3 * (extinction[i] + 4 * extinction[i + 1] + extinction[i + 2])
        opacity = 1 - numpy.exp(-depth)
        color += transmittance * opacity * light[i + 1]
        transmittance *= 1 - opacity
    return color, 1 - transmittance


random = numpy.random.default_rng(1)
origins = random.uniform(4, 27, size=(200, 3))
directions = random.normal(size=(200, 3))
LENGTH = 8.0  # sixteen intervals for every ray

truth = raytruth.rays(volume, transfer, origins, directions, lengths=LENGTH, border="voxel_centres")
whole = truth.length > LENGTH - 1e-9  # rays that do not leave the volume before
errors = {}
for scheme in raytruth.schemes():
    try:
        found = raytruth.rays(
            volume, transfer, origins[whole], directions[whole], lengths=LENGTH, border="voxel_centres",
            scheme=scheme["name"], step=STEP,
        )  # fmt: skip
    except raytruth.InputError:
        continue  # it needs other samples
    errors[scheme["name"]] = numpy.abs(found.color - truth.color[whole]).max(axis=1)

of_mine = []
for origin, direction, color in zip(origins[whole], directions[whole], truth.color[whole]):
    signal = raytruth.signal_along(volume, origin, direction, length=LENGTH, border="voxel_centres")
    scalars = signal.at(numpy.minimum(numpy.arange(0, LENGTH + STEP / 2, STEP), signal.length))
    of_mine.append(numpy.abs(mine(scalars, STEP)[0] - color).max())
errors["mine"] = numpy.array(of_mine)

print(f"{whole.sum()} rays of length {LENGTH}, step {STEP}: RMSE and largest error of the colour")
for name, error in sorted(errors.items(), key=lambda item: numpy.mean(item[1] ** 2)):
    print(f"{'-> ' if name == 'mine' else '   '}{name:<28} {numpy.sqrt(numpy.mean(error**2)):.1e}  {error.max():.1e}")
