"""Plants of other programs: MTGs (openalea.mtg, or dictionaries), PlantGL and L-Py scenes. Nothing of them is needed; what is there is used."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .scene import Plant, Scene

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "foot": 0.3048}


def _metres(unit: str) -> float:
    if unit not in UNITS:
        raise ValueError(f'unit: found "{unit}"; expected one of {", ".join(UNITS)}')
    return UNITS[unit]


def _fans(points: NDArray[np.float64], faces: Iterable[Any]) -> NDArray[np.float64]:
    rows = [(f[0], f[i], f[i + 1]) for f in map(tuple, faces) for i in range(1, len(f) - 1)]
    return points[np.asarray(rows, dtype=np.int64).reshape(-1, 3)]


def geometry_triangles(geometry: Any, cache: dict[int, Any] | None = None) -> NDArray[np.float64]:
    """(n, 3, 3) of a geometry of PlantGL, in its unit: a set of triangles or polygons as it is, others by PlantGL's own tesselation; an array
    as it is; none of points, curves and texts. `cache` keeps what was converted, by the geometry's identity."""
    if isinstance(geometry, np.ndarray) or (isinstance(geometry, (list, tuple)) and len(geometry) and not hasattr(geometry[0], "geometry")):
        return np.ascontiguousarray(geometry, dtype=float).reshape(-1, 3, 3)
    if isinstance(geometry, (list, tuple)):
        parts = [geometry_triangles(g, cache) for g in geometry]
        return np.concatenate(parts) if parts else np.empty((0, 3, 3))
    if hasattr(geometry, "geometry") and not hasattr(geometry, "indexList"):  # a shape, whose transforms are in its geometry
        inner = geometry.geometry
        return geometry_triangles(inner, cache)
    if cache is not None and id(geometry) in cache:
        return cache[id(geometry)][1]
    mesh = geometry
    if not (hasattr(mesh, "pointList") and hasattr(mesh, "indexList")):
        from openalea.plantgl import all as pgl

        worker = pgl.Tesselator()
        geometry.apply(worker)
        mesh = worker.triangulation
    if mesh is None:
        out = np.empty((0, 3, 3))
    else:
        points = np.array([tuple(p) for p in mesh.pointList], dtype=float).reshape(-1, 3)  # Point3Array has no buffer protocol
        out = _fans(points, mesh.indexList)
    if cache is not None:
        cache[id(geometry)] = (geometry, out)  # held, so that its identity stays its own
    return out


def _shapes(thing: Any) -> dict[Hashable, Any] | None:
    """{id: geometry or shapes} of an MTG or a PlantGL scene."""
    if hasattr(thing, "property") and hasattr(thing, "vertices"):
        return dict(thing.property("geometry"))
    if hasattr(thing, "todict"):
        return dict(thing.todict())
    try:
        shapes = list(thing)
    except TypeError:
        return None
    if not shapes or not all(hasattr(s, "geometry") and hasattr(s, "id") for s in shapes):
        return None
    out: dict[Hashable, Any] = {}
    for shape in shapes:
        out.setdefault(shape.id, []).append(shape)
    return out


def plantgl_triangles(thing: Any, cache: dict[int, Any] | None = None) -> dict[Hashable, NDArray[np.float64]] | None:
    """{id: (n, 3, 3)} of a PlantGL or L-Py scene (id is shape.id: of L-Py, the module's index in the string until the next derivation), or of
    an MTG with a property "geometry" (id is the vertex); None for anything else."""
    shapes = _shapes(thing)
    if shapes is None:
        return None
    found = {key: geometry_triangles(value, cache) for key, value in shapes.items()}
    return {key: triangles for key, triangles in found.items() if len(triangles)}


def from_plantgl(scene: Scene, name: str, thing: Any, *, optics: Any, unit: str = "m", organ_types: Any = None, cache: dict[int, Any] | None = None) -> Plant:
    """A plant of the scene from a PlantGL or L-Py scene: an organ for each shape id, which results keep (result.organs.id). A cache, the same
    dictionary in every step, saves converting geometries that stay. Raises ValueError where nothing in it has triangles."""
    found = plantgl_triangles(thing, cache)
    if not found:
        raise ValueError(f"{name}: found nothing with triangles; expected a PlantGL scene")
    organ = np.repeat(np.asarray([int(key) for key in found], dtype=np.int64), [len(t) for t in found.values()])  # type: ignore[call-overload]
    triangles = np.ascontiguousarray(np.concatenate(list(found.values())) * _metres(unit))
    return scene.plant(name, triangles, organ=organ, optics=optics, organ_types=organ_types)


