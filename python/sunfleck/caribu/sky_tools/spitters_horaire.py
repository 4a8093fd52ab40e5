"""The diffuse part of global radiation, hour by hour (Spitters, Toussaint & Goudriaan 1986, https://doi.org/10.1016/0168-1923(86)90060-2)."""

from __future__ import annotations

import math

# A table of CARIBU's: columns day, hour, global radiation, ... each a list that its name opens.
Table = list[list[str]]


def DecliSun(DOY: float) -> float:
    """The sun's declination [radians] on a day of the year."""
    day = 2 * math.pi * (DOY - 1) / 365
    return 0.006918 - 0.399912 * math.cos(day) + 0.070257 * math.sin(day)


def DayLength(latitude: float, decli: float) -> float:
    """The day's length [radians of the earth's turning] at a latitude [degrees] and declination [radians]."""
    return 2 * math.acos(max(-1.0, min(1.0, -math.tan(decli) * math.tan(math.radians(latitude)))))


def dH(angleH: float) -> float:
    """Hours of a day's length in radians."""
    return 24 / (2 * math.pi) * angleH


def _sine_of_elevation(DOY: float, heureTU: float, latitude: float) -> float:
    lat, declination = math.radians(latitude), DecliSun(DOY)
    return math.sin(lat) * math.sin(declination) + math.cos(lat) * math.cos(declination) * math.cos(2 * math.pi / 24 * (heureTU - 12))


def extra(Rg: float, DOY: float, heureTU: float, latitude: float) -> float:
    """Irradiance of a horizontal plane above the atmosphere [W m^-2]; Rg takes no part."""
    return 1370 * (1 + 0.033 * math.cos(2 * math.pi * (DOY - 4) / 366)) * _sine_of_elevation(DOY, heureTU, latitude)


def RdRsH(Rg: float, DOY: float, heureTU: float, latitude: float) -> float:
    """The diffuse share of global radiation Rg [W m^-2] (their equations 20a to 20d); one while the sun is down."""
    above = extra(Rg, DOY, heureTU, latitude)
    if above <= 0:
        return 1.0
    clearness, sine = Rg / above, _sine_of_elevation(DOY, heureTU, latitude)
    clear = 0.847 - 1.61 * sine + 1.04 * sine**2
    if clearness <= 0.22:
        return 1.0
    if clearness <= 0.35:
        return 1 - 6.4 * (clearness - 0.22) ** 2
    return 1.47 - 1.66 * clearness if clearness <= (1.47 - clear) / 1.66 else clear


class spitters_horaire:
    """`spitters_horaire()(Tab_Rg, latitude)` puts a column "RdRg" after the first three (day of the year, hour, global radiation) of each group's table."""

    DecliSun, DayLength, extra, RdRsH = staticmethod(DecliSun), staticmethod(DayLength), staticmethod(extra), staticmethod(RdRsH)

    def __call__(self, Tab_Rg: list[Table], latitude: float) -> tuple[list[Table]]:
        for table in Tab_Rg:
            days, hours, radiation = table[:3]
            table.insert(3, ["RdRg", *(str(RdRsH(float(r), int(d), float(h), latitude)) for d, h, r in zip(days[1:], hours[1:], radiation[1:]))])
        return (Tab_Rg,)
