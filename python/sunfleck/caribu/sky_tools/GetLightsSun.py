"""A sun as the text of a .light file."""

from .Gensun import Sun


def GetLightsSun(SunObject: Sun) -> str:
    """ "energy vx vy vz", or nothing at night."""
    return SunObject.toLight()
