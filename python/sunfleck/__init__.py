"""Sunfleck: the light that every leaf of a plant, crop or forest absorbs (docs/python.md)."""

from ._core import Error, InputError, Stopped
from ._core import version as __version__
from .result import Balance, Certificate, Facets, Organs, Result, read_result
from .scene import NO_ID, Group, Plant, Scene, SceneWarning
from .session import Session
from .solving import InaccurateWarning, solve

for _error in (Error, InputError, Stopped):
    _error.__module__ = "sunfleck"

__all__ = ["Balance", "Certificate", "Error", "Facets", "Group", "InaccurateWarning", "InputError", "NO_ID", "Organs", "Plant", "Result", "Scene",
           "SceneWarning", "Session", "Stopped", "__version__", "read_result", "solve"]
