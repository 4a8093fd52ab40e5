"""CARIBU's calls (openalea.caribu), answered by this solver: a script changes its imports from `alinea.caribu` or `openalea.caribu` to
`sunfleck.caribu`. Same arguments, units, keys and orientation; docs/python.md has what differs."""

from .CaribuScene import CaribuScene
from .caribu import mixed_radiosity, radiosity, raycasting, x_mixed_radiosity, x_radiosity, x_raycasting
from .caribu_star import caribu_star
from .light import diffuse_source, light_sources, turtle

__all__ = ["CaribuScene", "caribu_star", "diffuse_source", "light_sources", "mixed_radiosity", "radiosity", "raycasting", "turtle", "x_mixed_radiosity",
           "x_radiosity", "x_raycasting"]
