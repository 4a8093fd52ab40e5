import gc
import os
import signal
import threading
import time

import numpy as np
import pytest
from conftest import QUICK, leaves, new_scene

import sunfleck


def test_shapes_and_sums(scene):
    result = sunfleck.solve(scene, **QUICK)
    facets, organs = result.facets, result.organs
    assert facets.absorbed.shape == (1, 40 + 32, 2) and facets.absorbed.dtype == np.float32
    assert facets.irradiance.shape == (1, 72, 2, 2) and facets.sunlit.shape == (1, 72, 2)
    assert organs.absorbed.shape == (1, 20 + 16, 2) and organs.irradiance.shape == (1, 36, 2, 2)
    power = np.zeros((36, 2))
    np.add.at(power, facets.organ, facets.absorbed[0] * facets.area[:, None])
    np.testing.assert_allclose(power, organs.absorbed[0], rtol=1e-5)
    balance = result.balance
    np.testing.assert_allclose(balance.leaves[0], organs.absorbed[0, :20].sum(0), rtol=1e-6)
    np.testing.assert_allclose(balance.incident, balance.leaves + balance.ground + balance.escaped + balance.residual)
    assert result.status == "converged" and result.bands == ["PAR", "NIR"]


def test_a_leaf_by_hand():
    """Sun from the zenith, alone: absorbed = (1 - rho - tau) E."""
    scene = sunfleck.Scene(bands=["PAR"])
    scene.sun((0, 0, 1), 1000.0, angular_diameter=0)
    scene.optics("leaf", reflectance=0.1, transmittance=0.2)
    scene.plant("leaf", np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]]), optics="leaf").place()
    result = sunfleck.solve(scene, certificate=False)
    np.testing.assert_allclose(result.facets.absorbed, [[[700.0]]], rtol=1e-6)
    np.testing.assert_allclose(result.organs.absorbed, [[[350.0]]], rtol=1e-6)
    np.testing.assert_allclose(result.organs.irradiance, [[[[1000.0], [0.0]]]], rtol=1e-6)
    np.testing.assert_array_equal(result.organs.sunlit, [[[1, 0]]])


def test_organs_keep_ids_in_the_order_in_which_they_come_first():
    scene = new_scene()
    triangles = leaves(6)
    organ = np.array([7, -3, 7, 10**12, -3, 7])
    plant = scene.plant("p", triangles, optics={-3: "leaf", "*": "leaf"}, organ=organ, organ_names={7: "seven"}, organ_types={7: "petiole"})
    plant.place(position=[[0, 0, 0], [0.5, 0, 0]], turn=[0, 90])
    organs = sunfleck.solve(scene, **QUICK).organs
    assert organs.id.tolist() == [7, -3, 10**12] * 2
    assert organs.name.tolist() == ["seven", "p_-3", "p_1000000000000"] * 2
    assert organs.type.tolist() == ["petiole", "organ", "organ"] * 2
    assert organs.placement.tolist() == ["p[0]"] * 3 + ["p[1]"] * 3


def test_vertices_and_indices_are_the_same_as_triangles():
    triangles = leaves(20)
    a, b = new_scene(), new_scene()
    a.plant("p", triangles, optics="leaf").place()
    b.plant("p", vertices=triangles.reshape(-1, 3), indices=np.arange(60).reshape(20, 3), optics="leaf").place()
    np.testing.assert_array_equal(sunfleck.solve(a, **QUICK).facets.absorbed, sunfleck.solve(b, **QUICK).facets.absorbed)


def test_affine_is_position_turn_and_scale():
    triangles, c, s = leaves(20), np.cos(np.radians(30)), np.sin(np.radians(30))
    a, b = new_scene(), new_scene()
    a.plant("p", triangles, optics="leaf").place(position=(0.2, 0.1, 0.3), turn=30, scale=0.5)
    b.plant("p", triangles, optics="leaf").place(affine=[[0.5 * c, -0.5 * s, 0, 0.2], [0.5 * s, 0.5 * c, 0, 0.1], [0, 0, 0.5, 0.3], [0, 0, 0, 1]])
    one, other = sunfleck.solve(a, **QUICK), sunfleck.solve(b, **QUICK)
    np.testing.assert_allclose(one.facets.area, other.facets.area, rtol=1e-6)
    np.testing.assert_allclose(one.organs.absorbed, other.organs.absorbed, rtol=1e-3)


def test_groups_and_grids():
    scene = new_scene()
    scene.periodic = None
    plant = scene.plant("p", leaves(4), optics="leaf")
    row = scene.group("row")
    row.add(plant, grid={"step": (1, 1), "count": (3, 1)})
    row.place(position=[[0, 0, 0], [0, 5, 0]])
    organs = sunfleck.solve(scene, **QUICK).organs
    assert organs.placement.tolist() == [f"row[{i}]/p[{j}]" for i in (0, 1) for j in (0, 1, 2)]


