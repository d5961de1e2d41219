#!/usr/bin/env python3
"""Fits the parameters of area_lobe (nodes/area_light.node): of the linearly transformed cosine that is nearest to the lobe of GGX,
as functions of its alpha and of the view's cosine.

    bench/area_lobe.py

prints how far the node's lobes are from those of GGX, how far the best three parameters of each lobe leave them, and a fit of the
node's formulas: other numbers than the node's, which make lobes as near as its own to 0.002. The lobe of GGX is D, the masking of
both directions and the light's cosine, over their integral; a distance is half the integral of the absolute difference, in the mean
over alpha and cosine. It needs numpy and takes some minutes."""
import re
from pathlib import Path

import numpy as np

NODE = Path(__file__).resolve().parent.parent / "nodes/area_light.node"
STEPS, TURNS = 32, 48
ALPHAS = np.linspace(0.15, 1, 12) ** 2
COSINES = np.linspace(0.05, 1, 12)


def lobe(alpha, cosine):
    """Directions (x towards the view, z the normal), the lobe's density there, and how much of it each stands for."""
    step, turn = (of.ravel() for of in np.meshgrid(np.arange(STEPS) + 0.5, np.arange(TURNS) + 0.5))
    sine = np.sqrt(max(1 - cosine * cosine, 0))
    view = np.array([alpha * sine, 0, cosine]) / np.hypot(alpha * sine, cosine)
    # Facets that are seen, as a cap of the sphere (Dupuy and Benyoub 2023).
    z = 1 - step / STEPS * (1 + view[2])
    flat, angle = np.sqrt(np.maximum(1 - z * z, 0)), 2 * np.pi * turn / TURNS
    facet = np.stack([flat * np.cos(angle) + view[0], flat * np.sin(angle), z + view[2]], -1) * [alpha, alpha, 1]
    facet[:, 2] = np.maximum(facet[:, 2], 1e-12)
    facet /= np.linalg.norm(facet, axis=1, keepdims=True)
    to_eye = np.array([sine, 0, cosine])
    light = 2 * (facet @ to_eye)[:, None] * facet - to_eye
    facet, light = facet[light[:, 2] > 0], light[light[:, 2] > 0]

    def masked(c):
        return (np.sqrt(1 + alpha**2 * (1 - c**2) / c**2) - 1) / 2

    both = 1 + masked(cosine) + masked(light[:, 2])
    weight = (1 + masked(cosine)) / both
    d = alpha**2 / (np.pi * (facet[:, 2] ** 2 * (alpha**2 - 1) + 1) ** 2)
    return light, d / (4 * cosine * both) / (weight.sum() / (STEPS * TURNS)), weight / weight.sum()


def transformed(light, parameters):
    along, lean, across = parameters
    z = light[:, 2]
    length2 = (along * light[:, 0] + lean * z) ** 2 + (across * light[:, 1]) ** 2 + z * z
    return z * (along * across) / (np.pi * length2 * length2)


def distance(of, parameters):
    light, density, mass = of
    # Both are 1 in all, so that what one has more than the other is half of the difference.
    return float(mass @ np.maximum(1 - transformed(light, parameters) / density, 0))


def least(function, start, rounds=120):
    """The place of the least value near `start` (Nelder and Mead 1965)."""
    points = [np.array(start)] + [start + 0.1 * axis for axis in np.eye(len(start))]
    points = sorted(((function(p), tuple(p)) for p in points))
    for _ in range(rounds):
        middle = np.mean([p for _, p in points[:-1]], axis=0)
        worst = np.array(points[-1][1])
        tried = [(function(p), tuple(p)) for p in (2 * middle - worst,)]
        if tried[0] < points[0]:
            p = 3 * middle - 2 * worst
            tried.append((function(p), tuple(p)))
        elif tried[0] >= points[-2]:
            p = (middle + worst) / 2
            tried.append((function(p), tuple(p)))
        if min(tried) < points[-1]:
            points[-1] = min(tried)
        else:
            best = np.array(points[0][1])
            points = points[:1] + [(function(p), tuple(p)) for p in ((best + np.array(q)) / 2 for _, q in points[1:])]
        points.sort()
    return np.array(points[0][1])


def best_parameters(of, start):
    """By their logarithms, and the lean as a part of `along`."""
    found = least(lambda p: distance(of, (np.exp(p[0]), np.exp(p[0]) * p[1], np.exp(p[2]))),
                  np.array([np.log(start[0]), start[1] / start[0], np.log(start[2])]))
    return np.array([np.exp(found[0]), np.exp(found[0]) * found[1], np.exp(found[2])])


def node_parameters(alpha, cosine):
    """What the node's own text says."""
    text = NODE.read_text()
    body = text[text.index("node area_lobe("):]
    names = {"alpha": alpha, "cosine": cosine, "sqrt": np.sqrt, "max": np.maximum, "inversesqrt": lambda x: x**-0.5}
    for name, value in re.findall(r"^    float (\w+) = (.*);$", body[:body.index("\n}\n")], re.M):
        names[name] = eval(value, names)  # arithmetic of numbers above
    return names["along"], names["lean"], names["across"]


