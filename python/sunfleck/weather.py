"""Lighting states from hourly weather files: EPW (EnergyPlus) and TMY3 (NREL)."""

from __future__ import annotations

import csv
import math
import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta, timezone
from typing import Any

from . import _core
from .scene import SceneWarning

SHARES = {"PAR": 0.48, "NIR": 0.52}
"""Shares of global radiation by band (McCree 1972: about half is PAR)."""


@dataclass(frozen=True)
class Hour:
    """The hour that ends at `end`, in the station's standard time: global horizontal, direct normal and diffuse horizontal irradiance [W m^-2];
    None where the file has none."""

    end: datetime
    horizontal: float | None
    normal: float | None
    diffuse: float | None

    @property
    def middle(self) -> datetime:
        """Where the sun is taken from."""
        return self.end - timedelta(minutes=30)


@dataclass(frozen=True)
class Weather:
    """A station's hours, in the order of the file; gaps says what is missing."""

    name: str
    latitude: float
    longitude: float
    altitude: float
    hours: list[Hour]
    gaps: list[str] = field(default_factory=list)

    def states(self, month: int, day: int, *, shares: Mapping[str, float] = SHARES, sky: str = "standard_overcast") -> list[dict[str, Any]]:
        """Arguments of Scene.state(), one for each hour of a day with light: the sun where it is in the middle of the hour, its beam the direct
        normal irradiance, the sky the diffuse one, times the shares of the bands. Where the sun is below the horizon in the middle of the
        hour, all light is the sky's. Hours without data are left out and warned of. sky: a model of Scene.sky()."""
        of_day = [h for h in self.hours if (h.middle.month, h.middle.day) == (month, day)]
        if not of_day:
            raise ValueError(f"day: found no hour of {month:02d}-{day:02d} in {self.name}")
        out = []
        for hour in of_day:
            light = self._light(hour)
            if light is None:
                warnings.warn(f"{self.name}: no irradiance for the hour that ends {hour.end:%m-%d %H:%M}: left out", SceneWarning, stacklevel=2)
                continue
            beam, diffuse, above = light
            if beam <= 0 and diffuse <= 0:
                continue
            time = hour.middle.isoformat()
            where = {"latitude": self.latitude, "longitude": self.longitude, "altitude": self.altitude, "time": time}
            state: dict[str, Any] = {"name": f"{hour.middle:%H:%M}", "duration": 3600.0}
            if above:
                state["sun"] = {**where, "irradiance": {b: beam * s for b, s in shares.items()}}
            state["sky"] = {"model": sky if above or sky not in ("clear", "perez") else "uniform", "irradiance": {b: diffuse * s for b, s in shares.items()}}
            if state["sky"]["model"] == "perez" and diffuse > 0:
                state["sky"] |= {"direct": beam, "diffuse": diffuse}
            out.append(state)
        return out

    def _light(self, hour: Hour) -> tuple[float, float, bool] | None:
        """Beam on a plane that faces the sun, diffuse, and whether the sun is up."""
        elevation, _ = _core.solar_position(hour.middle.isoformat(), self.latitude, self.longitude, self.altitude)
        g, n, d = hour.horizontal, hour.normal, hour.diffuse
        height = math.sin(math.radians(elevation))
        if elevation <= 0:
            whole = g if g is not None else d
            return None if whole is None else (0.0, whole, False)
        if n is None and g is not None and d is not None:
            n = max(g - d, 0.0) / height
        if d is None and g is not None and n is not None:
            d = max(g - n * height, 0.0)
        return None if n is None or d is None else (n, d, True)


def _value(text: str, missing: float, where: str) -> float | None:
    try:
        x = float(text)
    except ValueError:
        raise ValueError(f'{where}: found "{text}"; expected a number') from None
    return None if x < 0 or x >= missing else x


def _rows(file: str | os.PathLike[str]) -> Iterator[tuple[int, list[str]]]:
    with open(file, encoding="latin-1", newline="") as lines:
        for row in (reader := csv.reader(lines)):
            if any(row):
                yield reader.line_num, row


def _place(row: Sequence[str], at: Sequence[int], where: str) -> list[float]:
    try:
        values = [float(row[i]) for i in at]
    except (IndexError, ValueError):
        raise ValueError(f"{where}: found {','.join(row)!r}; expected latitude, longitude, time zone and elevation") from None
    if not (-90 <= values[0] <= 90 and -180 <= values[1] <= 180 and -14 <= values[2] <= 14):
        raise ValueError(f"{where}: found latitude {values[0]}, longitude {values[1]}, time zone {values[2]}; expected a place on Earth")
    return values


