"""A sky as the text of a .light file."""

from .GenSky import Sky


def GetLight(SkyObject: Sky) -> str:
    """A line "energy vx vy vz" for each sector."""
    return "".join(" ".join(map(str, sector[:4])) + "\n" for sector in SkyObject.sky)
