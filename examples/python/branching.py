"""A tree that grows by Borchert and Honda's rule: vigour made from light goes up the stem and is split at every fork by the light of its sides.

Borchert & Honda (1984, Botanical Gazette 145, 184-195, doi:10.1086/337445) in the form of Palubicki et al. (2009, ACM Transactions on
Graphics 28(3), 58, doi:10.1145/1531326.1531364). Of the latter are the constants; from where the light of a leaf comes is the caller's matter.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Shoot = tuple[int, bool, list[tuple[Array, Array, Array, Array]]]
"""Row of what bears it, whether it is lateral, and its metamers: base, tip, axis, side."""


@dataclass(frozen=True)
class Rules:
    """Constants of growth. Relative light is 1 for a leaf that lies flat under the open sky."""

    reserve: float = 5.0  #: vigour of a tree without light
    yield_: float = 2.0  #: vigour per leaf in full light
    control_young: float = 0.65  #: lambda: share of the main axis where both sides have the same light
    control_old: float = 0.51
    young: int = 7  #: age [steps] to which lambda is the young one; it is the old one as many steps later
    shed: float = 0.3  #: a branch falls at this vigour per internode or less, a tree dies at so little from light
    most_metamers: int = 20  #: of a shoot
    leaf_life: int = 2  #: [steps]
    branch_angle: float = 65.0  #: of a lateral from its axis [degrees]
    phyllotaxis: float = 137.52  #: [degrees]
    pipe: float = 2.6  #: exponent e of radius^e = sum of radius^e of what is borne
    internode: float = 0.065  #: length at a vigour of 1 per metamer [m]
    twig_radius: float = 0.0012  #: of an internode that bears a leaf alone [m]
    leaf_length: float = 0.09  #: [m]
    leaf_width: float = 0.085  #: [m]
    droop: float = 20.0  #: of leaves below the horizontal [degrees]
    upward: float = 0.12  #: turn of shoots towards the vertical, per metamer
    wood_density: float = 400.0  #: [kg m^-3]
    leaf_mass: float = 0.08  #: per area [kg m^-2]

    @property
    def leaf_area(self) -> float:
        """One-sided, of a leaf [m^2]."""
        return 0.5 * self.leaf_length * self.leaf_width

    def control(self, age: int) -> float:
        """Lambda at an age of the tree [steps]."""
        old = min(max(age - self.young, 0) / self.young, 1.0)
        return self.control_young + old * (self.control_old - self.control_young)


def split(vigour: float, main: float, lateral: float, control: float) -> tuple[float, float]:
    """Vigour of the main axis and of the lateral, v l Q_m / (l Q_m + (1 - l) Q_l) and the rest; half each where neither has light."""
    whole = control * main + (1 - control) * lateral
    to_main = vigour * control * main / whole if whole > 0 else 0.5 * vigour
    return to_main, vigour - to_main


def _unit(x: Array) -> Array:
    return np.asarray(x / np.linalg.norm(x))


def _turned(x: Array, axis: Array, degrees: float) -> Array:
    """x turned about a unit axis (Rodrigues)."""
    a = np.radians(degrees)
    return np.asarray(x * np.cos(a) + np.cross(axis, x) * np.sin(a) + axis * (axis @ x) * (1 - np.cos(a)))


class Tree:
    """Metamers, an internode with a leaf and a bud in its axil each; parents before what they bear. All arrays are (n,) or (n, 3)."""

    def __init__(self, rules: Rules = Rules(), seed: int = 1, position: tuple[float, float] = (0.0, 0.0)) -> None:
        self.rules, self.age, self.shed_leaves, self.shed_branches = rules, 0, 0, 0
        self.alive = True
        self.position = position
        self._random = np.random.default_rng(seed)
        self._next_id = 0
        self.id = np.empty(0, dtype=np.int64)  #: never given twice
        self.parent = np.empty(0, dtype=np.int64)  #: -1: none
        self.lateral = np.empty(0, dtype=bool)  #: first of a branch
        self.born = np.empty(0, dtype=np.int64)  #: [step]
        self.base, self.tip, self.axis, self.side = (np.empty((0, 3)) for _ in range(4))
        self.fallen = np.empty(0)  #: radius^e of what a metamer bore and has lost
        turn = self._random.uniform(0, 2 * np.pi)
        seedling = self._shoot(-1, False, rules.reserve, np.zeros(3), np.array([0.0, 0.0, 1.0]), np.array([np.cos(turn), np.sin(turn), 0.0]))
        self._add([seedling])

    # ---- what there is

    def __len__(self) -> int:
        return len(self.id)

    @property
    def leafy(self) -> NDArray[np.bool_]:
        """(n,) bears a leaf"""
        return np.asarray(self.age - self.born < self.rules.leaf_life)

    @property
    def leaf_area(self) -> float:
        """One-sided [m^2]."""
        return float(self.leafy.sum()) * self.rules.leaf_area

    @property
    def height(self) -> float:
        """Of the highest leaf or twig [m]."""
        return float(self.tip[:, 2].max())

    def stem(self) -> NDArray[np.int64]:
        """Rows of the metamers of the main axis, from below."""
        rows = [0]
        next_ = {int(p): i for i, (p, is_lateral) in enumerate(zip(self.parent, self.lateral)) if not is_lateral}
        while rows[-1] in next_:
            rows.append(next_[rows[-1]])
        return np.asarray(rows)

    def radius(self) -> Array:
        """(n,) by the pipe model; wood that bore what has fallen stays [m]"""
        e = self.rules.pipe
        section = (self.fallen + self.rules.twig_radius**e).tolist()
        for i, parent in zip(range(len(self) - 1, 0, -1), self.parent[:0:-1].tolist()):
            section[parent] += section[i]
        return np.asarray(section) ** (1 / e)

    @property
    def mass(self) -> float:
        """Of wood and leaves, dry [kg]."""
        wood = np.pi * self.radius() ** 2 * np.linalg.norm(self.tip - self.base, axis=1)
        return float(wood.sum()) * self.rules.wood_density + self.leaf_area * self.rules.leaf_mass

    # ---- growth

    def grow(self, light: Array) -> None:
        """One step by the relative light of each metamer's leaf, (n,) [-]; what it is for metamers without one does not matter. Branches of
        too little vigour fall, buds with enough become shoots. A tree whose light makes too little vigour for its size dies."""
        rules, n, leafy = self.rules, len(self), self.leafy
        q = np.where(leafy, light, 0.0)
        self.alive = bool(rules.yield_ * q.sum() > rules.shed * n)
        self.age += 1
        if not self.alive:
            return
        main, side = np.full(n, -1), np.full(n, -1)
        borne = np.arange(1, n)
        main[self.parent[borne[~self.lateral[1:]]]] = borne[~self.lateral[1:]]
        side[self.parent[borne[self.lateral[1:]]]] = borne[self.lateral[1:]]
        mains, sides, lit = main.tolist(), side.tolist(), q.tolist()
        # A leaf's light is that of the bud in its axil; at the end of a shoot the terminal bud's, which lets none sprout beside it.
        light_main, light_side = np.where(main < 0, q, 0.0).tolist(), np.where(main < 0, 0.0, q).tolist()
        leaves = leafy.astype(int).tolist()
        size = [1] * n
        for i in range(n - 1, -1, -1):
            for borne_, of in ((mains[i], light_main), (sides[i], light_side)):
                if borne_ >= 0:
                    of[i] = light_main[borne_] + light_side[borne_]
                    leaves[i] += leaves[borne_]
                    size[i] += size[borne_]
        control = rules.control(self.age)
        vigour = [0.0] * n
        vigour[0] = rules.reserve + rules.yield_ * float(q.sum())
        falls = np.zeros(n, dtype=bool)
        shoots = []
        lateral, parents = self.lateral.tolist(), self.parent.tolist()
        for i in range(n):
            if i and (falls[parents[i]] or leaves[i] == 0 or (lateral[i] and vigour[i] <= rules.shed * size[i])):
                if not falls[parents[i]]:
                    self.shed_branches += int(lateral[i] and leaves[i] > 0)
                falls[i] = True
                continue
            to_main, to_side = split(vigour[i], light_main[i], light_side[i], control)
            for borne_, share, is_lateral in ((mains[i], to_main, False), (sides[i], to_side, True)):
                if borne_ >= 0:
                    vigour[borne_] = share
                elif share >= 1:
                    away = self.axis[i] if not is_lateral else self._branch(i)
                    shoots.append(self._shoot(i, is_lateral, share, self.tip[i], away, self._next_side(self.side[i], self.axis[i], away)))
        self._add(shoots)
        self._drop(np.concatenate([falls, np.zeros(len(self) - n, dtype=bool)]))

    def _branch(self, i: int) -> Array:
        angle = np.radians(self.rules.branch_angle + self._random.normal(0, 5))
        return _unit(np.cos(angle) * self.axis[i] + np.sin(angle) * self.side[i])

    def _next_side(self, side: Array, axis: Array, to: Array) -> Array:
        turned = _turned(side, axis, self.rules.phyllotaxis)
        across = turned - to * (to @ turned)
        return _unit(across) if np.linalg.norm(across) > 1e-6 else _unit(np.cross(to, [0.3, 0.5, 0.8]))

    def _shoot(self, parent: int, lateral: bool, vigour: float, at: Array, axis: Array, side: Array) -> Shoot:
        """A shoot of so many metamers as the vigour has units, as long as its rest makes them."""
        count = min(int(vigour), self.rules.most_metamers)
        length = self.rules.internode * min(vigour / count, 2.0)
        metamers: list[tuple[Array, Array, Array, Array]] = []
        for _ in range(count):
            bent = _unit(axis + np.array([0.0, 0.0, self.rules.upward]) + self._random.normal(0, 0.03, 3))
            side = self._next_side(side, axis, bent)
            axis = bent
            tip = np.asarray(at + length * axis)
            metamers.append((at, tip, axis, side))
            at = tip
        return parent, lateral, metamers

    def _add(self, shoots: list[Shoot]) -> None:
        parent, lateral, n = [], [], len(self)
        rows: list[tuple[Array, Array, Array, Array]] = []
        for first, is_lateral, metamers in shoots:
            for k, metamer in enumerate(metamers):
                parent.append(first if k == 0 else n + len(rows) - 1)
                lateral.append(is_lateral and k == 0)
                rows.append(metamer)
        if not rows:
            return
        self.id = np.concatenate([self.id, self._next_id + np.arange(len(rows))])
        self._next_id += len(rows)
        self.parent, self.lateral = np.concatenate([self.parent, parent]), np.concatenate([self.lateral, lateral])
        self.born = np.concatenate([self.born, np.full(len(rows), self.age)])
        self.fallen = np.concatenate([self.fallen, np.zeros(len(rows))])
        new = np.asarray(rows)
        self.base, self.tip, self.axis, self.side = (np.concatenate([old, new[:, k]]) for k, old in enumerate((self.base, self.tip, self.axis, self.side)))

    def _drop(self, falls: NDArray[np.bool_]) -> None:
        if not falls.any():
            return
        self.shed_leaves += int((falls & self.leafy).sum())
        stumps = np.flatnonzero(falls[1:] & ~falls[self.parent[1:]]) + 1
        np.add.at(self.fallen, self.parent[stumps], self.radius()[stumps] ** self.rules.pipe)
        row = np.cumsum(~falls) - 1
        self.parent = np.where(self.parent >= 0, row[self.parent], -1)
        for name in ("id", "parent", "lateral", "born", "base", "tip", "axis", "side", "fallen"):
            setattr(self, name, getattr(self, name)[~falls])

    # ---- shape

    def leaves(self) -> tuple[Array, NDArray[np.int64]]:
        """Two triangles for each leaf, upper side in front: (2 k, 3, 3) [m], and rows of their metamers (2 k,)."""
        rows = np.flatnonzero(self.leafy)
        out = self.side[rows].copy()
        out[:, 2] = 0
        flat = np.linalg.norm(out, axis=1, keepdims=True)
        out = np.where(flat > 1e-3, out / np.maximum(flat, 1e-3), (1.0, 0.0, 0.0))
        across = np.column_stack([-out[:, 1], out[:, 0], np.zeros(len(rows))])
        droop = np.radians(self.rules.droop)
        along = np.cos(droop) * out - np.sin(droop) * np.array([0.0, 0.0, 1.0])
        length, width = self.rules.leaf_length, self.rules.leaf_width
        foot = self.tip[rows] + 0.3 * length * along
        widest = foot + 0.35 * length * along
        left, right, tip = widest + 0.5 * width * across, widest - 0.5 * width * across, foot + length * along
        triangles = np.stack([np.stack([foot, right, tip], axis=1), np.stack([foot, tip, left], axis=1)], axis=1)
        return np.ascontiguousarray(triangles.reshape(-1, 3, 3)), np.repeat(rows, 2)

    def wood(self) -> tuple[Array, NDArray[np.int64]]:
        """A prism of six triangles for each internode: (6 n, 3, 3) [m], and rows of their metamers (6 n,)."""
        across = np.cross(self.axis, self.side)
        radius = self.radius()[:, None]
        corner = [radius * (np.cos(a) * self.side + np.sin(a) * across) for a in 2 * np.pi * np.arange(3) / 3]
        faces = []
        for a, b in ((0, 1), (1, 2), (2, 0)):
            low, high = self.base, self.tip
            faces += [np.stack([low + corner[a], low + corner[b], high + corner[b]], axis=1), np.stack([low + corner[a], high + corner[b], high + corner[a]], axis=1)]
        return np.ascontiguousarray(np.stack(faces, axis=1).reshape(-1, 3, 3)), np.repeat(np.arange(len(self)), 6)
