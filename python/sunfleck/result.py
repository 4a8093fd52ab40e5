"""Light that was found: arrays, tables and pictures."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from .scene import NO_ID

if TYPE_CHECKING:
    import pandas
    import xarray

_SIDES = ("front", "back")


class Facets:
    """Light of facets: plants in scene order, placements in theirs, facets in the plant's own; then the ground's. s states, n facets,
    b bands. Arrays are views of the result's memory and read only."""

    def __init__(self, light: _core.Light) -> None:
        self._light = light

    def _array(self, name: str) -> Any:
        if not self._light.has_facets:
            raise AttributeError(f"facets.{name}: found a result that keeps organs only; expected solve(..., facets=True)")
        return self._light.array(f"facets.{name}")

    @property
    def absorbed(self) -> NDArray[np.float32]:
        """(s, n, b) by both sides, per one-sided area [W m^-2]"""
        return self._array("absorbed")

    @property
    def irradiance(self) -> NDArray[np.float32]:
        """(s, n, 2, b) on front and back, direct and scattered [W m^-2]"""
        return self._array("irradiance")

    @property
    def sunlit(self) -> NDArray[np.float32]:
        """(s, n, 2) fraction of each side that the sun reaches [-]"""
        return self._array("sunlit")

    @property
    def area(self) -> NDArray[np.float32]:
        """(n,) one-sided [m^2]"""
        return self._array("area")

    @property
    def organ(self) -> NDArray[np.uint32]:
        """(n,) row of the organs"""
        return self._array("organ")

    @property
    def variance(self) -> NDArray[np.float32] | None:
        """(s, n, b) of absorbed [(W m^-2)^2]; None unless by method "reference" """
        return self._array("variance")

    def __len__(self) -> int:
        return len(self.area)