def test_states_lamps_and_sensors():
    scene = new_scene()
    scene.no_light()
    scene.state("morning", 3600, sun={"elevation": 30, "azimuth": 90, "irradiance": {"PAR": 300, "NIR": 300}})
    scene.state("night", 7200, sky={"model": "uniform", "irradiance": {"PAR": 0, "NIR": 0}})
    scene.plant("p", leaves(10, height=0.5), optics="leaf").place()
    scene.lamp("lamp", power={"PAR": 10, "NIR": 0}, triangles=np.array([[[0.0, 0, 2], [0, 1, 2], [1, 0, 2]]]), states=["night"])
    scene.sensor("above", grid={"z": 1.9, "cells": (2, 1)})
    result = sunfleck.solve(scene, **QUICK)
    assert result.states == ["morning", "night"] and result.durations.tolist() == [3600, 7200]
    assert result.organs.absorbed[1, 0, 0] > 0 and result.organs.absorbed[1, 0, 1] == 0
    assert result.sensors["above"]["irradiance"].shape == (2, 2, 2)
    np.testing.assert_allclose(result.sensors["above"]["irradiance"][0, :, 0], 150, rtol=1e-3)
    np.testing.assert_allclose(result.daily(), 3600 * result.organs.absorbed[0] + 7200 * result.organs.absorbed[1])


def test_same_bits_for_any_number_of_threads(scene):
    one, two = (sunfleck.solve(scene, quality="draft", certificate=False, threads=n) for n in (1, 2))
    np.testing.assert_array_equal(one.facets.irradiance, two.facets.irradiance)


def test_written_and_read(scene, tmp_path):
    result = sunfleck.solve(scene, quality="draft", seed=3)
    result.write(tmp_path / "result.h5")
    read = sunfleck.read_result(tmp_path / "result.h5")
    np.testing.assert_array_equal(read.facets.absorbed, result.facets.absorbed)
    np.testing.assert_array_equal(read.facets.sunlit, result.facets.sunlit)
    np.testing.assert_allclose(read.organs.absorbed, result.organs.absorbed, rtol=1e-6)
    assert read.organs.name.tolist() == result.organs.name.tolist()
    np.testing.assert_allclose(read.certificate.rmse, result.certificate.rmse)
    assert read.method == result.method and read.status == "converged"
    with pytest.raises(ValueError, match="facets"):
        sunfleck.solve(scene, facets=False, **QUICK).write(tmp_path / "no.h5")
    assert not (tmp_path / "no.h5").exists()
    with pytest.raises(OSError):
        result.write(tmp_path / "no folder" / "result.h5")


