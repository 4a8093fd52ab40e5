"""A row of maize over a season: at each date the light of a day's states, photosynthesis of every leaf, and growth of leaf area by the carbon won.

python3 examples/python/maize.py --out DIR
docs/tutorials/maize.md tells the whole.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from dataclasses import dataclass
from typing import Any, Sequence

import numpy as np
from numpy.typing import NDArray

import sunfleck
from sunfleck.photosynthesis import PHOTONS_PER_JOULE, Leaf, assimilation, monsi_saeki

Array = NDArray[np.float64]

PAR_SHARE = 0.48
"""Of global radiation (McCree 1972)."""
CANOPY_ABSORPTANCE = 0.95
"""Of PAR, by a closed canopy: a twentieth goes back to the sky."""
OPTICS = {"leaf": (0.09, 0.05), "stem": (0.15, 0.0)}
LEAF = Leaf(vcmax=100, jmax=180, rd=1, alpha=0.24, theta=0.7, g0=0.01, g1=3)


@dataclass(frozen=True)
class Field:
    """Rows along y; a cell of them repeats without end."""

    row: float = 0.75  #: between rows [m]
    plant: float = 0.2  #: between plants in a row [m]
    latitude: float = 45.0
    celsius: float = 25.0
    deficit: float = 1.0  #: of vapour pressure [kPa]
    carbon_dioxide: float = 400.0  #: [umol mol^-1]
    clearness: float = 0.75  #: of a clear day's radiation
    in_cell: int = 4  #: plants, each turned otherwise


@dataclass(frozen=True)
class Growth:
    """From carbon to leaf area: what is fixed becomes dry matter, a share of it leaves."""

    dry_matter: float = 30e-6 * 0.7  #: g per umol of CO2: CH2O, less growth's respiration
    to_leaves: float = 0.35  #: share, at most: falls with the leaves' number to none
    specific_area: float = 0.022  #: leaf area per dry matter [m^2 g^-1]
    most_area: float = 0.65  #: of a plant [m^2]


@dataclass
class Day:
    """A date's canopy and what it did. m leaves of a cell's plants, s states."""

    date: str
    leaf_area: float  #: of a plant [m^2]
    index: float  #: leaf area per ground area [-]
    height: Array  #: (m,) mean, of each leaf [m]
    area: Array  #: (m,) [m^2]
    absorbed: Array  #: (s, m) photons [umol m^-2 s^-1]
    net: Array  #: (s, m) assimilation [umol m^-2 s^-1]
    seconds: Array  #: (s,) duration
    above: Array  #: (s,) photons on the horizontal above [umol m^-2 s^-1]
    ground: float  #: area of the cell [m^2]
    solve: float  #: [s]

    @property
    def carbon(self) -> float:
        """Net, of the daylight hours per ground area [umol m^-2]."""
        return float(np.einsum("s,sm,m->", self.seconds, self.net, self.area) / self.ground)

    @property
    def light(self) -> float:
        """Absorbed by leaves over the day per ground area [umol m^-2]."""
        return float(np.einsum("s,sm,m->", self.seconds, self.absorbed, self.area) / self.ground)


def sun_elevation(latitude: float, day: int, hour: float) -> float:
    """Of the sun at a solar hour [degrees]; declination by Cooper (1969, doi:10.1016/0038-092X(69)90047-4)."""
    declination, turn, phi = np.radians(23.45) * np.sin(2 * np.pi * (284 + day) / 365), np.radians(15 * (hour - 12)), np.radians(latitude)
    return float(np.degrees(np.arcsin(np.sin(phi) * np.sin(declination) + np.cos(phi) * np.cos(declination) * np.cos(turn))))


def clear_sky(elevation: float) -> float:
    """Global radiation under a clear sky [W m^-2] (Haurwitz 1945, Journal of Meteorology 2, 154-166)."""
    sine = np.sin(np.radians(elevation))
    return float(1098 * sine * np.exp(-0.059 / sine)) if sine > 0 else 0.0


def plant_mesh(leaf_area: float) -> tuple[Array, NDArray[np.int64]]:
    """A plant of so much leaf area [m^2]: (n, 3, 3) [m] and the organ of each triangle (n,): 0 the stem, then leaves from below. Leaves are
    added as it grows; a blade's width goes by a parabola of its length, a leaf's area by a bell of its rank."""
    count = int(np.clip(round(5 + 9 * np.sqrt(leaf_area / 0.65)), 5, 14))
    rank = np.arange(count)
    weight = np.exp(-(((rank - 0.6 * count) / (0.45 * count)) ** 2))  # the middle ones are the largest
    area = leaf_area * weight / weight.sum()
    height = 2.1 * (leaf_area / 0.65) ** 0.6
    triangles, organ = [], []
    s = np.linspace(0, 1, 9)
    shape = np.maximum(0.6 + 1.9 * s - 2.5 * s**2, 0.0)  # of the width, 0 at the tip
    mean_shape = 0.5 * (shape[1:] + shape[:-1]).mean()
    for k in range(count):
        at = height * (0.12 + 0.78 * (k + 1) / count)
        length = np.sqrt(area[k] / (0.09 * mean_shape))
        width = 0.09 * length * shape
        angle = np.radians(25 + 75 * s**1.2)  # from the vertical
        step = length / 8
        middle_angle = 0.5 * (angle[1:] + angle[:-1])
        out = np.concatenate([[0], np.cumsum(step * np.sin(middle_angle))])
        up = at + np.concatenate([[0], np.cumsum(step * np.cos(middle_angle))])
        turn = np.radians(180 * (k % 2) + 12 * np.sin(2.4 * k))
        away, across = np.array([np.cos(turn), np.sin(turn), 0]), np.array([-np.sin(turn), np.cos(turn), 0])
        middle = (0.01 + out)[:, None] * away + up[:, None] * np.array([0, 0, 1.0])
        left, right = middle + 0.5 * width[:, None] * across, middle - 0.5 * width[:, None] * across
        blade = [(right[i], right[i + 1], left[i]) for i in range(8)] + [(right[i + 1], left[i + 1], left[i]) for i in range(7)]
        triangles += [np.stack(t) for t in blade]
        organ += [k + 1] * len(blade)
    corner = [0.012 * np.array([np.cos(a), np.sin(a), 0]) for a in 2 * np.pi * np.arange(6) / 6]
    top = np.array([0, 0, 0.9 * height])
    for a, b in zip(corner, corner[1:] + corner[:1]):
        triangles += [np.stack([a, b, b + top]), np.stack([a, b + top, a + top])]
    organ += [0] * (len(triangles) - len(organ))
    return np.ascontiguousarray(triangles), np.asarray(organ)


def states_of(date: str, field: Field, hours: float = 1.0) -> list[dict[str, Any]]:
    """Arguments of Scene.state() for a day in equal steps: the sun in the middle of each, what comes from the sky by Spitters et al. (1986)."""
    day = int((np.datetime64(date) - np.datetime64(date[:4] + "-01-01")).astype(int)) + 1
    out = []
    for middle in np.arange(0.5 * hours, 24, hours):
        elevation = sun_elevation(field.latitude, day, middle)
        if elevation < 2:
            continue
        radiation = field.clearness * clear_sky(elevation)
        time_ = f"{date}T{int(middle):02d}:{int(round(60 * (middle % 1))):02d}:00Z"
        out.append({"name": f"{middle:04.1f} h", "duration": 3600 * hours, "sun": {"latitude": field.latitude, "longitude": 0.0, "time": time_},
                    "sky": {"model": "standard_overcast"}, "split": {"irradiance": {"PAR": PAR_SHARE * radiation}, "shortwave": radiation}})
    return out


def canopy(leaf_area: float, field: Field) -> tuple[sunfleck.Scene, Array]:
    """A cell of the field, of plants with so much leaf area, and the mean height of each organ of a plant [m]."""
    scene = sunfleck.Scene(["PAR"])
    for name, (reflectance, transmittance) in OPTICS.items():
        scene.optics(name, reflectance, transmittance)
    width, depth = field.row, field.plant * field.in_cell
    scene.periodic = (0.0, 0.0, width, depth)
    scene.ground(size=(width, depth), center=(width / 2, depth / 2), height=0.0, cells=(3, 3), reflectance=0.15)
    mesh, organ = plant_mesh(leaf_area)
    optics = {i: "leaf" if i else "stem" for i in np.unique(organ).tolist()}
    plant = scene.plant("maize", mesh, organ=organ, optics=optics)
    for k in range(field.in_cell):
        plant.place((width / 2, field.plant * (k + 0.5), 0.0), turn=17.0 + 137.5 * k)
    height = np.array([mesh[organ == i][:, :, 2].mean() for i in range(organ.max() + 1)])
    return scene, height


def day(date: str, leaf_area: float, field: Field = Field(), hours: float = 1.0, quality: str = "draft") -> Day:
    """Light and photosynthesis of a canopy over a day."""
    scene, height = canopy(leaf_area, field)
    states = states_of(date, field, hours)
    for state in states:
        scene.state(**state)
    start = time.perf_counter()
    result = sunfleck.solve(scene, quality=quality, certificate=False, seed=1, facets=False)
    seconds = time.perf_counter() - start
    organs = result.organs
    leaf = (organs.plant == "maize") & (organs.id > 0)
    absorbed = organs.absorbed[:, leaf, 0] / organs.area[leaf] * PHOTONS_PER_JOULE
    net = assimilation(np.maximum(absorbed, 0.0), field.celsius, field.carbon_dioxide, field.deficit, LEAF).assimilation
    ground = field.row * field.plant * field.in_cell
    above = np.array([s["split"]["irradiance"]["PAR"] * PHOTONS_PER_JOULE for s in states])
    return Day(date, leaf_area, leaf_area / (field.row * field.plant), height[organs.id[leaf]], organs.area[leaf], absorbed, net, result.durations, above,
               ground, seconds)


def grown(day_: Day, days: float, field: Field, growth: Growth = Growth()) -> float:
    """Leaf area of a plant after so many days like this one [m^2]: dA = carbon x dry matter x share x specific area, and the share falls as the
    plant's leaf area nears its most."""
    area = day_.leaf_area
    if day_.carbon <= 0:
        return area
    share = growth.to_leaves * max(1 - area / growth.most_area, 0.0)
    gain = day_.carbon * field.row * field.plant * days * growth.dry_matter * share * growth.specific_area
    return min(area + gain, growth.most_area)


