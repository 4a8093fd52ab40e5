import numpy as np
import pytest
from conftest import leaves, new_scene

import sunfleck

SETTINGS = {"quality": "draft", "method": "instantiation", "certificate": False}


def stand():
    """Three copies of one plant and two of another."""
    scene = new_scene()
    scene.periodic = None
    small = scene.plant("small", leaves(40, 0.2, seed=3), optics="leaf", organ=np.arange(40))
    large = scene.plant("large", leaves(60, 0.2, seed=4), optics="leaf", organ=np.arange(60))
    small.place(position=[[3, 0, 0], [6, 0, 0], [9, 0, 0]])
    large.place(position=[[3, 5, 0], [6, 5, 0]])
    return scene, small, large


def same(session_result, fresh):
    np.testing.assert_allclose(session_result.organs.absorbed, fresh.organs.absorbed, rtol=2e-4, atol=1e-5 * fresh.organs.absorbed.max())


def test_what_did_not_change_is_not_computed_again():
    scene, small, large = stand()
    session = sunfleck.Session(scene, **SETTINGS)
    first = session.solve()
    assert "solution" not in session.reused and session.made["operators"] > 0
    all_made = session.made["operators"]
    again = session.solve()
    assert session.reused["solution"] == 1 and session.saved_seconds > 0
    np.testing.assert_array_equal(again.facets.absorbed, first.facets.absorbed)

    scene.sun((0.3, 0.2, 0.9), irradiance={"PAR": 300, "NIR": 200})
    lit = session.solve()
    assert session.reused["operators"] == all_made and session.made.get("operators", 0) == 0
    same(lit, sunfleck.solve(scene, **SETTINGS))

    small.reshape(leaves(44, 0.2, seed=5), optics="leaf", organ=np.arange(44))
    grown = session.solve()
    assert session.reused["operators"] == session.made["operators"] == all_made // 2  # those of the other plant
    same(grown, sunfleck.solve(scene, **SETTINGS))

    large.clear()
    large.place(position=[[3, 4, 0], [6, 6, 0]], turn=20)
    moved = session.solve()
    assert session.reused["operators"] == all_made
    same(moved, sunfleck.solve(scene, **SETTINGS))


def test_a_folder_keeps_operators_for_later_sessions(tmp_path):
    scene, _, _ = stand()
    earlier = sunfleck.Session(scene, folder=tmp_path, **SETTINGS)
    first = earlier.solve()
    later = sunfleck.Session(scene, folder=tmp_path, **SETTINGS)
    np.testing.assert_array_equal(later.solve().facets.absorbed, first.facets.absorbed)
    assert later.reused["operators_read"] == earlier.made["operators"]


def test_an_error_leaves_the_session_usable():
    scene, small, _ = stand()
    session = sunfleck.Session(scene, **SETTINGS)
    session.solve()

    def stop(*_):
        raise RuntimeError("enough")

    scene.sun((0, 0.1, 1), irradiance={"PAR": 1, "NIR": 2})
    with pytest.raises(RuntimeError, match="enough"):
        session.solve(progress=stop)
    same(session.solve(), sunfleck.solve(scene, **SETTINGS))
    with pytest.raises(ValueError, match="memory: found -1"):
        sunfleck.Session(scene, memory=-1)


def test_views_of_sky_and_ground():
    scene = sunfleck.Scene(bands=["PAR"])
    scene.sky("uniform", 100)
    scene.optics("black", reflectance=0)
    scene.plant("leaf", np.array([[[0.0, 0, 1], [1, 0, 1], [0, 1, 1]]]), optics="black").place()
    scene.ground(size=(2000, 2000), cells=(1, 1), reflectance=0)
    organs = sunfleck.solve(scene, certificate=False).organs
    np.testing.assert_allclose(organs.sky_view[0], [1, 0], atol=1e-3)
    np.testing.assert_allclose(organs.ground_view[0], [0, 1], atol=2e-3)
    np.testing.assert_allclose(organs.irradiance[0, 0, :, 0], 100 * organs.sky_view[0], atol=0.5)
