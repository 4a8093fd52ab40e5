"""CARIBU's tools for skies and suns, each in the module that it has there: `from sunfleck.caribu.sky_tools import GenSky, GetLight`,
`GetLight.GetLight(GenSky.GenSky()(1.0, "soc", 4, 5))`. X points north and Y west, as there; pi has all its digits."""

from . import GenSky, GetLight, GetLightsSun, Gensun, spitters_horaire, turtle

__all__ = ["GenSky", "GetLight", "GetLightsSun", "Gensun", "spitters_horaire", "turtle"]
