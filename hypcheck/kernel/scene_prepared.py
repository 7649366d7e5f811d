"""Scenes with their prepared data, made from files or arrays, or from a scene by a change of one hyperboloid.

For a changed scene the prepared data are copied and patched, not computed again. Numbers of hyperboloids are places in
the scene: an added hyperboloid is the last, and after a removal the numbers of all later ones are lower by one.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from itertools import chain
from math import inf, isfinite
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.rows import Floats, Indices
from hypcheck.kernel.clearance import enlarged
from hypcheck.kernel.scene_index import (
    ROOM,
    Bodies,
    PlaneGrid,
    bodies_of,
    cells_of,
    grid_of,
    hashed,
    in_reach,
    packed,
    reaches,
)
from hypcheck.kernel.scene_pairs import Numbers, limits_of
from hypcheck.scene import arrays
from hypcheck.scene.model import Hyperboloid, Mover, Region, SceneModel, is_tilted
from hypcheck.scene.reading import parse_scene, read_scene

if TYPE_CHECKING:
    from typing_extensions import Self


@dataclass(frozen=True)
class PreparedScene:
    """A scene with data that are prepared at their first use: columns of its hyperboloids, and their grid."""

    model: SceneModel

    @in_default_environment
    def __post_init__(self) -> None:
        if not isinstance(self.model, SceneModel):
            raise InputError(
                f"the model is of type {type(self.model).__name__}; it must be a SceneModel, or see "
                "Scene.from_arrays, Scene.from_text and Scene.from_toml"
            )
        arrays.require_valid_model(self.model)

    @classmethod
    @in_default_environment
    def from_toml(cls, path: str | os.PathLike[str]) -> Self:
        """Return the scene in a file, or a shipped scene by its name. Raises InputError naming key and line."""
        return cls(read_scene(os.fspath(path)))

    @classmethod
    @in_default_environment
    def from_text(cls, text: str) -> Self:
        """Return the scene that a TOML text describes. Raises InputError naming key and line."""
        if not isinstance(text, str):
            raise InputError(f"the scene is of type {type(text).__name__}; it must be a text")
        return cls(parse_scene(text))

    @classmethod
    @in_default_environment
    def from_arrays(
        cls,
        alpha: ArrayLike,
        gamma: ArrayLike,
        center: ArrayLike,
        axis: ArrayLike | None = None,
        *,
        mover: Mover | Sequence[float],
        z_min: ArrayLike = -inf,
        z_max: ArrayLike = inf,
        solid: ArrayLike = False,
        names: Sequence[str] | None = None,
        question: str = "position",
        region: Region = Region(),  # noqa: B008 - it is frozen
        name: str = "scene",
    ) -> Self:
        """Return the scene of hyperboloids in arrays: numbers and columns (n,) are broadcast.

        `alpha` and `gamma` are the semi-axes, `center` (n, 3) their centres in the scene, `axis` (n, 3) or (3,)
        their axes, upright without. `mover` is a Mover, or its two semi-axes b, d. Hyperboloids end at the heights
        `z_min` and `z_max` along their axes from their centres; where `solid`, flat ends belong to them. `names` are
        "hyperboloid 1", … without. All lengths are in one unit. Raises InputError naming the hyperboloid and the number
        that is not valid.

        >>> scene = Scene.from_arrays([2, 1], 17.8, [[0, 0, 0], [9, 0, 0]], mover=Mover(0.25, 0.15))
        >>> scene.classify([[0, 0, 5], [5, 0, 0], [8, 0, 0]])
        array([-1,  1,  0], dtype=int8)
        """
        heights = z_min, z_max, solid
        bodies = arrays.hyperboloids_of(alpha, gamma, center, axis, heights, names)
        return cls(SceneModel(name, question, bodies, arrays.mover_of(mover), region))

    def with_hyperboloid(self, hyperboloid: Hyperboloid) -> Self:
        """Return the scene with one more hyperboloid, the last.

        With 10⁵ hyperboloids this costs a hundredth of a new scene.

        Raises InputError where a number of it is not valid, or its name is taken.

        >>> scene = Scene.from_arrays([2, 1], 17.8, [[0, 0, 0], [9, 0, 0]], mover=(0.25, 0.15))
        >>> scene.with_hyperboloid(Hyperboloid("new", 1, 17.8, (5, 0, 0))).classify((5, 0, 5))
        -1
        """
        model, body = self.model, arrays.checked_hyperboloid(hyperboloid)
        if any(hyperboloid.name == other.name for other in model.hyperboloids):
            raise InputError(f"there is a hyperboloid {hyperboloid.name!r} already; each must have another name")
        return self._changed((*model.hyperboloids, body), len(model.hyperboloids), bodies_of([body]), added=True)

    def moved(self, which: int | str, center: ArrayLike, axis: ArrayLike | None = None) -> Self:
        """Return the scene with one hyperboloid, by number or name, at another centre, perhaps with another axis."""
        place, model = self._place(which), self.model
        new = replace(model.hyperboloids[place], center=arrays.point_of("center", center))
        new = new if axis is None else replace(new, axis=arrays.point_of("axis", axis))
        body = arrays.checked_hyperboloid(new)
        others = (*model.hyperboloids[:place], body, *model.hyperboloids[place + 1 :])
        return self._changed(others, place, bodies_of([body]), added=False)

    def without(self, which: int | str) -> Self:
        """Return the scene without one hyperboloid, by number or name.

        The numbers of all later ones are lower by one.
        """
        place, model = self._place(which), self.model
        if len(model.hyperboloids) == 1:
            raise InputError(arrays.NO_HYPERBOLOID)
        model = replace(model, hyperboloids=(*model.hyperboloids[:place], *model.hyperboloids[place + 1 :]))
        grid = grid_without(self._grid, place, renumbered=True)
        return self._with(model, bodies_without(self._bodies, place), grid)

    def _place(self, which: int | str) -> int:
        """Return the place of the hyperboloid with this name or number. Raises InputError."""
        bodies = self.model.hyperboloids
        if isinstance(which, str):
            places = [place for place, body in enumerate(bodies) if body.name == which]
            if places:
                return places[0]
        elif isinstance(which, (int, np.integer)) and not isinstance(which, bool) and 0 <= which < len(bodies):
            return int(which)
        raise InputError(
            f"there is no hyperboloid {which!r}; it must be a name, or a number from 0 to {len(bodies) - 1}"
        )

    def _changed(self, others: tuple[Hyperboloid, ...], place: int, body: Bodies, *, added: bool) -> Self:
        """Return the scene with these hyperboloids, of which the one at `place` is new, or `added`."""
        grid = self._grid if added else grid_without(self._grid, place, renumbered=False)
        reach = float(reaches(body, self.model.mover, self.model.region.z)[0])
        x, y, _ = body.origins[0].tolist()
        patched = grid_with(grid, place, x, y, reach)
        bodies = bodies_with(self._bodies, body, None if added else place)
        return self._with(replace(self.model, hyperboloids=others), bodies, patched)

    def _with(self, model: SceneModel, bodies: Bodies, grid: PlaneGrid | None) -> Self:
        """Return the scene of a model, with data that are already prepared, and without a check.

        The parts of a mover that is larger by a margin may reach beyond it.
        """
        scene = object.__new__(type(self))
        scene.__dict__.update(model=model, _bodies=bodies)
        if grid is not None:
            scene.__dict__["_grid"] = grid
        return scene

    def _enlarged(self, margin: float) -> Self | None:
        """Return the scene with a mover that contains all points within the margin of this one.

        None if it overflows.
        """
        if margin not in self._of_margins:
            mover = self.model.mover
            b, d = enlarged(mover.b, mover.d, margin)
            parts = [(part, *enlarged(part.b, part.d, margin)) for part in mover.parts]
            grown = tuple(replace(part, b=float(wide), d=float(tall)) for part, wide, tall in parts)
            model = replace(self.model, mover=replace(mover, b=float(b), d=float(d), parts=grown))
            fits = all(map(isfinite, (*(part.b for part in grown), *(part.d for part in grown), float(b), float(d))))
            self._of_margins[margin] = self._with(model, self._bodies, None) if fits else None
        return self._of_margins[margin]

    @cached_property
    def _of_margins(self) -> dict[float, Self | None]:
        """The scenes with a larger mover, by margin; None where it overflows."""
        return {}

    def _near(self, x: float, y: float, z: float) -> Sequence[int]:
        """Return the hyperboloids that a mover with its centre here can touch, and perhaps others."""
        height = self.model.region.z
        if height is not None and not height.low <= z <= height.high:  # of which the grid promises nothing
            near: list[int] = in_reach(self._bodies, self.model.mover, (x, y, z)).tolist()
            return near
        return self._grid.near(x, y)

    def _pairs(self, centres: Floats) -> tuple[Indices, Indices]:
        """Return the pairs of hyperboloids and centres that must be decided."""
        height = self.model.region.z
        if height is None or ((centres[:, 2] >= height.low) & (centres[:, 2] <= height.high)).all():
            return self._grid.near_each(centres[:, 0], centres[:, 1])
        near = [self._near(x, y, z) for x, y, z in centres.tolist()]
        counts = [len(bodies) for bodies in near]
        return np.repeat(np.arange(len(centres)), counts), np.array(list(chain.from_iterable(near)), np.int64)

    def _numbers(self, index: int) -> Numbers:
        """Return a hyperboloid's numbers and limits, without arrays; they are kept after their first use."""
        kept = self._numbers_kept.get(index)
        if kept is None:
            low, high, inner_low, inner_high = self._limits[index].tolist()
            kept = self._numbers_kept[index] = self._bodies.one(index), (low, high, inner_low, inner_high)
        return kept

    def _grid_holds(self, *heights: float) -> bool:
        """Whether what the grid and the reaches promise holds at these heights of the scene: they are in its region."""
        region = self.model.region.z
        return region is None or all(region.low <= height <= region.high for height in heights)

    @cached_property
    def _is_tilted(self) -> bool:
        """Whether the mover or a hyperboloid is tilted."""
        return is_tilted(self.model.mover.axis) or bool(self._bodies.tilted.any())

    @cached_property
    def _numbers_kept(self) -> dict[int, Numbers]:
        """The numbers of hyperboloids that were used before, by place."""
        return {}

    @cached_property
    def _grid(self) -> PlaneGrid:
        """The grid of the hyperboloids."""
        origins = self._bodies.origins
        return grid_of(origins[:, 0], origins[:, 1], self._reaches)

    @cached_property
    def _reaches(self) -> Floats:
        """The reach of each hyperboloid in the region."""
        return reaches(self._bodies, self.model.mover, self.model.region.z)

    @cached_property
    def _limits(self) -> Floats:
        """The limits of the mover's height beside each hyperboloid (limits_of)."""
        return limits_of(self._bodies, self.model.mover)

    @cached_property
    def _bodies(self) -> Bodies:
        """The columns of the hyperboloids. Raises InputError if a number is not valid."""
        try:
            bodies = bodies_of(self.model.hyperboloids)
        except (AttributeError, TypeError, ValueError):  # something in the place of a number, a Span or a hyperboloid
            for body in self.model.hyperboloids:
                arrays.checked_hyperboloid(body)
            raise
        numbers = np.concatenate([bodies.shapes, bodies.origins, bodies.axes], axis=1)
        valid = np.isfinite(numbers).all(axis=1) & (bodies.shapes > 0).all(axis=1) & (bodies.axes != 0).any(axis=1)
        for index in np.flatnonzero(~(valid & (bodies.spans[:, 0] < bodies.spans[:, 1])))[:1].tolist():
            arrays.checked_hyperboloid(self.model.hyperboloids[index])
        return bodies


