"""Sources of light as CARIBU has them: (energy, direction), the irradiance of a horizontal plane and the way the light travels."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .forms import Light


def light_sources(elevation: ArrayLike, azimuth: ArrayLike, irradiance: ArrayLike, orientation: float = 0) -> list[Light]:
    """Sources by elevation and azimuth (from north, clockwise) [degrees] and horizontal irradiance; orientation: the angle from X+ to north,
    clockwise [degrees]."""
    e, a, energy = np.broadcast_arrays(*(np.atleast_1d(np.asarray(x, dtype=float)) for x in (elevation, azimuth, irradiance)))
    height, turn = np.radians(e), -np.radians(a + orientation)
    towards = np.stack([np.cos(height) * np.cos(turn), np.cos(height) * np.sin(turn), np.sin(height)], axis=-1)
    ways = -np.round(towards, 15) + 0.0
    return [(float(w), (float(x), float(y), float(z))) for w, (x, y, z) in zip(energy, ways)]


def turtle_directions(sectors: int) -> NDArray[np.float64]:
    """Unit vectors towards the 1, 6, 16 or 46 sectors of a dodecahedron's upper half: its faces, then its corners, then five directions in each
    face, towards the middle of its edges (den Dulk 1989, The interpretation of remote sensing, thesis, Wageningen)."""
    if sectors not in (1, 6, 16, 46):
        raise ValueError(f"sectors: found {sectors}; expected 1, 6, 16 or 46")
    if sectors == 1:
        return np.array([[0.0, 0, 1]])
    faces = [np.array([0.0, 0, 1])]  # of a dodecahedron: corners of an icosahedron that stands on one
    for upper, k in itertools.product((1, -1), range(5)):
        turn = 2 * np.pi * (k + (0 if upper > 0 else 0.5)) / 5
        faces.append(np.array([2 * np.cos(turn), 2 * np.sin(turn), upper]) / 5**0.5)
    faces.append(np.array([0.0, 0, -1]))
    out = [f for f in faces if f[2] > 1e-9]
    if sectors >= 16:
        for a, b, c in itertools.combinations(faces, 3):
            if min(a @ b, b @ c, a @ c) > 0.4:
                corner = (a + b + c) / np.linalg.norm(a + b + c)
                if corner[2] > 1e-9:
                    out.append(corner)
    if sectors == 46:
        # where the mean direction of face, edge and corners lies: 20.84 degrees from the face's
        angle = np.radians(20.84)
        for a, b in itertools.permutations(faces, 2):
            if a @ b > 0.4:
                aside = b - (a @ b) * a
                d = np.cos(angle) * a + np.sin(angle) * aside / np.linalg.norm(aside)
                if d[2] > 1e-9:
                    out.append(d)
    return np.asarray(out)


def turtle(sectors: int | str = "46", format: str = "soc", energy: float = 1.0) -> list[Light]:
    """A sky of 1, 6, 16 or 46 directions with an energy in all: a standard overcast ("soc") or a uniform one ("uoc"); each sector has the
    same solid angle."""
    if format not in ("soc", "uoc"):
        raise ValueError(f'format: found "{format}"; expected "soc" or "uoc"')
    towards = turtle_directions(int(sectors))
    weight = towards[:, 2] * (1 + 2 * towards[:, 2] if format == "soc" else 1.0)
    share = energy * weight / weight.sum()
    return [(float(w), (float(-x), float(-y), float(-z))) for w, (x, y, z) in zip(share, towards)]


def diffuse_source(directions: int | str) -> list[Light]:
    """A standard overcast sky of an energy of one in 1, 6, 16 or 46 directions."""
    return turtle(directions, "soc")
