"""A poplar that grows by the light its leaves absorb: alone, beside a wall, in a crowd, and stands that thin themselves.

python3 examples/python/poplar.py --steps 38 --out DIR      the tree alone, with a certificate at the last step
python3 examples/python/poplar.py --scenarios --out DIR     all comparisons, with and without the feedback of light
The rule of growth is in branching.py; docs/tutorials/poplar.md tells the whole.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from dataclasses import dataclass, field
from typing import Any, Sequence

import numpy as np
from branching import Array, Rules, Tree

import sunfleck

SKY = 400.0
"""PAR of an overcast sky on the horizontal [W m^-2]; relative light does not depend on it."""
OPTICS = {"leaf": (0.09, 0.05), "bark": (0.2, 0.0)}
"""Reflectance and transmittance."""
NO_FEEDBACK = 0.65
"""Relative light that every leaf is given in the model without feedback, about the mean of a tree alone: the same for all, whatever stands around."""


@dataclass
class Site:
    """Where trees grow. cell: sides of the cell that repeats without end [m]; wall: distance to the west and height [m] of a black wall."""

    cell: tuple[float, float] | None = None
    wall: tuple[float, float] | None = None
    quality: str = "draft"


@dataclass
class Light:
    """Relative light of the leaf of each metamer (0 without a leaf) per tree, and what finding it took [s], also of all threads together."""

    relative: list[Array]
    seconds: float = 0.0
    processor: float = 0.0
    result: Any = None
    facets: int = 0


def scene_of(trees: Sequence[Tree], site: Site) -> tuple[sunfleck.Scene, int]:
    """The scene and its number of facets. The leaf of the metamer with id i is organ 2 i, its internode 2 i + 1."""
    scene = sunfleck.Scene(["PAR"])
    scene.sky("standard_overcast", SKY)
    for name, (reflectance, transmittance) in OPTICS.items():
        scene.optics(name, reflectance, transmittance)
    facets = 0
    for k, tree in enumerate(trees):
        (leaves, of_leaf), (wood, of_wood) = tree.leaves(), tree.wood()
        organ = np.concatenate([2 * tree.id[of_leaf], 2 * tree.id[of_wood] + 1])
        optics = {i: "bark" if i % 2 else "leaf" for i in np.unique(organ).tolist()}
        plant = scene.plant(f"poplar{k}", np.concatenate([leaves, wood]), organ=organ, optics=optics)
        plant.place((*tree.position, 0.0))
        facets += len(organ)
    if site.cell is not None:
        scene.periodic = (0.0, 0.0, *site.cell)
    if site.wall is not None:
        scene.optics("black", 0.0)
        x, height = -site.wall[0], site.wall[1]
        y = np.linspace(-1.5 * height, 1.5 * height, 13)
        z = np.linspace(0.0, height, 9)
        low = [[(x, a, c), (x, b, c), (x, b, d)] for a, b in zip(y, y[1:]) for c, d in zip(z, z[1:])]
        high = [[(x, a, c), (x, b, d), (x, a, d)] for a, b in zip(y, y[1:]) for c, d in zip(z, z[1:])]
        scene.plant("wall", np.asarray(low + high), optics="black").place()
        facets += 2 * len(low)
    return scene, facets


def light_of(trees: Sequence[Tree], site: Site, **settings: Any) -> Light:
    """Solves a scene of the trees. A leaf's relative light is what it absorbs over what one that lies under the open sky absorbs."""
    scene, facets = scene_of(trees, site)
    settings = {"quality": site.quality, "certificate": False, "seed": 1, **settings}
    start, used = time.perf_counter(), time.process_time()
    result = sunfleck.solve(scene, facets=False, **settings)
    light = Light([], time.perf_counter() - start, time.process_time() - used, result, facets)
    full = SKY * (1 - sum(OPTICS["leaf"]))
    organs = result.organs
    per_area, plant, identity = organs.absorbed[0, :, 0] / organs.area, organs.plant, organs.id
    for k, tree in enumerate(trees):
        relative = np.zeros(len(tree))
        here = (plant == f"poplar{k}") & (identity % 2 == 0)
        order = np.argsort(tree.id)
        relative[order[np.searchsorted(tree.id[order], identity[here] // 2)]] = per_area[here] / full
        light.relative.append(relative)
    return light


@dataclass
class Step:
    """What a step began with: a row of the history."""

    step: int
    trees: int
    facets: int
    mean_mass: float
    leaf_area: float
    height: float
    mean_light: float
    seconds: float
    processor: float


@dataclass
class Run:
    """Trees that are alive at the end, and how they came there."""

    trees: list[Tree]
    site: Site
    feedback: bool
    history: list[Step] = field(default_factory=list)


def grow(trees: Sequence[Tree], site: Site, steps: int, feedback: bool = True, verbose: bool = False) -> Run:
    """Grows trees together. Without feedback all leaves have the same light, whatever is solved: nothing is."""
    run = Run(list(trees), site, feedback)
    for step in range(steps):
        if not run.trees:
            break
        light = light_of(run.trees, site) if feedback else Light([np.full(len(t), NO_FEEDBACK) for t in run.trees])
        leafy = np.concatenate([q[t.leafy] for t, q in zip(run.trees, light.relative)])
        run.history.append(Step(step, len(run.trees), light.facets, float(np.mean([t.mass for t in run.trees])), sum(t.leaf_area for t in run.trees),
                                max(t.height for t in run.trees), float(leafy.mean()), light.seconds, light.processor))
        if verbose:
            h = run.history[-1]
            print(f"step {step:2d}: {h.trees} tree(s), {h.facets} facets, height {h.height:.2f} m, mass {h.mean_mass:.3f} kg, mean light {h.mean_light:.2f}, "
                  f"{h.seconds:.2f} s ({h.processor:.2f} s of processor)", flush=True)
        for tree, q in zip(run.trees, light.relative):
            tree.grow(q)
        run.trees = [t for t in run.trees if t.alive]
    return run


# ---- what is compared


def lean(tree: Tree) -> float:
    """Mean place of the leaves east of the stem at their height, over their rms distance from it [-]; 0 is symmetric."""
    at, stem = tree.tip[tree.leafy], tree.tip[tree.stem()]
    from_stem = at[:, :2] - np.column_stack([np.interp(at[:, 2], stem[:, 2], stem[:, k]) for k in range(2)])
    return float(from_stem[:, 0].mean() / np.sqrt((from_stem**2).sum(axis=1).mean()))


def spread(tree: Tree) -> float:
    """Diameter of a disc with the leaves' rms distance from the axis of the crown [m]."""
    at = tree.tip[tree.leafy][:, :2]
    return float(2 * np.sqrt(2 * ((at - at.mean(axis=0)) ** 2).sum(axis=1).mean()))


def crown_base(tree: Tree) -> float:
    """Height under which a tenth of the leaves is, over the tree's [-]."""
    return float(np.quantile(tree.tip[tree.leafy][:, 2], 0.1) / tree.height)


def describe(tree: Tree) -> dict[str, float]:
    """The figures that scenarios are compared by."""
    return {"height": tree.height, "spread": spread(tree), "slenderness": tree.height / spread(tree), "crown_base": crown_base(tree), "lean": lean(tree),
            "leaf_area": tree.leaf_area, "mass": tree.mass, "shed_branches": tree.shed_branches}


SITES = {"alone": Site(), "wall": Site(wall=(0.8, 5.0)), "crowd": Site(cell=(1.2, 1.2))}


def scenario(name: str, steps: int, seeds: Sequence[int] = (1, 2, 3), feedback: bool = True, rules: Rules = Rules()) -> tuple[dict[str, float], Tree]:
    """Means of describe() over trees that grew at one of SITES, and the first of these."""
    trees = [grow([Tree(rules, seed)], SITES[name], steps, feedback).trees[0] for seed in seeds]
    rows = [describe(t) for t in trees]
    return {key: float(np.mean([r[key] for r in rows])) for key in rows[0]}, trees[0]


def stand(count: int, side: float, steps: int, seed: int = 1, feedback: bool = True, rules: Rules = Rules()) -> Run:
    """count trees, a square number, in a cell of so many metres that repeats without end, each in its part of a grid, at random."""
    rows = round(count**0.5)
    if rows * rows != count:
        raise ValueError(f"count: found {count}; expected a square number")
    random, step = np.random.default_rng(seed), side / rows
    at = [((i + 0.5 + random.uniform(-0.3, 0.3)) * step, (j + 0.5 + random.uniform(-0.3, 0.3)) * step) for i in range(rows) for j in range(rows)]
    return grow([Tree(rules, 1000 * seed + k, p) for k, p in enumerate(at)], Site(cell=(side, side)), steps, feedback)


def thinning_points(runs: Sequence[Run], lost: float = 0.15, fewest: int = 3) -> Array:
    """Density [m^-2] and mean mass [kg] of stands while they thin: (k, 2) from steps at which a share `lost` of the trees is dead and so many
    are left that their number says something."""
    points = []
    for run in runs:
        area = run.site.cell[0] * run.site.cell[1] if run.site.cell else 1.0
        points += [(h.trees / area, h.mean_mass) for h in run.history if h.trees <= (1 - lost) * run.history[0].trees and h.trees >= fewest]
    return np.asarray(points).reshape(-1, 2)


def slope(points: Array) -> tuple[float, float]:
    """Of log mass over log density: reduced major axis, for neither is the cause, and least squares; -3/2 by Yoda et al. (1963)."""
    x, y = np.log(points).T
    return float(np.sign(np.corrcoef(x, y)[0, 1]) * y.std() / x.std()), float(np.polyfit(x, y, 1)[0])


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0], formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=38, help="steps of growth (38)")
    parser.add_argument("--seed", type=int, default=1, help="of the tree (1)")
    parser.add_argument("--out", required=True, help="folder for figures (JSON) and pictures")
    parser.add_argument("--scenarios", action="store_true", help="compare alone, wall, crowd and stands instead of growing one tree long")
    parser.add_argument("--fresh", type=int, default=0, metavar="K", help="beside it solve every K-th step at default settings, to compare the time")
    parser.add_argument("--certificate", type=int, default=400, metavar="ORGANS", help="organs that the last step's certificate path-traces (400)")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    import poplar_figures

    found = poplar_figures.scenarios(arguments.out, min(arguments.steps, 18)) if arguments.scenarios else poplar_figures.long_run(
        arguments.out, arguments.steps, arguments.seed, arguments.fresh, arguments.certificate)
    with open(os.path.join(arguments.out, "scenarios.json" if arguments.scenarios else "alone.json"), "w", encoding="utf-8") as file:
        json.dump(found, file, indent=1)


if __name__ == "__main__":
    main()
