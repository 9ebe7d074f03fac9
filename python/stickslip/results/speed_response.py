"""Amplitudes along the speed of rotation."""

from __future__ import annotations

from typing import ClassVar

from stickslip.drawn import Drawn
from stickslip.results.fields import Columns, Float, Shown, column
from stickslip.results.result import ColumnResult
from stickslip.settings.speed import SpeedSettings


class SpeedArrays(Columns):
    """What an engine order excites at each speed of rotation."""

    speed: Float = column("speed", "rad/s", "speed of rotation", least=0.0)
    omega: Float = column("speed", "rad/s", "angular frequency of the forces", least=0.0)
    amplitude: Float = column(
        "speed", "m", "half peak-to-peak amplitude; nan where none was found", least=0.0
    )
    error_estimate: Float = column(
        "speed", "m", "estimated error of the amplitude by discarded harmonics", least=0.0
    )


class SpeedResponse(ColumnResult):
    """Amplitudes along the speed of rotation; the model is that of the first speed."""

    kind: ClassVar[str] = "speed_response"
    title = "Response along the speed of rotation"
    headline = "amplitude"

    settings: SpeedSettings
    arrays: SpeedArrays

    def __repr__(self) -> str:
        return (
            f"SpeedResponse({self.dof}, engine order {self.engine_order:g}, {self.speed.size} "
            f"speeds from {self.speed.min():g} to {self.speed.max():g} rad/s)"
        )

    speed = Shown[Float]()
    omega = Shown[Float]()
    amplitude = Shown[Float]()
    error_estimate = Shown[Float]()

    @property
    def dof(self) -> str:
        """The degree of freedom."""
        return self.settings.dof

    @property
    def engine_order(self) -> float:
        """Frequency of the forces over the speed."""
        return float(self.settings.engine_order or 0.0)

    plot = Drawn("speed_response")
