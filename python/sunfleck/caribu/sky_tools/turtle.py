"""A sky of 1, 16 or 46 directions with all that CARIBU's turtle returns."""

from __future__ import annotations

import math

from ..light import turtle as _turtle

Floats = tuple[float, ...]


def turtle(sectors: str | int = "46", format: str = "soc", energy: float = 1.0) -> tuple[Floats, Floats, tuple[tuple[float, float, float], ...], Floats, Floats]:
    """(energies on a horizontal plane, energies across the direction, the ways that the light travels, elevations [degrees], azimuths [degrees
    from X, of the way that the light travels])."""
    sources = _turtle(sectors, format, energy)
    horizontal = tuple(e for e, _ in sources)
    ways = tuple((-v[0], -v[1], v[2]) for _, v in sources)  # a sector's azimuth there is the way its light travels
    across = tuple(e / -v[2] for e, v in sources)
    elevations = tuple(math.degrees(math.asin(min(1.0, -v[2]))) for v in ways)
    azimuths = tuple(math.degrees(math.atan2(v[1], v[0])) % 360 for v in ways)
    return horizontal, across, ways, elevations, azimuths
