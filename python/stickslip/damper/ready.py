"""Underplatform dampers that are ready: wedges, cylinders, split dampers and strips, in a plane."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import atan, cos, pi, radians, sin
from typing import Any, TypeAlias

from stickslip.checks import brief, members, set_fields
from stickslip.damper.body import Body, Centrifugal, ContactPoint, RigidBody
from stickslip.damper.damper import LEFT, RIGHT, Damper, Face
from stickslip.errors import ModelError
from stickslip.units import from_zero, physical_number

Pair: TypeAlias = float | tuple[float, float]
"""One number for both faces, or one for the left and one for the right face."""
Place: TypeAlias = tuple[float, float]
_SIDES = (LEFT, RIGHT)
_POINTS = "give points (x, y) in m, [(-0.01, 0.004), (-0.006, 0.008)]"


@dataclass(frozen=True, kw_only=True)
class _TwoFaces(Damper):
    """What dampers with a left and a right face have in common."""

    mass: float
    friction: Pair
    tangential_stiffness: Pair
    normal_stiffness: Pair
    load: float | Centrifugal
    gap: Pair = 0.0

    def __post_init__(self) -> None:
        set_fields(self, mass=from_zero(self.mass, "kg", f"{self._entry}: mass"))
        stiffness = dict.fromkeys(("tangential_stiffness", "normal_stiffness"), "N/m")
        self._keep_pairs(friction="", **stiffness, gap="m")
        for key in ("friction", *stiffness):
            for one in self._pair(key):
                from_zero(one, "", f"{self._entry}: {key}")
        if not isinstance(self.load, Centrifugal):
            set_fields(self, load=physical_number(self.load, "N", f"{self._entry}: load"))
        elif not self.mass:
            raise ModelError(
                f"{self._entry}: a mass of 0 has no centrifugal load, and nothing presses its "
                "faces; give the load in N, or a small mass"
            )

    @property
    def _entry(self) -> str:
        return type(self).__name__

    @property
    def force(self) -> float:
        """Static load along +y [N]."""
        if isinstance(self.load, Centrifugal):
            return self.load.force(self.mass)
        return float(self.load)

    def _keep_pairs(self, **units: str) -> None:
        """Keep numbers of one or both faces, which may be texts with units."""
        for key, unit in units.items():
            pair = _one_or_two(getattr(self, key), unit, f"{self._entry}: {key}")
            set_fields(self, **{key: pair})

    def _keep_angles(self) -> None:
        """Keep the angles of the faces [deg]."""
        self._keep_pairs(angle="deg")
        for one in self._pair("angle"):
            _require_angle(one, f"{self._entry}: angle")

    def _pair(self, key: str) -> tuple[float, float]:
        """Return the numbers of the left and the right face."""
        value: Pair = getattr(self, key)
        return value if isinstance(value, tuple) else (value, value)

    def _face(self, side: int, points: Sequence[ContactPoint], body: str = "damper") -> Face:
        return Face(
            points=tuple(points),
            to=_SIDES[side],
            friction=self._pair("friction")[side],
            tangential_stiffness=self._pair("tangential_stiffness")[side],
            normal_stiffness=self._pair("normal_stiffness")[side],
            gap=self._pair("gap")[side],
            body=body,
        )


@dataclass(frozen=True, kw_only=True)
class WedgeDamper(_TwoFaces):
    """A wedge under two platforms; with two angles a cottage roof that is not symmetric.

    The normals out of its faces are (-sin a, cos a) on the left and (sin a, cos a) on the right;
    the load acts along +y and presses both faces. From a friction of cot a on the wedge locks: it
    stays where it was driven without any load.

    Parameters
    ----------
    angle : float or (float, float)
        Angle a of the normals of the faces from the load [deg], 0 to 90: of both, or of the left
        and the right one.
    mass : float
        Mass [kg]; 0: the contacts alone decide how it moves.
    friction : float or (float, float)
        Coefficient of friction.
    tangential_stiffness, normal_stiffness : float or (float, float)
        Stiffnesses of a face [N/m]; its points share them equally.
    load : float or Centrifugal
        Static load along +y [N], or the radius and the speed that make it.
    gap : float or (float, float), optional
        Distance between a face and its neighbour [m], negative for an interference.
    inertia : float, optional
        Moment of inertia about the centre of mass [kg m2]. Without it the wedge does not turn.
    positions : sequence of (float, float), optional
        Points of the left face, from the centre of mass [m], of a wedge that turns; those of the
        right face are their mirror images. Two lists are those of the left and of the right face.
        With one point a face leaves rotation without stiffness while it slips.

    Raises
    ------
    ModelError
        If a number is outside its range, or positions are given without an inertia, or it without
        them.

    Examples
    --------
    >>> import stickslip as ss
    >>> wedge = ss.WedgeDamper(angle=30.0, mass=0.1, friction=0.5, tangential_stiffness=3e5,
    ...                        normal_stiffness=3e5, load=120.0)
    >>> blade = ss.Structure([[1.0, 0.0], [0.0, 1.0]], [[4e4, 0.0], [0.0, 9e4]], dofs=["x", "y"])
    >>> wedge.between(blade, blade, left_dofs=["x", "y"], right_dofs=["x", "y"]).structure
    Structure(6 dofs: left.x, left.y, right.x, right.y, damper.x, damper.y)
    """

    angle: Pair
    inertia: float | None = None
    positions: Sequence[Place] | tuple[Sequence[Place], Sequence[Place]] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        self._keep_angles()
        if (self.inertia is None) != (self.positions is None):
            raise ModelError(
                f"{self._entry}: give inertia and positions together: what turns does so by the "
                "lever arms of its contact points"
            )
        _places(self.positions)
        set_fields(self, inertia=_inertia(self.inertia, self._entry))

    @property
    def locks(self) -> bool:
        """Whether friction holds it where it is without any load: jamming, mu >= cot a."""
        cones = sum(map(atan, self._pair("friction")))
        return cones >= pi - radians(sum(self._pair("angle"))) - 1e-12

    @property
    def bodies(self) -> Mapping[str, Body]:
        """The wedge."""
        return {"damper": RigidBody(self.mass, self.inertia, load=(0.0, self.force))}

    @property
    def faces(self) -> tuple[Face, ...]:
        """The left and the right face."""
        return tuple(
            self._face(side, [ContactPoint(normal, place) for place in places])
            for side, (normal, places) in enumerate(
                zip(_normals(self._pair("angle")), _places(self.positions), strict=True)
            )
        )


@dataclass(frozen=True, kw_only=True)
class CylinderDamper(_TwoFaces):
    """A cylinder under two platforms: it slides and rolls.

    Its normals are those of a `WedgeDamper` of the same angle, at whose ends it touches.

    Parameters
    ----------
    angle : float or (float, float)
        Angle of the normals at the contacts from the load [deg], 0 to 90.
    cylinder_radius : float
        Radius of the cylinder [m].
    inertia : float, optional
        Moment of inertia [kg m2]. Default: of a full cylinder, m r^2 / 2.
    mass, friction, tangential_stiffness, normal_stiffness, load, gap
        As of `WedgeDamper`.

    Raises
    ------
    ModelError
        If a number is outside its range.
    """

    angle: Pair
    cylinder_radius: float
    inertia: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        self._keep_angles()
        radius = from_zero(self.cylinder_radius, "m", f"{self._entry}: cylinder_radius")
        set_fields(self, cylinder_radius=radius)
        if not radius > 0.0:
            raise ModelError(f"{self._entry}: cylinder_radius 0; give the radius in m")
        set_fields(self, inertia=_inertia(self.inertia, self._entry))

    @property
    def bodies(self) -> Mapping[str, Body]:
        """The cylinder."""
        full = 0.5 * self.mass * self.cylinder_radius**2
        turns = full if self.inertia is None else self.inertia
        return {"damper": RigidBody(self.mass, turns, load=(0.0, self.force))}

    @property
    def faces(self) -> tuple[Face, ...]:
        """The lines along which it touches."""
        r = self.cylinder_radius
        return tuple(
            self._face(side, [ContactPoint(n, (r * n[0], r * n[1]))])
            for side, n in enumerate(_normals(self._pair("angle")))
        )


@dataclass(frozen=True, kw_only=True)
class SplitDamper(_TwoFaces):
    """A wedge of two halves that rub on each other: bodies "damper.left" and "damper.right".

    Parameters
    ----------
    angle : float or (float, float)
        As of `WedgeDamper`.
    mass, load
        Of both halves together; each has a half.
    split_friction, split_tangential_stiffness, split_normal_stiffness : float, optional
        Of the contact "split" between the halves. Default: those of the left face.
    split_angle : float, optional
        Angle of the normal out of the left half into the right one, from x to y [deg].
    friction, tangential_stiffness, normal_stiffness, gap
        As of `WedgeDamper`.

    Raises
    ------
    ModelError
        If a number is outside its range.
    """

    angle: Pair
    split_angle: float = 0.0
    split_friction: float | None = None
    split_tangential_stiffness: float | None = None
    split_normal_stiffness: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        self._keep_angles()
        turned = physical_number(self.split_angle, "deg", f"{self._entry}: split_angle")
        set_fields(self, split_angle=turned)

    @property
    def bodies(self) -> Mapping[str, Body]:
        """The two halves."""
        half = RigidBody(0.5 * self.mass, load=(0.0, 0.5 * self.force))
        return {f"damper.{side}": half for side in _SIDES}

    @property
    def faces(self) -> tuple[Face, ...]:
        """The outer faces, and that between the halves."""
        outer = [
            self._face(side, [ContactPoint(n)], f"damper.{_SIDES[side]}")
            for side, n in enumerate(_normals(self._pair("angle")))
        ]
        turn = radians(self.split_angle)
        own = {
            key: self._pair(key)[0] if (given := getattr(self, f"split_{key}")) is None else given
            for key in ("friction", "tangential_stiffness", "normal_stiffness")
        }
        split = Face(
            points=(ContactPoint((cos(turn), sin(turn))),),
            body="damper.left",
            to="damper.right",
            name="split",
            friction=own["friction"],
            tangential_stiffness=own["tangential_stiffness"],
            normal_stiffness=own["normal_stiffness"],
        )
        return (*outer, split)


@dataclass(frozen=True, kw_only=True)
class StripDamper(_TwoFaces):
    """A strip between a platform and the disk below: the load presses it on the platform.

    The platform is the left neighbour, above, normal (0, 1); the disk the right one, below, normal
    (0, -1), as a rule behind a gap, or pressed by an interference.

    Parameters
    ----------
    inertia : float, optional
        Moment of inertia [kg m2]; without it the strip does not turn.
    positions : sequence of (float, float), optional
        Points of the upper face, from the centre of mass [m]; those of the lower face lie mirrored
        below. Two lists are those of the upper and the lower face.
    mass, friction, tangential_stiffness, normal_stiffness, load, gap
        As of `WedgeDamper`, of the platform and of the disk.

    Raises
    ------
    ModelError
        As of `WedgeDamper`.
    """

    inertia: float | None = None
    positions: Sequence[Place] | tuple[Sequence[Place], Sequence[Place]] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.inertia is None) != (self.positions is None):
            raise ModelError(f"{self._entry}: give inertia and positions together, or neither")
        _places(self.positions)
        set_fields(self, inertia=_inertia(self.inertia, self._entry))

    @property
    def bodies(self) -> Mapping[str, Body]:
        """The strip."""
        return {"damper": RigidBody(self.mass, self.inertia, load=(0.0, self.force))}

    @property
    def faces(self) -> tuple[Face, ...]:
        """The upper and the lower face."""
        places = _places(self.positions, mirror=(1.0, -1.0))
        return tuple(
            self._face(side, [ContactPoint((0.0, sign), place) for place in own])
            for side, (sign, own) in enumerate(zip((1.0, -1.0), places, strict=True))
        )


def _one_or_two(value: object, unit: str, entry: str) -> Pair:
    if isinstance(value, tuple | list):
        if len(value) != 2:
            raise ModelError(f"{entry}: {len(value)} numbers; give one, or (left, right)")
        return physical_number(value[0], unit, entry), physical_number(value[1], unit, entry)
    return physical_number(value, unit, entry)


def _inertia(value: float | None, entry: str) -> float | None:
    return None if value is None else from_zero(value, "kg*m^2", f"{entry}: inertia")


def _require_angle(angle: float, entry: str) -> None:
    if not 0.0 <= angle < 90.0:
        between = "from 0 to below 90, between the normal of a face and the load"
        raise ModelError(
            f"{entry} {angle:g}; give degrees {between}",
            study=f"{entry} {angle:g} deg; give degrees {between}, as '30 deg': a number alone is "
            "in rad",
        )


def _normals(angles: tuple[float, float]) -> tuple[Place, Place]:
    """Return the normals out of the left and the right face."""
    left, right = map(radians, angles)
    return (-sin(left), cos(left)), (sin(right), cos(right))


def _places(
    positions: object, mirror: Place = (-1.0, 1.0)
) -> tuple[Sequence[Place | None], Sequence[Place | None]]:
    """Return the points of both faces; those of one that are not given are mirror images."""
    if positions is None:
        return [None], [None]
    listed = _listed(positions)
    if any(
        isinstance(one, list | tuple) and one and isinstance(one[0], list | tuple) for one in listed
    ):
        if len(listed) != 2:
            raise ModelError(f"positions: {len(listed)} lists of points; give one, or two")
        left, right = ([_place(one) for one in _listed(each)] for each in listed)
    else:
        left = [_place(one) for one in listed]
        right = [(mirror[0] * x, mirror[1] * y) for x, y in left]
    if not left or not right:
        raise ModelError(f"positions: {brief(positions)} has a face without points; {_POINTS}")
    return left, right


def _place(value: object) -> Place:
    numbers = [physical_number(one, "m", "positions") for one in _listed(value)]
    if len(numbers) != 2:
        raise ModelError(f"positions: {brief(value)} is no point; {_POINTS}")
    return numbers[0], numbers[1]


def _listed(value: Any) -> tuple[Any, ...]:
    return members(value, "positions", _POINTS)
