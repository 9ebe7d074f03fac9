"""The tables [[analysis.measurement]] of a fit: tests, each from a file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from stickslip.analyses.fit_parameters import FitParameter
from stickslip.errors import ModelError
from stickslip.io.curve import read_curve
from stickslip.io.frf import read_frf
from stickslip.model import Model
from stickslip.model.measurement import Measured, MeasuredLoop, Measurement
from stickslip.settings.entries import (
    ONE_OF,
    Count,
    Dof,
    Factor,
    Measure,
    Newtons,
    Number,
    Ratio,
    Table,
    Text,
)
from stickslip.units import quantity

_UFF = (".uff", ".unv", ".58")


class MeasurementTable(Table):
    """One test: a response curve at a DOF, or a hysteresis loop of a contact."""

    file: Text = Field(
        description="Text file of two columns, frequency and amplitude, of loops displacement and "
        "force; or a UFF file with one frequency response function.",
        examples=["level-5.csv"],
    )
    dof: Dof | None = Field(default=None, description="The DOF that was measured.")
    contact: Text | None = Field(default=None, description="Instead: the contact of a loop.")
    name: Text | None = Field(default=None, description="Its name in tables and pictures.")
    level: Factor = Field(default=1.0, description="Factor on all forces in this test.")
    at: dict[str, Number] = Field(
        default_factory=dict,
        description="Parameters that this test had of its own, by name, in SI units.",
        examples=[{"pad.preload": 120.0}],
    )
    measure: Measure = Field(
        default="half_range", description="What was called amplitude; of UFF files the fundamental."
    )
    frequency_unit: Annotated[Literal["rad/s", "Hz", "rpm"], ONE_OF] = Field(
        default="rad/s", description="Unit of the frequencies of text files."
    )
    length_unit: Text = Field(
        default="m", description="Unit of the lengths of text files.", examples=["mm", "um"]
    )
    force: Newtons = Field(default=1.0, description="Amplitude of the force, of UFF files [N].")
    harmonics: Count = Field(default=5, description="Harmonics of the displacement of a loop.")
    relative_noise: Ratio | None = Field(
        default=None, description="Standard deviation of the amplitudes over themselves."
    )
    noise: Number | None = Field(
        default=None,
        description="Instead: standard deviation of all amplitudes [m], or forces [N].",
    )

    @model_validator(mode="after")
    def _require_one(self) -> MeasurementTable:
        if (self.dof is None) == (self.contact is None):
            raise ValueError("give one of 'dof' and 'contact'")
        return self

    def read(self, folder: Path) -> Measured:
        """Return the measurement, without a model of its own."""
        file = folder / self.file
        more: dict[str, Any] = {
            "relative_noise": self.relative_noise,
            "noise": self.noise,
            "name": self.name or file.stem,
        }
        if self.dof is not None and file.suffix.lower() in _UFF:
            frfs = read_frf(file)
            if len(frfs) != 1:
                raise ModelError(f"{file}: holds {len(frfs)} functions; give a file of one")
            return Measurement.of_frf(frfs[0], self.dof, self.force, **more)
        first, second = read_curve(file)
        length = quantity(f"1 {self.length_unit}", "m", "length_unit")
        if self.contact is not None:
            return MeasuredLoop(
                self.contact, first * length, second, harmonics=self.harmonics, **more
            )
        rate = quantity(f"1 {self.frequency_unit}", "rad/s", "frequency_unit")
        return Measurement(first * rate, str(self.dof), second * length, self.measure, **more)

    def model_of(self, model: Model) -> Model:
        """Return the model of the test."""
        for name, value in self.at.items():
            model = FitParameter(name, value, np.inf).apply(model, value)
        return model.scaled(force=self.level)
