"""The volume rendering integral of a conformance vector in 60 decimal digits, from the schema's description alone.

Pieces are split where the scalar turns or meets a point of the transfer function. In between extinction and colour are
polynomials, so the optical depth is one too; what remains is Gauss-Legendre quadrature, refined until it stands still.
Where the opacity is linear, not the extinction, so is the scalar, and the depth has a closed form with a logarithm.
"""

import decimal
import math
from decimal import Decimal

decimal.getcontext().prec = 60

# Numbers of vectors have some 30 bits: a turning scalar that comes this close to a point lies on it.
CONTACT = Decimal("1e-40")
STANDSTILL = Decimal("1e-30")
# What lies behind this optical depth adds nothing.
DARK = 120
NODES = 16


def value(polynomial, u):
    result = Decimal(0)
    for coefficient in reversed(polynomial):
        result = result * u + coefficient
    return result


def derivative(polynomial):
    return [k * coefficient for k, coefficient in enumerate(polynomial)][1:]


def antiderivative(polynomial):
    return [Decimal(0)] + [coefficient / (k + 1) for k, coefficient in enumerate(polynomial)]


def product(a, b):
    result = [Decimal(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            result[i + j] += x * y
    return result


def bisect(polynomial, low, high):
    """The root between two places of different sign."""
    is_negative_low = value(polynomial, low) < 0
    while (middle := (low + high) / 2) not in (low, high) and high - low > Decimal("1e-55"):
        if (value(polynomial, middle) < 0) == is_negative_low:
            low = middle
        else:
            high = middle
    return low


def roots(polynomial, length, turning_points):
    """Where the polynomial changes its sign, or turns on 0."""
    places = [Decimal(0), *turning_points, length]
    values = [value(polynomial, place) for place in places]
    values = [Decimal(0) if abs(x) < CONTACT else x for x in values]
    found = [place for place, x in zip(places, values) if x == 0]
    for (low, f), (high, g) in zip(zip(places, values), zip(places[1:], values[1:])):
        if f * g < 0:
            found.append(bisect(polynomial, low, high))
    return sorted(found)


def turning_points(polynomial, length):
    """A superset of the places where the polynomial turns."""
    if len(polynomial) < 3:
        return []
    slope = derivative(polynomial)
    return roots(slope, length, turning_points(slope, length))


def legendre(count):
    """Nodes and weights on [0, 1]: Newton's iteration on Legendre's polynomial."""
    rule = []
    for i in range(count):
        x = Decimal(math.cos(math.pi * (i + 0.75) / (count + 0.5)))
        for _ in range(8):
            before, here = Decimal(1), x
            for n in range(1, count):
                before, here = here, ((2 * n + 1) * x * here - n * before) / (n + 1)
            slope = count * (x * here - before) / (x * x - 1)
            x -= here / slope
        rule.append(((1 + x) / 2, 1 / ((1 - x * x) * slope * slope)))
    return rule


RULE = legendre(NODES)


def lines(points):
    """The transfer function as (low, high, point, slope) of its linear pieces, channel by channel (tau or a, r, g, b)."""
    density = "opacity" if "opacity" in points[0] else "extinction"
    table = [(Decimal(point["s"]), [Decimal(x) for x in (point[density], *point["color"])]) for point in points]
    zero = [Decimal(0)] * 4
    yield Decimal("-Infinity"), table[0][0], table[0], zero
    for (s, here), (s_next, following) in zip(table, table[1:]):
        if s < s_next:
            yield s, s_next, (s, here), [(y - x) / (s_next - s) for x, y in zip(here, following)]
    yield table[-1][0], Decimal("Infinity"), table[-1], zero


def optics(points, scalar, at):
    """Extinction, or opacity, and colour as polynomials, around a place where the scalar has the value `at`."""
    for low, high, (s, values), slopes in lines(points):
        if low <= at < high:
            return [[y + slope * ((scalar[0] - s) if slope else 0), *(slope * x for x in scalar[1:])] for y, slope in zip(values, slopes)]
    raise AssertionError("a scalar beyond all numbers")


def emitted(sources, depth, begin, end):
    """Integrals of sources times exp(-depth(u)), by halves until they add up to the whole."""

    def quadrature(low, high):
        sums = [Decimal(0)] * len(sources)
        for node, weight in RULE:
            u = low + node * (high - low)
            light = weight * (high - low) * (-depth(u)).exp()
            sums = [total + light * value(source, u) for total, source in zip(sums, sources)]
        return sums

    def refined(low, high, whole):
        if depth(low) > DARK:
            return [Decimal(0)] * len(sources)
        middle = (low + high) / 2
        halves = quadrature(low, middle), quadrature(middle, high)
        both = [x + y for x, y in zip(*halves)]
        if all(abs(x - y) <= STANDSTILL * abs(x) for x, y in zip(both, whole)):
            return both
        return [x + y for x, y in zip(refined(low, middle, halves[0]), refined(middle, high, halves[1]))]

    return refined(begin, end, quadrature(begin, end))


def pieces_of(vector):
    """(length, coefficients) of the scalar's pieces."""
    if "slab" in vector:
        front, back, length = (Decimal(vector["slab"][key]) for key in ("front", "back", "length"))
        yield length, [front, (back - front) / length]
        return
    signal = vector["signal"]
    for begin, end, coefficients in zip(signal["breaks"], signal["breaks"][1:], signal["coefficients"]):
        yield Decimal(end) - Decimal(begin), [Decimal(x) for x in coefficients]


def depth_of_extinction(extinction, begin):
    """The optical depth from `begin` to u."""
    depth = antiderivative(extinction)
    depth[0] -= value(depth, begin)
    return lambda u: value(depth, u)


def depth_of_opacity(opacity, unit_length, begin):
    """The integral of -ln(1 - a) / unit_length from `begin` to u, with a linear in u."""
    constant, slope = opacity

    def antiderivative_of_log(clear):
        return clear * clear.ln() - clear if clear > 0 else Decimal(0)

    clear = [1 - constant, -slope]
    if slope == 0:
        return lambda u: -clear[0].ln() * (u - begin) / unit_length
    at_begin = antiderivative_of_log(value(clear, begin))
    return lambda u: -(antiderivative_of_log(value(clear, u)) - at_begin) / (clear[1] * unit_length)


def emitted_by_depth(channels, depth, begin, end):
    """Integrals of channels times d(1 - exp(-depth)), by parts: the extinction itself may be infinite at an end."""
    light = emitted([derivative(channel) for channel in channels], depth, begin, end)
    front, back = (-depth(begin)).exp(), (-depth(end)).exp()
    return [value(channel, begin) * front - value(channel, end) * back + inside for channel, inside in zip(channels, light)]


def integrate(vector):
    """Colour, three channels, and opacity."""
    points = vector["transfer_function"]["points"]
    unit_length = vector["transfer_function"].get("unit_length")
    is_plain = vector["emission"] == "plain"
    color = [Decimal(0)] * 3
    depth_before = Decimal(0)
    for length, scalar in pieces_of(vector):
        turns = turning_points(scalar, length)
        splits = {Decimal(0), length, *turns}
        for point in points:
            splits.update(roots([scalar[0] - Decimal(point["s"]), *scalar[1:]], length, turns))
        splits = sorted(splits)
        for begin, end in zip(splits, splits[1:]):
            if end - begin < Decimal("1e-50"):
                continue
            density, *channels = optics(points, scalar, value(scalar, (begin + end) / 2))
            front = (-depth_before).exp()
            if unit_length is None:
                depth = depth_of_extinction(density, begin)
                sources = channels if is_plain else [product(density, channel) for channel in channels]
                light = emitted(sources, depth, begin, end)
            elif density == [1, 0]:
                light = [Decimal(0) if is_plain else value(channel, begin) for channel in channels]
                return [x + front * y for x, y in zip(color, light)], Decimal(1)
            else:
                depth = depth_of_opacity(density, Decimal(unit_length), begin)
                light = (emitted if is_plain else emitted_by_depth)(channels, depth, begin, end)
            color = [x + front * y for x, y in zip(color, light)]
            depth_before += depth(end)
    return color, 1 - (-depth_before).exp()
