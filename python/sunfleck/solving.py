"""From a scene to its light."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Mapping
from typing import Any, Union

from . import _core
from .result import Result
from .scene import Scene, SceneWarning

Progress = Union[bool, Callable[[str, Union[float, None], Union[str, None]], Any], None]
"""True: a bar on standard error. A function: called in the solving thread of Python as progress(phase, fraction, None) while a phase goes on,
and progress("", None, line) for each line that the program has to say; what it raises ends the solve and is raised again."""


class InaccurateWarning(UserWarning):
    """A result that is not as it was asked for: it did not converge, its certificate contradicts it, or a wanted error was missed."""


def _bar(phase: str, fraction: float | None, line: str | None) -> None:
    if fraction is not None:
        done = int(30 * fraction)
        end = "\n" if fraction >= 1 else ""
        sys.stderr.write(f"\r{phase:<24.24} [{'#' * done}{' ' * (30 - done)}] {100 * fraction:3.0f} %{end}")
        sys.stderr.flush()


def listener(progress: Progress) -> Any:
    """What the compiled part calls."""
    return _bar if progress is True else progress or None


def settings(method: str | None = None, quality: str | None = None, error: float | Mapping[str, float] | None = None, seed: int | None = None,
             certificate: bool | None = None, certificate_organs: int | None = None, certificate_rays: int | None = None,
             samples: int | None = None, threads: int = 0) -> _core.Run:
    """How to solve, as solve() takes it."""
    wanted = [] if error is None else list(error.items()) if isinstance(error, Mapping) else [("", float(error))]
    return _core.Run(method, quality, wanted, seed, certificate, certificate_organs, certificate_rays, samples, threads)


def check(scene: Scene, level: int = 3) -> None:
    """Warns of plants and groups that nothing places."""
    for name in scene._core.unplaced:
        warnings.warn(f'"{name}" is placed nowhere: it has no part in the scene', SceneWarning, stacklevel=level)


def finished(scene: Scene, light: _core.Light, level: int = 3) -> Result:
    """The result; warns where it is not as it was asked for."""
    result = Result(light, dict(scene._ids), scene._core.plant_names)
    if result.status != "converged":
        warnings.warn(result.verdict or result.status, InaccurateWarning, stacklevel=level)
    return result


def solve(scene: Scene, *, quality: str | None = None, method: str | None = None, error: float | Mapping[str, float] | None = None,
          certificate: bool | None = None, certificate_organs: int | None = None, certificate_rays: int | None = None, samples: int | None = None,
          seed: int | None = None, threads: int = 0, progress: Progress = None, facets: bool = True) -> Result:
    """The light on all facets and organs of a scene. No process is started and no file written; other Python threads run on meanwhile, and
    Ctrl-C ends it.

    quality: "draft", "standard" or "fine". method: "instantiation", "clustering", "flat", "direct" (no scattering), "lattice" and
    "occlusion" (approximate), "reference" (path tracing, samples= paths a facet); what suits the scene where it is left out. error: instead of a quality, the rms error of an organ's absorbed light
    over the mean, of all bands or per band, until which is solved. certificate: path-traces some organs to tell the error. seed of all sampling.
    threads: 0 is all cores; the bits are the same for any number. facets=False keeps organs only.
    Where the scene was read from a file, its [solve] fills in what is not said.
    Raises ValueError for a scene or setting that cannot be right, MemoryError; warns (InaccurateWarning) of a result that is not as asked.
    """
    run = settings(method, quality, error, seed, certificate, certificate_organs, certificate_rays, samples, threads)
    check(scene)
    return finished(scene, _core.solve(scene._core, run, facets, listener(progress)))
