"""What analyses return: immutable results, their tables, data sets and files."""

from stickslip.calls import checked_names
from stickslip.results.arrays import Measure
from stickslip.results.certificate import Certificate
from stickslip.results.forced_response import ForcedResponse
from stickslip.results.peaks import Peak, Summary
from stickslip.results.status import Status

__all__ = ["Certificate", "ForcedResponse", "Measure", "Peak", "Status", "Summary"]

checked_names(globals(), __all__)