DATES = ("2025-05-20", "2025-06-04", "2025-06-19", "2025-07-04", "2025-07-19", "2025-08-03")


def season(dates: Sequence[str] = DATES, leaf_area: float = 0.03, field: Field = Field(), growth: Growth = Growth(), hours: float = 1.0,
           quality: str = "draft", verbose: bool = False) -> list[Day]:
    """The canopy at each date, from a first leaf area per plant [m^2]."""
    days = []
    for k, date in enumerate(dates):
        days.append(day(date, leaf_area, field, hours, quality))
        if verbose:
            d = days[-1]
            print(f"{date}: leaf area index {d.index:.2f}, {d.carbon / 1e6:.3f} mol CO2 and {d.light / 1e6:.1f} mol photons m^-2 d^-1, "
                  f"closed form {turbid(d) / 1e6:.3f}, light {d.solve:.1f} s", flush=True)
        if k + 1 < len(dates):
            apart = float((np.datetime64(dates[k + 1]) - np.datetime64(date)).astype(int))
            leaf_area = grown(days[-1], apart, field, growth)
    return days


def saturated(day_: Day, field: Field = Field()) -> float:
    """What the canopy would fix if every leaf were in the brightest light of the day all day [umol m^-2 d^-1]: a bound."""
    most = float(assimilation(2500.0, field.celsius, field.carbon_dioxide, field.deficit, LEAF).assimilation)
    return most * float(day_.seconds.sum()) * day_.index


