"""Whatever is wrong is a ValueError that names the argument and the index, and leaves nothing half done."""

import warnings

import numpy as np
import pytest
from conftest import QUICK, leaves, new_scene

import sunfleck

TRIANGLES = leaves(5)


def bad(at, value):
    out = TRIANGLES.copy()
    out[at] = value
    return out


@pytest.mark.parametrize("arguments, text", [
    ({"triangles": TRIANGLES.reshape(-1, 9)}, r"triangles: found shape \(5, 9\); expected \(n, 3, 3\)"),
    ({"triangles": TRIANGLES.astype("f4")}, r"triangles: found dtype float32; expected float64 \(triangles.astype\(float\) converts it\)"),
    ({"triangles": np.repeat(TRIANGLES, 2, 0)[::2]}, r"triangles: found an array that is not contiguous; expected C order"),
    ({"triangles": bad((2, 1, 0), np.nan)}, r"triangles\[2, 1, 0\]: found nan; expected a finite number"),
    ({"triangles": bad((4, 2, 2), np.inf)}, r"triangles\[4, 2, 2\]: found inf; expected a finite number"),
    ({"triangles": np.empty((0, 3, 3))}, r"triangles: found none; expected at least one"),
    ({}, r"triangles: found nothing; expected triangles, vertices and indices, structure, or file"),
    ({"triangles": TRIANGLES, "vertices": TRIANGLES[0]}, r"triangles: found beside vertices"),
    ({"vertices": TRIANGLES[0]}, r"vertices: found without indices"),
    ({"vertices": TRIANGLES[0], "indices": [[0, 1, 3]]}, r"indices\[0, 2\]: found 3; expected a row of the 3 vertices"),
    ({"vertices": TRIANGLES[0], "indices": [[0, -1, 2]]}, r"indices\[0, 1\]: found -1"),
    ({"vertices": TRIANGLES[0], "indices": np.array([[0.0, 1, 2]])}, r"indices: found dtype float64; expected int64"),
    ({"triangles": TRIANGLES, "organ": np.arange(4)}, r"organ: found 4 values; expected 5, one for each triangle"),
    ({"triangles": TRIANGLES, "organ": np.arange(5.0)}, r"organ: found dtype float64; expected int64"),
    ({"triangles": TRIANGLES, "organ": np.arange(5), "organ_names": {9: "x"}}, r"organ_names: found id 9, of which there is no triangle"),
    ({"triangles": TRIANGLES, "optics": "laef"}, r'plant.optics: found "laef"; expected one of leaf; did you mean "leaf"\?'),
    ({"triangles": TRIANGLES, "optics": {"stem": "leaf"}}, r'optics: found none for organ 0 of type "organ"'),
    ({"triangles": TRIANGLES, "optics": None}, r"optics: found NoneType"),
    ({"triangles": TRIANGLES, "name": "there"}, r'plant.name: found "there" twice'),
    ({"triangles": TRIANGLES, "name": "a/b"}, r'plant.name: found "a/b"; expected a name without "/"'),
    ({"triangles": TRIANGLES, "unit": "cm"}, r"unit, age, seed: found without file"),
    ({"file": "nowhere.obj"}, r'plant\[0\].file: found no file "nowhere.obj"'),
    ({"triangles": TRIANGLES, "policy": "nowhere.toml"}, r'policy: found no file "nowhere.toml"'),
    ({"structure": {"type": "plant", "childs": []}}, r'structure: found the key "childs"; expected some of attributes, children'),
    ({"structure": {"type": "plant", "children": [{"id": 1, "triangles": TRIANGLES}, {"id": 1, "triangles": TRIANGLES}]}},
     r"structure.children\[1\].id: found 1 twice"),
    ({"structure": {"type": "plant"}}, r"structure: found no triangles; expected at least one"),
])
def test_plants(arguments, text):
    scene = new_scene()
    scene.plant("there", TRIANGLES, optics="leaf").place()
    before = scene._core.plant_names
    with pytest.raises(ValueError, match=text):
        scene.plant(**{"name": "p", "optics": "leaf", **arguments})
    assert scene._core.plant_names == before
    assert sunfleck.solve(scene, **QUICK).status == "converged"


