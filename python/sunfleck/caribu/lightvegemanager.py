"""LightVegeManager's calls with light model "caribu", answered by this solver: `from lightvegemanager.LVM import LightVegeManager` becomes
`from sunfleck.caribu.lightvegemanager import LightVegeManager`. X points north; docs/python.md has what differs."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Hashable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import forms
from .CaribuScene import CaribuScene
from .engine import area_of
from .forms import UNITS, Light
from .sky_tools.GenSky import GenSky
from .sky_tools.Gensun import Gensun, Sun
from .sky_tools.spitters_horaire import RdRsH
from .sky_tools.turtle import turtle

ENVIRONMENT: dict[str, Any] = {"coordinates": [46.4, 0.0, 1.0], "sky": "turtle46", "diffus": True, "direct": True, "reflected": False, "infinite": False}
PARAMETERS: dict[str, Any] = {"caribu opt": {"par": (0.10, 0.05)}, "sun algo": "caribu", "soil mesh": -1, "debug": False}
# umol m^-2 s^-1 of photosynthetic photons per W m^-2 of global radiation, as there
PHOTONS_OF_GLOBAL = 2.02
# how each of its names for the X axis is turned to north [degrees]
TURNS = {"x+ = N": 0, "x+ = S": 180, "x+ = W": 90, "x+ = E": -90}


class LightVegeManager:
    """environment: "coordinates" [latitude, longitude (degrees), hours added to the time of day], "sky" ("turtle46", a file of elevation, azimuth,
    solid angle and weight, or [azimuths, zeniths, "soc" or "uoc"]), "diffus", "direct", "reflected", "infinite". lightmodel_parameters: "caribu opt"
    {band: material}, "soil mesh" (-1 for none), "sensors" ["grid", sizes, numbers, origin]; the others change nothing."""

    def __init__(self, environment: Mapping[str, Any] | None = None, lightmodel: str = "caribu", lightmodel_parameters: Mapping[str, Any] | None = None,
                 main_unit: str = "m"):
        if lightmodel != "caribu":
            raise ValueError(f'lightmodel: found "{lightmodel}"; expected "caribu": grids of voxels are not solved here')
        if main_unit not in UNITS:
            raise ValueError(f'main_unit: found "{main_unit}"; expected one of {", ".join(UNITS)}')
        self._environment = {**ENVIRONMENT, **(environment or {})}
        self._parameters = {**PARAMETERS, **(lightmodel_parameters or {})}
        self._unit = main_unit
        self._sky = _sky(self._environment["sky"]) if self._environment["diffus"] else []
        self._corners: list[NDArray[np.float64]] | None = None
        self._sensors: dict[str, dict[Hashable, float]] | None = None
        self.sun: tuple[float, float, float] | None = None
        self.soilenergy: dict[str, float | None] = {}
        self.modelruntime = 0.0  # [s]

    def build(self, geometry: Any = None, global_scene_tesselate_level: int = 0) -> None:
        """geometry: {"scenes": [scene, ...], "domain": ((x, y), (x, y)), "stems id": [(id, scene), ...], "transformations": {"scenes unit",
        "rescale", "translate", "xyz orientation": {scene: value}}}; a scene is whatever CaribuScene takes, or a list of triangles. Each level of
        tesselation cuts a triangle into four."""
        given = dict(geometry) if isinstance(geometry, Mapping) and "scenes" in geometry else {"scenes": geometry}
        self._corners, self._elements = [], []  # of each element: its triangles in main_unit; (its id in its scene, which scene)
        for index, scene in enumerate(_list_of_scenes(given["scenes"])):
            for key, triangles in _elements(scene, index).items():
                placed = _transformed(triangles, index, given.get("transformations") or {}, self._unit)
                for _ in range(global_scene_tesselate_level):
                    placed = _in_four(placed)
                self._corners.append(placed)
                self._elements.append((key, index))
        self._stems = {tuple(stem) for stem in given.get("stems id") or []}
        points = np.concatenate([c.reshape(-1, 3) for c in self._corners]) if self._corners else np.empty((0, 3))
        if len(points) == 0:
            raise ValueError('geometry["scenes"]: found no triangle')
        low, high = points.min(axis=0), points.max(axis=0)
        self._domain = given.get("domain") or ((low[0], low[1]), (high[0], high[1]))
        self.maxtrianglearea = float(max(area_of(c).max() for c in self._corners))

    def run(self, energy: float = 0.0, day: int = 0, hour: float = 0, parunit: str = "micromol.m-2.s-1", truesolartime: bool = False,
            id_sensors: Any = None) -> None:
        """energy: of a horizontal plane; what is absorbed has its unit, with sun and sky shared by Spitters' model, for which `energy` is
        photons [umol m^-2 s^-1]. id_sensors changes nothing."""
        if self._corners is None:
            raise ValueError("run: found no scene; expected build() before")
        light: list[Light] = []
        if self._environment["direct"]:
            self.sun, up = self._sun(day, hour, truesolartime)
            if up:
                diffuse = RdRsH(energy / PHOTONS_OF_GLOBAL, day, hour, self._environment["coordinates"][0]) if self._sky else 0.0
                light = [(share * diffuse, way) for share, way in self._sky] + [(1 - diffuse, self.sun)]
        light = light or self._sky
        begin = time.perf_counter()
        raw, mean = self._solve(light) if light else self._dark()
        self.modelruntime = time.perf_counter() - begin
        self._keep(raw, mean, energy, day, hour)

    def _solve(self, light: Sequence[Light]) -> tuple[Any, Any]:
        """Light for a horizontal irradiance of one."""
        optics = {band: {i: (material[0],) if self._elements[i] in self._stems else material for i in range(len(self._elements))}
                  for band, material in self._parameters["caribu opt"].items()}
        scene = CaribuScene({i: list(c) for i, c in enumerate(self._corners or [])}, light=light, opt=optics, scene_unit=self._unit, pattern=self._domain,
                            soil_mesh=self._parameters["soil mesh"])
        sensors = _grid(self._parameters["sensors"]) if "sensors" in self._parameters else None
        found = scene.run(direct=not self._environment["reflected"], infinite=self._environment["infinite"], sensors=sensors)
        if sensors:
            self._sensors = {band: dict(values["sensors"]["Ei"]) for band, values in found[1].items()}
        self.soilenergy = dict(zip(("Qi", "Einc"), scene.getSoilEnergy())) if scene.soil else {}
        return found

    def _dark(self) -> tuple[Any, Any]:
        names = ("Eabs", "Ei")
        raw = {band: {n: {i: [0.0] * len(c) for i, c in enumerate(self._corners or [])} for n in names} for band in self._parameters["caribu opt"]}
        mean = {band: {n: dict.fromkeys(range(len(self._elements)), 0.0) for n in names} for band in raw}
        return raw, mean

    def _sun(self, day: int, hour: float, truesolartime: bool) -> tuple[tuple[float, float, float], bool]:
        """The way that its light travels; whether it stands two degrees or more above the horizon, below which there is no sun, as there."""
        latitude, longitude, added = self._environment["coordinates"]
        solar = hour if truesolartime else hour + added + longitude / 15 + _equation_of_time(day) / 60
        sun: Sun = Gensun()(1.0, day, solar, latitude)
        way = (math.sin(sun.elev) * math.cos(sun.azim), math.sin(sun.elev) * math.sin(sun.azim), -math.cos(sun.elev))
        return way, math.degrees(math.pi / 2 - sun.elev) > 2

    def _keep(self, raw: Any, mean: Any, energy: float, day: int, hour: float) -> None:
        """The frames; areas in main_unit squared."""
        import pandas

        assert self._corners is not None
        self._energy = energy
        area = [area_of(c) for c in self._corners]
        species = np.array([scene for _, scene in self._elements])
        owner = np.repeat(np.arange(len(area)), [len(a) for a in area])

        def light(values: Any) -> dict[str, NDArray[np.float64]]:
            return {f"{band} {name}": energy * np.nan_to_num(np.concatenate([np.ravel(of[name][i]) for i in range(len(area))]))
                    for band, of in values.items() for name in ("Eabs", "Ei")}

        self.triangles_outputs = pandas.DataFrame({"Day": day, "Hour": hour, "Triangle": np.arange(len(owner)), "Organ": owner,
                                                   "VegetationType": species[owner], "Area": np.concatenate(area), **light(raw)})
        self.elements_outputs = pandas.DataFrame({"Day": day, "Hour": hour, "Organ": [key for key, _ in self._elements], "VegetationType": species,
                                                  "Area": [a.sum() for a in area], **light(mean)})
        if self._sensors:
            first = next(iter(self._sensors.values()))
            self._sensor_frame = pandas.DataFrame({"Day": day, "Hour": hour, "Sensor": list(first), "PAR": list(first.values()), "VegetationType": 0})

    def sensors_outputs(self, dataframe: bool = False) -> Any:
        """{band: {sensor: irradiance relative to the incoming one}}, or a frame of the first band; None without sensors."""
        if self._sensors is None:
            return None
        return self._sensor_frame if dataframe else self._sensors

    def to_MTG(self, energy: float = 1.0, mtg: Any = None, id: Sequence[int] | None = None) -> None:
        """Properties PARa (energy times what an element absorbs in band "par") and Erel (the same for an incoming energy of one) of an MTG's
        vertices."""
        if not hasattr(self, "elements_outputs"):
            raise AttributeError("No results yet, run a light modeling first")
        frame = self.elements_outputs
        if id is not None:
            frame = frame[frame.VegetationType.isin(list(id))]
        absorbed = dict(zip(frame["Organ"], frame["par Eabs"]))
        for name, factor in (("PARa", energy), ("Erel", 1 / self._energy if self._energy else 0.0)):
            if name not in mtg.properties():
                mtg.add_property(name)
            mtg.property(name).update({vid: value * factor for vid, value in absorbed.items()})


def _list_of_scenes(given: Any) -> list[Any]:
    """A list of scenes; one triangle, or one list of triangles, is a scene."""
    scenes = list(given) if isinstance(given, (list, tuple)) else [given]
    depth = _depth(scenes)
    return [[scenes]] if depth == 2 else [scenes] if depth == 3 else scenes


def _depth(x: Any) -> int:
    """How deep lists are nested down to numbers: 2 for a triangle, 3 for a list of triangles; 0 for what is none."""
    if isinstance(x, (list, tuple, np.ndarray)) and len(x) > 0:
        inner = _depth(x[0])
        return inner + 1 if inner or isinstance(x[0], (int, float, np.number)) else 0
    return 0


def _elements(scene: Any, index: int) -> dict[Hashable, NDArray[np.float64]]:
    where = f'geometry["scenes"][{index}]'
    if isinstance(scene, Mapping) and set(scene) == {"LA", "distrib"}:
        raise ValueError(f"{where}: found a grid of voxels; expected triangles, which alone are solved here")
    if isinstance(scene, (list, tuple, np.ndarray)):
        scene = {0: [scene] if _depth(scene) == 2 else scene}
    return {key: forms.corners(triangles, f"{where}[{key!r}]") for key, triangles in forms.scene(scene).items()}


def _transformed(triangles: NDArray[np.float64], scene: int, by: Mapping[str, Any], unit: str) -> NDArray[np.float64]:
    """Unit, factor, shift and turn of the scene, in this order."""
    unknown = set(by) - {"scenes unit", "rescale", "translate", "xyz orientation"}
    if unknown:
        raise ValueError(f'geometry["transformations"]: found "{unknown.pop()}"; expected "scenes unit", "rescale", "translate" or "xyz orientation"')

    def of(name: str, default: Any) -> Any:
        return by.get(name, {}).get(scene, default)

    its_unit, side = of("scenes unit", unit), of("xyz orientation", "x+ = N")
    if its_unit not in UNITS:
        raise ValueError(f'geometry["transformations"]["scenes unit"][{scene}]: found "{its_unit}"; expected one of {", ".join(UNITS)}')
    if side not in TURNS:
        raise ValueError(f'geometry["transformations"]["xyz orientation"][{scene}]: found "{side}"; expected one of {", ".join(TURNS)}')
    c, s = math.cos(math.radians(TURNS[side])), math.sin(math.radians(TURNS[side]))
    out = triangles * (UNITS[its_unit] / UNITS[unit]) * of("rescale", 1.0) + np.asarray(of("translate", (0.0, 0.0, 0.0)), dtype=float)
    return out if c == 1 else out @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])


def _in_four(t: NDArray[np.float64]) -> NDArray[np.float64]:
    """Each triangle cut at the middles of its edges."""
    a, b, c = t[:, 0], t[:, 1], t[:, 2]
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    return np.stack([np.stack(corners, axis=1) for corners in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))], axis=1).reshape(-1, 3, 3)


def _sky(form: Any) -> list[Light]:
    """Shares of a horizontal irradiance of one, and the ways that light travels."""
    if form == "turtle46":
        energies, _, ways, _, _ = turtle("46", "soc")
        return list(zip(energies, ways))
    if isinstance(form, (str, os.PathLike)):
        with open(form, encoding="utf-8") as file:
            count = int(file.readline().split()[0])
            rows = [[float(x) for x in file.readline().split()] for _ in range(count)]
        if any(len(row) < 4 for row in rows):
            raise ValueError(f"{form}: found a line of fewer than four numbers; expected elevation, azimuth [degrees], solid angle, weight")
        height, turn = (np.radians([row[i] for row in rows]) for i in (0, 1))
        ways = np.stack([np.cos(height) * np.cos(turn), np.cos(height) * np.sin(turn), -np.sin(height)], axis=-1)
        return [(row[3], (float(x), float(y), float(z))) for row, (x, y, z) in zip(rows, ways)]
    if isinstance(form, (list, tuple)) and len(form) == 3:
        return [(s[0], (s[1], s[2], s[3])) for s in GenSky()(1.0, form[2], form[0], form[1]).sky]
    raise ValueError(f'environment["sky"]: found {form!r}; expected "turtle46", a file, or [azimuths, zeniths, "soc" or "uoc"]')


def _equation_of_time(day: float) -> float:
    """Solar less mean time [minutes] (Spencer 1971)."""
    x = 2 * math.pi * (day - 1) / 365
    return 229.18 * (0.000075 + 0.001868 * math.cos(x) - 0.032077 * math.sin(x) - 0.014615 * math.cos(2 * x) - 0.04089 * math.sin(2 * x))


def _grid(form: Sequence[Any]) -> dict[Hashable, list[list[tuple[float, float, float]]]]:
    """Horizontal squares that face up at the bottoms of a grid's cells: x outermost, z innermost."""
    if len(form) < 4 or form[0] != "grid" or any(len(v) != 3 for v in form[1:4]):
        raise ValueError(f'lightmodel_parameters["sensors"]: found {form!r}; expected ["grid", [dx, dy, dz], [nx, ny, nz], [x, y, z]]')
    size, number, origin = form[1:4]
    out: dict[Hashable, list[list[tuple[float, float, float]]]] = {}
    for ix in range(number[0]):
        for iy in range(number[1]):
            for iz in range(number[2]):
                x, y, z = (origin[k] + i * size[k] for k, i in enumerate((ix, iy, iz)))
                a, b, c, d = (x, y, z), (x + size[0], y, z), (x + size[0], y + size[1], z), (x, y + size[1], z)
                out[len(out)] = [[a, b, c], [a, c, d]]
    return out