def _finished(name: str, place: Sequence[float], hours: list[Hour], file: str) -> Weather:
    if not hours:
        raise ValueError(f"{file}: found no hour; expected hourly rows")
    gaps = []
    for before, after in zip(hours, hours[1:]):
        jump = (after.middle.replace(year=2001) if (after.middle.month, after.middle.day) != (2, 29) else after.middle) - (
            before.middle.replace(year=2001) if (before.middle.month, before.middle.day) != (2, 29) else before.middle)
        missing = int(jump.total_seconds() // 3600) - 1
        if 0 < missing < 8700:
            gaps.append(f"{missing} hour(s) missing after {before.end:%m-%d %H:%M}")
        elif missing < 0 and -8000 < missing:
            gaps.append(f"hours go back after {before.end:%m-%d %H:%M}")
    for hour in hours:
        if hour.horizontal is None and (hour.normal is None or hour.diffuse is None):
            gaps.append(f"no irradiance for the hour that ends {hour.end:%m-%d %H:%M}")
    weather = Weather(name, place[0], place[1], place[3], hours, gaps)
    if gaps:
        shown = "; ".join(gaps[:5]) + (f"; and {len(gaps) - 5} more" if len(gaps) > 5 else "")
        warnings.warn(f"{file}: {shown}", SceneWarning, stacklevel=3)
    return weather


def read_epw(file: str | os.PathLike[str]) -> Weather:
    """An EPW file (EnergyPlus weather format). Warns of gaps; raises ValueError naming file and line."""
    hours, place, name = [], None, os.fspath(file)
    for number, row in _rows(file):
        where = f"{os.fspath(file)}:{number}"
        if number == 1:
            if row[0].upper() != "LOCATION":
                raise ValueError(f'{where}: found "{row[0]}"; expected LOCATION, as an EPW file begins')
            place, name = _place(row, (6, 7, 8, 9), where), row[1]
        elif number > 8:
            if place is None or len(row) < 16:
                raise ValueError(f"{where}: found {len(row)} cells; expected at least 16")
            zone = timezone(timedelta(hours=place[2]))
            try:
                end = datetime(int(row[0]), int(row[1]), int(row[2]), tzinfo=zone) + timedelta(hours=int(row[3]))
            except ValueError:
                raise ValueError(f"{where}: found {','.join(row[:4])}; expected year, month, day, hour") from None
            hours.append(Hour(end, *(_value(row[i], 9999, where) for i in (13, 14, 15))))
    if place is None:
        raise ValueError(f"{os.fspath(file)}: found nothing; expected an EPW file")
    return _finished(name, place, hours, os.fspath(file))


def read_tmy3(file: str | os.PathLike[str]) -> Weather:
    """A TMY3 file (NREL, CSV with two header lines). Warns of gaps; raises ValueError naming file and line."""
    hours: list[Hour] = []
    place, name = None, os.fspath(file)
    columns: dict[str, int] = {}
    wanted = {"Date (MM/DD/YYYY)": "date", "Time (HH:MM)": "time", "GHI (W/m^2)": "g", "DNI (W/m^2)": "n", "DHI (W/m^2)": "d"}
    for number, row in _rows(file):
        where = f"{os.fspath(file)}:{number}"
        if place is None:
            place, name = _place(row, (4, 5, 3, 6), where), row[1]
        elif not columns:
            columns = {wanted[c]: i for i, c in enumerate(row) if c in wanted}
            missing = [c for c, key in wanted.items() if key not in columns]
            if missing:
                raise ValueError(f"{where}: found no column {missing[0]}; expected {', '.join(wanted)}")
        else:
            if len(row) <= max(columns.values()):
                raise ValueError(f"{where}: found {len(row)} cells; expected at least {max(columns.values()) + 1}")
            try:
                month, day, year = (int(x) for x in row[columns["date"]].split("/"))
                hour, minute = (int(x) for x in row[columns["time"]].split(":"))
                end = datetime(year, month, day, tzinfo=timezone(timedelta(hours=place[2]))) + timedelta(hours=hour, minutes=minute)
            except ValueError:
                raise ValueError(f"{where}: found {row[columns['date']]} {row[columns['time']]}; expected MM/DD/YYYY and HH:MM") from None
            hours.append(Hour(end, *(_value(row[columns[c]], 9900, where) for c in "gnd")))
    if place is None:
        raise ValueError(f"{os.fspath(file)}: found nothing; expected a TMY3 file")
    return _finished(name, place, hours, os.fspath(file))
