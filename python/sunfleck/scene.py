"""Scenes in memory: bands, light, optics, ground, plants and how they are placed."""

from __future__ import annotations

import os
import warnings
from collections.abc import Hashable, Iterable, Mapping, Sequence
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core, _toml

PerBand = Union[float, Mapping[str, float]]
"""A value per band, {"PAR": .1, "NIR": .4}; a number where the scene has one band."""

NO_ID = np.iinfo(np.int64).min
"""Id of organs that were given none: the ground's, and those of plant files."""


class SceneWarning(UserWarning):
    """What the user of a scene should know: a sun below the horizon, a plant that nothing places."""


def _warn(notes: Iterable[str], level: int = 4) -> None:
    for note in notes:
        warnings.warn(note.removeprefix("scene in memory: "), SceneWarning, stacklevel=level)


def _array(x: Any, dtype: Any) -> Any:
    """Arrays as they are, for the compiled part to judge; other sequences converted."""
    return x if x is None or isinstance(x, np.ndarray) else np.ascontiguousarray(x, dtype=dtype)


class _Placed:
    """A plant or a group: something that can be placed, any number of times."""

    _is_group = False

    def __init__(self, scene: "Scene", row: int, name: str) -> None:
        self._scene, self._row = scene, row
        #: under which results know it
        self.name = name

    def _places(self, position: Any, turn: Any, scale: Any, tilt: Any, tilt_azimuth: Any, mirror: bool, affine: Any, grid: Any, file: Any) -> _core.Places:
        if affine is not None:
            maps = _array(affine, float)
            if maps.shape[-2:] == (4, 4):
                maps = np.ascontiguousarray(maps[..., :3, :])
            return _core.affines(maps.reshape(-1, *maps.shape[-2:]) if maps.ndim in (2, 3) else maps)
        if grid is not None or file is not None:
            return self._scene._core.places(_toml.text({"place": [{"grid": grid, "file": file}]}))
        at = np.ascontiguousarray(position, dtype=float)
        a, b, c, d = (np.ascontiguousarray(np.atleast_1d(x), dtype=float) for x in (turn, scale, tilt, tilt_azimuth))
        return _core.stances(at.reshape(1, -1) if at.ndim == 1 else at, a, b, c, d, mirror)

    def place(self, position: ArrayLike = (0, 0, 0), turn: ArrayLike = 0, scale: ArrayLike = 1, tilt: ArrayLike = 0, tilt_azimuth: ArrayLike = 0,
              mirror: bool = False, *, affine: ArrayLike | None = None, grid: Mapping[str, Any] | None = None, file: str | os.PathLike[str] | None = None) -> None:
        """Places copies in the world, beside those that are there: scaled, mirrored, turned about the vertical, tilted, moved.

        position: (3,) or, of many copies, (k, 3) [m]; turn counter-clockwise seen from above [degrees], scale (> 0), tilt [degrees] towards
        tilt_azimuth (from north over east): one number, or (k,). Or affine, (3, 4), (4, 4) or (k, 3, 4); or grid = {"origin": (x, y),
        "step": (dx, dy), "count": (columns, rows), "turn": "random"}; or file, a CSV of x, y, z, turn, scale.
        Raises ValueError naming the argument.
        """
        self._scene._core.place(self._is_group, self._row, self._places(position, turn, scale, tilt, tilt_azimuth, mirror, affine, grid, file))

    def clear(self) -> None:
        """Takes all copies out of the world."""
        self._scene._core.clear_places(self._is_group, self._row)


class Plant(_Placed):
    """A plant of a scene; Scene.plant() makes it."""

    def reshape(self, triangles: Any = None, **as_in_plant: Any) -> None:
        """Another shape, in the place of the one it has: the arguments of Scene.plant(). Places stay. A plant that grows."""
        last = self._scene._add_plant(f"{self.name} (new)", triangles, **as_in_plant)
        self._scene._core.replace_plant(self._row)
        self._scene._ids[self._row] = self._scene._ids.pop(last)


