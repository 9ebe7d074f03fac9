"""The tables [[analysis.measurement]] of a fit: tests, each from a file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from stickslip.analyses.fit_parameters import FitParameter, require_distinct, require_unit
from stickslip.checks import brief
from stickslip.errors import EntryError, ModelError
from stickslip.io.curve import read_curve
from stickslip.io.frf import read_frf
from stickslip.model import Model
from stickslip.model.measurement import Measured, MeasuredBackbone, MeasuredLoop, Measurement
from stickslip.model.measurement.curve import only_force
from stickslip.settings.entries import (
    ONE_OF,
    Count,
    Dof,
    Factor,
    Index,
    Measure,
    Newtons,
    Quantified,
    Ratio,
    Table,
    Text,
)
from stickslip.settings.variation import unit_of
from stickslip.units import physical_number, quantity

_UFF = (".uff", ".unv", ".58")
_OF_AMPLITUDES = ("relative_noise", "noise")
_USED = {
    "harmonics": (("loop",), "the loop of a contact"),
    "force": (("function",), "a Universal File"),
    "measure": (("curve", "backbone"), "amplitudes of a text file at a dof"),
    "frequency_unit": (("curve", "backbone", "modal backbone"), "frequencies of a text file"),
    "length_unit": (("curve", "backbone", "loop"), "displacements of a text file"),
}
"""What is used of which kinds of files only."""
_TOLD = {("function", "measure"): "fundamental"}
"""What is so in any case, and may be said."""


def _own_values(given: object) -> dict[str, Any]:
    """Check the values of parameters, each a number or a text with its unit."""
    if not isinstance(given, Mapping):
        raise EntryError("", f": {brief(given)} is no table; give {{parameter = value}}")
    for name, value in given.items():
        try:
            physical_number(value, unit_of(name), "")
        except EntryError as error:
            raise EntryError("", f"[{name!r}]{error.said}") from None
    return dict(given)


class MeasurementTable(Table):
    """One test: a response curve at a DOF, a hysteresis loop of a contact, or a backbone."""

    file: Text = Field(
        description="Text file of two columns, frequency and amplitude, of loops displacement and "
        "force; of backbones of three, amplitude, frequency and damping ratio; or a UFF file with "
        "one frequency response function.",
        examples=["level-5.csv"],
    )
    dof: Dof | None = Field(default=None, description="The DOF that was measured.")
    contact: Text | None = Field(default=None, description="Instead: the contact of a loop.")
    mode: Index | None = Field(
        default=None,
        description="Mode of a backbone, counted from 0; with `dof` its amplitudes are those of "
        "that DOF, else modal ones [m kg^(1/2)].",
    )
    name: Text | None = Field(default=None, description="Its name in tables and pictures.")
    level: Factor = Field(default=1.0, description="Factor on the forces that vary in this test.")
    at: Annotated[dict[str, Any], BeforeValidator(_own_values)] = Field(
        default_factory=dict,
        description="Parameters that this test had of its own, by name.",
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
    force: Newtons | None = Field(
        default=None,
        description="Amplitude of the force, of UFF files [N]. Default: that of the model's force "
        "at this level.",
    )
    harmonics: Count = Field(default=5, description="Harmonics of the displacement of a loop.")
    relative_noise: Ratio | None = Field(
        default=None, description="Standard deviation of the amplitudes over themselves."
    )
    noise: Quantified | None = Field(
        default=None,
        description="Instead: standard deviation of all amplitudes [m], or forces [N].",
        examples=["0.01 mm"],
    )
    frequency_noise: Ratio | None = Field(
        default=None, description="Of backbones: standard deviation of frequencies over themselves."
    )
    damping_noise: Ratio | None = Field(
        default=None, description="Of backbones: that of the damping ratios over themselves."
    )

    @model_validator(mode="after")
    def _require_one(self) -> MeasurementTable:
        if self.mode is not None and self.contact is not None:
            raise ValueError("'mode' is for a backbone, 'contact' for a loop; give one of them")
        if self.mode is None and (self.dof is None) == (self.contact is None):
            raise ValueError("give one of 'dof' and 'contact', or 'mode' of a backbone")
        backbone = self.mode is not None
        for key in ("frequency_noise", "damping_noise") if not backbone else _OF_AMPLITUDES:
            if getattr(self, key) is not None:
                kind = "a backbone" if not backbone else "amplitudes and forces"
                raise ValueError(f"{key!r} is for {kind}; leave it out")
        self._require_used()
        return self

    def _require_used(self) -> None:
        """Refuse what would change nothing, as a length unit of a file that has SI units."""
        kind = self._kind
        for key, (kinds, said) in _USED.items():
            value, default = getattr(self, key), type(self).model_fields[key].default
            if kind not in kinds and value not in (default, _TOLD.get((kind, key), default)):
                raise ValueError(f"{key!r} is for {said}; leave it out")
        if isinstance(self.noise, float) and self.length_unit != "m" and kind != "loop":
            raise ValueError(
                f"noise = {self.noise:g} beside length_unit = {self.length_unit!r}; write its "
                f"unit, '{self.noise:g} {self.length_unit}' or '{self.noise:g} m'"
            )

    @property
    def _kind(self) -> str:
        """What the file holds."""
        if self.mode is not None:
            return "modal backbone" if self.dof is None else "backbone"
        if self.contact is not None:
            return "loop"
        return "function" if Path(self.file).suffix.lower() in _UFF else "curve"

    def read(self, folder: Path) -> Measured:
        """Return the measurement, without a model of its own."""
        file = folder / self.file
        if self.mode is not None:
            return self._backbone(file, self.mode)
        more: dict[str, Any] = {
            "relative_noise": self.relative_noise,
            "noise": self.noise,
            "name": self.name or file.stem,
        }
        if self.dof is not None and self._kind == "function":
            frfs = read_frf(file)
            if len(frfs) != 1:
                raise ModelError(f"{file}: holds {len(frfs)} functions; give a file of one")
            force = 1.0 if self.force is None else self.force
            return Measurement.of_frf(frfs[0], self.dof, force, **more)
        first, second = read_curve(file)
        length = self._length
        if self.contact is not None:
            return MeasuredLoop(
                self.contact, first * length, second, harmonics=self.harmonics, **more
            )
        omega, amplitude = first * self._rate, second * length
        return Measurement(omega, str(self.dof), amplitude, self.measure, **more)

    def _backbone(self, file: Path, mode: int) -> Measured:
        """Return the backbone of a file."""
        amplitude, frequency, damping_ratio = read_curve(file, columns=3)
        return MeasuredBackbone(
            amplitude if self.dof is None else amplitude * self._length,
            frequency * self._rate,
            damping_ratio,
            dof=self.dof,
            measure=self.measure,
            mode=mode,
            frequency_noise=self.frequency_noise,
            damping_noise=self.damping_noise,
            name=self.name or file.stem,
        )

    @property
    def _length(self) -> float:
        return quantity(f"1 {self.length_unit}", "m", "length_unit")

    @property
    def _rate(self) -> float:
        return quantity(f"1 {self.frequency_unit}", "rad/s", "frequency_unit")

    def test(self, read: Measured, model: Model, fitted: Iterable[str]) -> Measured:
        """Return a measurement as `read`, with the model of its test, of which some is fitted."""
        require_distinct(model, [*self.at, *fitted], f"measurement of {self.file!r}: at")
        own = self._model_of(model)
        if self._kind == "function" and self.force is None and isinstance(read, Measurement):
            read = read.times(only_force(own))
        return read.on(own)

    def _model_of(self, model: Model) -> Model:
        for name, given in self.at.items():
            require_unit(model, name, [given])
            value = physical_number(given, unit_of(name), name)
            model = FitParameter(name, value, np.inf).apply(model, value)
        return model.scaled(force=self.level)
