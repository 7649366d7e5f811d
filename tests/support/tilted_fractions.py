"""Expected positions of tilted spheroids, from the 4×4 matrices alone, in fractions and whole numbers.

The spheroid is exterior where S + λH is positive definite for some λ > 0, interior where it is for some λ < 0, and in
contact otherwise. det(S + λH) is interpolated from five determinants; between each two of its neighbouring real roots
the matrix has one signature, so one rational λ there is asked (Sylvester's criterion). Roots are separated by Sturm's
sequence of the squarefree part. Nothing of the kernel's formulas is used.
"""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise


def exact_position(row, hyperboloid=(0, 0, 1)):
    """+1, 0 or −1 for alpha, gamma, b, d, x, y, z, axis_x, axis_y, axis_z, beside a hyperboloid with that axis."""
    S, H = map(whole, matrices(row, hyperboloid))
    samples = between_roots(interpolated(S, H))
    sides = {1 if at > 0 else -1 for at in samples if at and positive_definite(whole(combined(S, H, at)))}
    assert len(sides) <= 1
    return sides.pop() if sides else 0


def matrices(row, hyperboloid=(0, 0, 1)):
    """S of the spheroid, with (X−C)ᵀM(X−C) − 1, and H of the hyperboloid."""
    alpha, gamma, b, d, x, y, z, *axis = map(Fraction, row)
    size = sum(each * each for each in axis)
    extra = 1 / (d * d) - 1 / (b * b)
    M = [[extra * axis[i] * axis[j] / size + (1 / (b * b) if i == j else 0) for j in range(3)] for i in range(3)]
    centre = (x, y, z)
    MC = [sum(M[i][j] * centre[j] for j in range(3)) for i in range(3)]
    S = [[*M[i], -MC[i]] for i in range(3)]
    S.append([*(-each for each in MC), sum(MC[i] * centre[i] for i in range(3)) - 1])
    w = [Fraction(each) for each in hyperboloid]
    waist, whole = 1 / alpha**2, sum(each * each for each in w)
    less = (waist + 1 / gamma**2) / whole
    H = [[*((waist if i == j else 0) - less * w[i] * w[j] for j in range(3)), Fraction(0)] for i in range(3)]
    H.append([Fraction(0), Fraction(0), Fraction(0), Fraction(-1)])
    return S, H


def whole(matrix):
    """The matrix times the least positive number that makes it whole: signs of minors stay, and so does that of λ."""
    times = math.lcm(*(each.denominator for line in matrix for each in line))
    return [[int(each * times) for each in line] for line in matrix]


def combined(S, H, at):
    return [[S[i][j] + at * H[i][j] for j in range(4)] for i in range(4)]


def determinant(matrix):
    if len(matrix) == 1:
        return matrix[0][0]
    return sum(
        (-1) ** k * matrix[0][k] * determinant([[*line[:k], *line[k + 1 :]] for line in matrix[1:]])
        for k in range(len(matrix))
        if matrix[0][k]
    )


def positive_definite(matrix):
    return all(determinant([line[:size] for line in matrix[:size]]) > 0 for size in (1, 2, 3, 4))


def interpolated(S, H):
    """The coefficients of det(S + λH), lowest first, from its values at λ = 0 … 4."""
    values = [determinant(combined(S, H, at)) for at in range(5)]
    total = [Fraction(0)] * 5
    for at, value in enumerate(values):
        basis, scale = [Fraction(1)], Fraction(1)
        for other in range(5):
            if other != at:
                basis = [a - other * b for a, b in zip([Fraction(0), *basis], [*basis, Fraction(0)], strict=True)]
                scale *= at - other
        total = [a + value / scale * b for a, b in zip(total, basis, strict=True)]
    return total


def trimmed(poly):
    while len(poly) > 1 and poly[-1] == 0:
        poly = poly[:-1]
    return poly


def divided(poly, by):
    """Quotient and remainder."""
    rest, quotient = list(poly), [Fraction(0)] * max(1, len(poly) - len(by) + 1)
    while len(rest) >= len(by) and any(rest):
        shift, factor = len(rest) - len(by), rest[-1] / by[-1]
        quotient[shift] = factor
        for k, each in enumerate(by):
            rest[shift + k] -= factor * each
        rest = trimmed(rest[:-1])
    return quotient, trimmed(rest)


def derivative(poly):
    return trimmed([k * each for k, each in enumerate(poly)][1:] or [0])


def value(poly, at):
    total = Fraction(0)
    for each in reversed(poly):
        total = total * at + each
    return total


def primitive(poly):
    """The polynomial times a positive number: whole coefficients without a common divisor."""
    (numbers,) = whole([poly])
    return [each // (math.gcd(*numbers) or 1) for each in numbers]


def sign(poly, at):
    """The sign of a polynomial with whole coefficients at a rational number."""
    total, scale = 0, 1
    for each in reversed(poly):
        total, scale = total * at.numerator + each * scale, scale * at.denominator
    return (total > 0) - (total < 0)


def remainder(poly, by):
    """The remainder times a positive number, in whole numbers."""
    return primitive(divided(list(map(Fraction, poly)), by)[1])


def between_roots(poly):
    """A rational number between each two neighbouring real roots, of which none is 0, and beyond the first and last."""
    common, other = primitive(poly), primitive(derivative(poly))
    while any(other):
        common, other = other, remainder(common, other)
    free = primitive(trimmed(divided(poly, common)[0]))
    chain = [free, derivative(free)]
    while len(chain[-1]) > 1:
        rest = remainder(chain[-2], chain[-1])
        if not any(rest):
            break
        chain.append([-each for each in rest])

    def below(at):
        signs = [each for each in (sign(one, at) for one in chain) if each]
        return -sum(a != b for a, b in pairwise(signs))

    largest, least = bound(free), 1 / bound(free[::-1])  # det S is not 0, and neither is a root
    parts = [(-largest, -least), (least, largest)]
    found = {below(at): at for part in parts for at in part}
    while parts:
        low, high = parts.pop()
        if below(high) - below(low) < 2:
            continue
        middle = between(low, high)
        if sign(free, middle) == 0:  # a power of two would be met again and again
            middle = (low + high) / 2
        while sign(free, middle) == 0:
            middle = (low + middle) / 2
        found[below(middle)] = middle
        parts += [(low, middle), (middle, high)]
    return sorted(found.values())


def bound(poly):
    """A power of two above the absolute value of every root: more than 1 + |each coefficient / the first|."""
    largest = max(abs(each) for each in poly) // abs(poly[-1])
    return Fraction(1 << (1 + largest).bit_length())


def between(low, high):
    """A number between two of one sign: a power of two where they are far apart, as the roots of stiff pairs are."""
    one, other = (each.numerator.bit_length() - each.denominator.bit_length() for each in map(abs, (low, high)))
    if abs(one - other) < 2:
        return (low + high) / 2
    return Fraction(2) ** ((one + other) // 2) * (-1 if low < 0 else 1)
