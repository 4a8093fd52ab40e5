"""A sky of sectors by azimuth and zenith angle."""

from __future__ import annotations

import math


class Sky:
    """`sky`: for each sector [energy, vx, vy, vz, azimuth index, zenith index]: the irradiance of a horizontal plane, and the way the light travels
    from the sector's middle."""

    def __init__(self, azimuths: int, zeniths: int):
        if azimuths < 1 or zeniths < 1:
            raise ValueError(f"sectors: found {azimuths} x {zeniths}; expected at least one each")
        self.sec = [azimuths, zeniths]
        self.dp, self.dt = 2 * math.pi / azimuths, math.pi / 2 / zeniths
        self.sky: list[list[float]] = []
        for j in range(azimuths):
            for k in range(zeniths):
                azimuth, zenith = (j + 0.5) * self.dp, (k + 0.5) * self.dt
                self.sky.append([0.0, math.sin(zenith) * math.cos(azimuth), math.sin(zenith) * math.sin(azimuth), -math.cos(zenith), j, k])

    def set_Rd(self, Rd: float, Tsky: str) -> None:
        """Shares the horizontal irradiance Rd among the sectors: "soc", the radiance of a standard overcast sky (Moon & Spencer 1942), or "uoc",
        a uniform one."""
        if Tsky not in ("soc", "uoc"):
            raise ValueError(f'Tsky: found "{Tsky}"; expected "soc" or "uoc"')
        for sector in self.sky:
            near, far = math.cos(sector[5] * self.dt), math.cos((sector[5] + 1) * self.dt)
            square, cube = near**2 - far**2, near**3 - far**3
            sector[0] = Rd * self.dp / math.pi * (square / 2 if Tsky == "uoc" else 3 / 14 * square + 2 / 7 * cube)

    def get_Rs(self) -> float:
        """The irradiance of a horizontal plane."""
        return sum(sector[0] for sector in self.sky)


class GenSky:
    """`GenSky()(Rd, Tsky, Nazi, Nzen)`: a `Sky` of Nazi x Nzen sectors and horizontal irradiance Rd."""

    def __call__(self, Rd: float, Tsky: str, Nazi: int, Nzen: int) -> Sky:
        sky = Sky(Nazi, Nzen)
        sky.set_Rd(Rd, Tsky)
        return sky
