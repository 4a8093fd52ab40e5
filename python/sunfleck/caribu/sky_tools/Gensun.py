"""The sun by day of the year, hour and latitude."""

from __future__ import annotations

import math

from .spitters_horaire import DecliSun


class Sun:
    """`Rsun`: its horizontal irradiance; `elev`: its *zenith* angle; `azim`: which way its light travels, from X (north) towards Y (west); both
    in radians."""

    def __init__(self, Rsun: float = 1.0, elev: float = 0.0, azim: float = 0.0):
        self.Rsun, self.elev, self.azim = Rsun, elev, azim

    def _set_pos_astro(self, DOY: int, heureTU: float, lat: float) -> None:
        """Its place on a day of the year at an hour of solar time; latitude in radians."""
        declination, hour = DecliSun(DOY), 2 * math.pi / 24 * (heureTU - 12)
        height = math.sin(lat) * math.sin(declination) + math.cos(lat) * math.cos(declination) * math.cos(hour)
        self.elev = math.acos(max(-1.0, min(1.0, height)))
        self.azim = -math.atan2(math.sin(hour), math.sin(lat) * math.cos(hour) - math.cos(lat) * math.tan(declination))

    def _get_pos_astro(self) -> tuple[float, float]:
        return self.elev, self.azim

    def toLight(self) -> str:
        """ "energy vx vy vz", or nothing at night."""
        if self.elev >= math.pi / 2:
            return ""
        way = math.sin(self.elev) * math.cos(self.azim), math.sin(self.elev) * math.sin(self.azim), -math.cos(self.elev)
        return " ".join(map(str, (self.Rsun, *way)))


class Gensun:
    """`Gensun()(Rsun, DOY, heureTU, lat)`: a `Sun`; latitude in degrees."""

    def __call__(self, Rsun: float, DOY: int, heureTU: float, lat: float) -> Sun:
        sun = Sun(Rsun)
        sun._set_pos_astro(DOY, heureTU, math.radians(lat))
        return sun
