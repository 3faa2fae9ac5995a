#!/usr/bin/env python3
"""A ray of about 100 tetrahedra: Raytruth's certified integral beside one call of VTK's Linear integrator with the same segments.

RAYTRUTH=build/release/raytruth /usr/bin/python3 experiments/peers/tetrahedral_ray.py       needs python3-vtk9

Prints the seconds of both for a ray, and how far VTK's opacity and colour are from the certified ones. Raytruth's seconds are those of
`eval` for many rays less those for one, so that they hold the walk and the JSON; VTK's are those of the integrator alone.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
import time
from fractions import Fraction

import numpy
import vtkmodules.all as vtk

SIZE = (42, 3, 3)
RAYS = 300
CALLS = 20000
ORIGIN, DIRECTION = (-1.0, 0.3125, 0.4375), (1.0, 0.03125, 0.0234375)
POINTS = [(0, 0, (0, 0, 1)), (0.4, 0.3, (0, 1, 0)), (1, 0.9, (1, 0, 0))]  # scalar, extinction, colour
EVEN, ODD = "0356 1053 2036 4065 7356".split(), "1247 0124 3172 5147 6274".split()


def segments(values):
    """Length, and scalars at front and back, of each cell on the ray: clipped against its planes in rational numbers."""
    origin, direction = numpy.array([Fraction(x) for x in ORIGIN]), numpy.array([Fraction(x) for x in DIRECTION])
    found = {}
    for i in range(SIZE[0] - 1):
        for j in range(SIZE[1] - 1):
            for k in range(SIZE[2] - 1):
                for word in EVEN if (i + j + k) % 2 == 0 else ODD:
                    corners = [(i + (b & 1), j + (b >> 1 & 1), k + (b >> 2)) for b in map(int, word)]
                    points = [numpy.array([Fraction(x) for x in corner]) for corner in corners]
                    low, high, lines = Fraction(-(10**6)), Fraction(10**6), []
                    for corner in range(4):
                        a, b, c = (points[other] for other in range(4) if other != corner)
                        normal = numpy.cross(b - a, c - a)
                        scale = normal @ (points[corner] - a)
                        at_0, slope = normal @ (origin - a) / scale, normal @ direction / scale
                        lines.append((at_0, slope))
                        if slope > 0:
                            low = max(low, -at_0 / slope)
                        elif slope < 0:
                            high = min(high, -at_0 / slope)
                        elif at_0 < 0:
                            high = low
                    if low < high:
                        scalars = [Fraction(values[k, j, i]) for i, j, k in corners]
                        at = lambda t: float(sum((a + s * t) * v for (a, s), v in zip(lines, scalars)))
                        found[low, high] = (high - low, at(low), at(high))
    unit = math.sqrt(sum(x * x for x in DIRECTION))
    return [(float(length) * unit, front, back) for _, (length, front, back) in sorted(found.items())]


def certified(values, count):
    case = {
        "signal": {
            "kind": "tetrahedra",
            "volume": "values.npy",
            "split": 5,
            "origin": ORIGIN,
            "direction": DIRECTION,
        },
        "transfer_function": {"points": [{"s": s, "extinction": e, "color": c} for s, e, c in POINTS]},
        "schemes": ["reference"],
    }
    program = os.path.abspath(os.environ.get("RAYTRUTH", "raytruth")) if os.sep in os.environ.get("RAYTRUTH", "") else "raytruth"
    with tempfile.TemporaryDirectory() as folder:
        numpy.save(os.path.join(folder, "values.npy"), values)
        begin = time.perf_counter()
        done = subprocess.run([program, "eval", "-"], input=json.dumps([case] * count).encode(), stdout=subprocess.PIPE, cwd=folder, check=True)
        return json.loads(done.stdout)[0], time.perf_counter() - begin


def array(numbers):
    result = vtk.vtkDoubleArray()
    for x in numbers:
        result.InsertNextValue(x)
    return result


def by_vtk(parts):
    color, opacity = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    for s, extinction, rgb in POINTS:
        color.AddRGBPoint(s, *rgb)
        opacity.AddPoint(s, extinction)
    properties = vtk.vtkVolumeProperty()
    properties.SetColor(color)
    properties.SetScalarOpacity(opacity)
    properties.SetInterpolationTypeToLinear()
    volume = vtk.vtkVolume()
    volume.SetProperty(properties)
    # A new integrator for these scalars: one that has seen others keeps their transfer function.
    integrator = vtk.vtkUnstructuredGridLinearRayIntegrator()
    integrator.Initialize(volume, array([0, 1]))
    lengths, fronts, backs = (array(column) for column in zip(*parts))
    begin = time.perf_counter()
    for _ in range(CALLS):
        light = [0.0] * 4
        integrator.Integrate(lengths, fronts, backs, light)
    return light, (time.perf_counter() - begin) / CALLS


def main():
    values = numpy.random.default_rng(1).random(SIZE[::-1])
    parts = segments(values)
    answer, one = certified(values, 1)
    _, many = certified(values, RAYS + 1)
    light, seconds = by_vtk(parts)
    cells = sum(part["cells"] for part in answer["parts"])
    reference = answer["reference"]
    errors = [abs(a - b) for a, b in zip(light, [*reference["color"], reference["opacity"]])]
    print(f"cells                  {cells} ({len(parts)} segments)")
    print(f"raytruth               {(many - one) / RAYS * 1e6:.1f} us, error bound {reference['error_bound']:.1e}")
    print(f"vtk {vtk.vtkVersion().GetVTKVersion()} Linear       {seconds * 1e6:.1f} us, errors of R G B and opacity", *(f"{error:.1e}" for error in errors))
    return 0 if cells == len(parts) else 1


if __name__ == "__main__":
    sys.exit(main())
