"""Solves one after another: a growth model's light."""

from __future__ import annotations

import os
from collections.abc import Mapping

from . import _core
from .result import Result
from .scene import Scene
from .solving import Progress, check, finished, listener, settings


class Session:
    """A solver that does not compute again what did not change since the solves before: the last solution, and with method "instantiation" the
    operators of plants (what light does inside them), by content. Changed light reuses all of them; plants that are moved, added or taken out
    leave the others theirs. Results are those of solve() to rounding, and the same bits whatever the session solved before.

    scene: what is solved, as it is then. The settings are those of solve(). memory: bytes that are kept at most; folder: keeps operators on disk
    too, for later sessions (the one case where files are written). After an error or Ctrl-C the session goes on.
    """

    def __init__(self, scene: Scene, *, memory: int = 1 << 30, folder: str | os.PathLike[str] | None = None, quality: str | None = None,
                 method: str | None = None, error: float | Mapping[str, float] | None = None, certificate: bool | None = None,
                 certificate_organs: int | None = None, certificate_rays: int | None = None, samples: int | None = None, seed: int | None = None,
                 threads: int = 0) -> None:
        self.scene = scene
        run = settings(method, quality, error, seed, certificate, certificate_organs, certificate_rays, samples, threads)
        if memory < 0:
            raise ValueError(f"memory: found {memory}; expected bytes, zero or more")
        self._core = _core.Session(run, memory, "" if folder is None else os.fspath(folder))

    def solve(self, *, progress: Progress = None, facets: bool = True) -> Result:
        """The light of the scene as it is now; as solve() otherwise."""
        check(self.scene)
        return finished(self.scene, self._core.solve(self.scene._core, facets, listener(progress)))

    @property
    def reused(self) -> dict[str, int]:
        """Names and numbers of what the last solve() did not compute again."""
        return self._core.reused

    @property
    def made(self) -> dict[str, int]:
        """The same of what it computed."""
        return self._core.made

    @property
    def saved_seconds(self) -> float:
        """That computing what was reused took when it was computed."""
        return self._core.saved_seconds
