import sys
import types

import numpy as np
import pytest
from conftest import QUICK, leaves, new_scene

import sunfleck
from sunfleck import convert

SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


class Geometry:
    """As PlantGL's TriangleSet and QuadSet."""

    def __init__(self, points, faces):
        self.pointList, self.indexList = points, faces


class Solid:
    """As PlantGL's sphere: only a tesselator knows its triangles."""

    def apply(self, worker):
        worker.triangulation = Geometry(SQUARE, [(0, 1, 2), (0, 2, 3)])


class Shape:
    def __init__(self, geometry, id):
        self.geometry, self.id = geometry, id


class LpyScene(list):
    def todict(self):
        out = {}
        for shape in self:
            out.setdefault(shape.id, []).append(shape)
        return out


class Mtg:
    """As openalea.mtg.MTG: a plant (1) of two axes (2, 5); metamers 3 < 4 on the first, 6 on the second, which 3 bears."""

    rows = {0: (0, None, None, None, ""), 1: (1, 0, None, None, "Plant"), 2: (2, 1, None, None, "Axis"), 5: (2, 1, 2, "+", "Axis"),
            3: (3, 2, None, None, "Metamer"), 4: (3, 2, 3, "<", "Metamer"), 6: (3, 5, 3, "+", "Metamer")}

    def __init__(self):
        self._properties = {"geometry": {3: Shape(Geometry(SQUARE, [(0, 1, 2)]), 3), 4: [Shape(Geometry(SQUARE, [(0, 1, 2, 3)]), 4)], 6: Solid()},
                            "length": {3: 1.5, 6: 2.5}}

    def vertices(self):
        return list(self.rows)

    def scale(self, v):
        return self.rows[v][0]

    def complex(self, v):
        return self.rows[v][1]

    def parent(self, v):
        return self.rows[v][2]

    def edge_type(self, v):
        return self.rows[v][3]

    def class_name(self, v):
        return self.rows[v][4]

    def property(self, name):
        return self._properties.setdefault(name, {})

    def add_property(self, name):
        self._properties.setdefault(name, {})


@pytest.fixture
def plantgl(monkeypatch):
    """Enough of openalea.plantgl to tesselate."""
    package, plantgl, everything = types.ModuleType("openalea"), types.ModuleType("openalea.plantgl"), types.ModuleType("openalea.plantgl.all")
    everything.Tesselator = type("Tesselator", (), {"triangulation": None})
    plantgl.all = everything
    for name, module in {"openalea": package, "openalea.plantgl": plantgl, "openalea.plantgl.all": everything}.items():
        monkeypatch.setitem(sys.modules, name, module)


def outline(node):
    return node["type"], node.get("id"), [outline(c) for c in node["children"]]


def test_an_mtg_as_a_tree_of_structures(plantgl):
    node = convert.mtg_structure(Mtg(), attributes=["length"], unit="cm")
    assert outline(node) == ("Plant", 1, [("Axis", 2, [("Axis", 5, [("Metamer", 6, [])]), ("Metamer", 3, []), ("Metamer", 4, [])])])
    first = node["children"][0]["children"][1]
    assert first["attributes"] == {"length": 1.5} and first["triangles"].shape == (1, 3, 3) and first["triangles"].max() == 0.01


def test_an_mtg_lit_and_written_back(plantgl):
    scene, mtg = new_scene(), Mtg()
    convert.from_mtg(scene, "tree", mtg, optics="leaf").place()
    organs = sunfleck.solve(scene, **QUICK).organs
    assert sorted(organs.id) == [3, 4, 6] and set(organs.type) == {"Metamer"}
    np.testing.assert_allclose(organs.area[np.argsort(organs.id)], [0.5, 1, 1], rtol=1e-6)
    result = sunfleck.solve(scene, **QUICK)
    convert.to_property(mtg, result, "light", result.organs.absorbed[0, :, 0])
    assert set(mtg.property("light")) == {3, 4, 6}


def test_an_mtg_as_a_dictionary():
    table = {1: {"class": "Plant"}, 2: {"class": "Leaf", "complex": 1, "geometry": leaves(3)}, 3: {"class": "Leaf", "complex": 1, "parent": 2, "edge": "+", "geometry": leaves(2)},
             4: {"class": "Leaf", "complex": 1, "parent": 3, "edge": "<", "geometry": leaves(1)}}
    assert outline(convert.mtg_structure(table)) == ("Plant", 1, [("Leaf", 2, [("Leaf", 3, []), ("Leaf", 4, [])])])
    with pytest.raises(ValueError, match=r"mtg\[2\]\['complex'\]: found vertex 9"):
        convert.mtg_structure({2: {"complex": 9}})
    with pytest.raises(ValueError, match=r"mtg\[2\]: found the key 'klass'"):
        convert.mtg_structure({2: {"klass": "Leaf"}})
    with pytest.raises(ValueError, match="unit: found"):
        convert.mtg_structure(table, unit="furlong")


def test_lpy_and_plantgl_scenes(plantgl):
    solid = Solid()
    shapes = LpyScene([Shape(Geometry(SQUARE, [(0, 1, 2)]), 12), Shape(solid, 7), Shape(solid, 12)])
    cache = {}
    found = convert.plantgl_triangles(shapes, cache)
    assert {k: len(v) for k, v in found.items()} == {12: 3, 7: 2} and len(cache) == 2
    scene = new_scene()
    scene.periodic = None
    convert.from_plantgl(scene, "p", shapes, optics="leaf", unit="cm", cache=cache).place()
    organs = sunfleck.solve(scene, **QUICK).organs
    assert organs.id.tolist() == [12, 7]
    np.testing.assert_allclose(organs.area, [1.5e-4, 1e-4], rtol=1e-6)
    from sunfleck.caribu import CaribuScene

    assert {k: len(v) for k, v in CaribuScene(shapes).scene.items()} == {12: 3, 7: 2}
    assert {k: len(v) for k, v in CaribuScene(Mtg()).scene.items()} == {3: 1, 4: 2, 6: 2}
    with pytest.raises(ValueError, match="expected a PlantGL scene"):
        convert.from_plantgl(scene, "q", 7, optics="leaf")


def test_nested_structures_are_what_policies_see():
    scene = new_scene()
    leaf = {"type": "leaf", "optics": "leaf"}
    tree = {"type": "tree", "children": [{"type": "branch", "name": f"b{i}", "attributes": {"age": i}, "children": [{**leaf, "id": 10 * i + j, "triangles": leaves(2, seed=10 * i + j)} for j in (1, 2)]}
                                         for i in (1, 2)]}
    scene.plant("tree", structure=tree).place()
    result = sunfleck.solve(scene, **QUICK)
    assert result.organs.id.tolist() == [11, 12, 21, 22] and set(result.organs.type) == {"leaf"}
    one = new_scene()
    one.plant("tree", np.concatenate([leaves(2, seed=s) for s in (11, 12, 21, 22)]), organ=np.repeat([11, 12, 21, 22], 2), optics="leaf").place()
    np.testing.assert_allclose(sunfleck.solve(one, **QUICK).organs.absorbed, result.organs.absorbed, rtol=1e-6)
