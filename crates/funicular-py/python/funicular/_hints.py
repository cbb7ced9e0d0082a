"""Errors of calls in the words of Python: a mistyped keyword gets a hint, an argument of another type its name."""

import functools
import inspect
import re
from collections.abc import Callable, Mapping
from types import ClassMethodDescriptorType, MethodDescriptorType
from typing import Any, ParamSpec, TypeVar

from funicular._errors import InputError
from funicular._funicular import Analyses, Catenary, Equilibrium, Pose, Robot, suggested

P = ParamSpec("P")
R = TypeVar("R")

# Types in messages of the compiled half, and words for them.
_WANTED = {"str": "text", "bool": "True or False", "PathLike": "a path as text or pathlib.Path", "dict": "a dictionary"}


def hinted(function: Callable[P, R]) -> Callable[P, R]:
    """Function with hints in the errors of its call."""

    @functools.wraps(function)
    def call(*arguments: P.args, **keywords: P.kwargs) -> R:
        try:
            return function(*arguments, **keywords)
        except TypeError as error:
            # An error from inside has further places.
            inside = error.__traceback__ is not None and error.__traceback__.tb_next is not None
            better = None if inside else _better(function, arguments, keywords, error)
            if better is None:
                raise
        raise better

    return call


def _better(function: Callable[..., Any], arguments: Any, keywords: Any, error: TypeError) -> Exception | None:
    signature = inspect.signature(function)
    if unknown := re.search(r"got an unexpected keyword argument '(.+)'$", str(error)):
        known = [name for name in signature.parameters if name not in ("self", "keywords")]
        return TypeError(f"{error}{suggested(unknown[1], known)}")
    return in_words(signature.bind_partial(*arguments, **keywords).arguments, error)


def in_words(given: Mapping[str, Any], error: TypeError) -> InputError | None:
    """Error of the compiled half about the type of an argument, in words; None for another error."""
    said, notes = str(error), " ".join(getattr(error, "__notes__", ()))
    named = re.search(r"while processing '(\w+)'", notes)
    if not named:
        return None
    value = given.get(named[1])
    shown = repr(value)
    is_short = len(shown) <= 60 and shown.isprintable()
    kinds = [words for kind, words in _WANTED.items() if re.search(rf"\b{kind}\b['`]?$", said)]
    wanted = f"give {kinds[0]}" if kinds else said
    return InputError(f"`{named[1]}` is {f'{shown}, ' if is_short else ''}of type {type(value).__name__}: {wanted}")


def _hinted_class_method(method: ClassMethodDescriptorType) -> Any:
    """Class method with hints in the errors of its call."""

    @functools.wraps(method)
    def call(of: type, /, *arguments: Any, **keywords: Any) -> Any:
        return hinted(method.__get__(None, of))(*arguments, **keywords)

    return classmethod(call)


# Assigned here and not written into the classes, which are compiled.
for _class in (Analyses, Catenary, Robot, Equilibrium, Pose):
    for _name, _method in list(vars(_class).items()):
        if isinstance(_method, MethodDescriptorType) and not _name.startswith("_"):
            setattr(_class, _name, hinted(_method))
        elif isinstance(_method, ClassMethodDescriptorType):
            setattr(_class, _name, _hinted_class_method(_method))
