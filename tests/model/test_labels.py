"""Names that tables give the degrees of freedom of a structure."""

import numpy as np
import pytest

import stickslip as ss


class Table:
    """What numpy and `Structure` see of a table of pandas."""

    def __init__(self, values, names, rows=None):
        self.values, self.columns = np.asarray(values), names
        self.index = names if rows is None else rows

    def __array__(self, dtype=None, copy=None):
        return self.values


def test_tables_name_the_degrees_of_freedom():
    mass, stiffness = np.diag([1.0, 2.0]), np.diag([3.0, 4.0])
    tables = [Table(one, ["root", "tip"]) for one in (mass, stiffness)]
    assert ss.Structure(*tables).dofs == ("root", "tip")
    assert ss.Structure(mass, tables[1]).dofs == ("root", "tip")
    assert ss.Structure(*tables, dofs=["a", "b"]).dofs == ("a", "b")
    assert ss.Structure(Table(mass, range(2)), stiffness).dofs == ("0", "1")
    assert ss.Structure(Table(mass, ["root", "tip"], range(2)), stiffness).dofs == ("root", "tip")


@pytest.mark.parametrize(
    ("make", "entry"),
    [
        (lambda ahead, back: ss.Structure(ahead, back), "stiffness: its columns"),
        (lambda ahead, back: ss.Structure(ahead, ahead, back), "damping: its columns"),
        (lambda ahead, back: ss.Structure(back, back, dofs=["root", "tip"]), "mass: its columns"),
        (
            lambda ahead, back: ss.Structure(Table(np.eye(2), ahead.columns, back.columns), ahead),
            "mass: its index",
        ),
    ],
)
def test_tables_in_another_order_are_refused(make, entry):
    """Their numbers had been put at other degrees of freedom, silently."""
    ahead, back = (Table(np.eye(2), names) for names in (["root", "tip"], ["tip", "root"]))
    with pytest.raises(ss.ModelError, match=rf"{entry} are \['.*'\], beside .*one order"):
        make(ahead, back)
