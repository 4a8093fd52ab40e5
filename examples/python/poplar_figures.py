"""Figures and pictures of the poplar: what poplar.py writes."""

from __future__ import annotations

import os
import time
from dataclasses import asdict
from typing import Any

import numpy as np
import poplar
from branching import Array, Rules, Tree

import sunfleck

DENSITIES = (100, 64, 36, 16, 9, 4)
"""Trees that a stand begins with, in a cell of STAND_SIDE metres."""
STAND_SIDE = 2.5
SEEDS = (1, 2, 3, 4, 5, 6)


def plots() -> Any:
    """matplotlib.pyplot without a window, or None where it is not installed."""
    try:
        import matplotlib
    except ImportError:
        print("matplotlib is not installed: figures are written, plots are not")
        return None
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    return plt


def draw_tree(axes: Any, tree: Tree, light: Array | None, title: str) -> None:
    """A tree from the south: twigs as lines, leaves as triangles in the colour of their relative light, near ones over far ones."""
    from matplotlib.collections import LineCollection, PolyCollection

    order = np.argsort(-tree.tip[:, 1])
    lines = np.stack([tree.base[order][:, (0, 2)], tree.tip[order][:, (0, 2)]], axis=1)
    axes.add_collection(LineCollection(lines, colors="#5b4636", zorder=1, linewidths=0.15 + 50 * tree.radius()[order]))
    triangles, rows = tree.leaves()
    nearer = np.argsort(-triangles[:, :, 1].mean(axis=1))
    faces = PolyCollection(triangles[nearer][:, :, (0, 2)], linewidths=0, zorder=2)
    if light is None:
        faces.set_facecolor("#6b9f4d")
    else:
        faces.set_array(light[rows[nearer]])
        faces.set_cmap("viridis")
        faces.set_clim(0, 1)
    axes.add_collection(faces)
    axes.set_title(title, fontsize=9)
    axes.set_aspect("equal")
    axes.set_xlabel("m", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.autoscale_view()


def long_run(out: str, steps: int, seed: int, fresh_every: int, certificate_organs: int) -> dict[str, Any]:
    """One tree alone, draft light in each step; the last one again at standard quality, with a certificate. Where fresh_every is given, each so
    many-th step is also solved as a user would at once, sunfleck.solve(scene); between them the sum over all steps is interpolated."""
    site, rules = poplar.Site(), Rules()
    tree, history = Tree(rules, seed), []
    fresh: list[dict[str, Any]] = []
    for step in range(steps):
        run = poplar.grow([tree], site, 1, verbose=False)
        row = run.history[0]
        row.step = step
        history.append(row)
        print(f"step {step:2d}: {row.facets} facets, height {row.height:.2f} m, mean light {row.mean_light:.2f}, {row.seconds:.2f} s, "
              f"{row.processor:.2f} s of processor", flush=True)
        if fresh_every and step % fresh_every == 0:
            scene, facets = poplar.scene_of([tree], site)
            start, used = time.perf_counter(), time.process_time()
            result = sunfleck.solve(scene)
            fresh.append({"step": step, "facets": facets, "seconds": time.perf_counter() - start, "processor": time.process_time() - used,
                          "method": result.method})
            print(f"         fresh: {fresh[-1]}", flush=True)
    scene, facets = poplar.scene_of([tree], site)
    found: dict[str, Any] = {"history": [asdict(h) for h in history], "tree": poplar.describe(tree), "fresh": fresh}
    checked: dict[str, Any] = {}
    for quality in ("draft", "standard"):
        start, used = time.perf_counter(), time.process_time()
        result = sunfleck.solve(scene, quality=quality, seed=1, certificate=True, certificate_organs=certificate_organs, facets=quality == "standard")
        c = result.certificate
        checked[quality] = {"facets": facets, "seconds": time.perf_counter() - start, "processor": time.process_time() - used, "method": result.method,
                            "rmse": float(c.rmse[0]), "rmse_low": float(c.rmse_low[0]), "rmse_high": float(c.rmse_high[0]), "bias": float(c.bias[0])} if c else {}
        print(quality, checked[quality], flush=True)
    found["certificate"] = checked
    found["light_seconds"] = sum(h.seconds for h in history) + checked["standard"]["seconds"]
    found["light_processor"] = sum(h.processor for h in history) + checked["standard"]["processor"]
    if fresh:
        at = [f["step"] for f in fresh] + [steps - 1] * (fresh[-1]["step"] < steps - 1)
        for key in ("seconds", "processor"):
            values = [f[key] for f in fresh] + [checked["standard"][key]] * (len(at) - len(fresh))
            found[f"fresh_{key}"] = float(np.interp(np.arange(steps), at, values).sum())
    with open(os.path.join(out, "poplar_light.png"), "wb") as file:
        file.write(result.png(width=360, height=480))
    plt = plots()
    if plt:
        figure, (left, right) = plt.subplots(1, 2, figsize=(7.5, 4.5))
        draw_tree(left, tree, poplar.light_of([tree], site).relative[0], f"after {steps} steps")
        right.semilogy([h.facets for h in history], label="facets")
        right.semilogy([max(h.processor, 1e-3) for h in history], label="processor time of light [s]")
        right.semilogy([h.mean_mass for h in history], label="mass [kg]")
        right.set_xlabel("step")
        right.legend(fontsize=8)
        figure.tight_layout()
        figure.savefig(os.path.join(out, "poplar_alone.png"), dpi=90)
    return found


def scenarios(out: str, steps: int) -> dict[str, Any]:
    """Trees at all sites and stands over densities, each with and without the feedback of light."""
    found: dict[str, Any] = {"steps": steps, "sites": {}, "thinning": {}}
    shown = {}
    for name in poplar.SITES:
        for feedback in (True, False):
            key = f"{name}, {'feedback' if feedback else 'no feedback'}"
            found["sites"][key], shown[key] = poplar.scenario(name, min(steps, 12), SEEDS, feedback)
            print(key, {k: round(v, 3) for k, v in found["sites"][key].items()}, flush=True)
    points: dict[str, list[list[tuple[float, float]]]] = {}
    for feedback in (True, False):
        key = "feedback" if feedback else "no feedback"
        runs = [poplar.stand(n, STAND_SIDE, steps if feedback else min(steps, 8), seed, feedback) for n in DENSITIES for seed in SEEDS[:2]]
        points[key] = [[(h.trees / STAND_SIDE**2, h.mean_mass) for h in run.history] for run in runs]
        thin = poplar.thinning_points(runs)
        both = poplar.slope(thin) if len(thin) > 2 else (None, None)
        found["thinning"][key] = {"points": len(thin), "slope_rma": both[0], "slope_ols": both[1], "left": [len(run.trees) for run in runs],
                                  "stands": points[key]}
        print("thinning,", key, {k: v for k, v in found["thinning"][key].items() if k != "stands"}, flush=True)
    plt = plots()
    if plt:
        _draw_sites(plt, shown, os.path.join(out, "poplar_sites.png"))
        _draw_thinning(plt, points, found["thinning"]["feedback"]["slope_rma"], os.path.join(out, "poplar_thinning.png"))
    return found


def _draw_sites(plt: Any, shown: dict[str, Tree], file: str) -> None:
    names = [f"{name}, feedback" for name in poplar.SITES] + ["alone, no feedback"]
    figure, axes = plt.subplots(1, len(names), figsize=(7, 6), sharey=True)
    titles = ("alone", "wall in the west", "in a crowd", "no feedback, all sites")
    for at, name, title in zip(axes, names, titles):
        tree = shown[name]
        site = poplar.SITES[name.split(",")[0]]
        draw_tree(at, tree, poplar.light_of([tree], site).relative[0] if "no" not in name else None, title)
        at.set_xlim(-1.3, 1.3)
    wall = poplar.SITES["wall"].wall
    if wall:
        axes[1].add_patch(plt.Rectangle((-1.3, 0), 1.3 - wall[0], wall[1], color="#333333"))
    axes[0].set_ylabel("m")
    figure.tight_layout(w_pad=0.2)
    figure.savefig(file, dpi=100)


def _draw_thinning(plt: Any, points: dict[str, list[list[tuple[float, float]]]], slope: float | None, file: str) -> None:
    figure, axes = plt.subplots(figsize=(5, 4))
    for key, style in (("feedback", "o-"), ("no feedback", "x:")):
        for k, run in enumerate(points[key]):
            density, mass = np.asarray(run).T
            axes.loglog(density, mass, style, ms=3, lw=0.8, color="#2a7f62" if key == "feedback" else "#999999", label=key if k == 0 else None)
    if slope is not None:
        x = np.array([1.0, 16.0])
        axes.loglog(x, 4.0 * x**-1.5, "k--", lw=1, label="slope -3/2")
        axes.set_title(f"slope where stands thin: {slope:.2f}", fontsize=9)
    axes.set_xlabel("trees m$^{-2}$")
    axes.set_ylabel("mean mass [kg]")
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(file, dpi=90)
