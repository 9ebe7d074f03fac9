"""Matrices from files."""

from stickslip.io.matrices import read_matrix

__all__ = ["read_matrix"]
