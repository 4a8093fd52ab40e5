"""Python values as TOML: the compiled part reads scenes in memory in the words of scene files."""

from __future__ import annotations

import datetime
import json
import math
import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np


def value(x: Any, where: str = "") -> str:
    """A value as TOML writes it, tables inline. Raises ValueError naming `where` for what TOML does not have."""
    if isinstance(x, (bool, np.bool_)):
        return "true" if x else "false"
    if isinstance(x, (int, np.integer)):
        return str(int(x))
    if isinstance(x, (float, np.floating)):
        x = float(x)
        return repr(x) if math.isfinite(x) else "nan" if math.isnan(x) else "inf" if x > 0 else "-inf"
    if isinstance(x, str):
        return json.dumps(x, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(x, os.PathLike):
        return value(os.fspath(x), where)
    if isinstance(x, datetime.datetime):
        if x.tzinfo is None:
            raise ValueError(f"{where}: found {x.isoformat()} without a zone; expected a datetime with tzinfo")
        return value(x.isoformat(), where)
    if isinstance(x, Mapping):
        inner = (f"{value(str(k))} = {value(v, f'{where}.{k}')}" for k, v in x.items() if v is not None)
        return "{ " + ", ".join(inner) + " }"
    if isinstance(x, np.ndarray):
        return value(x.tolist(), where)
    if isinstance(x, Sequence):
        return "[" + ", ".join(value(v, f"{where}[{i}]") for i, v in enumerate(x)) + "]"
    raise ValueError(f"{where}: found {type(x).__name__}; expected a number, text, sequence or mapping")


def text(table: Mapping[str, Any]) -> str:
    """A whole document; keys of None are left out."""
    return "".join(f"{value(k)} = {value(v, k)}\n" for k, v in table.items() if v is not None)
