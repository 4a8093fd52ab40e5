"""The growth models of examples/python, shortened."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "examples" / "python"))

import branching  # noqa: E402
import maize  # noqa: E402
import poplar  # noqa: E402
from branching import Rules, Tree  # noqa: E402

SEEDS = (1, 2, 3)


@pytest.fixture(scope="module")
def alone():
    return [poplar.grow([Tree(seed=s)], poplar.SITES["alone"], 9) for s in SEEDS]


def shed_share(tree):
    """Branches that fell, of all metamers there ever were."""
    return tree.shed_branches / tree.id.max()


def test_vigour_is_split_by_light_and_conserved():
    assert branching.split(8, 3, 1, 0.5) == pytest.approx((6, 2))
    main, lateral = branching.split(8, 3, 1, 0.46)
    assert main == pytest.approx(8 * 0.46 * 3 / (0.46 * 3 + 0.54)) and main + lateral == pytest.approx(8)
    assert branching.split(8, 0, 0, 0.6) == (4, 4)
    rules = Rules()
    assert [rules.control(age) for age in (0, 7, 14, 40)] == pytest.approx([0.65, 0.65, 0.51, 0.51])
    assert rules.control(10) == pytest.approx(0.65 - 0.14 * 3 / 7)


def test_structure_stays_a_tree():
    tree = Tree(seed=5)
    for _ in range(10):
        last = tree.id.max()
        tree.grow(np.where(tree.tip[:, 0] > -0.15, 0.8, 0.02))  # dark in the west: branches fall
        assert len(np.unique(tree.id)) == len(tree) and tree.id.max() >= last
        assert tree.parent[0] == -1 and np.all(tree.parent[1:] >= 0) and np.all(tree.parent[1:] < np.arange(1, len(tree)))
        np.testing.assert_allclose(tree.base[1:], tree.tip[tree.parent[1:]], atol=1e-12)
        np.testing.assert_allclose(np.linalg.norm(tree.side, axis=1), 1, atol=1e-9)
        assert np.abs(np.einsum("ij,ij->i", tree.side, tree.axis)).max() < 1e-9
    assert tree.shed_branches > 0 and tree.fallen.sum() > 0
    e, radius = tree.rules.pipe, tree.radius()
    borne = np.bincount(tree.parent[1:], radius[1:] ** e, len(tree))
    np.testing.assert_allclose(radius**e, borne + tree.fallen + tree.rules.twig_radius**e, rtol=1e-9)
    triangles, rows = tree.leaves()
    area = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1) / 2
    assert area.sum() == pytest.approx(tree.leaf_area) and len(rows) == 2 * tree.leafy.sum()
    assert np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])[:, 2].min() > 0  # upper sides are fronts


def test_light_comes_back_by_the_id_of_the_organ():
    tree = Tree(seed=2)
    for _ in range(4):
        tree.grow(np.full(len(tree), 0.8))
    light = poplar.light_of([tree], poplar.Site())
    relative, organs = light.relative[0], light.result.organs
    assert np.all(relative[~tree.leafy] == 0) and np.all(relative[tree.leafy] > 0.02) and relative.max() < 1.1
    row = int(np.flatnonzero(tree.leafy)[7])
    here = organs.id == 2 * tree.id[row]
    assert here.sum() == 1
    assert organs.area[here][0] == pytest.approx(tree.rules.leaf_area, rel=1e-5)
    assert relative[row] == pytest.approx(organs.absorbed[0, here, 0][0] / organs.area[here][0] / (poplar.SKY * 0.86))
    top, low = tree.tip[tree.leafy][:, 2].argsort()[[-1, 0]]
    assert relative[tree.leafy][top] > relative[tree.leafy][low]


def test_the_same_seed_grows_the_same_tree(alone):
    again = poplar.grow([Tree(seed=1)], poplar.SITES["alone"], 9).trees[0]
    np.testing.assert_array_equal(again.tip, alone[0].trees[0].tip)
    assert len(again) != len(alone[1].trees[0]) or not np.array_equal(again.tip, alone[1].trees[0].tip)


def test_more_light_more_growth(alone):
    dim, bright = Tree(seed=1), Tree(seed=1)
    for _ in range(7):
        dim.grow(np.full(len(dim), 0.5))
        bright.grow(np.full(len(bright), 0.8))
    assert bright.mass > 1.5 * dim.mass and bright.height > dim.height
    crowded = poplar.grow([Tree(seed=1)], poplar.SITES["crowd"], 9).trees[0]
    assert alone[0].trees[0].mass > 1.5 * crowded.mass


def test_crowns_lean_to_the_gap_and_only_by_light(alone):
    wall = [poplar.grow([Tree(seed=s)], poplar.SITES["wall"], 9).trees[0] for s in SEEDS]
    lean_wall = np.mean([poplar.lean(t) for t in wall])
    lean_alone = np.mean([poplar.lean(r.trees[0]) for r in alone])
    assert lean_wall > 0.15 and lean_wall > lean_alone + 0.15 and abs(lean_alone) < 0.12
    without = [poplar.grow([Tree(seed=1)], poplar.SITES[s], 9, feedback=False).trees[0] for s in ("alone", "wall", "crowd")]
    np.testing.assert_array_equal(without[0].tip, without[1].tip)
    np.testing.assert_array_equal(without[0].tip, without[2].tip)
    assert abs(np.mean([poplar.lean(poplar.grow([Tree(seed=s)], poplar.Site(), 9, feedback=False).trees[0]) for s in SEEDS])) < 0.12


def test_crowded_trees_are_slender_and_shed(alone):
    crowd = [poplar.grow([Tree(seed=s)], poplar.SITES["crowd"], 9).trees[0] for s in SEEDS]
    open_ = [r.trees[0] for r in alone]
    assert np.mean([t.height / poplar.spread(t) for t in crowd]) > 1.1 * np.mean([t.height / poplar.spread(t) for t in open_])
    assert np.mean([poplar.crown_base(t) for t in crowd]) > 1.3 * np.mean([poplar.crown_base(t) for t in open_])
    assert np.mean([shed_share(t) for t in crowd]) > 3 * np.mean([shed_share(t) for t in open_])
    young = poplar.grow([Tree(seed=1)], poplar.Site(), 4).trees[0]
    assert young.shed_branches == 0 and max(shed_share(t) for t in open_) < 0.02


def test_stands_thin_themselves():
    dense, thin = poplar.stand(25, 1.1, 13), poplar.stand(4, 1.1, 8)
    assert len(dense.trees) <= 18 and len(thin.trees) == 4
    assert thin.history[-1].mean_mass > 2 * dense.history[7].mean_mass
    # from six steps each of two stands; from three of one, as many as ten steps leave, it is anything between -.9 and -4
    assert -1.8 < poplar.slope(poplar.thinning_points([dense, poplar.stand(25, 1.1, 13, seed=2)]))[0] < -1.0
    assert len(poplar.stand(25, 1.1, 7, feedback=False).trees) == 25
    with pytest.raises(ValueError, match="count: found 5; expected a square number"):
        poplar.stand(5, 1.0, 1)


def test_slope_of_a_power_law():
    density = np.geomspace(20, 2000, 12)
    assert poplar.slope(np.column_stack([density, 1e4 * density**-1.5])) == pytest.approx((-1.5, -1.5))


# ---- maize


def test_maize_has_the_leaf_area_that_was_asked_for():
    for wanted in (0.03, 0.3, 0.65):
        mesh, organ = maize.plant_mesh(wanted)
        area = np.linalg.norm(np.cross(mesh[:, 1] - mesh[:, 0], mesh[:, 2] - mesh[:, 0]), axis=1) / 2
        assert area[organ > 0].sum() == pytest.approx(wanted, rel=1e-9)
        assert mesh[:, :, 2].min() >= 0 and set(organ.tolist()) == set(range(organ.max() + 1))


def test_a_day_of_maize_lies_between_dark_and_bright():
    day = maize.day("2025-06-19", 0.3, hours=2.0)
    assert 0 < day.carbon < maize.saturated(day)
    assert day.net.min() >= -maize.LEAF.rd - 1e-9
    assert 0.3 * day.seconds @ day.above < day.light < day.seconds @ day.above
    assert day.area.sum() == pytest.approx(4 * 0.3, rel=1e-5) and day.index == pytest.approx(2.0)
    low, high = day.height < 0.4 * day.height.max(), day.height > 0.8 * day.height.max()
    assert day.absorbed[:, high].mean() > 2 * day.absorbed[:, low].mean()
    assert day.carbon == pytest.approx(maize.turbid(day), rel=0.1)


def test_a_day_in_hours_is_a_day_in_two_hours():
    fine, coarse = maize.day("2025-06-19", 0.2, hours=1.0), maize.day("2025-06-19", 0.2, hours=2.0)
    assert coarse.carbon == pytest.approx(fine.carbon, rel=0.05)
    assert fine.seconds @ fine.above == pytest.approx(coarse.seconds @ coarse.above, rel=0.03)


def test_a_season_grows_and_levels_off():
    days = maize.season(maize.DATES[:4], hours=3.0)
    index = [d.index for d in days]
    assert all(b > a for a, b in zip(index, index[1:])) and index[-1] > 5 * index[0]
    assert days[-1].leaf_area <= maize.Growth().most_area
    dark = maize.season(maize.DATES[:2], field=maize.Field(clearness=0.05), hours=3.0)
    assert dark[1].leaf_area < days[1].leaf_area


def test_another_day_reuses_the_plant():
    found = maize.session_day(0.1, quality="draft")
    assert found["second"]["reused"].get("operators", 0) == found["first"]["made"]["operators"] > 0
    assert found["largest_difference"] < 2e-4


# ---- what the command lines write


def test_the_poplar_writes_its_figures(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["poplar.py", "--steps", "3", "--fresh", "2", "--certificate", "20", "--out", str(tmp_path)])
    poplar.main()
    found = json.loads((tmp_path / "alone.json").read_text())
    assert [h["step"] for h in found["history"]] == [0, 1, 2] and found["history"][2]["facets"] > found["history"][0]["facets"]
    assert found["certificate"]["standard"]["rmse"] < 0.05 and found["fresh_processor"] > 0
    assert [f["step"] for f in found["fresh"]] == [0, 2]
    assert (tmp_path / "poplar_light.png").read_bytes()[:4] == b"\x89PNG"


def test_the_scenarios_are_written(tmp_path, monkeypatch):
    import poplar_figures

    monkeypatch.setattr(poplar_figures, "DENSITIES", (4,))
    monkeypatch.setattr(poplar_figures, "SEEDS", (1, 2))
    found = poplar_figures.scenarios(str(tmp_path), 4)
    assert set(found["sites"]) == {f"{s}, {f}" for s in poplar.SITES for f in ("feedback", "no feedback")}
    assert found["thinning"]["feedback"]["left"] == [4, 4] and found["thinning"]["feedback"]["slope_rma"] is None


def test_the_maize_writes_its_figures(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["maize.py", "--quality", "draft", "--hours", "3", "--out", str(tmp_path)])
    maize.main()
    found = json.loads((tmp_path / "maize.json").read_text())
    assert len(found["season"]) == len(maize.DATES) and found["session"]["second"]["reused"]["operators"] > 0
    assert (tmp_path / "maize_row.png").read_bytes()[:4] == b"\x89PNG"
