"""CARIBU's scene."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..result import Result
from . import forms
from .caribu import below
from .engine import Found, Soil, area_of, light_of
from .forms import UNITS, Light, Material

Values = dict[str, dict[str, dict[Hashable, Any]]]


class CaribuScene:
    """A scene as openalea.caribu's CaribuScene takes it (docs/python.md has the table of forms).

    scene: {id: [triangle, ...]}, a .can file, a PlantGL scene or an MTG with geometry; light: [(energy, (vx, vy, vz)), ...], energy per m2 of
    a horizontal plane whatever scene_unit, or a .light file; pattern: (xmin, ymin, xmax, ymax) or a .8 file; opt: {band: {id: material}},
    {band: material} or .opt files; soil_reflectance: {band: rho}; soil_mesh: None or -1 for none, else two triangles over the pattern at z_soil.
    debug and filecache change nothing.
    """

    default_material = (0.06, 0.07)
    default_soil_reflectance = 0.15
    default_light = (1, (0, 0, -1))
    default_band = "default_band"
    units = UNITS
    #: further arguments of sunfleck.solve(), such as {"quality": "fine", "certificate": True}
    solve_options: dict[str, Any] = {}

    def __init__(self, scene: Any = None, light: Any = None, pattern: Any = None, opt: Any = None, soil_reflectance: Mapping[str, float] | None = None,
                 soil_mesh: int | None = None, z_soil: float | None = None, scene_unit: str = "m", debug: bool = False, filecache: bool = True) -> None:
        if scene_unit not in UNITS:
            raise ValueError(f'scene_unit: found "{scene_unit}"; expected one of {", ".join(UNITS)}')
        self.scene_unit, self.conv_unit = scene_unit, UNITS[scene_unit]
        self.scene: dict[Hashable, list[Any]] | None = None if scene is None else forms.scene(scene)
        self.setLight(light)
        self.pattern = None if pattern is None else forms.pattern(pattern)
        self._set_optics(scene, opt, soil_reflectance)
        self.soil: list[Any] | None = None
        self.soil_raw: Any = None
        self.soil_aggregated: Any = None
        #: of the last run(): the light of all lights apart
        self.result: Result | None = None
        self.z_soil = z_soil
        if soil_mesh is not None and soil_mesh != -1:
            if self.pattern is None:
                raise ValueError("soil_mesh: found no pattern; expected one, whose size the soil has")
            x0, y0, x1, y1 = self.pattern
            z = self._soil_height() / self.conv_unit
            self.soil = [((x0, y0, z), (x1, y0, z), (x1, y1, z)), ((x0, y0, z), (x1, y1, z), (x0, y1, z))]

    def _set_optics(self, scene: Any, opt: Any, soil_reflectance: Mapping[str, float] | None) -> None:
        of_files: dict[str, float] = {}
        given: Any = opt
        if isinstance(opt, (list, tuple)):
            if not forms.is_path(scene, ".can") or not all(forms.is_path(f, ".opt") for f in opt):
                raise ValueError("opt: found a list; expected .opt files beside a .can file, {band: {id: material}} or {band: material}")
            given, of_files = forms.opt_files(opt, forms.can(str(scene))[1])
        elif opt is None:
            given = dict.fromkeys(soil_reflectance or [self.default_band], self.default_material)
        elif not isinstance(opt, Mapping) or not opt:
            raise ValueError("opt: found no recognised form; expected {band: {id: material}}, {band: material} or .opt files")
        self.material: dict[str, dict[Hashable, Material]] | None = None
        if self.scene is not None:
            self.material = {}
            for band, materials in given.items():
                of_id = materials if isinstance(materials, Mapping) else dict.fromkeys(self.scene, materials)
                missing = [key for key in self.scene if key not in of_id]
                if missing:
                    raise ValueError(f"opt[{band!r}]: found no material for id {missing[0]!r}; expected one for every id of the scene")
                self.material[band] = {key: forms.material(of_id[key], f"opt[{band!r}][{key!r}]") for key in self.scene}
        bands = list(given)
        if soil_reflectance is None:
            self.soil_reflectance = {band: of_files.get(band, self.default_soil_reflectance) for band in bands}
        else:
            if set(soil_reflectance) != set(bands):
                raise ValueError(f"soil_reflectance: found bands {sorted(soil_reflectance)}; expected {sorted(bands)}, as opt has them")
            self.soil_reflectance = dict(soil_reflectance)
        for band, rho in self.soil_reflectance.items():
            if not 0 <= rho <= 1:
                raise ValueError(f"soil_reflectance[{band!r}]: found {rho}; expected 0 to 1")

    def setLight(self, light: Any = None) -> None:
        """Other light."""
        self.light: list[Light] = [self.default_light] if light is None else forms.lights(light)

    # ---- what the scene is

    def _corners(self) -> tuple[NDArray[np.float64], dict[Hashable, slice]]:
        """All triangles (n, 3, 3) in scene_unit, and which of them each id has."""
        parts, where, at = [], {}, 0
        for key, triangles in (self.scene or {}).items():
            parts.append(forms.corners(triangles, f"scene[{key!r}]"))
            where[key] = slice(at, at + len(parts[-1]))
            at += len(parts[-1])
        return np.concatenate(parts) if parts else np.empty((0, 3, 3)), where

    def _soil_height(self) -> float:
        """[m]"""
        return below(self._corners()[0] * self.conv_unit) if self.z_soil is None else self.z_soil * self.conv_unit

    def bbox(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Lowest and highest coordinates, in scene_unit."""
        points = self._corners()[0].reshape(-1, 3)
        if len(points) == 0:
            raise ValueError("bbox: found no triangle")
        return tuple(points.min(axis=0).tolist()), tuple(points.max(axis=0).tolist())

    def triangle_areas(self, convert: bool = True) -> NDArray[np.float64]:
        """(n,) [m2], or in scene_unit squared."""
        return area_of(self._corners()[0] * (self.conv_unit if convert else 1.0))

    def auto_screen(self, screen_resolution: float) -> int:
        """Pixels of CARIBU's screen for a resolution in scene_unit; nothing here depends on it."""
        low, high = self.bbox()
        return int(np.linalg.norm(np.subtract(high, low)) / screen_resolution)

    def getIncidentEnergy(self) -> tuple[float, float, float | None]:
        """(Qi, Qem, Einc): horizontal irradiance, the sources' emission, and Qi times the pattern's area [m2] (None without one)."""
        horizontal = float(sum(e for e, _ in self.light))
        emitted = float(sum(e * np.linalg.norm(v) / abs(v[2]) for e, v in self.light if v[2] != 0))
        return horizontal, emitted, None if self.pattern is None else horizontal * self._pattern_area()

    def getSoilEnergy(self) -> tuple[float | None, float | None]:
        """(Qi, Einc) of the soil in the first band of the last run(): irradiance, and that times the soil's area [m2]."""
        if not self.soil_aggregated:
            return None, None
        soil = next(iter(self.soil_aggregated.values()))
        return soil["Ei"], soil["Ei"] * soil["area"]

    def _pattern_area(self) -> float:
        x0, y0, x1, y1 = self.pattern or (0, 0, 0, 0)
        return (x1 - x0) * (y1 - y0) * self.conv_unit**2

    def runPeriodise(self) -> None:
        """Nothing: what reaches beyond the pattern comes in again on its other side, as run(infinite=True) solves it."""

    def plot(self, *_: Any, **__: Any) -> Any:
        """CARIBU draws by PlantGL; here result.png() and the viewer draw."""
        raise NotImplementedError("plot: CaribuScene.result.png() is a picture, CaribuScene.result.write(file) what `sunfleck view` shows")

    # ---- light

    def run(self, direct: bool = True, infinite: bool = False, d_sphere: float = 0.5, layers: int = 10, height: float | None = None,
            screen_size: int = 1536, screen_resolution: float | None = None, sensors: Mapping[Hashable, Any] | None = None, split_face: bool = False,
            simplify: bool = False) -> tuple[Any, Any]:
        """(raw, aggregated): raw[band][name] = {id: [one value a triangle]}, aggregated[band][name] = {id: value}; with simplify, one band is
        left out as a level. Names: "area" [m2], "Eabs" and "Ei" [energy per m2 of one-sided area; Ei is front plus back], with split_face
        "Ei_sup" and "Ei_inf"; with sensors = {id: [triangle, ...]} "sensors": {"Ei", "Ei0", "area"}, of their fronts. The soil's is in soil_raw and
        soil_aggregated.

        direct: light straight from the sources alone, else also scattered light. infinite: the pattern repeats without end; its scattered
        light then meets a soil, at z_soil or just below the lowest point. d_sphere, layers, height and the screen's arguments change nothing:
        near and far scattered light are found alike.
        """
        if infinite and self.pattern is None:
            raise ValueError("run: found infinite=True without a pattern; expected a pattern")
        if self.scene is None or self.material is None:
            raise ValueError("run: found no scene; expected one")
        corners, where = self._corners()
        metres = corners * self.conv_unit
        materials = {band: [of_id[key] for key in where] for band, of_id in self.material.items()}
        organ = np.repeat(np.arange(len(where)), [part.stop - part.start for part in where.values()])
        domain = None if self.pattern is None else [x * self.conv_unit for x in self.pattern]
        soil = Soil(self._soil_height(), self.soil_reflectance) if self.soil is not None or (infinite and not direct) else None
        patches = {key: forms.corners(triangles, f"sensors[{key!r}]") * self.conv_unit for key, triangles in (sensors or {}).items()}
        common: dict[str, Any] = {"domain": domain, "periodic": infinite, "soil": soil, "sensors": patches, "options": self.solve_options}
        found, self.result = light_of(metres, organ, materials, self.light, direct=direct, **common)
        first = found if direct or not patches else light_of(metres, organ, materials, self.light, direct=True, **common)[0]

        area = area_of(metres)
        raw: Values = {}
        aggregated: Values = {}
        for band, light in found.items():
            values = _by_name(light.absorbed, light.front, light.back, split_face)
            raw[band] = {"area": {key: area[part].tolist() for key, part in where.items()}}
            aggregated[band] = {"area": {key: float(area[part].sum()) for key, part in where.items()}}
            for name, of_all in values.items():
                raw[band][name] = {key: np.where(area[part] > 0, of_all[part], np.nan).tolist() for key, part in where.items()}
                aggregated[band][name] = {key: _mean(of_all[part], area[part]) for key, part in where.items()}
            if patches:
                raw[band]["sensors"], aggregated[band]["sensors"] = _of_sensors(light, first[band], patches)
        self._keep_soil(found, split_face)
        if simplify and len(found) == 1:
            band = next(iter(found))
            return raw[band], aggregated[band]
        return raw, aggregated

    def _keep_soil(self, found: Mapping[str, Found], split_face: bool) -> None:
        self.soil_raw, self.soil_aggregated = None, None
        if self.soil is None:
            return
        area = area_of(np.asarray(self.soil, dtype=float) * self.conv_unit)
        self.soil_raw, self.soil_aggregated = {}, {}
        for band, light in found.items():
            values = _by_name(light.soil_absorbed, light.soil_irradiance, np.zeros(2), split_face)
            self.soil_raw[band] = {"area": area.tolist(), **{name: v.tolist() for name, v in values.items()}}
            self.soil_aggregated[band] = {"area": float(area.sum()), **{name: _mean(v, area) for name, v in values.items()}}


def _by_name(absorbed: Any, front: Any, back: Any, split_face: bool) -> dict[str, NDArray[np.float64]]:
    out = {"Eabs": absorbed, "Ei": front + back}
    return {**out, "Ei_sup": front, "Ei_inf": back} if split_face else out


def _mean(values: NDArray[np.float64], area: NDArray[np.float64]) -> float:
    return float(values @ area / area.sum()) if area.sum() > 0 else 0.0


def _of_sensors(light: Found, first: Found, patches: Mapping[Hashable, NDArray[np.float64]]) -> tuple[Any, Any]:
    area = {key: area_of(triangles) for key, triangles in patches.items()}
    raw = {"Ei": {k: v.tolist() for k, v in light.sensors.items()}, "Ei0": {k: v.tolist() for k, v in first.sensors.items()}, "area": {k: a.tolist() for k, a in area.items()}}
    mean = {"Ei": {k: _mean(v, area[k]) for k, v in light.sensors.items()}, "Ei0": {k: _mean(v, area[k]) for k, v in first.sensors.items()},
            "area": {k: float(a.sum()) for k, a in area.items()}}
    return raw, mean