def bodies_with(bodies: Bodies, other: Bodies, place: int | None = None) -> Bodies:
    """Return the columns with one hyperboloid replaced at a place; None: with one more at the end."""
    columns = {}
    for part in fields(Bodies):
        column, one = getattr(bodies, part.name), getattr(other, part.name)
        if place is None:
            columns[part.name] = np.concatenate([column, one])
        else:
            columns[part.name] = column.copy()
            columns[part.name][place] = one[0]
    return Bodies(**columns)


def bodies_without(bodies: Bodies, place: int) -> Bodies:
    """Return the columns without those of one hyperboloid."""
    return Bodies(**{part.name: np.delete(getattr(bodies, part.name), place, axis=0) for part in fields(Bodies)})


def grid_with(grid: PlaneGrid, place: int, x: float, y: float, reach: float) -> PlaneGrid | None:
    """Return the grid with a hyperboloid of this number at (x, y).

    Return None where its table has become too small to be quick.
    """
    columns, rows, everywhere = cells_of(np.array([x]), np.array([y]), np.array([reach]), grid.side)
    if everywhere:
        return replace(grid, everywhere=sorted([*grid.everywhere, place]))
    size, members = len(grid.starts) - 1, np.frombuffer(grid.members, np.intc)
    if 2 * size < ROOM * (len(members) + len(columns)):
        return None
    places = np.unique(hashed(columns, rows, size))
    starts = np.frombuffer(grid.starts, np.intc)
    more = np.zeros(size + 1, np.intc)
    more[places + 1] = 1
    return replace(
        grid,
        starts=packed(starts + np.cumsum(more, dtype=np.intc)),
        members=packed(np.insert(members, starts[places + 1], place)),
    )


def grid_without(grid: PlaneGrid, place: int, *, renumbered: bool) -> PlaneGrid:
    """Return the grid without a hyperboloid; with `renumbered`, the numbers of later ones decrease by one."""
    members, starts = np.frombuffer(grid.members, np.intc), np.frombuffer(grid.starts, np.intc)
    gone = np.flatnonzero(members == place)
    fewer = np.searchsorted(gone, starts).astype(np.intc)  # how many are gone before each start
    kept = np.delete(members, gone)
    everywhere: Sequence[int] = [number for number in grid.everywhere if number != place]
    if renumbered:
        kept = kept - (kept > place)
        everywhere = [number - (number > place) for number in everywhere]
    return replace(grid, starts=packed(starts - fewer), members=packed(kept), everywhere=list(everywhere))