def turbid(day_: Day, field: Field = Field()) -> float:
    """The same day by Monsi and Saeki's closed form [umol m^-2]: leaves as a turbid medium that absorbs as much light as this canopy does in the
    day, c I0 (1 - exp(-K F)), where c is what a closed canopy does not throw back; and a hyperbola in the place of the leaf model, through its
    values at 200 and 1500 umol m^-2 s^-1. All leaves of a layer have the same light: no sunflecks."""
    share = min(day_.light / float(day_.seconds @ day_.above) / CANOPY_ABSORPTANCE, 0.999)
    extinction = -np.log(1 - share) / day_.index
    low, high = 200.0, 1500.0
    gross = assimilation(np.array([low, high]), field.celsius, field.carbon_dioxide, field.deficit, LEAF).assimilation + LEAF.rd
    bend, start = np.polyfit([low, high], [low / gross[0], high / gross[1]], 1)  # I / p = 1 / b + (a / b) I
    b, a = 1 / start, bend / start
    fixed = sum(seconds * monsi_saeki(b, a, extinction, CANOPY_ABSORPTANCE * above, day_.index) for seconds, above in zip(day_.seconds, day_.above))
    return float(fixed - LEAF.rd * day_.index * day_.seconds.sum())


def session_day(leaf_area: float, field: Field = Field(), first: str = "2025-06-19", other: str = "2025-08-03",
                quality: str = "standard") -> dict[str, Any]:
    """A day of 24 states on a plant already solved for another day: seconds of both solves of a session and of a fresh one, and what was reused."""
    scene, _ = canopy(leaf_area, field)
    session = sunfleck.Session(scene, method="instantiation", quality=quality, certificate=False, seed=1)
    out: dict[str, Any] = {}
    for name, date in (("first", first), ("second", other)):
        scene.no_light()
        states = states_of(date, field, 0.5)
        early = (len(states) - 24) // 2
        for state in states[early : early + 24]:
            scene.state(**state)
        start = time.process_time()
        result = session.solve(facets=False)
        out[name] = {"processor": time.process_time() - start, "reused": session.reused, "made": session.made, "timings": result.timings}
    start = time.process_time()
    fresh = sunfleck.solve(scene, method="instantiation", quality=quality, certificate=False, seed=1, facets=False)
    out["fresh"] = {"processor": time.process_time() - start, "timings": fresh.timings}
    out["largest_difference"] = float(np.abs(fresh.organs.absorbed - result.organs.absorbed).max() / fresh.organs.absorbed.max())
    return out