class Group(_Placed):
    """A structure made of plants and other groups: a row, a tile, a stand; Scene.group() makes it."""

    _is_group = True

    def add(self, member: _Placed, position: ArrayLike = (0, 0, 0), turn: ArrayLike = 0, scale: ArrayLike = 1, tilt: ArrayLike = 0,
            tilt_azimuth: ArrayLike = 0, mirror: bool = False, *, affine: ArrayLike | None = None, grid: Mapping[str, Any] | None = None,
            file: str | os.PathLike[str] | None = None) -> None:
        """Places copies of a plant or group in this one; arguments as those of place()."""
        if not isinstance(member, _Placed) or member._scene is not self._scene:
            raise ValueError("member: found something else; expected a plant or group of the same scene")
        places = self._places(position, turn, scale, tilt, tilt_azimuth, mirror, affine, grid, file)
        self._scene._core.place_in(self._row, member._is_group, member._row, places)


class Scene:
    """A scene in memory. Lengths [m], angles [degrees], z up, x east, y north; irradiance in W m^-2, or umol m^-2 s^-1 in bands whose unit
    says so. Whatever is wrong is a ValueError that names the argument, and leaves the scene as it was.

    bands: names of the spectral bands. units: {"PAR": "umol m^-2 s^-1"}; W m^-2 where it says nothing.
    """

    def __init__(self, bands: Sequence[str] = ("PAR",), units: Mapping[str, str] | None = None) -> None:
        if isinstance(bands, str):
            raise ValueError(f'bands: found the text "{bands}"; expected names, like ["PAR", "NIR"]')
        units = dict(units or {})
        for name in units:
            if name not in bands:
                raise ValueError(f'units: found the band "{name}"; expected some of {", ".join(bands)}')
        self._set_up(_core.Scene(list(bands), [units.get(b, "W m^-2") for b in bands]))

    def _set_up(self, core: _core.Scene) -> None:
        self._core = core
        self._light: dict[str, Any] = {}
        self._ids: dict[int, NDArray[np.int64]] = {}

    @classmethod
    def read(cls, file: str | os.PathLike[str]) -> "Scene":
        """A scene file (docs/formats-scene.md) with all that it names. The first sun(), sky() or state() takes the place of all its light."""
        scene = cls.__new__(cls)
        scene._set_up(_core.Scene(os.fspath(file)))
        _warn(scene._core.notes, 3)
        return scene

    @property
    def bands(self) -> list[str]:
        """Names of the bands."""
        return self._core.bands

    @property
    def units(self) -> dict[str, str]:
        """Unit of irradiance, per band."""
        return dict(zip(self._core.bands, self._core.units))

    @property
    def periodic(self) -> tuple[float, float, float, float] | None:
        """xmin, ymin, xmax, ymax of the cell that repeats without end [m]; None: a finite scene."""
        cell = self._core.periodic
        return None if cell is None else (cell[0], cell[1], cell[2], cell[3])

    @periodic.setter
    def periodic(self, cell: Sequence[float] | None) -> None:
        if cell is not None and len(cell) != 4:
            raise ValueError(f"periodic: found {len(cell)} values; expected xmin, ymin, xmax, ymax [m], or None")
        self._core.periodic = None if cell is None else [float(x) for x in cell]

    @property
    def slope(self) -> tuple[float, float]:
        """dz/dx, dz/dy of the plane that a periodic scene repeats along; (0, 0): level. Set it after periodic."""
        return self._core.slope

    @slope.setter
    def slope(self, rise: Sequence[float]) -> None:
        if len(rise) != 2:
            raise ValueError(f"slope: found {len(rise)} values; expected dz/dx, dz/dy")
        self._core.slope = [float(x) for x in rise]

    # ---- light

    def _per_band(self, values: PerBand | None, where: str) -> Mapping[str, float] | None:
        if values is None or isinstance(values, Mapping):
            return values
        if len(self.bands) > 1 or not np.isscalar(values):
            raise ValueError(f'{where}: found {values!r}; expected a number per band, like {{"{self.bands[0]}": ...}}')
        return {self.bands[0]: values}  # type: ignore[dict-item]

    def _table(self, table: Mapping[str, Any] | None, where: str) -> dict[str, Any] | None:
        if table is None:
            return None
        out = dict(table)
        if "irradiance" in out:
            out["irradiance"] = self._per_band(out["irradiance"], f"{where}.irradiance")
        return out

    def _set_light(self, light: dict[str, Any]) -> None:
        light = {k: v for k, v in light.items() if v is not None}
        if light:
            _warn(self._core.light(_toml.text(light)))
        else:
            self._core.no_light()
        self._light = light

    def _one_state(self, key: str, table: dict[str, Any] | None) -> None:
        if "state" in self._light:
            raise ValueError(f"{key}: found a scene with states; expected {key}= of state(), or no_light() before")
        self._set_light({**self._light, key: table})

    def sun(self, direction: Sequence[float] | None = None, irradiance: PerBand | None = None, *, elevation: float | None = None, azimuth: float | None = None,
            latitude: float | None = None, longitude: float | None = None, time: Any = None, altitude: float | None = None, angular_diameter: float = 0.53) -> None:
        """The sun, in the place of the one before. direction: towards the sun; or elevation and azimuth (from north over east); or latitude,
        longitude and time (ISO 8601 or datetime, with zone). irradiance on a plane that faces it; left out where split() gives it.
        angular_diameter: 0 is a point."""
        self._one_state("sun", {"direction": None if direction is None else [float(x) for x in direction], "elevation": elevation, "azimuth": azimuth,
                                "latitude": latitude, "longitude": longitude, "time": time, "altitude": altitude,
                                "irradiance": self._per_band(irradiance, "sun.irradiance"), "angular_diameter": angular_diameter})

    def sky(self, model: str = "standard_overcast", irradiance: PerBand | None = None, *, file: str | os.PathLike[str] | None = None,
            directions: ArrayLike | None = None, turn: float | None = None, sun: str | None = None, encoding: str | None = None,
            clearness: float | None = None, brightness: float | None = None, direct: float | None = None, diffuse: float | None = None,
            day: int | None = None) -> None:
        """The sky, in the place of the one before. irradiance on an unobstructed horizontal plane. model: "uniform"; "standard_overcast";
        "clear" (after sun()); "perez" (after sun(); weather by clearness and brightness, or by direct and diffuse irradiance of all
        wavelengths [W m^-2] and the day of the year, or by the bands' sums); "file" with a CSV file or directions (k, 4) of x, y, z (towards
        the sky) and radiance; "image" with a file (HDR, EXR, PNG) of all directions, turn (azimuth of its middle column, from north over
        east [degrees]), sun "keep" or "cut", encoding "linear" or "srgb"; "sphere"."""
        self._one_state("sky", {"model": model, "irradiance": self._per_band(irradiance, "sky.irradiance"), "file": file,
                                "directions": None if directions is None else np.asarray(directions, dtype=float), "turn": turn, "sun": sun,
                                "encoding": encoding, "clearness": clearness, "brightness": brightness, "direct": direct, "diffuse": diffuse,
                                "day": day})

    def split(self, irradiance: PerBand, *, sun: Mapping[str, Any], sky: Mapping[str, Any] | None = None, shortwave: float | None = None, day: int | None = None) -> None:
        """Global irradiance on a horizontal plane, split into sun and sky (Spitters, Toussaint & Goudriaan 1986) by the global radiation of
        all wavelengths, shortwave [W m^-2], and the day of the year, unless the sun has a time. sun and sky as in state()."""
        table = {"irradiance": self._per_band(irradiance, "global.irradiance"), "shortwave": shortwave, "day": day}
        self._set_light({"sun": dict(sun), "sky": dict(sky or {"model": "standard_overcast"}), "global": table})

    def state(self, name: str | None = None, duration: float | None = None, *, sun: Mapping[str, Any] | None = None, sky: Mapping[str, Any] | None = None,
              split: Mapping[str, Any] | None = None) -> None:
        """One more lighting state, in the place of a single sun and sky: a day's course is solved at once. sun, sky and split have the
        arguments of the methods of these names, as mappings. duration [s]."""
        table = {"name": name, "duration_s": duration, "sun": self._table(sun, "sun"), "sky": self._table(sky, "sky"), "global": self._table(split, "global")}
        self._set_light({"state": [*self._light.get("state", []), {k: v for k, v in table.items() if v is not None}]})

    def no_light(self) -> None:
        """Takes out sun, sky and states."""
        self._set_light({})

    @property
    def states(self) -> list[tuple[str, float]]:
        """(name, duration [s]) of each state; one without a name where none is listed."""
        return self._core.states

    # ---- surfaces

    def optics(self, name: str, reflectance: PerBand | None = None, transmittance: PerBand | None = None, *, reflectance_front: PerBand | None = None,
               reflectance_back: PerBand | None = None, counts_as: str | None = None, replace: bool = False) -> None:
        """Optical properties under a name: reflectance of both sides, or of front and back, and transmittance (0 where left out), each 0 to 1
        per band with a sum of at most 1. counts_as: "leaf" or "other" in fAPAR. A name given twice is an error, or replaces the one before."""
        given = {"reflectance": reflectance, "reflectance_front": reflectance_front, "reflectance_back": reflectance_back, "transmittance": transmittance}
        table: dict[str, Any] = {k: self._per_band(v, f"optics.{name}.{k}") for k, v in given.items()}
        _warn(self._core.optics(_toml.text({"optics": {name: {**table, "counts_as": counts_as}}}), replace), 3)

    def ground(self, size: Sequence[float] | None = None, center: Sequence[float] | None = None, height: float | None = None, cells: Sequence[int] | None = None,
               reflectance: PerBand | None = None, *, triangles: Any = None, vertices: Any = None, indices: Any = None, mesh: str | os.PathLike[str] | None = None,
               unit: str | None = None) -> None:
        """The ground, in the place of the one before: flat, of a size and center [m] (of a periodic scene the cell's, where left out), in
        cells of two facets; or triangles (n, 3, 3), or vertices (v, 3) and indices (n, 3), or a mesh file."""
        points, rows = _points(triangles, vertices, indices)
        table = {"size": size, "center": center, "height": height, "cells": cells, "mesh": mesh, "unit": unit,
                 "reflectance": self._per_band(reflectance, "ground.reflectance")}
        _warn(self._core.ground(_toml.text({"ground": table}), points, rows), 3)

    def no_ground(self) -> None:
        """Takes out the ground."""
        self._core.no_ground()

    # ---- plants

    def plant(self, name: str, triangles: Any = None, **arguments: Any) -> Plant:
        """A plant, which plant.place() puts into the world.

        triangles: (n, 3, 3) float64, corners counter-clockwise seen from the front [m]; or vertices= (v, 3) and indices= (n, 3) int64; arrays
        are taken as they are, C-contiguous. optics=: a name, or {key: name} whose keys are ids, names or types of organs, or "*".
        organ=: (n,) integers, the organ of each triangle: any numbers; organs get their rows in results by the order in which their numbers
        come first, and keep them (result.organs.id). Without it all is one organ. organ_names=, organ_types=: {id: text}, or one text for all
        types. policy=: a policy file (docs/formats-policy.md).
        structure=: instead of these a nested structure, {"type": ..., "name": ..., "id": ..., "optics": ..., "triangles": ..., "attributes":
        {...}, "children": [...]}; or file=: a plant file, with unit=, age=, seed= as in scene files.
        Raises ValueError naming the argument and the index; then the scene is as it was.
        """
        row = self._add_plant(name, triangles, **arguments)
        return Plant(self, row, name)

    def _add_plant(self, name: str, triangles: Any = None, *, vertices: Any = None, indices: Any = None, optics: str | Mapping[Any, str] | None = None,
                   organ: Any = None, organ_names: Mapping[Any, str] | None = None, organ_types: str | Mapping[Any, str] | None = None,
                   structure: Mapping[str, Any] | None = None, policy: str | os.PathLike[str] | None = None, file: str | os.PathLike[str] | None = None,
                   unit: str | None = None, age: float | None = None, seed: int | None = None) -> int:
        row = len(self._core.plant_names)
        policy_file = "" if policy is None else os.fspath(policy)
        if policy_file and not os.path.isfile(policy_file):
            raise ValueError(f'policy: found no file "{policy_file}"; expected a policy file')
        if file is not None:
            if triangles is not None or vertices is not None or structure is not None:
                raise ValueError("file: found beside triangles, vertices or structure; expected one of them")
            by_type = {"*": optics} if isinstance(optics, str) else optics
            table = {"name": name, "file": file, "unit": unit, "age": age, "seed": seed, "optics": by_type, "policy": policy}
            _warn(self._core.plant_file(_toml.text({"plant": [table]})), 4)
            self._ids[row] = np.empty(0, dtype=np.int64)
            return row
        if unit is not None or age is not None or seed is not None:
            raise ValueError("unit, age, seed: found without file; expected with it (arrays are in metres)")
        tree = _Tree(name, optics)
        if structure is not None:
            if triangles is not None or vertices is not None or organ is not None:
                raise ValueError("structure: found beside triangles, vertices or organ; expected one of them")
            tree.read(structure, -1, optics)
            points, rows, owner = tree.arrays()
        else:
            points, rows = _points(triangles, vertices, indices)
            if points is None:
                raise ValueError("triangles: found nothing; expected triangles, vertices and indices, structure, or file")
            owner = tree.flat(name, len(points) if rows is None else len(rows), _array(organ, np.int64), organ_names, organ_types)
        self._core.plant_arrays(name, points, rows, owner, tree.parents, tree.types, tree.names, tree.optics, tree.attributes, policy_file)
        self._ids[row] = np.asarray([tree.ids[i] for i in tree.organs(owner)], dtype=np.int64)
        return row

    def group(self, name: str) -> Group:
        """A structure that group.add() fills with plants and other groups, and group.place() puts into the world."""
        return Group(self, self._core.group(name), name)

    # ---- devices

    def lamp(self, name: str | None = None, *, exitance: PerBand | None = None, power: PerBand | None = None, triangles: Any = None, vertices: Any = None,
             indices: Any = None, **as_in_file: Any) -> None:
        """A lamp: a mesh that shines from its front with an exitance [W m^-2] or a power [W] (it does not shade), or ies= a photometric file
        with position=, aim=, turn=. place=, grid=, states= as in scene files."""
        points, rows = _points(triangles, vertices, indices)
        table = {"name": name, "exitance": self._per_band(exitance, "lamp.exitance"), "power": self._per_band(power, "lamp.power"), **as_in_file}
        _warn(self._core.lamp(_toml.text({"lamp": [table]}), points, rows), 3)

    def sensor(self, name: str, *, triangles: Any = None, vertices: Any = None, indices: Any = None, **as_in_file: Any) -> None:
        """A sensor: measures, does not shade. grid={"z": .5, "cells": (10, 10)}, or profile={...}, or a mesh; sides="both", samples= as in
        scene files. result.sensors[name] holds what it measured."""
        points, rows = _points(triangles, vertices, indices)
        _warn(self._core.sensor(_toml.text({"sensor": [{"name": name, **as_in_file}]}), points, rows), 3)


