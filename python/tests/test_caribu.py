"""Numbers that CARIBU's own tests hold, and its forms of arguments; and a canopy against path tracing."""

import math

import numpy as np
import pytest

import sunfleck
from sunfleck.caribu import (CaribuScene, caribu_star, diffuse_source, light_sources, mixed_radiosity, radiosity, raycasting, turtle, x_mixed_radiosity,
                             x_raycasting)
from sunfleck.caribu.CaribuScene import CaribuScene as AlsoByModule

R = math.sqrt(2)
UNIT = [(0, 0, 0), (R, 0, 0), (0, R, 0)]
DOWN = [(100, (0, 0, -1))]
UPPER, LOWER, BESIDE = [(0, 0, 1e-5), (1, 0, 1e-5), (0, 1, 1e-5)], [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(1, 0, 0), (1, 1, 0), (0, 1, 0)]


def test_one_triangle():
    out = raycasting([UNIT], [(0.06, 0.04)], DOWN)
    assert set(out) == {"index", "label", "area", "Eabs", "Ei", "Ei_sup", "Ei_inf"}
    np.testing.assert_allclose([out[k][0] for k in ("area", "Ei", "Eabs", "Ei_sup", "Ei_inf")], [1, 100, 90, 100, 0], rtol=1e-6)
    out = raycasting([list(reversed(UNIT))], [(0.06, 0.04)], DOWN)
    np.testing.assert_allclose([out[k][0] for k in ("Ei", "Ei_sup", "Ei_inf")], [100, 0, 100], rtol=1e-6)
    assert raycasting([UNIT], [(1.0, 0.0)], DOWN)["Eabs"] == [0]
    np.testing.assert_allclose(raycasting([UNIT], [(0.1, 0, 0.2, 0)], DOWN)["Eabs"], 90, rtol=1e-6)
    np.testing.assert_allclose(raycasting([reversed(UNIT)], [(0.1, 0, 0.2, 0)], DOWN)["Eabs"], 80, rtol=1e-6)
    assert raycasting([UNIT], [(0.06, 0.07)], [(0, (0, 0, -1))])["Ei"] == [0]


def test_light_from_aside():
    slanting = [(100, (-1, 0, -1))]
    np.testing.assert_allclose(raycasting([UNIT], [(0.06, 0.07)], slanting)["Ei"], 100, rtol=1e-5)
    s = math.cos(math.radians(45)) * R
    facing = [(0, 0, 0), (0, R, 0), (-s, 0, s)]
    np.testing.assert_allclose(raycasting([facing], [(0.06, 0.07)], slanting)["Ei"], 100 * R, rtol=1e-5)
    upright = [(0, 0, 0), (0, R, 0), (0, 0, R)]
    with pytest.warns(sunfleck.SceneWarning, match="does not come from above"):
        assert raycasting([upright], [(0.06, 0.07)], [(100, (-1, 0, 0))])["Ei"] == [0]


def test_coincident_and_stacked():
    for first, second in ((UNIT, UNIT), (UNIT, list(reversed(UNIT))), (list(reversed(UNIT)), UNIT)):
        out = raycasting([first, second], [(0.06, 0.07)] * 2, DOWN)
        np.testing.assert_allclose(out["Ei"], [100, 0], atol=0.5)
    low, high = [(0, 0, 0), (1, 0, 0), (0, 1, 0)], UPPER
    out = radiosity([low, high], [(0.1, 0.2)] * 2, DOWN)
    np.testing.assert_allclose([out["Ei"][1], out["Ei_sup"][1], out["Ei_inf"][1], out["Eabs"][1]], [102, 100, 2, 71], atol=0.55)
    np.testing.assert_allclose([out["Ei"][0], out["Eabs"][0]], [20, 14], atol=0.5)
    out = radiosity([low, high], [(0.1,), (0.1, 0.2)], DOWN)
    np.testing.assert_allclose(out["Ei"], [20, 102], atol=0.5)