def draw(days: Sequence[Day], out: str) -> None:
    """Profiles of light and assimilation, and the season."""
    try:
        import matplotlib
    except ImportError:
        print("matplotlib is not installed: figures are written, plots are not")
        return
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(9, 3.6))
    for k, d in enumerate(days):
        colour = plt.cm.viridis(0.85 * k / max(len(days) - 1, 1))
        for at, values in ((axes[0], d.absorbed), (axes[1], d.net)):
            of_day = 1e-6 * np.einsum("s,sm->m", d.seconds, values)
            height = np.unique(np.round(d.height, 6))
            mean = [np.average(of_day[np.isclose(d.height, h)], weights=d.area[np.isclose(d.height, h)]) for h in height]
            at.plot(mean, height, ".-", color=colour)
            at.annotate(d.date[5:], (mean[-1], height[-1]), xytext=(-8, 4), textcoords="offset points", fontsize=6, color=colour)
    for at in axes[:2]:
        at.margins(y=0.1)
    axes[0].set_xlabel("absorbed PAR [mol m$^{-2}$ d$^{-1}$]", fontsize=8)
    axes[1].set_xlabel("net assimilation [mol m$^{-2}$ d$^{-1}$]", fontsize=8)
    axes[0].set_ylabel("height of the leaf [m]", fontsize=8)
    x = np.arange(len(days))
    axes[2].plot(x, [d.carbon / 1e6 for d in days], "o-", label="canopy, each leaf in its light")
    axes[2].plot(x, [turbid(d) / 1e6 for d in days], "s--", label="Monsi-Saeki, same absorbed light")
    axes[2].plot(x, [d.index / 10 for d in days], "^:", color="#888888", label="leaf area index / 10")
    axes[2].set_xticks(x, [d.date[5:] for d in days], rotation=45)
    axes[2].set_ylabel("mol CO$_2$ m$^{-2}$ of ground d$^{-1}$", fontsize=8)
    axes[2].legend(fontsize=7)
    for at in axes:
        at.tick_params(labelsize=7)
    figure.tight_layout()
    figure.savefig(os.path.join(out, "maize_season.png"), dpi=90)


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("--out", required=True, help="folder for figures (JSON) and pictures")
    parser.add_argument("--hours", type=float, default=1.0, help="length of a day's states (1)")
    parser.add_argument("--quality", default="standard", choices=("draft", "standard", "fine"))
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    days = season(hours=arguments.hours, quality=arguments.quality, verbose=True)
    draw(days, arguments.out)
    found = {"season": [{"date": d.date, "index": d.index, "mol_co2": d.carbon / 1e6, "mol_photons": d.light / 1e6, "turbid": turbid(d) / 1e6,
                         "seconds": d.solve} for d in days], "session": session_day(days[-1].leaf_area, quality=arguments.quality)}
    print(json.dumps(found["session"], indent=1))
    with open(os.path.join(arguments.out, "maize.json"), "w", encoding="utf-8") as file:
        json.dump(found, file, indent=1)
    scene, _ = canopy(days[-1].leaf_area, Field())
    scene.state(**states_of(days[-1].date, Field())[8])
    with open(os.path.join(arguments.out, "maize_row.png"), "wb") as file:
        file.write(sunfleck.solve(scene, quality="draft", certificate=False, seed=1).png(width=560, height=420))


if __name__ == "__main__":
    main()
