"""Optics of bands from spectra: tables, and leaf chemistry where the package prosail is installed."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

BANDS = {"PAR": (400.0, 700.0), "NIR": (700.0, 2500.0)}
"""Limits of bands [nm]."""


def sunlight(wavelength: ArrayLike, temperature: float = 5800.0) -> NDArray[np.float64]:
    """Relative power per wavelength [nm] of a black body, by default about the sun's (Planck 1901, doi:10.1002/andp.19013090310)."""
    metre = np.asarray(wavelength, dtype=float) * 1e-9
    return np.asarray(metre**-5 / np.expm1(1.438776877e-2 / (metre * temperature)))


def band_mean(wavelength: ArrayLike, values: ArrayLike, low: float, high: float, spectrum: ArrayLike | None = None, photons: bool = False) -> float:
    """Mean of values (n,) over low to high [nm], weighted by the power of a spectrum (n,) at the same wavelengths (sunlight() where it is left
    out), or by its photons. By the trapezoidal rule, the ends interpolated. Raises ValueError where the table does not reach so far."""
    w, v = np.asarray(wavelength, dtype=float), np.asarray(values, dtype=float)
    s = sunlight(w) if spectrum is None else np.asarray(spectrum, dtype=float)
    if w.ndim != 1 or v.shape != w.shape or s.shape != w.shape:
        raise ValueError(f"values: found shapes {w.shape}, {v.shape} and {s.shape}; expected wavelength, values and spectrum alike, (n,)")
    if not np.all(np.diff(w) > 0):
        raise ValueError("wavelength: found values that do not rise; expected rising ones [nm]")
    if not (low < high and w[0] <= low and high <= w[-1]):
        raise ValueError(f"band: found {low} to {high} nm; expected limits within the table's {w[0]} to {w[-1]} nm, the lower first")
    at = np.concatenate([[low], w[(w > low) & (w < high)], [high]])
    weight = np.interp(at, w, s) * (at if photons else 1.0)
    y = np.interp(at, w, v)
    whole = np.sum(np.diff(at) * (weight[1:] + weight[:-1]))
    return float(np.sum(np.diff(at) * (weight[1:] * y[1:] + weight[:-1] * y[:-1])) / whole)


def optics(wavelength: ArrayLike, reflectance: ArrayLike, transmittance: ArrayLike | None = None, bands: Mapping[str, tuple[float, float]] = BANDS,
           spectrum: ArrayLike | None = None, photons: bool = False) -> dict[str, dict[str, float]]:
    """Arguments of Scene.optics() from spectra (n,) at wavelengths (n,) [nm]: {"reflectance": {band: ...}, "transmittance": {band: ...}}."""
    out = {"reflectance": {b: band_mean(wavelength, reflectance, lo, hi, spectrum, photons) for b, (lo, hi) in bands.items()}}
    if transmittance is not None:
        out["transmittance"] = {b: band_mean(wavelength, transmittance, lo, hi, spectrum, photons) for b, (lo, hi) in bands.items()}
    return out


def read_table(file: str | os.PathLike[str], bands: Mapping[str, tuple[float, float]] = BANDS, photons: bool = False) -> dict[str, dict[str, float]]:
    """optics() of a CSV file with a header: wavelength [nm], reflectance, and transmittance and spectrum where it has them; in per cent where
    any value is above 1.5. Raises ValueError naming file, line and column."""
    with open(file, encoding="utf-8-sig") as lines:
        rows = [[cell.strip() for cell in line.split("#")[0].split(",")] for line in lines]
    header: list[str] = next((r for r in rows if any(r)), [])
    names = {"wavelength", "reflectance", "transmittance", "spectrum"}
    if not {"wavelength", "reflectance"} <= set(header) or not set(header) <= names:
        raise ValueError(f"{os.fspath(file)}: found columns {', '.join(header)}; expected wavelength, reflectance, and any of transmittance, spectrum")
    table: dict[str, list[float]] = {name: [] for name in header}
    for number, row in enumerate(rows, 1):
        if row is header or not any(row):
            continue
        for name, cell in zip(header, row + [""] * len(header)):
            try:
                table[name].append(float(cell))
            except ValueError:
                raise ValueError(f"{os.fspath(file)}:{number}: {name}: found \"{cell}\"; expected a number") from None
    columns = {name: np.asarray(values) for name, values in table.items()}
    for name in ("reflectance", "transmittance"):
        if name in columns and np.any(columns[name] > 1.5):
            columns[name] = columns[name] / 100
    return optics(columns["wavelength"], columns["reflectance"], columns.get("transmittance"), bands, columns.get("spectrum"), photons)


def leaf(n: float = 1.5, cab: float = 40.0, car: float = 8.0, cbrown: float = 0.0, cw: float = 0.01, cm: float = 0.009, ant: float = 0.0, *,
         bands: Mapping[str, tuple[float, float]] = BANDS, spectrum: ArrayLike | None = None, photons: bool = False, **further: Any) -> dict[str, dict[str, float]]:
    """Arguments of Scene.optics() of a leaf by its chemistry, PROSPECT-D (Feret et al. 2017, doi:10.1016/j.rse.2017.03.004), by the package
    prosail: layers n, chlorophyll cab, carotenoids car and anthocyanins ant [ug cm^-2], brown pigments cbrown, water cw [cm], dry matter cm
    [g cm^-2]. spectrum at 400, 401, ... 2500 nm. Raises ImportError without prosail."""
    import prosail

    wavelength, reflectance, transmittance = prosail.run_prospect(n, cab, car, cbrown, cw, cm, ant=ant, prospect_version="D", **further)
    return optics(wavelength, reflectance, transmittance, bands, spectrum, photons)