# The monomials of the formulas in alpha a, cosine c and g = a^2 / (c^2 + 5 a^2): above and below the line, beside 1.
FORMS = {
    "along": (["a2", "a2*c", "g", "g2*a", "g2", "g2*g2"], ["a2", "a2*a", "g*a", "g"]),
    "across": (["a2", "a2*c", "g", "g*a", "g2"], ["a2", "g", "g*a"]),
    "slant": (["a2", "g2", "g2*a", "g2*g2"], ["a2", "g2", "g2*a"]),
}


def monomials(alpha, cosine):
    g = alpha**2 / (cosine**2 + 5 * alpha**2)
    names = {"a": alpha, "a2": alpha**2, "c": cosine, "g": g, "g2": g * g}
    return lambda of: np.stack([eval(one, names) for one in of], -1)


def fitted(form, alpha, cosine, values, weights):
    """Coefficients of a quotient of polynomials, by least squares of the values, each multiplied by the last denominator."""
    above, below = (monomials(alpha, cosine)(of) for of in FORMS[form])
    scale = weights / values
    for _ in range(30):
        rows = np.concatenate([above, -below * values[:, None]], axis=1) * scale[:, None]
        # Small coefficients, so that no denominator has a root.
        rows = np.concatenate([rows, 0.1 * np.diag(np.concatenate([above, below], axis=1).max(axis=0))])
        found = np.linalg.lstsq(rows, np.concatenate([(values - 1) * scale, np.zeros(rows.shape[1])]), rcond=None)[0]
        scale = weights / values / (1 + below @ found[above.shape[1]:])
    return found


def quotient(form, found, alpha, cosine):
    above, below = (monomials(alpha, cosine)(of) for of in FORMS[form])
    return (1 + above @ found[:above.shape[-1]]) / (1 + below @ found[above.shape[-1]:])


def parameters_of(found, alpha, cosine):
    """The node's, by these coefficients."""
    parts = np.split(found, np.cumsum([len(above) + len(below) for above, below in FORMS.values()])[:-1])
    along, across, slant = (quotient(form, part, alpha, cosine) for form, part in zip(FORMS, parts))
    wide2 = cosine**2 + 5 * alpha**2
    along = along * wide2 / (2 * alpha)
    lean = along * np.sqrt(1 - cosine**2) * (1 - alpha**2) / np.sqrt(wide2) * slant
    return np.stack([along, lean, across / (2 * alpha)], -1)


def refined(found, mean, alpha, cosine, rounds=150):
    """Coefficients of the least mean distance near these (Broyden, Fletcher, Goldfarb, Shanno 1970)."""
    most = np.concatenate([monomials(alpha, cosine)(of).max(axis=0) for form in FORMS.values() for of in form])

    def error(x):
        with np.errstate(all="ignore"):
            at = parameters_of(x / most, alpha, cosine)
            return np.nan_to_num(mean(at), nan=np.inf) if (at[:, [0, 2]] > 0).all() else np.inf

    def slope(x):
        return np.array([(error(x + 1e-5 * axis) - error(x - 1e-5 * axis)) / 2e-5 for axis in np.eye(len(x))])

    x = found * most
    now, down = error(x), slope(x)
    inverse = np.eye(len(x))
    for _ in range(rounds):
        way, scale = -inverse @ down, 1.0
        if way @ down >= 0:
            inverse, way = np.eye(len(x)), -down
        while not error(x + scale * way) < now + 1e-4 * scale * (way @ down):
            scale /= 2
            if scale < 1e-8:
                return x / most
        step = scale * way
        then = slope(x + step)
        change = then - down
        x, now, down = x + step, error(x + step), then
        if (along := step @ change) > 0:
            left = np.eye(len(x)) - np.outer(step, change) / along
            inverse = left @ inverse @ left.T + np.outer(step, step) / along
    return x / most


def main():
    alpha, cosine = (of.ravel() for of in np.meshgrid(ALPHAS, COSINES))
    lobes = [lobe(a, c) for a, c in zip(alpha, cosine)]
    node = np.stack(node_parameters(alpha, cosine), -1)
    best = np.stack([best_parameters(of, start) for of, start in zip(lobes, node)])

    def mean(parameters):
        return np.mean([distance(of, each) for of, each in zip(lobes, parameters)])

    wide2 = cosine**2 + 5 * alpha**2
    sine = np.sqrt(1 - cosine**2)
    # The lean says nothing of how slanted a lobe is that is the same all around.
    slanted = sine * (1 - alpha**2) > 0.05
    slant = best[:, 1] / best[:, 0] * np.sqrt(wide2) / np.where(slanted, sine * (1 - alpha**2), 1)
    shapes = {"along": best[:, 0] * 2 * alpha / wide2, "across": best[:, 2] * 2 * alpha, "slant": np.where(slanted, slant, 1)}
    start = [fitted(form, alpha, cosine, values, np.where(slanted | (form != "slant"), 1, 0))
             for form, values in shapes.items()]
    made = refined(np.concatenate(start), mean, alpha, cosine)
    refit = parameters_of(made, alpha, cosine)
    numbers = iter(made)
    for form, parts in FORMS.items():
        for part, of in zip("pq", parts):
            print(f"{form}_{part} = 1 " + " ".join(f"{next(numbers):+.6g} * {one}" for one in of))
    print(f"mean distance: the node's {mean(node):.4f}, the best parameters' {mean(best):.4f}, this fit's {mean(refit):.4f}")


if __name__ == "__main__":
    main()
