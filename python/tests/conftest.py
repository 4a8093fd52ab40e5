import numpy as np
import pytest

import sunfleck

PER_BAND = {"PAR": 400.0, "NIR": 450.0}


def leaves(count, size=0.05, seed=1, height=1.0):
    """Random triangles in the unit square, (count, 3, 3) [m]."""
    rng = np.random.default_rng(seed)
    centre = rng.random((count, 1, 3)) * (1, 1, height)
    return np.ascontiguousarray(centre + size * rng.normal(size=(count, 3, 3)) * 0.5)


def new_scene(sky=True):
    scene = sunfleck.Scene(bands=["PAR", "NIR"])
    scene.periodic = (0, 0, 1, 1)
    scene.sun(direction=(0, 0, 1), irradiance=PER_BAND, angular_diameter=0)
    if sky:
        scene.sky("standard_overcast", irradiance={"PAR": 100, "NIR": 80})
    scene.optics("leaf", reflectance={"PAR": 0.09, "NIR": 0.45}, transmittance={"PAR": 0.05, "NIR": 0.40})
    return scene


@pytest.fixture
def scene():
    """A leaf over a ground that fills a periodic cell."""
    out = new_scene()
    out.ground(size=(1, 1), center=(0.5, 0.5), height=0, cells=(4, 4), reflectance={"PAR": 0.12, "NIR": 0.2})
    plant = out.plant("leaves", leaves(40), optics="leaf", organ=np.arange(40) // 2)
    plant.place(position=(0, 0, 0), turn=0, scale=1)
    return out


QUICK = {"quality": "draft", "certificate": False, "seed": 1}