def test_a_scene_file_and_its_settings(scene, tmp_path):
    (tmp_path / "leaf.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                                       "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 1\n1 0 1\n0 1 1\n3 0 1 2\n")
    (tmp_path / "scene.toml").write_text('bands = ["PAR"]\n[sun]\ndirection = [0, 0, 1]\nirradiance = { PAR = 100 }\n'
                                         '[optics.leaf]\nreflectance = { PAR = 0.1 }\n[[plant]]\nname = "leaf"\nfile = "leaf.ply"\noptics = { "*" = "leaf" }\n'
                                         'place = [ { position = [0, 0, 0] } ]\n[solve]\nmethod = "direct"\n')
    scene = sunfleck.Scene.read(tmp_path / "scene.toml")
    result = sunfleck.solve(scene)
    assert result.method == "direct" and result.organs.id.tolist() == [sunfleck.NO_ID]
    np.testing.assert_allclose(result.facets.absorbed, [[[90]]], rtol=1e-6)
    scene.sun((0, 0, 1), 50)
    np.testing.assert_allclose(sunfleck.solve(scene).facets.absorbed, [[[45]]], rtol=1e-6)
    more = scene.plant("more", file=tmp_path / "leaf.ply", unit="cm", optics="leaf")
    more.place(position=(5, 5, 0))
    np.testing.assert_allclose(sunfleck.solve(scene).organs.area, [0.5, 0.5e-4], rtol=1e-6)


def test_a_plant_that_grows():
    scene = new_scene()
    plant = scene.plant("p", leaves(4), optics="leaf", organ=np.arange(4))
    plant.place()
    assert sunfleck.solve(scene, **QUICK).organs.id.tolist() == [0, 1, 2, 3]
    plant.reshape(leaves(6), optics="leaf", organ=np.arange(6) + 10)
    result = sunfleck.solve(scene, **QUICK)
    assert result.organs.id.tolist() == [10, 11, 12, 13, 14, 15] and set(result.organs.plant) == {"p"}
    scene.optics("leaf", reflectance={"PAR": 0, "NIR": 0}, replace=True)
    assert sunfleck.solve(scene, **QUICK).balance.escaped.sum() < result.balance.escaped.sum()
    plant.clear()
    with pytest.warns(sunfleck.SceneWarning, match="placed nowhere"), pytest.raises(ValueError):
        sunfleck.solve(scene, **QUICK)


def test_inaccurate_is_said():
    """An error below what there are lines for: not reached, and said so."""
    scene = sunfleck.Scene(bands=["PAR"])
    scene.sky("uniform", 100)
    scene.optics("leaf", reflectance=0.1)
    scene.plant("p", leaves(200, 0.2), optics="leaf", organ=np.arange(200)).place()
    with pytest.warns(sunfleck.InaccurateWarning, match="error"):
        result = sunfleck.solve(scene, error=1e-4, certificate_rays=20000)
    assert result.status == "not_converged" and result.verdict


def test_progress_and_what_it_raises(scene):
    said = []
    sunfleck.solve(scene, quality="draft", progress=lambda *word: said.append(word))
    assert any(line for _, _, line in said) and all((fraction is None) != (line is None) for _, fraction, line in said)

    def stop(phase, fraction, line):
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        sunfleck.solve(scene, quality="draft", progress=stop)
    assert sunfleck.solve(scene, **QUICK).status == "converged"


def long_scene():
    scene = new_scene()
    scene.plant("p", leaves(3000), optics="leaf").place()
    return scene


def test_ctrl_c_ends_a_solve_and_the_next_one_works(scene):
    big, sent = long_scene(), []
    timer = threading.Timer(0.7, lambda: (sent.extend((time.perf_counter(), time.process_time())), os.kill(os.getpid(), signal.SIGINT)))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        sunfleck.solve(big, method="reference", samples=10**6)
    worked = (time.process_time() - sent[1]) / len(os.sched_getaffinity(0))  # on a machine that does other things too, the clock runs on
    assert min(time.perf_counter() - sent[0], worked) < 0.5
    assert sunfleck.solve(scene, **QUICK).status == "converged"


def test_other_threads_run_while_a_solve_does():
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    sunfleck.solve(long_scene(), quality="draft", certificate=False)
    stop.set()
    thread.join()
    assert counted[0] - before > 1000


def test_python_costs_little():
    """The interpreter's thread against the whole process, in processor time, of a scene made, solved and read."""
    triangles = leaves(100_000, 0.01)
    start, start_all = time.thread_time(), time.process_time()
    scene = new_scene()
    scene.plant("p", triangles, optics="leaf").place()
    made = time.thread_time() - start
    result = sunfleck.solve(scene, quality="draft", method="direct", certificate=False)
    assert result.organs.absorbed.shape == (1, 1, 2) and result.facets.absorbed.shape == (1, 100_000, 2)
    spent, all_spent = time.thread_time() - start, time.process_time() - start_all
    assert made < 0.05
    assert spent < 0.05 * all_spent


def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_a_thousand_solves_take_no_more_memory():
    scene = new_scene(sky=False)
    plant = scene.plant("p", leaves(20), optics="leaf", organ=np.arange(20))
    plant.place()

    def solves(count):
        for i in range(count):
            scene.sun((0, 0, 1), irradiance={"PAR": 100 + i, "NIR": 1}, angular_diameter=0)
            plant.reshape(leaves(20, seed=i), optics="leaf", organ=np.arange(20))
            result = sunfleck.solve(scene, method="direct", quality="draft", certificate=False)
            assert result.facets.absorbed.sum() > 0 and len(result.organs.name) == 20
        gc.collect()
        return resident()

    before = solves(300)
    assert solves(700) - before < 4e6


def test_arrays_outlive_their_result(scene):
    absorbed = sunfleck.solve(scene, **QUICK).facets.absorbed
    copy = absorbed.copy()
    gc.collect()
    np.testing.assert_array_equal(absorbed, copy)
    with pytest.raises(ValueError):
        absorbed[0, 0, 0] = 1


def test_tables_and_pictures(scene):
    xarray, pandas = pytest.importorskip("xarray"), pytest.importorskip("pandas")
    result = sunfleck.solve(scene, **QUICK)
    data = result.to_xarray(facets=True)
    assert isinstance(data, xarray.Dataset) and data.absorbed.attrs["units"] == "W" and data.irradiance.attrs["units"] == "W m^-2"
    np.testing.assert_allclose(data.absorbed.sel(band="NIR").isel(state=0), result.organs.absorbed[0, :, 1])
    frame = result.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and len(frame) == 36
    np.testing.assert_allclose(frame.absorbed_PAR, result.organs.absorbed[0, :, 0])
    assert result.png(width=64, height=48, samples=1)[:8] == b"\x89PNG\r\n\x1a\n"
    assert result._repr_png_()[1:4] == b"PNG"
