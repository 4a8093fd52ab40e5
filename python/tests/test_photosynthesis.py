import numpy as np
import pytest

import sunfleck
from sunfleck.photosynthesis import (Leaf, arrhenius, assimilation, compensation, day_sine, electrons, monsi_saeki, peaked)

TABLE = {0: -1.0, 100: 2.9532, 400: 12.1491, 800: 19.1463, 1600: 24.2791, 2000: 24.7477}
LEAF = Leaf(vcmax=100, jmax=180, rd=1, alpha=0.24, theta=0.7, g0=0.01, g1=3)


def test_the_table_to_its_digits():
    found = assimilation(list(TABLE), 25, 400, 1.0, LEAF)
    np.testing.assert_allclose(found.assimilation, list(TABLE.values()), atol=5e-5)
    assert found.limit.tolist() == ["dark", "J", "J", "J", "J", "V"]
    np.testing.assert_allclose(found.inside, 400 - found.assimilation / found.conductance)
    medlyn = 0.01 + (1 + 3 / 1.0**0.5) * found.assimilation[1:] / 400
    np.testing.assert_allclose(found.conductance[1:], medlyn)


def test_constants():
    assert compensation(28) == pytest.approx(49.76935360, abs=5e-6)
    assert peaked(250, 29680, 28 + 273.15, 200000, 631.88) == pytest.approx(278.5161762, abs=5e-6)
    assert electrons(1500, 250, 0.425, 0.7) == pytest.approx(216.5715753, abs=5e-7)
    assert arrhenius(3.0, 1e5, 298.15) == pytest.approx(3.0)


def test_limits_are_consistent_with_their_equations():
    """Each limit's A and Ci, by bisection on the supply A = g (Cs - Ci), without the quadratic."""
    for q, celsius in ((150, 15), (900, 32), (2000, 25)):
        found = assimilation(q, celsius, 380, 1.4, LEAF)
        low, high = 1.0, 380.0
        t = celsius + 273.15
        km = arrhenius(404.9, 79430, t) * (1 + 210 / arrhenius(278.4, 36380, t))
        vc, j = peaked(100, 58550, t, 200000, 629.26), electrons(q, peaked(180, 29680, t, 200000, 631.88), 0.24, 0.7)
        g = compensation(celsius)

        def net(ci):
            return min(vc * (ci - g) / (ci + km), j / 4 * (ci - g) / (ci + 2 * g)) - arrhenius(1, 46390, t)

        for _ in range(80):
            ci = (low + high) / 2
            a = net(ci)
            supply = (0.01 + (1 + 3 / 1.4**0.5) * a / 380) * (380 - ci)
            low, high = (low, ci) if a > supply else (ci, high)
        assert found.assimilation == pytest.approx(net(ci), rel=1e-6)


def test_shapes_and_errors():
    assert assimilation(np.full((2, 3), 500.0), np.array([20, 25, 30])).assimilation.shape == (2, 3)
    with pytest.raises(ValueError, match="absorbed: found -1"):
        assimilation([-1.0, 5])


def test_closed_forms():
    assert monsi_saeki(0.05, 0.002, 0.5, 1000, 4) == pytest.approx(28.310958, abs=5e-7)
    layer = (np.arange(400000) + 0.5) / 100000
    light = 0.5 * 1000 * np.exp(-0.5 * layer)
    assert monsi_saeki(0.05, 0.002, 0.5, 1000, 4) == pytest.approx(np.mean(0.05 * light / (1 + 0.002 * light)) * 4, rel=1e-8)
    assert day_sine(45, 23.45) == pytest.approx(8.806449, abs=5e-7)


def test_canopy_photosynthesis_of_a_turbid_canopy():
    """Small black leaves at random, all of one inclination and any azimuth, under a sun from the zenith: by path tracing and clustering, leaves
    at a leaf area l below the top get K I0 exp(-K l), K the cosine of their inclination. Photosynthesis is of facets' light on average over a
    layer, as the closed form's is; the layers are thin."""
    count, area_index, k, light = 100_000, 2.0, 0.5, 1000.0
    rng = np.random.default_rng(7)
    # an equilateral triangle whose normal leans by 60 degrees
    side = np.sqrt(4 * area_index / count / np.sqrt(3))
    corner = side / np.sqrt(3) * np.array([[np.cos(a), np.sin(a), 0] for a in np.radians([90, 210, 330])])
    azimuth, tilt = rng.uniform(0, 2 * np.pi, count), np.arccos(k)
    c, s, zero, one = np.cos(azimuth), np.sin(azimuth), np.zeros(count), np.ones(count)
    about = np.stack([np.stack([c, -s, zero], -1), np.stack([s, c, zero], -1), np.stack([zero, zero, one], -1)], 1)
    lean = np.array([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]])
    depth = (rng.permutation(count) + rng.random(count)) / count  # the share of leaf area that is above
    centre = np.stack([rng.random(count), rng.random(count), 10 * (1 - depth)], -1)
    triangles = np.einsum("nij,kj->nki", about @ lean, corner) + centre[:, None]
    scene = sunfleck.Scene(bands=["PAR"], units={"PAR": "umol m^-2 s^-1"})
    scene.periodic = (0, 0, 1, 1)
    scene.sun((0, 0, 1), light, angular_diameter=0)
    scene.optics("black", reflectance=0)
    scene.plant("canopy", np.ascontiguousarray(triangles), optics="black").place()
    result = sunfleck.solve(scene, method="direct", quality="fine", certificate=False)
    absorbed = result.facets.absorbed[0, :, 0].astype(float)
    layer = np.minimum((depth * 50).astype(int), 49)
    mean = np.bincount(layer, absorbed, 50) / np.bincount(layer, minlength=50)
    b, a = 0.05, 0.002
    found = np.mean(b * mean / (1 + a * mean)) * area_index
    assert found == pytest.approx(monsi_saeki(b, a, k, light, area_index), rel=1e-3)
