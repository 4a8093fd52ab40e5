"""CARIBU's functions on lists of triangles [m]. What they return, per band: lists with an entry for each triangle,
{"index", "label", "area" [m2], "Eabs", "Ei", "Ei_sup", "Ei_inf" [per m2]}, and "sensors": {"Ei", "Ei0", "area"} where there are some."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import forms
from .engine import Soil, area_of, light_of
from .forms import Light, Material

green_leaf_PAR = (0.06, 0.07)
green_leaf_NIR = (0.5, 0.4)
soil_reflectance_PAR, soil_reflectance_NIR = 0.15, 0.25
default_light = (1, (0, 0, -1))

Output = dict[str, Any]


def _run(triangles: Iterable[Any], materials: Mapping[str, Iterable[Any]], lights: Sequence[Light], direct: bool, domain: Any, soil: Mapping[str, float] | None,
         sensors: Iterable[Any] | None) -> dict[str, Output]:
    corners = forms.corners(triangles, "triangles")
    checked: dict[str, list[Material]] = {}
    for band, given in materials.items():
        checked[band] = [forms.material(m, f"materials[{i}]") for i, m in enumerate(given)]
        if len(checked[band]) != len(corners):
            raise ValueError(f"materials: found {len(checked[band])}; expected {len(corners)}, one for each triangle")
    cell = None if domain is None else forms.pattern(domain)
    ground = None if soil is None else Soil(below(corners), soil)
    patches = {i: t for i, t in enumerate(forms.corners(sensors, "sensors")[:, None])} if sensors is not None else {}
    common: dict[str, Any] = {"domain": cell, "periodic": cell is not None, "soil": ground, "sensors": patches}
    found, _ = light_of(corners, np.arange(len(corners)), checked, forms.lights(lights), direct=direct, **common)
    first = found if direct or not patches else light_of(corners, np.arange(len(corners)), checked, forms.lights(lights), direct=True, **common)[0]
    area = area_of(corners)
    out = {}
    for band, light in found.items():
        def values(x: Any) -> list[float]:
            return np.where(area > 0, x, np.nan).tolist()

        out[band] = {"index": list(range(len(corners))), "label": [str(i) for i in range(len(corners))], "area": area.tolist(), "Eabs": values(light.absorbed),
                     "Ei": values(light.front + light.back), "Ei_sup": values(light.front), "Ei_inf": values(light.back)}
        if patches:
            out[band]["sensors"] = {"Ei": {k: float(v[0]) for k, v in light.sensors.items()}, "Ei0": {k: float(v[0]) for k, v in first[band].sensors.items()},
                                    "area": {k: float(area_of(t)[0]) for k, t in patches.items()}}
    return out


def below(corners: NDArray[np.float64]) -> float:
    """Just below the lowest point [m]."""
    if len(corners) == 0:
        return 0.0
    low = float(corners[..., 2].min())
    return low - 1e-4 * max(float(np.ptp(corners.reshape(-1, 3), axis=0).max()), 1e-3)


def x_raycasting(triangles: Iterable[Any], materials: Mapping[str, Iterable[Any]], lights: Sequence[Light] = (default_light,), domain: Any = None,
                 screen_size: int = 1536, sensors: Any = None, debug: bool = False, canfile: Any = None, optfile: Any = None) -> dict[str, Output]:
    """Light that comes straight from the sources, {band: ...}; a domain (xmin, ymin, xmax, ymax) repeats without end. screen_size, debug,
    canfile and optfile change nothing."""
    return _run(triangles, materials, lights, True, domain, None, sensors)


def raycasting(triangles: Iterable[Any], materials: Iterable[Any], lights: Sequence[Light] = (default_light,), domain: Any = None, screen_size: int = 1536,
               sensors: Any = None, debug: bool = False, canfile: Any = None, optfile: Any = None) -> Output:
    """x_raycasting() of one band."""
    return x_raycasting(triangles, {"band": materials}, lights, domain, sensors=sensors)["band"]


def x_radiosity(triangles: Iterable[Any], materials: Mapping[str, Iterable[Any]], lights: Sequence[Light] = (default_light,), screen_size: int = 1536,
                sensors: Any = None, debug: bool = False) -> dict[str, Output]:
    """All light, also what is scattered any number of times, {band: ...}, of a finite scene."""
    return _run(triangles, materials, lights, False, None, None, sensors)


def radiosity(triangles: Iterable[Any], materials: Iterable[Any], lights: Sequence[Light] = (default_light,), screen_size: int = 1536, sensors: Any = None,
              debug: bool = False) -> Output:
    """x_radiosity() of one band."""
    return x_radiosity(triangles, {"band": materials}, lights, sensors=sensors)["band"]


def x_mixed_radiosity(triangles: Iterable[Any], materials: Mapping[str, Iterable[Any]], lights: Sequence[Light], domain: Any,
                      soil_reflectance: Mapping[str, float], diameter: float | None = None, layers: int | None = None, height: float | None = None,
                      screen_size: int = 1536, sensors: Any = None, debug: bool = False) -> dict[str, Output]:
    """All light of a domain that repeats without end, over a soil just below the lowest point, {band: ...}. diameter, layers and height
    change nothing: here all scattered light is found as near light is there."""
    return _run(triangles, materials, lights, False, domain, soil_reflectance, sensors)


def mixed_radiosity(triangles: Iterable[Any], materials: Iterable[Any], lights: Sequence[Light], domain: Any, soil_reflectance: float,
                    diameter: float | None = None, layers: int | None = None, height: float | None = None, screen_size: int = 1536, sensors: Any = None,
                    debug: bool = False) -> Output:
    """x_mixed_radiosity() of one band."""
    return x_mixed_radiosity(triangles, {"band": materials}, lights, domain, {"band": soil_reflectance}, sensors=sensors)["band"]
