import numpy as np
import pytest

import sunfleck
from sunfleck import spectra


def test_band_means():
    w = np.arange(300.0, 1001)
    assert spectra.band_mean(w, w, 400, 700, np.ones_like(w)) == pytest.approx(550)
    assert spectra.band_mean(w, w, 400.25, 700.75, np.ones_like(w)) == pytest.approx(550.5)
    assert spectra.band_mean(w, np.full_like(w, 0.3), 400, 700) == pytest.approx(0.3)
    # photons count long waves more: mean of l^2 over mean of l
    assert spectra.band_mean(w, w, 400, 700, np.ones_like(w), photons=True) == pytest.approx((700**3 - 400**3) / 3 / ((700**2 - 400**2) / 2), rel=1e-6)
    # photons per joule of a black body of 5800 K: 4.564 umol/J
    assert spectra.band_mean(w, w, 400, 700) / 119.626565 == pytest.approx(4.5641, abs=2e-4)
    for wrong, text in (((w[::-1], w, 400, 700), "rise"), ((w, w[1:], 400, 700), "shapes"), ((w, w, 200, 700), "within the table"), ((w, w, 700, 400), "within")):
        with pytest.raises(ValueError, match=text):
            spectra.band_mean(*wrong)


def test_tables(tmp_path):
    (tmp_path / "leaf.csv").write_text("wavelength, reflectance, transmittance # of a leaf\n400, 5, 2\n700, 5, 2\n701, 45, 40\n2500, 45, 40\n")
    table = spectra.read_table(tmp_path / "leaf.csv", {"PAR": (400, 700), "NIR": (701, 2500)})
    assert table == {"reflectance": {"PAR": pytest.approx(0.05), "NIR": pytest.approx(0.45)}, "transmittance": {"PAR": pytest.approx(0.02), "NIR": pytest.approx(0.40)}}
    sunfleck.Scene(bands=["PAR", "NIR"]).optics("leaf", **table)
    (tmp_path / "bad.csv").write_text("wavelength,reflectance\n400,5\n500,x\n")
    with pytest.raises(ValueError, match=r'bad.csv:3: reflectance: found "x"; expected a number'):
        spectra.read_table(tmp_path / "bad.csv")
    (tmp_path / "bad.csv").write_text("nm,reflectance\n400,5\n")
    with pytest.raises(ValueError, match=r"bad.csv: found columns nm, reflectance"):
        spectra.read_table(tmp_path / "bad.csv")


def test_leaf_chemistry():
    pytest.importorskip("prosail")
    green, pale = spectra.leaf(cab=40), spectra.leaf(cab=5)
    assert green["reflectance"]["PAR"] < pale["reflectance"]["PAR"] and green["transmittance"]["PAR"] < pale["transmittance"]["PAR"]
    far = {"NIR": (800.0, 2500.0)}
    assert spectra.leaf(cab=40, bands=far)["reflectance"]["NIR"] == pytest.approx(spectra.leaf(cab=5, bands=far)["reflectance"]["NIR"], rel=1e-3)
    assert 0.03 < green["reflectance"]["PAR"] < 0.12 and 0.2 < green["reflectance"]["NIR"] < 0.5
    wet, dry = spectra.leaf(cw=0.03), spectra.leaf(cw=0.003)
    assert wet["reflectance"]["NIR"] < dry["reflectance"]["NIR"]