def mtg_structure(mtg: Any, *, geometry: str = "geometry", unit: str = "m", attributes: Iterable[str] = (), cache: dict[int, Any] | None = None) -> dict[str, Any]:
    """The nested structure (Scene.plant(structure=...)) of an MTG.

    mtg: an openalea.mtg.MTG, or {vertex: {"class": "Leaf", "complex": vertex, "parent": vertex, "edge": "<" or "+", geometry: triangles (n, 3, 3)
    or PlantGL, ...}}. A vertex stands in its complex; a branch ("+") stands in what bears it where both have the same complex, and what
    succeeds it ("<") beside it, so that a structure holds all that it bears. `attributes`: names of further properties that are kept.
    """
    factor = _metres(unit)
    table = _mtg_table(mtg, geometry, tuple(attributes))
    above: dict[Hashable, Hashable | None] = {}

    def holder(v: Hashable) -> Hashable | None:
        chain = []
        while v not in above:
            chain.append(v)
            row = table[v]
            parent = row.get("parent")
            beside = parent is not None and table[parent].get("complex") == row.get("complex")
            if beside and row.get("edge") != "+":
                v = parent  # a successor stands where its predecessor does
                continue
            above[v] = parent if beside else row.get("complex")
            break
        for u in chain:
            above[u] = above[v]
        return above[v]

    children: dict[Hashable | None, list[Hashable]] = {}
    for v in table:
        children.setdefault(holder(v), []).append(v)

    nodes: dict[Hashable, dict[str, Any]] = {}
    for v, fields in table.items():
        node: dict[str, Any] = {"type": str(fields.get("class") or "structure"), "id": int(v), "children": []}  # type: ignore[call-overload]
        if fields.get(geometry) is not None:
            triangles = geometry_triangles(fields[geometry], cache)
            if len(triangles):
                node["triangles"] = np.ascontiguousarray(triangles * factor)
        kept = {key: fields[key] for key in attributes if fields.get(key) is not None}
        if kept:
            node["attributes"] = kept
        nodes[v] = node
    for v, inside in children.items():
        if v is not None:
            nodes[v]["children"] = [nodes[c] for c in inside]
    roots = children.get(None, [])
    if not roots:
        raise ValueError("mtg: found a circle of complexes; expected a tree")
    return nodes[roots[0]] if len(roots) == 1 else {"type": "scene", "children": [nodes[r] for r in roots]}


def _mtg_table(mtg: Any, geometry: str, attributes: tuple[str, ...]) -> dict[Hashable, dict[str, Any]]:
    if isinstance(mtg, Mapping):
        known = {"class", "complex", "parent", "edge", geometry, *attributes}
        for v, row in mtg.items():
            for key in ("complex", "parent"):
                if row.get(key) is not None and row[key] not in mtg:
                    raise ValueError(f"mtg[{v!r}][{key!r}]: found vertex {row[key]!r}, which there is not")
            unknown = set(row) - known
            if unknown:
                raise ValueError(f"mtg[{v!r}]: found the key {sorted(unknown)[0]!r}; expected some of {', '.join(sorted(known))}")
        return {v: dict(row) for v, row in mtg.items()}
    properties = {key: mtg.property(key) for key in (geometry, *attributes)}
    out: dict[Hashable, dict[str, Any]] = {}
    for v in mtg.vertices():
        scale = mtg.scale(v)
        if scale == 0:  # the MTG's own root, of which everything is a part
            continue
        fields: dict[str, Any] = {"class": mtg.class_name(v), "parent": mtg.parent(v), "edge": mtg.edge_type(v) if mtg.parent(v) is not None else None,
                               "complex": mtg.complex(v) if scale > 1 else None}
        fields.update({key: values[v] for key, values in properties.items() if v in values})
        out[v] = fields
    return out


def from_mtg(scene: Scene, name: str, mtg: Any, *, optics: Any, **arguments: Any) -> Plant:
    """A plant of the scene from an MTG (mtg_structure() has the arguments); result.organs.id are its vertices."""
    return scene.plant(name, structure=mtg_structure(mtg, **arguments), optics=optics)


def to_property(mtg: Any, result: Any, name: str, values: NDArray[Any]) -> None:
    """Writes values (m,) of organs into a property of an MTG, {vertex: value}: what a model reads in its next step."""
    ids = result.organs.id
    known = set(mtg.vertices())
    mtg.add_property(name)
    mtg.property(name).update({int(v): float(x) for v, x in zip(ids.tolist(), np.asarray(values).tolist()) if v in known})
