"""Silhouette to total area ratio."""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any

import numpy as np

from .CaribuScene import CaribuScene
from .light import diffuse_source


def caribu_star(scene: Any, directions: int | str = 1, output_by_triangle: bool = False, domain: Any = None, convUnit: float = 0.01) -> tuple[dict[Hashable, Any], dict[Hashable, Any]]:
    """(star, exposed_area) of a scene in units of convUnit [m] under 1, 16 or 46 directions of an overcast sky: irradiance of each id (or
    triangle) over that of a horizontal plane in the open, and that times its area [m2]."""
    unit = {0.001: "mm", 0.01: "cm", 0.1: "dm", 1.0: "m"}.get(float(convUnit))
    if unit is None:
        raise ValueError(f"convUnit: found {convUnit}; expected .001, .01, .1 or 1 m")
    caribu = CaribuScene(scene, light=diffuse_source(directions), pattern=domain, opt={"band": (0.0,)}, scene_unit=unit)
    raw, aggregated = caribu.run(direct=True, infinite=domain is not None, simplify=True)
    light, area = (raw["Ei"], raw["area"]) if output_by_triangle else (aggregated["Ei"], aggregated["area"])
    exposed = {key: (np.asarray(light[key]) * np.asarray(area[key])).tolist() for key in light}
    return light, exposed
