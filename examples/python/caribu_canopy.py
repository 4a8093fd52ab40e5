"""A script of CARIBU's with only its import changed: a canopy of a hundred plants, light per plant and leaf, against path tracing.

Run it: python3 caribu_canopy.py
"""

import math
import random

from sunfleck.caribu.CaribuScene import CaribuScene  # before: from alinea.caribu.CaribuScene import CaribuScene


def leaf(x, y, azimuth, height, length=20.0, width=3.0, pieces=6):
    """A bent leaf as a list of triangles, lists of three points [cm]."""
    edge = []
    for i in range(pieces + 1):
        s = i / pieces
        away, up, half = length * s, height + length * (0.9 * s - 0.8 * s * s), width / 2 * math.sin(math.pi * (0.1 + 0.9 * s))
        cx, cy = x + away * math.cos(azimuth), y + away * math.sin(azimuth)
        edge.append(((cx + half * math.sin(azimuth), cy - half * math.cos(azimuth), up), (cx - half * math.sin(azimuth), cy + half * math.cos(azimuth), up)))
    triangles = []
    for (a, b), (c, d) in zip(edge, edge[1:]):
        triangles += [[a, c, d], [a, d, b]]
    return triangles


random.seed(3)
scene = {}
for plant in range(100):
    x, y, turn = 10 * (plant % 10) + 5, 10 * (plant // 10) + 5, random.uniform(0, 2 * math.pi)
    for i in range(5):
        scene[100 * plant + i] = leaf(x, y, turn + i * math.pi + random.gauss(0, 0.3), 8 + 7 * i)

light = [(300, (0.3, 0.2, -0.9))] + [(20, (math.cos(a), math.sin(a), -0.6)) for a in (0, 1.26, 2.51, 3.77, 5.03)] + [(40, (0, 0, -1))]
opt = {"par": (0.10, 0.05), "nir": (0.45, 0.42)}
canopy = CaribuScene(scene, light=light, pattern=(0, 0, 100, 100), opt=opt, soil_reflectance={"par": 0.15, "nir": 0.25}, soil_mesh=1, scene_unit="cm")
raw, aggregated = canopy.run(direct=False, infinite=True, split_face=True)

for band in opt:
    light_of = aggregated[band]
    absorbed = sum(light_of["Eabs"][k] * light_of["area"][k] for k in scene)
    print(f"{band}: {absorbed / canopy.getIncidentEnergy()[2]:.3f} of the light is absorbed, soil gets {canopy.soil_aggregated[band]['Ei']:.1f}")
top, bottom = (sum(aggregated["par"]["Ei"][k] for k in scene if k % 100 == i) / 100 for i in (4, 0))
print(f"mean PAR on leaves: {top:.0f} at the top, {bottom:.0f} at the bottom")

# ---- what CARIBU cannot say of itself: how far this is from path tracing of the same scene, and what the certificate says of it
canopy.solve_options = {"certificate": True}
_, solved = canopy.run(direct=False, infinite=True)
certificate = canopy.result.certificate
canopy.solve_options = {"method": "reference", "samples": 64}
_, traced = canopy.run(direct=False, infinite=True)
noise = canopy.result.organs.variance.sum(axis=0)  # of the traced light of each leaf, over all lights [W^2]
for b, band in enumerate(opt):
    area = [solved[band]["area"][k] for k in scene]
    mean = sum(traced[band]["Eabs"][k] * a for k, a in zip(scene, area)) / sum(area)
    square = sum(a * (solved[band]["Eabs"][k] - traced[band]["Eabs"][k]) ** 2 - noise[i, b] / a for i, (k, a) in enumerate(zip(scene, area)))
    error = math.sqrt(max(0.0, square / sum(area))) / mean
    print(f"{band}: {100 * error:.2f} % rms from path tracing; the certificate says {100 * certificate.rmse[b]:.2f} %, at most {100 * certificate.rmse_high[b]:.2f} %")
    assert error < max(certificate.rmse_high[b], 0.01)
