"""The dissertation reproduced: its tables and figures, computed with the public interface.

J. Guillen, "Studies of the dynamics of dry-friction-damped blade assemblies" (University of
Michigan, 1999). One function per table or figure in the module of its chapter; `catalogue` knows
which there are, and which are still missing.
"""

from stickslip_reproduce.catalogue import SUBJECTS, chosen, items
from stickslip_reproduce.costs import costs
from stickslip_reproduce.folder import write
from stickslip_reproduce.item import Item, heading
from stickslip_reproduce.numbers import Axis, Fact, Numbers, Panel, Plot, Series, Table
from stickslip_reproduce.resolution import COARSE, FULL, Resolution

__all__ = [
    "COARSE",
    "FULL",
    "SUBJECTS",
    "Axis",
    "Fact",
    "Item",
    "Numbers",
    "Panel",
    "Plot",
    "Resolution",
    "Series",
    "Table",
    "chosen",
    "costs",
    "heading",
    "items",
    "write",
]