@pytest.mark.parametrize("domain", [(-2, -2, 0, 2), (2, -2, 4, 2), (12, 12, 14, 14), ((14, 14), (12, 12))])
def test_what_reaches_beyond_the_domain_is_wrapped(domain):
    np.testing.assert_allclose(raycasting([UNIT], [(0.06, 0.07)], DOWN, domain)["Ei_sup"], 100, rtol=1e-3)


def test_aggregation_and_units():
    raw, mean = CaribuScene({"lower": [LOWER, BESIDE], "upper": [UPPER]}, pattern=(0, 0, 1, 1)).run(direct=True, infinite=False, simplify=True)
    np.testing.assert_allclose([mean["area"]["lower"], mean["Ei"]["lower"], mean["Ei"]["upper"]], [1, 0.5, 1], rtol=1e-4)
    null = [(1, 0, 0), (1, 0, 0), (0, 1, 0)]
    raw, mean = CaribuScene({"lower": [LOWER, null], "upper": [UPPER]}).run(simplify=True)
    assert mean["area"]["lower"] == pytest.approx(0.5) and mean["Ei"]["lower"] == pytest.approx(0, abs=1e-4)
    assert raw["area"]["lower"][1] == 0 and math.isnan(raw["Ei"]["lower"][1]) and math.isnan(raw["Eabs"]["lower"][1])
    cm = {"lower": [[tuple(100 * x for x in p) for p in t] for t in (LOWER, BESIDE)], "upper": [[(x * 100, y * 100, 1e-3) for x, y, _ in UPPER]]}
    raw, mean = CaribuScene(cm, pattern=(0, 0, 100, 100), scene_unit="cm").run(simplify=True)
    np.testing.assert_allclose([sum(raw["area"]["lower"]), mean["Ei"]["lower"], mean["Ei"]["upper"]], [1, 0.5, 1], rtol=1e-4)


def test_soil():
    scene = CaribuScene({0: [LOWER, BESIDE], 1: [UPPER]}, pattern=(0, 0, 1, 1), soil_mesh=1)
    _, mean = scene.run(direct=True, infinite=False, simplify=True)
    np.testing.assert_allclose([mean["area"][0], mean["Ei"][0], mean["Ei"][1]], [1, 0.5, 1], rtol=1e-3)
    assert len(scene.soil) == 2 and len(scene.soil_raw["default_band"]["Ei"]) == 2
    assert scene.soil_aggregated["default_band"]["Ei"] == pytest.approx(0, abs=0.01) and scene.soil_aggregated["default_band"]["area"] == pytest.approx(1)
    assert scene.getSoilEnergy()[1] == pytest.approx(0, abs=0.01)
    two = CaribuScene({0: [UPPER]}, pattern=(0, 0, 1, 1), soil_mesh=1, opt={"par": (0.1, 0.1), "nir": (0.4, 0.4)})  # a TypeError there
    two.run(direct=False, infinite=True)
    assert set(two.soil_raw) == {"par", "nir"} and two.soil_aggregated["par"]["Ei"] == pytest.approx(0.5, abs=0.12)


