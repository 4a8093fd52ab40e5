"""One solve behind all of CARIBU's calls."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..result import Result
from ..scene import Scene, SceneWarning
from ..solving import solve
from .forms import Light, Material, sides_of


@dataclass
class Soil:
    """Flat ground at a height [m], with a reflectance per band; its two triangles fill the domain."""

    height: float
    reflectance: Mapping[str, float]


@dataclass
class Found:
    """Light of n triangles in one band, energies per m2: absorbed (n,), irradiance of the front and back (n,), of soil (2,) and sensors."""

    absorbed: NDArray[np.float64]
    front: NDArray[np.float64]
    back: NDArray[np.float64]
    soil_absorbed: NDArray[np.float64]
    soil_irradiance: NDArray[np.float64]
    sensors: dict[Any, NDArray[np.float64]] = field(default_factory=dict)


def area_of(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) of triangles (n, 3, 3)"""
    return np.asarray(np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2)


def _parted(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of triangles that coincide, later ones a hundred-thousandth of their size lower, so that the first is met first from above."""
    if len(corners) < 2:
        return corners
    order = np.lexsort(corners.transpose(2, 1, 0).reshape(3, -1)).reshape(-1)  # points in order, to know a triangle by whichever corner is first
    rank = np.empty(order.size, dtype=np.int64)
    rank[order] = np.arange(order.size)
    points = corners.transpose(2, 1, 0).reshape(3, -1)[:, order]
    same = np.concatenate([[0], np.cumsum(np.any(points[:, 1:] != points[:, :-1], axis=0))])
    of_point = same[rank].reshape(3, -1)
    _, inverse, counts = np.unique(np.sort(of_point, axis=0).T, axis=0, return_inverse=True, return_counts=True)
    if counts.max() == 1:
        return corners
    out = corners.copy()
    seen: dict[int, int] = {}
    for i in np.flatnonzero(counts[inverse.reshape(-1)] > 1).tolist():
        k = int(inverse.reshape(-1)[i])
        out[i, :, 2] -= 1e-5 * seen.get(k, 0) * np.ptp(corners[i], axis=0).max()
        seen[k] = seen.get(k, 0) + 1
    return out


def _sources(lights: Sequence[Light]) -> list[Light]:
    """Directions from above with some energy, each once."""
    merged: dict[tuple[float, ...], float] = {}
    for energy, v in lights:
        towards = -np.asarray(v, dtype=float) / np.linalg.norm(v)
        if energy > 0 and towards[2] <= 1e-9:
            warnings.warn(f"light {v} does not come from above: it gives nothing", SceneWarning, stacklevel=4)
        elif energy > 0:
            key = tuple(float(x) for x in towards)
            merged[key] = merged.get(key, 0.0) + float(energy)
    return [(e, (d[0], d[1], d[2])) for d, e in merged.items()] or [(0.0, (0.0, 0.0, 1.0))]


def light_of(corners: NDArray[np.float64], organ: NDArray[np.int64], materials: Mapping[str, Sequence[Material]], lights: Sequence[Light], *, direct: bool,
             domain: Sequence[float] | None = None, periodic: bool = False, soil: Soil | None = None, sensors: Mapping[Any, NDArray[np.float64]] | None = None,
             options: Mapping[str, Any] | None = None) -> tuple[dict[str, Found], Result]:
    """Light of triangles (n, 3, 3) [m] of organs (n,) counted from 0, with a material per band and organ, under lights; domain [m] repeats where periodic. Every light
    is a sun of its own; energies are added up over them."""
    bands = list(materials)
    names = [f"band {b}" for b in range(len(bands))]
    scene = Scene(bands=names)
    if periodic and domain is not None:
        scene.periodic = (domain[0], domain[1], domain[2], domain[3])
    sources = _sources(lights)
    for i, (energy, towards) in enumerate(sources):
        beam = energy / towards[2]
        scene.state(f"light {i + 1}", sun={"direction": list(towards), "irradiance": dict.fromkeys(names, beam), "angular_diameter": 0})

    rows = np.asarray([[sides_of(m) for m in materials[band]] for band in bands], dtype=float).reshape(len(bands), -1, 4)  # (b, m, 4)
    kinds, kind = np.unique(rows.transpose(1, 0, 2).reshape(rows.shape[1], -1), axis=0, return_inverse=True)
    for k, values in enumerate(kinds.reshape(-1, len(bands), 4)):
        if np.any(values[:, 1] != values[:, 3]):
            warnings.warn("transmittances of the two sides differ; their mean is taken, since light through a leaf is the same both ways", SceneWarning, stacklevel=4)
        scene.optics(f"material {k}", reflectance_front=dict(zip(names, values[:, 0])), reflectance_back=dict(zip(names, values[:, 2])),
                     transmittance=dict(zip(names, values[:, [1, 3]].mean(axis=1))))
    n = len(corners)
    if n:
        of_organ = {i: f"material {k}" for i, k in enumerate(kind.reshape(-1).tolist())}
        scene.plant("plants", np.ascontiguousarray(_parted(corners)), organ=organ, optics=of_organ).place()
    if soil is not None and domain is not None:
        size = (domain[2] - domain[0], domain[3] - domain[1])
        scene.ground(size=size, center=((domain[0] + domain[2]) / 2, (domain[1] + domain[3]) / 2), height=soil.height, cells=(1, 1),
                     reflectance={name: soil.reflectance[band] for name, band in zip(names, bands)})
    keys = list(sensors or ())
    for i, key in enumerate(keys):
        scene.sensor(f"sensor {i}", triangles=(sensors or {})[key])

    chosen: dict[str, Any] = {"certificate": False, **(options or {})}
    if direct:
        chosen["method"] = "direct"
    result = solve(scene, **chosen)
    absorbed, irradiance = (np.sum(x, axis=0, dtype=float) for x in (result.facets.absorbed, result.facets.irradiance))
    out = {}
    for b, band in enumerate(bands):
        read = {key: np.sum(result.sensors[f"sensor {i}"]["irradiance"][:, :, b], axis=0, dtype=float) for i, key in enumerate(keys)}
        out[band] = Found(absorbed[:n, b], irradiance[:n, 0, b], irradiance[:n, 1, b], absorbed[n:, b], irradiance[n:, 0, b], read)
    return out, result
