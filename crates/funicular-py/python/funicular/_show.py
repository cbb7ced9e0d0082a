"""Hooks for presentation: results call them, and `_html`, `_tables` and `_datasets` register what each type looks like.

Results import this module alone, so that they know nothing of HTML, pandas or xarray.
"""

from functools import singledispatch
from typing import Any


@singledispatch
def html(result: object) -> str:
    """HTML that a notebook shows for a result."""
    raise TypeError(f"no HTML is registered for {type(result).__name__}")


@singledispatch
def table(result: object) -> Any:
    """Table of pandas for a result."""
    raise TypeError(f"no table is registered for {type(result).__name__}")


@singledispatch
def dataset(result: object) -> Any:
    """Dataset of xarray for a result."""
    raise TypeError(f"no dataset is registered for {type(result).__name__}")
