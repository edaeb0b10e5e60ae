"""What a vehicle's modes work with: a Guidance that moves the reference."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from inspect_cli.interfaces import FlightStack, Posture
from inspect_cli.records import SurfaceEstimate
from inspect_cli.schema.plan import Target


class Guidance(Protocol):
    """Moves the reference of a vehicle that follows poses; see ``guidance.pursuit``."""

    tracks_surface: bool
    """Whether the surface that is seen corrects the reference."""

    def go_to(self, t_s: float, postures: Sequence[Posture], speed_mps: float) -> None:
        """Pass postures at rest, one after the other."""
        ...

    def take_impedance(self, name: str) -> None:
        """Fly with an impedance profile from now on."""
        ...

    def approach(self, t_s: float, target: Target, depth_m: float, speed_mps: float) -> None:
        """Aim the tool ``depth_m`` behind the target's surface (negative: in front of it)."""
        ...

    def slide(self, t_s: float, target: Target) -> None:
        """Move along the target's stroke, or along the surface that is seen."""
        ...

    def observe(self, t_s: float, surface: SurfaceEstimate) -> None:
        """Correct the contact frame by what the camera sees."""
        ...

    def contradicts(self, t_s: float, target: Target, surface: SurfaceEstimate) -> bool:
        """Whether the surface cannot be the one that is believed at the target."""
        ...

    def hold(self, t_s: float) -> None:
        """Stop smoothly."""
        ...

    def arrived(self, t_s: float) -> bool:
        """Whether the reference has come to rest at its goal."""
        ...


class GuidedStack(FlightStack, Protocol):
    """A flight stack whose reference is moved by a Guidance."""

    @property
    def guidance(self) -> Guidance:
        """What moves its reference."""
        ...
