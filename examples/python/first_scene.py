"""A first scene: a maize-like row crop without end, its light per leaf, an hour later, and written to a file that the viewer opens.

Run it: python3 first_scene.py
"""

import tempfile
from pathlib import Path

import numpy as np

import sunfleck

rng = np.random.default_rng(1)


def leaf(length, width, azimuth, height, pieces=8):
    """A leaf that rises and bends over, as triangles (2 * pieces, 3, 3) [m], seen from above counter-clockwise."""
    s = np.linspace(0, 1, pieces + 1)
    away, up = length * s * (1 - 0.2 * s), height + length * (0.8 * s - 0.9 * s**2)
    half = width * np.sin(np.pi * (0.15 + 0.85 * s)) / 2
    side = np.array([-np.sin(azimuth), np.cos(azimuth), 0])
    spine = np.stack([away * np.cos(azimuth), away * np.sin(azimuth), up], axis=-1)
    left, right = spine + half[:, None] * side, spine - half[:, None] * side
    one = np.stack([right[:-1], right[1:], left[1:]], axis=1)
    other = np.stack([right[:-1], left[1:], left[:-1]], axis=1)
    return np.concatenate([one, other])


# A plant of eight leaves. Every triangle has the number of its leaf: results keep these numbers.
leaves = [leaf(0.6, 0.07, i * np.pi + rng.normal(0, 0.3), 0.15 + 0.18 * i) for i in range(8)]
triangles = np.concatenate(leaves)
number = np.repeat(np.arange(8), [len(t) for t in leaves])

scene = sunfleck.Scene(bands=["PAR", "NIR"])
scene.periodic = (0, 0, 1.5, 0.8)  # two rows, 75 cm apart, repeated without end
scene.optics("leaf", reflectance={"PAR": 0.09, "NIR": 0.45}, transmittance={"PAR": 0.05, "NIR": 0.40})
scene.ground(cells=(6, 4), reflectance={"PAR": 0.12, "NIR": 0.2})
maize = scene.plant("maize", triangles, organ=number, organ_types="leaf", optics="leaf")
maize.place(position=[[x, y, 0] for x in (0.375, 1.125) for y in (0.1, 0.3, 0.5, 0.7)], turn=rng.uniform(0, 360, 8))

# Two hours of a day are solved at once: what does not depend on the light is found once.
for hour in ("09:30", "12:30"):
    scene.state(hour, duration=3600,
                sun={"latitude": 43.6, "longitude": 3.9, "time": f"2026-06-21T{hour}:00+02:00", "irradiance": {"PAR": 330, "NIR": 360}},
                sky={"model": "clear", "irradiance": {"PAR": 60, "NIR": 40}})

result = sunfleck.solve(scene, quality="standard", seed=1)
print(result)
print("rms error of a leaf's light against path tracing:", np.round(100 * result.certificate.rmse, 2), "%")

organs = result.organs
leaf_rows = organs.type == "leaf"
for i in range(8):
    light = organs.absorbed[:, leaf_rows & (organs.id == i), 0].mean(axis=1)
    print(f"leaf {i}: absorbs on average {light[0]:.2f} W of PAR at 09:30, {light[1]:.2f} W at 12:30")

absorbed = result.balance.leaves / result.balance.incident
print("fraction of PAR that the crop absorbs:", np.round(absorbed[:, 0], 3))
assert np.all(np.diff([organs.absorbed[1, leaf_rows & (organs.id == i), 0].sum() for i in (0, 3, 7)]) > 0), "the higher a leaf, the more light"

with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "maize.h5"
    result.write(file)  # python3 -m sunfleck view maize.h5
    again = sunfleck.read_result(file)
    assert np.array_equal(again.facets.absorbed, result.facets.absorbed)
