"""Arguments that become requests, by the readers that all arguments have."""

import json
from collections.abc import Iterable, Mapping, Sequence
from os import PathLike
from typing import Any

import numpy as np

from funicular._errors import InputError
from funicular._funicular import argument, interval

# Path of a file.
File = str | PathLike[str]


def read(command: str, key: str, value: Any, *, cables: Sequence[str] = (), name: str | None = None) -> Any:
    """Value of a key of a request; `name` stands in errors."""
    return json.loads(argument(command, key, name or key, value, list(cables)))


def keywords(command: str, given: Mapping[str, Any], cables: Sequence[str]) -> dict[str, Any]:
    """Keys of a request; None counts as not given."""
    return {key: _READERS.get(key, read)(command, key, value, cables=cables) for key, value in given.items() if value is not None or key in _READERS}


def _listed_experiments(given: Any) -> Sequence[Mapping[str, Any]]:
    listed = [given] if isinstance(given, Mapping) else given
    if not isinstance(listed, (list, tuple)) or not all(isinstance(one, Mapping) for one in listed):
        raise InputError(
            f"`experiments` is of type {type(given).__name__}: give what `funicular.read_measurements` returns, or a list "
            "of such mappings"
        )
    return listed


def with_state(given: Any, state: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Experiments of `identify`, each with the keys of the state that it does not give itself."""
    return [{**state, **{key: value for key, value in one.items() if value is not None}} for one in _listed_experiments(given)]


def _pairs(key: str, given: Any, wanted: str) -> Iterable[tuple[str, Any]]:
    """Paths with what belongs to them, of a mapping or a series."""
    is_series = hasattr(given, "items") and hasattr(given, "index") and not hasattr(given, "columns")
    if not isinstance(given, Mapping) and not is_series:
        raise InputError(f"`{key}` is of type {type(given).__name__}: {wanted}")
    for path, value in given.items():
        if not isinstance(path, str):
            raise InputError(f"`{key}` has the path {path!r:.40}: a path is text, as in \"platform.mass_kg\"")
        yield path, value


def _number_of_file(key: str, path: str, value: Any, known: Sequence[str], scalar: str | None) -> dict[str, Any]:
    """Number that a request chooses, with its bounds or other keys."""
    name = f'{key}["{path}"]'
    if value is None and scalar is None:
        return {"path": path}
    if isinstance(value, Mapping):
        unknown = [word for word in value if word not in known]
        if unknown:
            raise InputError(f"`{name}` has no key `{unknown[0]!s:.40}`: it has {', '.join(known)}")
        return {"path": path, **{word: read("", word, of, name=f"{name}.{word}") for word, of in value.items() if of is not None}}
    if scalar is not None and not _is_row(value):
        return {"path": path, scalar: read("", scalar, value, name=name)}
    if not _is_row(value):
        raise InputError(f"`{name}` is {value!r:.40}, of type {type(value).__name__}: give None, bounds (minimum, maximum), or a mapping with {', '.join(known)}")
    low, high = interval(name, value)
    return {"path": path, "minimum": low, "maximum": high}


def _is_row(value: Any) -> bool:
    try:
        return not isinstance(value, (str, bytes)) and np.ndim(value) > 0
    except ValueError:  # rows of unequal length
        return True


def _listed(key: str, given: Any, known: Sequence[str]) -> list[dict[str, Any]] | None:
    """Numbers of a list of mappings with their `path`; None for another object."""
    if isinstance(given, (list, tuple)) and given and all(isinstance(one, Mapping) and isinstance(one.get("path"), str) for one in given):
        return [_number_of_file(key, one["path"], {word: of for word, of in one.items() if word != "path"}, known, "") for one in given]
    return None


_FIT = ("minimum", "maximum", "prior", "prior_std")
_CHANGE = ("plus_minus", "minimum", "maximum")


def _fit(command: str, key: str, given: Any, *, cables: Sequence[str]) -> list[dict[str, Any]]:
    """Values to identify: paths, or a mapping from paths to None, bounds or keys of a value."""
    if isinstance(given, str) or (not isinstance(given, Mapping) and isinstance(given, (list, tuple, np.ndarray)) and all(isinstance(one, str) for one in given)):
        return [{"path": path} for path in ([given] if isinstance(given, str) else given)]
    if isinstance(given, (list, tuple)) and given:
        mixed = [{"path": one} if isinstance(one, str) else one for one in given]
        listed = _listed(key, mixed, _FIT)
        if listed is not None:
            return listed
    wanted = 'give paths, as in ["platform.mass_kg"], or a mapping from paths to None, bounds or priors'
    return [_number_of_file(key, path, value, _FIT, None) for path, value in _pairs(key, given, wanted)]


def _change(command: str, key: str, given: Any, *, cables: Sequence[str]) -> list[dict[str, Any]]:
    """Values to choose: a mapping from paths to a reach (one number) or to bounds (minimum, maximum)."""
    listed = _listed(key, given, _CHANGE)
    if listed is not None:
        return listed
    wanted = 'give a mapping from paths to a largest change or to bounds, as in {"cables.*.attachment_m": 0.1}'
    return [_number_of_file(key, path, value, _CHANGE, "plus_minus") for path, value in _pairs(key, given, wanted)]


def _prior(command: str, key: str, given: Any, *, cables: Sequence[str]) -> list[dict[str, Any]]:
    """Values known beforehand: a mapping from names to a deviation, to value and deviation, or to keys of a prior."""
    known = ("prior", "prior_std")
    listed = _listed(key, given, known)
    if listed is not None:
        return listed
    wanted = 'give a mapping from names to deviations or to value and deviation, as in {"offsets": (0.0, 0.02)}'
    found = []
    for path, value in _pairs(key, given, wanted):
        if _is_row(value):
            if np.size(value) != 2:
                raise InputError(f'`{key}["{path}"]` has {np.size(value)} numbers: give the value and its deviation')
            value = dict(zip(known, value, strict=True))
        found.append(_number_of_file(key, path, value, known, "prior_std"))
    return found


def _experiments(command: str, key: str, given: Any, *, cables: Sequence[str]) -> list[dict[str, Any]]:
    """Experiments of `identify`; those that name their cables have one number per such cable."""
    found = []
    for i, one in enumerate(_listed_experiments(given)):
        mounted = read(command, "cables", one["cables"], name=f"experiments[{i}].cables") if one.get("cables") is not None else cables
        found.append({
            name: read(command, name, value, cables=mounted, name=f"experiments[{i}].{name}")
            for name, value in one.items()
            if value is not None
        })
    return found


_READERS: dict[str, Any] = {"fit": _fit, "change": _change, "prior": _prior, "experiments": _experiments}