class Organs:
    """Light of organs: plants in scene order, placements in theirs, organs in the plant's own; cells of the ground are organs too, at the
    end. s states, m organs, b bands. Arrays of light are views of the result's memory and read only."""

    def __init__(self, light: _core.Light, ids: Mapping[int, NDArray[np.int64]], plants: Sequence[str]) -> None:
        self._light, self._ids, self._plants = light, ids, plants

    @property
    def absorbed(self) -> NDArray[np.float64]:
        """(s, m, b) by both sides [W]"""
        return self._light.array("organs.absorbed")

    @property
    def irradiance(self) -> NDArray[np.float64]:
        """(s, m, 2, b) mean over front and back [W m^-2]"""
        return self._light.array("organs.irradiance")

    @property
    def sunlit(self) -> NDArray[np.float64]:
        """(s, m, 2) fraction of each side that the sun reaches [-]"""
        return self._light.array("organs.sunlit")

    @property
    def area(self) -> NDArray[np.float64]:
        """(m,) one-sided [m^2]"""
        return self._light.array("organs.area")

    @property
    def variance(self) -> NDArray[np.float64] | None:
        """(s, m, b) of absorbed [W^2]; None unless by method "reference" """
        return self._light.array("organs.variance")

    @cached_property
    def name(self) -> NDArray[np.str_]:
        """(m,)"""
        return np.asarray(self._light.names("name"), dtype=str)

    @cached_property
    def type(self) -> NDArray[np.str_]:
        """(m,) of the structure; "ground" for the ground's"""
        return np.asarray(self._light.names("type"), dtype=str)

    @cached_property
    def plant(self) -> NDArray[np.str_]:
        """(m,) names of the plants"""
        return np.asarray(self._light.names("plant"), dtype=str)

    @cached_property
    def placement(self) -> NDArray[np.str_]:
        """(m,) which copy: "tile[3]/coffee[1]" """
        return np.asarray(self._light.names("placement"), dtype=str)

    @cached_property
    def id(self) -> NDArray[np.int64]:
        """(m,) the ids that Scene.plant() was given; NO_ID (the least int64) where there were none"""
        out = np.full(len(self), NO_ID, dtype=np.int64)
        if self._ids:
            member = self._light.array("organs.member")
            for row, ids in self._ids.items():
                if len(ids):
                    here = self.plant == self._plants[row]
                    out[here] = ids[member[here]]
        return out

    @cached_property
    def _views(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return self._light.views(1024, 1)

    @property
    def sky_view(self) -> NDArray[np.float64]:
        """(m, 2) share of the sky that each side sees: of what a Lambertian side would send, what leaves the scene upwards [-]. By 1,024
        rays from each side when first asked for: the standard error is at most .016."""
        return self._views[0]

    @property
    def ground_view(self) -> NDArray[np.float64]:
        """(m, 2) the same of the ground; what is neither meets plants, or leaves below the horizon"""
        return self._views[1]

    def __len__(self) -> int:
        return self._light.organ_count


@dataclass(frozen=True)
class Balance:
    """Power balance, (s, b) each [W]; of one cell where the scene is periodic. incident = leaves + ground + escaped + residual."""

    incident: NDArray[np.float64]
    leaves: NDArray[np.float64]
    ground: NDArray[np.float64]
    escaped: NDArray[np.float64]
    residual: NDArray[np.float64]


@dataclass(frozen=True)
class Certificate:
    """Some organs path-traced, against what the solve found for them; k organs. rmse and bias are fractions of the mean absorbed light per
    area, rmse_low to rmse_high the 95 % interval."""

    rmse: NDArray[np.float64]
    rmse_low: NDArray[np.float64]
    rmse_high: NDArray[np.float64]
    bias: NDArray[np.float64]
    organs: NDArray[np.uint64]
    solved: NDArray[np.float32]
    reference: NDArray[np.float32]
    standard_error: NDArray[np.float32]
    rays: int


class Result:
    """The light of a scene. facets and organs hold it; units has the unit of irradiance per band (W stands for umol s^-1 in bands of
    photons)."""

    def __init__(self, light: _core.Light, ids: Mapping[int, NDArray[np.int64]], plants: Sequence[str]) -> None:
        self._light = light
        self.facets = Facets(light)
        self.organs = Organs(light, ids, plants)

    @property
    def bands(self) -> list[str]:
        """Names of the bands."""
        return self._light.bands

    @property
    def units(self) -> dict[str, str]:
        """Unit of irradiance, per band."""
        return dict(zip(self._light.bands, self._light.units))

    @property
    def states(self) -> list[str]:
        """Names of the lighting states; "" where none is listed."""
        return [name for name, _ in self._light.states]

    @property
    def durations(self) -> NDArray[np.float64]:
        """(s,) [s]; 0 where none is given"""
        return np.asarray([seconds for _, seconds in self._light.states])

    @property
    def status(self) -> str:
        """"converged", "not_converged" or "inaccurate"; of the latter two, verdict says what was found and what helps."""
        return self._light.status

    @property
    def verdict(self) -> str:
        """Empty where all is as it was asked for."""
        return self._light.verdict

    @property
    def method(self) -> str:
        """By which the light was found; why it was chosen is in `why`."""
        return self._light.method

    @property
    def why(self) -> str:
        """Why this method, where it was not asked for."""
        return self._light.why

    @property
    def balance(self) -> Balance:
        """Power balance per state and band [W]."""
        return Balance(**self._light.balance)

    @property
    def certificate(self) -> Certificate | None:
        """None where none was wanted, or there is nothing to check."""
        found = self._light.certificate
        return None if found is None else Certificate(**found)

    @property
    def sensors(self) -> dict[str, dict[str, Any]]:
        """Per sensor: area (k,) [m^2], centroid (k, 3) [m], irradiance (s, k, b) [W m^-2], standard_error, irradiance_back."""
        return self._light.sensors

    @property
    def timings(self) -> dict[str, float]:
        """Seconds per phase."""
        return self._light.timings

    @property
    def counts(self) -> dict[str, int]:
        """Work that was done: links, rays, ..."""
        return self._light.counts

    @property
    def memory(self) -> dict[str, int]:
        """Bytes held per phase."""
        return self._light.memory

    def write(self, file: str | os.PathLike[str]) -> None:
        """Writes the result file (docs/formats-result.md), complete or not at all: for view, compare, export and read_result(). Raises
        ValueError where facets were not kept, OSError where it cannot be written."""
        self._light.write(os.fspath(file))

    def daily(self) -> NDArray[np.float64]:
        """(m, b) absorbed by organs over all states [J]: sum of absorbed x duration. Raises ValueError where a state has no duration."""
        if not np.all(self.durations > 0):
            raise ValueError("daily: found states without duration; expected one for each")
        return np.asarray(np.einsum("s,smb->mb", self.durations, self.organs.absorbed))

    def to_xarray(self, facets: bool = False) -> "xarray.Dataset":
        """An xarray data set of organs, and of facets where asked for, with units and coordinates."""
        import xarray

        b, o = self.bands, self.organs
        per_area = ", ".join(f"{band}: {unit}" for band, unit in self.units.items())
        if len(set(self.units.values())) == 1:
            per_area = next(iter(self.units.values()))
        power = per_area.replace(" m^-2", "")
        data: dict[str, Any] = {
            "absorbed": (("state", "organ", "band"), o.absorbed, {"units": power, "long_name": "absorbed by both sides"}),
            "irradiance": (("state", "organ", "side", "band"), o.irradiance, {"units": per_area, "long_name": "mean irradiance of a side"}),
            "sunlit": (("state", "organ", "side"), o.sunlit, {"units": "1", "long_name": "fraction of a side that the sun reaches"}),
            "area": ("organ", o.area, {"units": "m^2", "long_name": "one-sided area"}),
        }
        coordinates: dict[str, Any] = {
            "state": [name or str(i) for i, name in enumerate(self.states)], "band": b, "side": list(_SIDES), "duration": ("state", self.durations, {"units": "s"}),
            "name": ("organ", o.name), "type": ("organ", o.type), "plant": ("organ", o.plant), "placement": ("organ", o.placement), "id": ("organ", o.id),
        }
        if facets:
            f = self.facets
            data["facet_absorbed"] = (("state", "facet", "band"), f.absorbed, {"units": per_area, "long_name": "absorbed per one-sided area"})
            data["facet_irradiance"] = (("state", "facet", "side", "band"), f.irradiance, {"units": per_area})
            data["facet_sunlit"] = (("state", "facet", "side"), f.sunlit, {"units": "1"})
            data["facet_area"] = ("facet", f.area, {"units": "m^2"})
            coordinates["facet_organ"] = ("facet", f.organ)
        return xarray.Dataset(data, coordinates, {"method": self.method, "status": self.status})

    def to_pandas(self) -> "pandas.DataFrame":
        """A pandas frame: a row for each state and organ; absorbed_BAND [W], irradiance_front_BAND [W m^-2], ..., area [m^2]."""
        import pandas

        o, s = self.organs, len(self.states)
        columns: dict[str, Any] = {"state": np.repeat(self.states, len(o))}
        for key in ("name", "type", "plant", "placement", "id", "area"):
            columns[key] = np.tile(getattr(o, key), s)
        for side, title in enumerate(_SIDES):
            columns[f"sunlit_{title}"] = o.sunlit[:, :, side].ravel()
        for b, band in enumerate(self.bands):
            columns[f"absorbed_{band}"] = o.absorbed[:, :, b].ravel()
            for side, title in enumerate(_SIDES):
                columns[f"irradiance_{title}_{band}"] = o.irradiance[:, :, side, b].ravel()
        return pandas.DataFrame(columns)

    def png(self, state: int = 0, width: int = 800, height: int = 600, samples: int = 9) -> bytes:
        """A ray-traced picture in natural colour, as the bytes of a PNG; nothing is written."""
        return self._light.png(state, width, height, samples)

    def _repr_png_(self) -> bytes | None:
        if not self._light.has_facets and not self._light.file:
            return None
        return self.png(width=640, height=480, samples=4)

    def __repr__(self) -> str:
        many = f"{len(self.facets)} facets, " if self._light.has_facets else ""
        return f"<sunfleck.Result: {many}{len(self.organs)} organs, bands {', '.join(self.bands)}, {len(self.states)} state(s), {self.method}, {self.status}>"


def read_result(file: str | os.PathLike[str]) -> Result:
    """Reads a result file into memory. Raises ValueError where it is none, or broken."""
    return Result(_core.read_result(os.fspath(file)), {}, ())
