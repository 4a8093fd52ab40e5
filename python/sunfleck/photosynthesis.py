"""Leaf photosynthesis that eats absorbed light: Farquhar, von Caemmerer & Berry with Medlyn's stomata, and a canopy's closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

PHOTONS_PER_JOULE = 4.598
"""umol of photons per joule of PAR with a flat spectrum from 400 to 700 nm; 4.564 for a black body of 5,800 K."""
_GAS, _KELVIN, _REFERENCE = 8.314, 273.15, 298.15

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Leaf:
    """Parameters at 25 degrees C: largest carboxylation vcmax, electron transport jmax and dark respiration rd [umol m^-2 s^-1]; quantum yield
    alpha of electrons per absorbed photon, curvature theta; stomata for CO2: g0 [mol m^-2 s^-1] and g1 [kPa^.5] of Medlyn et al. (2011,
    doi:10.1111/j.1365-2486.2010.02375.x), not less than g_min; oxygen [mmol mol^-1]."""

    vcmax: float = 200.0
    jmax: float = 250.0
    rd: float = 0.6
    alpha: float = 0.425
    theta: float = 0.7
    g0: float = 0.03
    g1: float = 12.0
    oxygen: float = 210.0
    g_min: float = 0.001


@dataclass(frozen=True)
class Exchange:
    """Net assimilation [umol CO2 m^-2 s^-1], conductance for CO2 [mol m^-2 s^-1] (for water 1.6 times that), CO2 inside [umol mol^-1]; limit is
    "J" (electrons), "V" (carboxylation) or "dark"."""

    assimilation: Array
    conductance: Array
    inside: Array
    limit: NDArray[np.str_]


def arrhenius(rate: ArrayLike, energy: float, kelvin: ArrayLike) -> Array:
    """A rate at 25 degrees C at another temperature [K]; activation energy [J mol^-1]."""
    t = np.asarray(kelvin, dtype=float)
    return np.asarray(np.asarray(rate, dtype=float) * np.exp(energy * (t - _REFERENCE) / (_GAS * t * _REFERENCE)))


def peaked(rate: ArrayLike, energy: float, kelvin: ArrayLike, deactivation: float, entropy: float) -> Array:
    """arrhenius() with a peak: deactivation energy [J mol^-1] and entropy [J mol^-1 K^-1] (Medlyn et al. 2002,
    doi:10.1046/j.1365-3040.2002.00891.x)."""
    t = np.asarray(kelvin, dtype=float)
    top = 1 + np.exp((_REFERENCE * entropy - deactivation) / (_REFERENCE * _GAS))
    return np.asarray(arrhenius(rate, energy, t) * top / (1 + np.exp((t * entropy - deactivation) / (t * _GAS))))


def compensation(celsius: ArrayLike) -> Array:
    """CO2 compensation point without respiration [umol mol^-1] (Bernacchi et al. 2001, doi:10.1111/j.1365-3040.2001.00668.x)"""
    return arrhenius(42.75, 37830.0, np.asarray(celsius, dtype=float) + _KELVIN)


def electrons(absorbed: ArrayLike, jmax: ArrayLike, alpha: float, theta: float) -> Array:
    """Electron transport [umol m^-2 s^-1] from *absorbed* photons [umol m^-2 s^-1]: the lesser root of theta J^2 - (alpha Q + Jmax) J + alpha Q Jmax."""
    q = alpha * np.asarray(absorbed, dtype=float)
    most = np.asarray(jmax, dtype=float)
    both = q + most
    return np.asarray((both - np.sqrt(both**2 - 4 * theta * q * most)) / (2 * theta))


def _larger_root(a: Array, b: Array, c: Array) -> Array:
    """Of a x^2 + b x + c; where a vanishes (g0 = s (V - Rd): round numbers in the dark) the only one."""
    straight = np.abs(a) < 1e-12 * np.abs(b)
    safe = np.where(straight, 1.0, a)
    d = np.sqrt(np.maximum(b * b - 4 * a * c, 0.0))
    linear = -c / np.where(b == 0, 1.0, b)
    return np.where(straight, linear, np.maximum((-b + d) / (2 * safe), (-b - d) / (2 * safe)))


def assimilation(absorbed: ArrayLike, celsius: ArrayLike = 25.0, carbon_dioxide: ArrayLike = 400.0, deficit: ArrayLike = 1.0, leaf: Leaf = Leaf()) -> Exchange:
    """Gas exchange of leaves (Farquhar, von Caemmerer & Berry 1980, doi:10.1007/BF00386231; stomata as Leaf says; solved for both limits in
    closed form, the lesser one counts). All arguments are broadcast.

    absorbed: photons of PAR that the leaf *absorbs* [umol m^-2 s^-1] of one-sided area (W m^-2 times PHOTONS_PER_JOULE); temperature of the leaf
    [degrees C]; CO2 at its surface [umol mol^-1]; vapour pressure deficit [kPa].
    """
    q, celsius_, cs, d = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in (absorbed, celsius, carbon_dioxide, deficit)))
    if np.any(q < 0) or not np.all(np.isfinite(q)):
        raise ValueError(f"absorbed: found {q.min()}; expected photons of zero or more [umol m^-2 s^-1]")
    t = celsius_ + _KELVIN
    gamma = compensation(celsius_)
    michaelis = arrhenius(404.9, 79430.0, t) * (1 + leaf.oxygen / arrhenius(278.4, 36380.0, t))
    jmax = peaked(leaf.jmax, 29680.0, t, 200000.0, 631.88)
    vcmax = peaked(leaf.vcmax, 58550.0, t, 200000.0, 629.26)
    rd = arrhenius(leaf.rd, 46390.0, t)
    by_light = electrons(q, jmax, leaf.alpha, leaf.theta) / 4
    slope = (1 + leaf.g1 / np.sqrt(np.maximum(d, 1e-9))) / cs

    def gross(v: Array, k: Array) -> Array:
        a = leaf.g0 + slope * (v - rd)
        b = (1 - cs * slope) * (v - rd) + leaf.g0 * (k - cs) - slope * (v * gamma + k * rd)
        c = -(1 - cs * slope) * (v * gamma + k * rd) - leaf.g0 * k * cs
        inside = _larger_root(a, b, c)
        with np.errstate(invalid="ignore", divide="ignore"):  # in the dark, which is looked at below
            return np.nan_to_num(v * (inside - gamma) / (inside + k), nan=0.0)

    light, carbon = gross(by_light, 2 * gamma), gross(vcmax, michaelis)
    dark = (by_light * (cs - gamma) / (cs + 2 * gamma) - rd < 1e-6) | (light - rd < 1e-6)
    least = max(leaf.g_min, leaf.g0)
    net = np.where(dark, -rd, np.minimum(light, carbon) - rd)
    conductance = np.where(dark, least, np.maximum(leaf.g_min, leaf.g0 + slope * net))
    limit = np.where(dark, "dark", np.where(light < carbon, "J", "V"))
    return Exchange(net, conductance, np.asarray(cs - net / conductance), limit)


def monsi_saeki(b: float, a: float, extinction: float, light: float, leaf_area_index: float) -> float:
    """Photosynthesis of a canopy per ground area whose leaves have p = b I / (1 + a I), I = K I0 exp(-K l) on leaves below a leaf area l (Monsi &
    Saeki 1953, in English doi:10.1093/aob/mci052): P = b / (a K) ln[(1 + a K I0) / (1 + a K I0 exp(-K F))]."""
    top = a * extinction * light
    return float(b / (a * extinction) * np.log((1 + top) / (1 + top * np.exp(-extinction * leaf_area_index))))


def day_sine(latitude: float, declination: float) -> float:
    """Integral of the sine of the sun's elevation over a day [h]; angles [degrees]."""
    phi, delta = np.radians(latitude), np.radians(declination)
    sunset = np.arccos(np.clip(-np.tan(phi) * np.tan(delta), -1.0, 1.0))
    return float(24 / np.pi * (sunset * np.sin(phi) * np.sin(delta) + np.cos(phi) * np.cos(delta) * np.sin(sunset)))