def test_defaults_and_forms(tmp_path):
    empty = CaribuScene()
    assert empty.scene is None and empty.light == [empty.default_light] and empty.pattern is None and empty.material is None
    assert empty.soil_reflectance == {"default_band": 0.15}
    scene = CaribuScene({"t": [LOWER]}, opt={"par": {"t": (0.3,)}}, pattern=((20, 20), (0, 0)))
    assert scene.material == {"par": {"t": (0.3,)}} and scene.pattern == (0, 0, 20, 20) and scene.soil_reflectance == {"par": 0.15}
    assert CaribuScene({"t": [LOWER]}, soil_reflectance={"par": 0}).material == {"par": {"t": (0.06, 0.07)}}
    assert scene.bbox() == ((0, 0, 0), (1, 1, 0)) and scene.auto_screen(0.01) == 141
    np.testing.assert_allclose(scene.triangle_areas(), [0.5])
    assert scene.getIncidentEnergy() == (1, 1, 400)
    assert AlsoByModule is CaribuScene
    scene.setLight([(2, (-1, 0, -1)), (1, (0, 0, -3))])
    np.testing.assert_allclose(scene.getIncidentEnergy(), (3, 1 + 2 * R, 1200))

    (tmp_path / "t.can").write_text("p 1 100001001001 3 0 0 0 1 0 0 0 1 0\np 1 100001000002 3 0 0 -1 1 0 -1 0 1 -1\n")
    (tmp_path / "par.opt").write_text("n 1\ns d 0.2\ne d 0.05 d 0.1 0.2 d 0.1 0.2\n")
    (tmp_path / "nir.opt").write_text("n 1\ns d 0.3\ne d 0.05 d 0.4 0.5 d 0.4 0.5\n")
    (tmp_path / "sky.light").write_text("1 0 0 -1\n0.5 1 0 -1\n")
    (tmp_path / "cell.8").write_text("0 0\n2 2\n")
    files = CaribuScene(str(tmp_path / "t.can"), light=str(tmp_path / "sky.light"), pattern=str(tmp_path / "cell.8"),
                        opt=[str(tmp_path / "par.opt"), str(tmp_path / "nir.opt")])
    assert files.material == {"par": {"100001001001": (0.1, 0.2, 0.1, 0.2), "100001000002": (0.05,)},
                              "nir": {"100001001001": (0.4, 0.5, 0.4, 0.5), "100001000002": (0.05,)}}
    assert files.soil_reflectance == {"par": 0.2, "nir": 0.3} and files.pattern == (0, 0, 2, 2) and len(files.light) == 2
    raw, _ = files.run(direct=True, infinite=True)
    np.testing.assert_allclose(raw["par"]["Ei"]["100001001001"], [1.5], rtol=2e-3)
    np.testing.assert_allclose(raw["nir"]["Eabs"]["100001001001"], [0.15], rtol=2e-3)


@pytest.mark.parametrize("arguments, text", [
    ({"scene": 7}, "Unrecognised scene format"), ({"scene": {"a": [[(0, 0, 0), (1, 0, 0)]]}, "pattern": None, "run": True}, "three points"),
    ({"light": 3}, "light: found"), ({"light": [(1, (0, 0))]}, r"light\[0\]"), ({"light": [(-1, (0, 0, -1))]}, r"light\[0\]"),
    ({"pattern": (0, 0, 1)}, "pattern: found"), ({"pattern": (0, 0, 0, 1)}, "pattern: found"), ({"scene_unit": "inch"}, "scene_unit: found"),
    ({"opt": ["a.opt"]}, "opt: found a list"), ({"opt": {"par": {"b": (0.1,)}}}, "found no material for id 'a'"), ({"opt": {"par": (0.6, 0.6)}}, "at most 1"),
    ({"opt": {"par": (0.1,)}, "soil_reflectance": {"nir": 0}}, "soil_reflectance: found bands"), ({"soil_reflectance": {"par": 2}}, r"soil_reflectance\['par'\]"),
    ({"soil_mesh": 1}, "soil_mesh: found no pattern"), ({"infinite": True}, "without a pattern"),
])
def test_errors(arguments, text):
    run = arguments.pop("run", False) or "infinite" in arguments
    infinite = arguments.pop("infinite", False)
    with pytest.raises(ValueError, match=text):
        scene = CaribuScene(**{"scene": {"a": [LOWER]}, **arguments})
        if run:
            scene.run(infinite=infinite)


def test_changed_optics_count_in_the_next_run():
    scene = CaribuScene({"t": [LOWER]}, opt={"par": (0.1,)})
    before = scene.run(simplify=True)[1]["Eabs"]["t"]
    scene.material = {"par": {"t": (0.5,)}}
    assert scene.run(simplify=True)[1]["Eabs"]["t"] == pytest.approx(before / 0.9 * 0.5)
    assert CaribuScene({"t": [LOWER]}, opt={"par": (0.0,)}).run(direct=False, simplify=True)[1]["Eabs"]["t"] == pytest.approx(1)


