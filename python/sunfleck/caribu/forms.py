"""The forms in which CARIBU takes scenes, light, patterns and materials."""

from __future__ import annotations

import os
from collections.abc import Hashable, Iterable, Mapping, Sequence
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

from .. import _core

Point = tuple[float, float, float]
Light = tuple[float, Point]
"""(irradiance of a horizontal plane per m2, the way in which the light travels: down)"""
Material = tuple[float, ...]
"""(rho,) opaque; (rho, tau) both sides; (rho_up, tau_up, rho_low, tau_low)"""
PathLike = Union[str, "os.PathLike[str]"]

UNITS = {"mm": 0.001, "cm": 0.01, "dm": 0.1, "m": 1.0, "dam": 10.0, "hm": 100.0, "km": 1000.0}


def is_path(x: Any, suffix: str) -> bool:
    """Is it a file name that ends so?"""
    return isinstance(x, (str, os.PathLike)) and os.fspath(x).lower().endswith(suffix)


def corners(triangles: Iterable[Any], where: str) -> NDArray[np.float64]:
    """Triangles, lists, tuples or iterators of three points each, as (n, 3, 3)."""
    if not isinstance(triangles, np.ndarray):
        triangles = [[tuple(p) for p in t] for t in triangles]
    try:
        out = np.ascontiguousarray(triangles, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"{where}: found no triangles of three points with three coordinates each") from None
    if out.size == 0:
        return np.empty((0, 3, 3))
    if out.ndim != 3 or out.shape[1:] != (3, 3):
        raise ValueError(f"{where}: found shape {out.shape}; expected triangles of three points with three coordinates each")
    bad = np.argwhere(~np.isfinite(out))
    if len(bad):
        raise ValueError(f"{where}{list(map(int, bad[0]))}: found {out[tuple(bad[0])]}; expected a finite number")
    return out


def lights(light: Any) -> list[Light]:
    """A list of (energy, direction), or a .light file."""
    if is_path(light, ".light"):
        return [(e, (-x, -y, -z)) for e, (x, y, z) in _core.read_light_file(os.fspath(light))]
    if isinstance(light, (str, os.PathLike)) or not isinstance(light, Iterable):
        raise ValueError("light: found no recognised form; expected [(energy, (vx, vy, vz)), ...] or a .light file")
    out: list[Light] = []
    for i, source in enumerate(light):
        try:
            energy, (x, y, z) = source
            values = [float(v) for v in (energy, x, y, z)]
        except (TypeError, ValueError):
            raise ValueError(f"light[{i}]: found {source!r}; expected (energy, (vx, vy, vz))") from None
        if not all(np.isfinite(values)) or values[0] < 0 or values[1:] == [0, 0, 0]:
            raise ValueError(f"light[{i}]: found {source!r}; expected an energy of zero or more, and a direction that is not zero")
        out.append((energy, (x, y, z)))
    return out


def pattern(given: Any) -> tuple[float, float, float, float]:
    """(xmin, ymin, xmax, ymax), or two corners, in any order; or a .8 file."""
    if is_path(given, ".8"):
        values = _core.read_pattern_file(os.fspath(given))
    else:
        try:
            values = [float(v) for v in np.ravel(given)]
        except (TypeError, ValueError):
            values = []
    if len(values) != 4 or not all(np.isfinite(values)) or values[0] == values[2] or values[1] == values[3]:
        raise ValueError(f"pattern: found {given!r}; expected (xmin, ymin, xmax, ymax), ((x, y), (x, y)) or a .8 file")
    xs, ys = sorted((values[0], values[2])), sorted((values[1], values[3]))
    return xs[0], ys[0], xs[1], ys[1]


def material(given: Any, where: str) -> Material:
    """A material as CARIBU has it, checked."""
    try:
        out = tuple(float(v) for v in given)
    except (TypeError, ValueError):
        out = ()
    sides = sides_of(out) if len(out) in (1, 2, 4) else None
    if sides is None or not all(0 <= v <= 1 for v in out) or any(rho + tau > 1 + 1e-6 for rho, tau in (sides[:2], sides[2:])):
        raise ValueError(f"{where}: found {given!r}; expected (rho,), (rho, tau) or (rho_up, tau_up, rho_low, tau_low), each rho + tau at most 1")
    return out


def sides_of(m: Material) -> tuple[float, float, float, float]:
    """Reflectance and transmittance of the upper and the lower side."""
    return (m[0], 0.0, m[0], 0.0) if len(m) == 1 else (m[0], m[1], m[0], m[1]) if len(m) == 2 else (m[0], m[1], m[2], m[3])


def scene(given: Any) -> dict[Hashable, list[Any]]:
    """{id: [triangle, ...]} of whatever a scene is: a mapping, a .can file, a PlantGL scene, an MTG, CARIBU's triangle sets."""
    if isinstance(given, Mapping):
        return {key: triangles if isinstance(triangles, list) else list(triangles) for key, triangles in given.items()}
    if is_path(given, ".can"):
        return can(os.fspath(given))[0]
    if all(hasattr(given, name) for name in ("allvalues", "allids")):  # AbstractCaribuTriangleSet
        out: dict[Hashable, list[Any]] = {}
        for key, triangle in zip(given.allids(), given.allvalues()):
            out.setdefault(key, []).append(triangle)
        return out
    from ..convert import plantgl_triangles

    shapes = plantgl_triangles(given)
    if shapes is None:
        raise ValueError("Unrecognised scene format: expected {id: [triangle, ...]}, a .can file, an MTG or a PlantGL scene")
    return {key: [tuple(map(tuple, t)) for t in triangles.tolist()] for key, triangles in shapes.items()}


def can(file: str) -> tuple[dict[Hashable, list[Any]], dict[Hashable, tuple[str, int]]]:
    """Triangles by label of a .can file, and of each label its type ("leaf", "stem" or "soil") and optical species."""
    triangles, owner, organs = _core.read_plant(file)
    points = triangles.tolist()
    scene_of: dict[Hashable, list[Any]] = {}
    species: dict[Hashable, tuple[str, int]] = {}
    for row, (name, kind, of_material, label) in enumerate(organs):
        key = label or name
        scene_of[key] = [[tuple(p) for p in points[t]] for t in np.flatnonzero(owner == row)]
        species[key] = (kind, int(of_material.rsplit("_", 1)[-1]))
    return scene_of, species


def opt_files(files: Sequence[PathLike], species: Mapping[Hashable, tuple[str, int]]) -> tuple[dict[str, dict[Hashable, Material]], dict[str, float]]:
    """Materials per band and label, and the soil's reflectance, of .opt files; a band is named as its file up to the first dot."""
    materials: dict[str, dict[Hashable, Material]] = {}
    soil: dict[str, float] = {}
    for file in files:
        band = os.path.basename(os.fspath(file)).split(".")[0]
        of_soil, rows = _core.read_opt(os.fspath(file))
        materials[band] = {}
        for key, (kind, number) in species.items():
            if not 1 <= number <= len(rows):
                raise ValueError(f"opt: found {len(rows)} species in {os.fspath(file)}; expected species {number}, which label {key} has")
            stem, *leaf = rows[number - 1]
            materials[band][key] = material(leaf if kind == "leaf" else (stem,), f"opt {os.fspath(file)}, species {number}")
        if of_soil >= 0:
            soil[band] = of_soil
    return materials, soil