def _points(triangles: Any, vertices: Any, indices: Any) -> tuple[Any, Any]:
    if (triangles is not None) + (vertices is not None) > 1:
        raise ValueError("triangles: found beside vertices; expected one of them")
    if (vertices is None) != (indices is None):
        raise ValueError("indices: found without vertices; expected both" if vertices is None else "vertices: found without indices; expected both")
    if indices is not None:
        rows = _array(indices, np.int64)
        if rows.dtype.kind in "iu" and rows.dtype != np.int64:
            rows = rows.astype(np.int64)
        return _array(vertices, float), rows
    return _array(triangles, float), None


class _Tree:
    """The structures of a plant as the compiled part takes them: row 0 is the plant, parents come before their children."""

    def __init__(self, name: str, optics: Any) -> None:
        self.parents, self.types, self.names, self.optics = [0], ["plant"], [name], [""]
        self.ids: list[int] = [NO_ID]
        self.attributes: list[dict[str, Any] | None] = [None]
        self._meshes: list[tuple[int, NDArray[np.float64]]] = []
        self._given = optics

    def _add(self, parent: int, kind: str, name: str, identity: int, optics: str) -> int:
        self.parents.append(max(parent, 0))
        self.types.append(kind)
        self.names.append(name)
        self.ids.append(identity)
        self.optics.append(optics)
        self.attributes.append(None)
        return len(self.parents) - 1

    @staticmethod
    def _optics_of(given: Any, where: str, *keys: Hashable) -> str:
        if isinstance(given, str):
            return given
        if isinstance(given, Mapping):
            for key in (*keys, "*"):
                if key in given:
                    return str(given[key])
            raise ValueError(f'{where}: found none for organ {keys[0]} of type "{keys[-1]}"; expected a key that is its id, name or type, or "*"')
        raise ValueError(f"{where}: found {type(given).__name__}; expected a name, or names by id, name or type of organs")

    def flat(self, plant: str, count: int, organ: Any, names: Any, types: Any) -> NDArray[np.int64]:
        """One organ for each number of `organ`; returns the structure of each triangle."""
        if organ is None:
            kind = types if isinstance(types, str) else "organ"
            self._add(0, kind, plant, 0, self._optics_of(self._given, "optics", 0, plant, kind))
            return np.ones(count, dtype=np.int64)
        if organ.dtype.kind in "iu" and organ.dtype != np.int64:
            organ = organ.astype(np.int64)
        rows, ids = _core.organ_rows(organ)
        if len(rows) != count:
            raise ValueError(f"organ: found {len(rows)} values; expected {count}, one for each triangle")
        numbers = ids.tolist()
        unknown = set(names or ()).difference(numbers)
        if unknown:
            raise ValueError(f"organ_names: found id {min(unknown)!r}, of which there is no triangle; expected ids of organ")
        kinds = [types] * len(numbers) if isinstance(types, str) else [(types or {}).get(i, "organ") for i in numbers]
        titles = [(names or {}).get(i, f"{plant}_{i}") for i in numbers]
        self.parents += [0] * len(numbers)
        self.types += kinds
        self.names += titles
        self.ids += numbers
        self.attributes += [None] * len(numbers)
        self.optics += ([self._given] * len(numbers) if isinstance(self._given, str)
                        else [self._optics_of(self._given, "optics", *keys) for keys in zip(numbers, titles, kinds)])
        return np.ascontiguousarray(rows + 1)

    def read(self, node: Mapping[str, Any], parent: int, optics: Any, where: str = "structure") -> None:
        """A nested structure; row 0 is its outermost."""
        stack = [(node, parent, optics, where)]
        seen: set[int] = set()
        known = {"type", "name", "id", "optics", "triangles", "vertices", "indices", "attributes", "children"}
        while stack:
            node, parent, optics, where = stack.pop()
            for key in node:
                if key not in known:
                    raise ValueError(f'{where}: found the key "{key}"; expected some of {", ".join(sorted(known))}')
            kind, name, optics = str(node.get("type", "structure")), node.get("name"), node.get("optics", optics)
            identity = int(node.get("id", NO_ID))
            if identity != NO_ID and identity in seen:
                raise ValueError(f"{where}.id: found {identity} twice; expected an id of its own for every structure")
            seen.add(identity)
            points, rows = _points(node.get("triangles"), node.get("vertices"), node.get("indices"))
            if points is not None and rows is not None:
                points = np.ascontiguousarray(np.asarray(points, dtype=float)[rows])
            has = points is not None and len(points) > 0
            title = str(name) if name is not None else kind if identity == NO_ID else f"{kind}_{identity}"
            used = self._optics_of(optics, f"{where}.optics", identity, title, kind) if has else ""
            if parent < 0:
                row = 0
                self.types[0], self.names[0], self.ids[0], self.optics[0] = kind, title if name is not None else self.names[0], identity, used
            else:
                row = self._add(parent, kind, title, identity, used)
            self.attributes[row] = dict(node["attributes"]) if "attributes" in node else None
            if has:
                if not isinstance(points, np.ndarray) or points.ndim != 3 or points.shape[1:] != (3, 3):
                    raise ValueError(f"{where}.triangles: found shape {getattr(points, 'shape', '?')}; expected (n, 3, 3)")
                self._meshes.append((row, points))
            children = list(node.get("children", ()))
            stack.extend((child, row, optics, f"{where}.children[{i}]") for i, child in reversed(list(enumerate(children))))

    def arrays(self) -> tuple[NDArray[np.float64], None, NDArray[np.int64]]:
        if not self._meshes:
            raise ValueError("structure: found no triangles; expected at least one")
        owner = np.repeat(np.asarray([row for row, _ in self._meshes], dtype=np.int64), [len(m) for _, m in self._meshes])
        return np.ascontiguousarray(np.concatenate([m for _, m in self._meshes]), dtype=float), None, owner

    def organs(self, owner: NDArray[np.int64]) -> NDArray[np.int64]:
        """Structures that own triangles, in the order of results."""
        return np.unique(owner)