def test_sensors_measure_and_do_not_shade():
    sensors = {"two": [[(0, 0, 2), (1, 0, 2), (0, 1, 2)], [(1, 0, 2), (1, 1, 2), (0, 1, 2)]], 3: [[(0, 0, 3), (1, 0, 3), (0, 1, 3)]]}
    scene = CaribuScene({"lower": [LOWER, BESIDE], "upper": [UPPER]}, pattern=(0, 0, 1, 1), opt={"par": (0.1,), "nir": (0.5,)})
    for direct, infinite in ((True, False), (False, False), (False, True)):
        raw, mean = scene.run(direct=direct, infinite=infinite, sensors=sensors)
        assert set(raw) == {"par", "nir"} and [len(raw["par"]["Eabs"][k]) for k in ("lower", "upper")] == [2, 1]
        np.testing.assert_allclose([mean["par"]["Ei"]["upper"], mean["par"]["Ei"]["lower"]], [1, 0.5], atol=2e-2)
        assert set(raw["nir"]["sensors"]) == {"Ei", "Ei0", "area"} and len(raw["nir"]["sensors"]["Ei"]["two"]) == 2
        np.testing.assert_allclose([mean["nir"]["sensors"]["Ei0"][k] for k in ("two", 3)], 1, atol=1e-3)
        assert mean["nir"]["sensors"]["area"] == {"two": pytest.approx(1), 3: pytest.approx(0.5)}


def test_mixed_radiosity_is_periodic_and_has_a_soil():
    leaves = [[tuple(p) for p in t] for t in np.random.default_rng(2).random((60, 1, 3)) + 0.1 * np.random.default_rng(3).normal(size=(60, 3, 3))]
    two = x_mixed_radiosity(leaves, {"a": [(0.5, 0.4)] * 60, "b": [(0.1, 0.1)] * 60}, DOWN, (0, 0, 1, 1), {"a": 0.0, "b": 0.0}, 0.5, 10, 1)
    bright = mixed_radiosity(leaves, [(0.5, 0.4)] * 60, DOWN, (0, 0, 1, 1), 0.5, 0.5, 10, 1)
    assert np.sum(bright["Eabs"]) > 1.1 * np.sum(two["a"]["Eabs"])
    direct = x_raycasting(leaves, {"a": [(0.5, 0.4)] * 60}, DOWN, (0, 0, 1, 1))["a"]
    assert np.sum(np.multiply(direct["Ei"], direct["area"])) < 100 and np.sum(two["a"]["Ei"]) > np.sum(direct["Ei"])


def test_light_sources():
    (energy, way), = light_sources(90, 0, 1)
    np.testing.assert_array_equal([energy, *way], [1, 0, 0, -1])
    ways = [w for _, w in light_sources([45] * 4, [0, 180, 90, -90], [1] * 4)]
    np.testing.assert_allclose(ways, np.array([[-1, 0, -1], [1, 0, -1], [0, 1, -1], [0, -1, -1]]) / R, atol=1e-9)
    ways = [w for _, w in light_sources([45] * 4, [0, 180, 90, -90], [1] * 4, orientation=-90)]
    np.testing.assert_allclose(ways, np.array([[0, -1, -1], [0, 1, -1], [-1, 0, -1], [1, 0, -1]]) / R, atol=1e-9)


@pytest.mark.parametrize("sectors", [1, 6, 16, 46])
def test_turtles(sectors):
    for form in ("soc", "uoc"):
        sky = turtle(sectors, form, 3.0)
        assert len(sky) == sectors and sum(e for e, _ in sky) == pytest.approx(3) and all(v[2] < 0 for _, v in sky)
        np.testing.assert_allclose([np.linalg.norm(v) for _, v in sky], 1)
    if sectors == 46:  # den Dulk's elevations
        heights = np.sort(np.degrees(np.arcsin([-v[2] for _, v in sky])))
        np.testing.assert_allclose(heights, np.repeat([9.23, 10.81, 26.57, 31.08, 47.41, 52.62, 69.16, 90], [10, 5, 5, 10, 5, 5, 5, 1]), atol=0.02)
    assert len(diffuse_source(sectors)) == sectors