@pytest.mark.parametrize("call, text", [
    (lambda s: s.optics("x", reflectance={"PAR": 0.6, "NIR": 0.1}, transmittance={"PAR": 0.5, "NIR": 0}),
     r"optics.x.reflectance.PAR: found reflectance 0.6 \+ transmittance 0.5 = 1.1; expected a sum of at most 1"),
    (lambda s: s.optics("leaf", reflectance={"PAR": 0.6, "NIR": 0.1}), r'optics.name: found "leaf" twice'),
    (lambda s: s.optics("x", reflectance={"PAR": 0.6}), r"optics.x.reflectance.NIR: found nothing"),
    (lambda s: s.optics("x", reflectance={"PAR": 0.6, "NIR": 0.1, "RED": 0}), r"optics.x.reflectance.RED: unknown key"),
    (lambda s: s.optics("x", reflectance=0.5), r"optics.x.reflectance: found 0.5; expected a number per band"),
    (lambda s: s.optics("x", reflectance={"PAR": np.nan, "NIR": 0}), r"optics.x.reflectance.PAR: found nan; expected a finite number"),
    (lambda s: s.sun((0, 0, 1), {"PAR": -1, "NIR": 0}), r"sun.irradiance.PAR: found -1; expected a number of zero or more"),
    (lambda s: s.sun((0, 0), {"PAR": 1, "NIR": 0}), r"sun.direction: found an array of 2; expected an array of 3 numbers"),
    (lambda s: s.sun((0, 0, 0), {"PAR": 1, "NIR": 0}), r"sun.direction: found \[0, 0, 0\]"),
    (lambda s: s.sun(elevation=30, irradiance={"PAR": 1, "NIR": 0}), r"sun.azimuth: found nothing"),
    (lambda s: s.sun(latitude=0, longitude=0, time="2026-06-21T12:00", irradiance={"PAR": 1, "NIR": 0}), r"sun.time: found \"2026-06-21T12:00\""),
    (lambda s: s.sky("standard_overcst", {"PAR": 1, "NIR": 0}), r'sky.model: found "standard_overcst"; expected one of .*did you mean "standard_overcast"'),
    (lambda s: s.state("noon", sun={"elevation": 3}), r"state\[0\].sun"),
    (lambda s: s.ground(size=(1, -1), reflectance={"PAR": 1, "NIR": 0}), r"ground.size: found \[1, -1\]; expected two lengths above zero"),
    (lambda s: s.ground(triangles=TRIANGLES[0], reflectance={"PAR": 1, "NIR": 0}), r"ground.triangles: found shape \(3, 3\)"),
    (lambda s: setattr(s, "periodic", (0, 0, 0, 1)), r"periodic: found \(0, 0, 0, 1\); expected xmin, ymin, xmax, ymax"),
    (lambda s: setattr(s, "periodic", (0, 0, 1)), r"periodic: found 3 values"),
    (lambda s: s.sensor("a"), r"sensor\[0\]: found no shape"),
    (lambda s: s.lamp(power={"PAR": 1, "NIR": 1}), r"lamp\[0\]: found neither `mesh` nor `ies`"),
    (lambda s: s.plant("q", TRIANGLES, optics="leaf").place(scale=0), r"scale: found 0; expected a number above zero"),
    (lambda s: s.plant("q", TRIANGLES, optics="leaf").place(position=[[0, 0, 0], [1, 0, np.nan]]), r"position\[1, 2\]: found nan"),
    (lambda s: s.plant("q", TRIANGLES, optics="leaf").place(position=np.zeros((3, 3)), turn=[1, 2]), r"turn: found 2 values; expected one, or one for each of 3"),
    (lambda s: s.group("there"), r'group.name: found "there" twice'),
])
def test_scenes(call, text):
    scene = new_scene()
    scene.plant("there", TRIANGLES, optics="leaf").place()
    states = scene.states
    with pytest.raises(ValueError, match=text):
        call(scene)
    assert scene.states == states and scene._core.optics_names == ["leaf"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sunfleck.SceneWarning)
        assert sunfleck.solve(scene, **QUICK).status == "converged"


@pytest.mark.parametrize("bands, units, text", [
    ([], {}, "bands: found none"), (["A", "A"], {}, r'bands\[0\]: found "A" twice'), ("PAR", {}, 'bands: found the text "PAR"'),
    (["A"], {"A": "lux"}, r'units\["A"\]: found "lux"; expected "W m\^-2" or "umol m\^-2 s\^-1"'), (["A"], {"B": "W m^-2"}, 'units: found the band "B"'),
])
def test_bands(bands, units, text):
    with pytest.raises(ValueError, match=text):
        sunfleck.Scene(bands=bands, units=units)


def test_empty_scenes():
    scene = sunfleck.Scene(bands=["PAR"])
    with pytest.raises(ValueError, match="scene: found no plant, ground or sensor"):
        sunfleck.solve(scene)
    scene.ground(size=(1, 1), reflectance=0.1)
    with pytest.raises(ValueError, match="states: found none"):
        sunfleck.solve(scene)


@pytest.mark.parametrize("settings, text", [
    ({"quality": "best"}, "quality: found"), ({"method": "magic"}, "magic"), ({"threads": -1}, "threads: found -1"), ({"seed": -1}, "seed: found -1"),
    ({"error": 0.9}, "error"), ({"error": {"RED": 0.1}}, "RED"), ({"error": 0.1, "quality": "fine"}, "error"), ({"samples": -4}, "."),
])
def test_settings(scene, settings, text):
    with pytest.raises((ValueError, TypeError), match=text):
        sunfleck.solve(scene, **settings)


def test_read(tmp_path):
    with pytest.raises(ValueError, match="nowhere.toml"):
        sunfleck.Scene.read(tmp_path / "nowhere.toml")
    with pytest.raises(ValueError, match="nowhere.h5"):
        sunfleck.read_result(tmp_path / "nowhere.h5")
    (tmp_path / "scene.toml").write_text('bands = ["PAR"]\nbnads = 1\n')
    with pytest.raises(ValueError, match=r'scene.toml:2: bnads: unknown key; did you mean "bands"\?'):
        sunfleck.Scene.read(tmp_path / "scene.toml")