def test_star_of_a_flat_leaf_is_one():
    star, exposed = caribu_star({"leaf": [[(0, 0, 0), (10, 0, 0), (0, 10, 0)]]}, 16)
    assert star["leaf"] == pytest.approx(1, rel=1e-4) and exposed["leaf"] == pytest.approx(0.5e-2, rel=1e-4)
    with pytest.raises(ValueError, match="convUnit"):
        caribu_star({"leaf": [LOWER]}, convUnit=3)


def test_sky_tools_as_scripts_use_them():
    from sunfleck.caribu.sky_tools import GenSky, GetLight, GetLightsSun, Gensun, spitters_horaire
    from sunfleck.caribu.sky_tools.turtle import turtle as sectors_of

    for kind in ("soc", "uoc"):
        sky = GenSky.GenSky()(3.0, kind, 4, 5)
        assert sky.get_Rs() == pytest.approx(3) and len(sky.sky) == 20
        lines = [[float(x) for x in line.split()] for line in GetLight.GetLight(sky).splitlines()]
        np.testing.assert_allclose(lines, [s[:4] for s in sky.sky])
        light = [(e, v) for e, *v in lines]
        assert CaribuScene({"a": [LOWER]}, light=light).run()[1]["default_band"]["Ei"]["a"] == pytest.approx(3, rel=1e-6)
    # the first ring of an overcast sky, 0 to 18 degrees from the zenith: 3/7 sin^2 + 4/7 (1 - cos^3) of all
    edge = np.radians(18)
    overcast = GenSky.GenSky()(1.0, "soc", 4, 5).sky
    assert sum(s[0] for s in overcast if s[5] == 0) == pytest.approx(3 / 7 * np.sin(edge) ** 2 + 4 / 7 * (1 - np.cos(edge) ** 3))

    noon, morning, night = (Gensun.Gensun()(2.0, 172, hour, 45.0) for hour in (12, 8, 0))
    assert np.degrees(noon.elev) == pytest.approx(45 - 23.45, abs=0.3)  # a short series
    energy, *way = map(float, GetLightsSun.GetLightsSun(noon).split())
    np.testing.assert_allclose([energy, *way], [2, np.sin(noon.elev), 0, -np.cos(noon.elev)], atol=1e-12)  # from the south to X, north
    assert float(GetLightsSun.GetLightsSun(morning).split()[2]) > 0.5 and GetLightsSun.GetLightsSun(night) == ""  # from the east to Y, west

    assert spitters_horaire.RdRsH(50, 172, 12, 45) == 1 and spitters_horaire.RdRsH(0, 172, 0, 45) == 1
    sine = np.cos(noon.elev)
    assert spitters_horaire.RdRsH(1200, 172, 12, 45) == pytest.approx(0.847 - 1.61 * sine + 1.04 * sine**2)
    assert spitters_horaire.dH(spitters_horaire.DayLength(45, spitters_horaire.DecliSun(80))) == pytest.approx(12, abs=0.1)
    (table,), = spitters_horaire.spitters_horaire()([[["DOY", "172"], ["HU", "12"], ["Rg", "50"], ["group", "1"]]], 45)
    assert [c[0] for c in table] == ["DOY", "HU", "Rg", "RdRg", "group"] and table[3][1] == "1.0"

    energies, across, ways, heights, azimuths = sectors_of("46", "soc", 2.0)
    assert sum(energies) == pytest.approx(2) and len(azimuths) == 46
    np.testing.assert_allclose(np.multiply(across, [-v[2] for v in ways]), energies)
    ring = sorted(a % 360 for a, h in zip(azimuths, heights) if abs(h - 26.57) < 0.1)
    np.testing.assert_allclose(np.round(ring, 3) % 360, [0, 72, 144, 216, 288], atol=0.01)


def test_light_vege_manager():
    from sunfleck.caribu.lightvegemanager import LightVegeManager

    here = {"coordinates": [45, 0, 0], "sky": [4, 5, "soc"]}
    leaf = {7: [LOWER, BESIDE], "high": [[(0, 0, 1), (1, 0, 1), (0, 1, 1)]]}
    dark_stem = {"scenes": [leaf], "domain": ((0, 0), (1, 1)), "stems id": [("high", 0)]}
    light = LightVegeManager({**here, "direct": False}, "caribu", {"caribu opt": {"par": (0.1, 0.05), "nir": (0.4, 0.5)}})
    light.build(dark_stem)
    light.run(energy=500, day=172, hour=12)
    organs, triangles = light.elements_outputs, light.triangles_outputs
    assert list(organs["Organ"]) == [7, "high"] and list(triangles["Organ"]) == [0, 0, 1] and list(organs["Area"]) == [1, 0.5]
    assert organs["par Ei"][1] == pytest.approx(500, rel=1e-5)  # a horizontal leaf under the whole sky
    assert organs["par Eabs"][1] == pytest.approx(450, rel=1e-5) and organs["nir Eabs"][1] == pytest.approx(300, rel=1e-5)  # opaque
    assert 0 < triangles["par Ei"][0] < 500 and triangles["par Eabs"][0] == pytest.approx(0.85 * triangles["par Ei"][0])
    assert light.sensors_outputs() is None

    # sun and sky are shared by Spitters' model, and a sun below two degrees gives nothing
    both = LightVegeManager(here, "caribu", {"sensors": ["grid", [1, 1, 1], [1, 1, 2], [5, 5, 0]], "caribu opt": {"par": (0.1, 0.05)}})
    both.build({"scenes": [[[(0, 0, 0), (1, 0, 0), (0, 1, 0)]], {1: [UPPER]}], "transformations": {"translate": {1: (9, 0, 0)}, "scenes unit": {1: "cm"}}}, 1)
    both.run(energy=800, day=172, hour=12, truesolartime=True)
    assert both.elements_outputs["par Ei"][0] == pytest.approx(800, rel=1e-5) and len(both.triangles_outputs) == 8
    assert list(both.elements_outputs["VegetationType"]) == [0, 1] and both.elements_outputs["Area"][1] == pytest.approx(0.5e-4)
    np.testing.assert_allclose(both.sun, [np.sin(np.radians(45 - 23.45)), 0, -np.cos(np.radians(45 - 23.45))], atol=5e-3)
    frame = both.sensors_outputs(dataframe=True)
    assert len(frame) == 2 and frame["PAR"].tolist() == pytest.approx([1, 1], rel=1e-5)
    both.run(energy=800, day=172, hour=0, truesolartime=True)
    assert both.elements_outputs["par Ei"][0] == pytest.approx(800, rel=1e-5)  # the sky alone
    alone = LightVegeManager({**here, "diffus": False})
    alone.build([LOWER])
    alone.run(energy=800, day=172, hour=0, truesolartime=True)
    assert alone.elements_outputs["par Ei"].tolist() == [0]

    class Tree:  # as openalea.mtg.MTG keeps properties
        kept: dict = {}
        add_property = lambda self, name: self.kept.setdefault(name, {})  # noqa: E731
        properties = property = lambda self, name=None: self.kept if name is None else self.kept[name]  # noqa: E731

    light.to_MTG(energy=2, mtg=Tree())
    assert Tree.kept["PARa"][7] == 2 * organs["par Eabs"][0] and Tree.kept["Erel"]["high"] == pytest.approx(0.9, rel=1e-5)

    with pytest.raises(ValueError, match="lightmodel"):
        LightVegeManager({}, "ratp")
    with pytest.raises(ValueError, match="build"):
        LightVegeManager().run()
    with pytest.raises(ValueError, match="x\\+ = N"):
        light.build({"scenes": [leaf], "transformations": {"xyz orientation": {0: "up"}}})
    with pytest.raises(ValueError, match="voxels"):
        light.build({"scenes": [{"LA": [], "distrib": []}]})
