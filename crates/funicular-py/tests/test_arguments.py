"""Every method refuses arguments without real numbers and names them."""

import datetime
import itertools
import pickle
import re
import warnings
from array import array
from collections import deque
from collections.abc import Callable, Iterator
from decimal import Decimal
from fractions import Fraction
from typing import Any

import funicular
import funicular.plot
import numpy as np
import pytest

POSE = [0.0, 0.0, 0.5]
LENGTHS = list(funicular.Robot.example().lengths_m)  # type: ignore[arg-type]


def masked(values: Any, at: Any) -> Any:
    hidden = np.ma.array(values, dtype=float)
    hidden[at] = np.ma.masked
    return hidden


# Every public argument that takes one number: its name in errors, and a call with it.
SCALARS: list[tuple[str, Callable[[funicular.Robot, Any], object]]] = [
    ("below_hz", lambda robot, x: robot.modes(x)),
    ("below_hz", lambda robot, x: robot.equilibrium().modes(x)),
    ("mass_kg", lambda robot, x: robot.with_(mass_kg=x)),
    ("min_tension_n", lambda robot, x: robot.equilibrium(min_tension_n=x)),
    ("max_tension_n", lambda robot, x: robot.equilibria([POSE], max_tension_n=x)),
    ("min_tension_n", lambda robot, x: robot.map(poses=[POSE], min_tension_n=x)),
    ("up_to_hz", lambda robot, x: robot.map(poses=[POSE], up_to_hz=x)),
    ("up_to_hz", lambda robot, x: robot.sweep({"platform.mass_kg": 10}, up_to_hz=x)),
    (r"x\[0\]", lambda robot, x: robot.map({"x": (x, 1e3, 3), "y": 0, "z": 0.5})),
    (r"x\[1\]", lambda robot, x: robot.map({"x": (-1e3, x, 3), "y": 0, "z": 0.5})),
    (r"platform.mass_kg\[1\]", lambda robot, x: robot.sweep({"platform.mass_kg": (1e-3, x, 3)})),
    ("prominence_db", lambda robot, x: funicular.peaks([1, 2, 3], [1, 2, 1], prominence_db=x)),
    ("span_m", lambda robot, x: hanging(span_m=x)),
    ("rise_m", lambda robot, x: hanging(rise_m=x)),
    ("unstrained_length_m", lambda robot, x: hanging(unstrained_length_m=x)),
    ("weight_n_per_m", lambda robot, x: hanging(weight_n_per_m=x)),
    ("axial_stiffness_n", lambda robot, x: hanging(axial_stiffness_n=x)),
]

# Every public argument that takes an array, with valid numbers.
ARRAYS: list[tuple[str, list[Any], Callable[[funicular.Robot, Any], object]]] = [
    ("position_m", POSE, lambda robot, x: funicular.Pose(x)),
    ("roll_pitch_yaw_deg", POSE, lambda robot, x: funicular.Pose(POSE, x)),
    ("quaternion_wxyz", [1.0, 0, 0, 0], lambda robot, x: funicular.Pose(POSE, quaternion_wxyz=x)),
    ("pose", POSE, lambda robot, x: robot.equilibrium(pose=x)),
    ("lengths_m", LENGTHS, lambda robot, x: robot.equilibrium(lengths_m=x)),
    ("target_tension_n", [900.0] * 8, lambda robot, x: eight().equilibrium([1, 2, 1.5], target_tension_n=x)),
    ("force_n", [1.0, 0, 0], lambda robot, x: robot.equilibrium(force_n=x)),
    ("moment_n_m", [0.1, 0, 0], lambda robot, x: robot.equilibria([POSE], moment_n_m=x)),
    ("load_point_m", [0.1, 0, 0], lambda robot, x: robot.map(poses=[POSE], force_n=[0, 0, -1], load_point_m=x)),
    ("poses", [POSE, POSE], lambda robot, x: robot.equilibria(poses=x)),
    ("lengths_m", [LENGTHS, LENGTHS], lambda robot, x: robot.equilibria(lengths_m=x)),
    ("poses", [POSE, POSE], lambda robot, x: robot.map(poses=x)),
    ("pose", POSE, lambda robot, x: robot.map({"z": 0.5}, pose=x)),
    ("lengths_m", LENGTHS, lambda robot, x: robot.sweep({"platform.mass_kg": 10}, lengths_m=x)),
    ("z", [0.5, 0.625, 0.75, 0.875], lambda robot, x: robot.map({"x": 0, "y": 0, "z": x})),
    ("platform.mass_kg", [10.0, 11.0], lambda robot, x: robot.sweep({"platform.mass_kg": x})),
    ("at_hz", [1.0, 2.0], lambda robot, x: robot.stiffness(x, cable_model="shallow-dynamic")),
    ("hz", [1.0, 2.0], lambda robot, x: robot.frf(x, "fz", "z", cable_model="shallow-dynamic")),
    ("hz", [1.0, 2.0], lambda robot, x: robot.receptance(x, cable_model="shallow-dynamic")),
    ("input_point_m", [0.1, 0, 0], lambda robot, x: robot.frf([1], "fz", "z", input_point_m=x, cable_model="shallow-dynamic")),
    ("output_point_m", [0.1, 0, 0], lambda robot, x: robot.frf([1], "fz", "z", output_point_m=x, cable_model="shallow-dynamic")),
    ("hz", [1.0, 2.0, 3.0], lambda robot, x: funicular.peaks(x, [1, 2, 1])),
    ("arc_length_m", [0.5, 1.0], lambda robot, x: hanging().points_m(x)),
]


def hanging(**changes: Any) -> funicular.Catenary:
    good = {"span_m": 4, "rise_m": -1, "unstrained_length_m": 4.5, "weight_n_per_m": 0.6, "axial_stiffness_n": 1e5}
    return funicular.Catenary(**(good | changes))


def eight() -> funicular.Robot:
    from conftest import ROBOTS

    return funicular.Robot.from_file(ROBOTS / "cogiro.toml")


NO_NUMBERS: list[Any] = [
    True,
    np.True_,
    "5",
    np.str_("5"),
    b"5",
    5 + 0j,
    np.complex64(5),
    np.ma.masked,
    masked([5.0], 0)[0],
    np.array("5"),
    np.array(5 + 0j),
    np.array(True),
    masked(5.0, ()),
    np.datetime64(5, "s"),
    np.timedelta64(5, "s"),
    datetime.timedelta(5),
    np.array((5.0,), dtype=[("a", float)]),
    {5},
    {5: 5},
    object(),
    range,
    Decimal("sNaN"),
    np.array([5.0]),
    [5.0],
    10**400,
]


@pytest.mark.parametrize(("named", "call"), SCALARS, ids=[f"{i}-{name}" for i, (name, _) in enumerate(SCALARS)])
def test_one_number_is_nothing_else(
    named: str, call: Callable[[funicular.Robot, Any], object], robot: funicular.Robot
) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for value in NO_NUMBERS:
            with pytest.raises(funicular.InputError, match=f"^`{named}") as error:
                call(robot, value)
            assert "\n" not in str(error.value) and str(pickle.loads(pickle.dumps(error.value))) == str(error.value)


@pytest.mark.parametrize("number", [5, 5.0, np.float16(5), np.float32(5), np.longdouble(5), np.uint8(5), np.array(5), Decimal(5), Fraction(5), np.ma.array(5.0)])
@pytest.mark.parametrize("value", [5.0])
def test_one_number_is_any_real_number(number: Any, value: float, robot: funicular.Robot) -> None:
    assert robot.with_(mass_kg=number).mass_kg == value
    assert robot.with_({"platform.mass_kg": number}).mass_kg == value
    assert robot.equilibrium(POSE, force_n=[number, 0, 0]) == robot.equilibrium(POSE, force_n=[value, 0, 0])
    assert hanging(span_m=number if number != 5 else 4).tension_end_n == hanging().tension_end_n


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize(("named", "call"), SCALARS, ids=[f"{i}-{name}" for i, (name, _) in enumerate(SCALARS)])
def test_one_number_is_finite(
    named: str, call: Callable[[funicular.Robot, Any], object], value: float, robot: funicular.Robot
) -> None:
    for number in (value, np.float32(value), np.array(value), Decimal(repr(value).replace("np.", ""))):
        with pytest.raises(funicular.InputError, match="finite"):
            call(robot, number)


def bad_arrays(good: list[Any]) -> Iterator[tuple[str, Any]]:
    """Arrays of the right shape with something else than a real number in the last place."""
    numbers = np.array(good)
    last = tuple(size - 1 for size in numbers.shape)

    def with_last(value: Any) -> Any:
        changed = numbers.tolist()
        row = changed
        for index in last[:-1]:
            row = row[index]
        row[last[-1]] = value
        return changed

    at = rf"\[{', '.join(map(str, last))}\]"
    listed = "".join(rf"\[{index}\]" for index in last)
    yield at + "` is masked", masked(numbers, last)
    yield listed + "` is masked", with_last(np.ma.masked)
    if numbers.ndim == 2:
        yield r"\[1\]\[0\]` is masked", [numbers[0], masked(numbers[1], 0)]
    for kind in (complex, np.complex64, bool, str, bytes, "datetime64[s]", "timedelta64[s]"):
        other = numbers.astype(int).astype(kind)
        yield re.escape(f"` is of type {other.dtype}, as in "), other
    for value in (True, np.True_, "5", b"5", 5j, np.complex128(5), None, datetime.datetime(2000, 1, 1), object()):
        yield listed + "` is ", with_last(value)
        objects = np.array(with_last(0), dtype=object)
        objects[last] = value
        yield at + "` is ", objects
    yield "` is of type ", np.zeros(numbers.shape, dtype=[("a", float), ("b", float)])
    for whole in ("text", b"text", {1.0}, {"a": 1.0}, iter(numbers.tolist()), 5j, True):
        yield "` is of type |` is ", whole
    yield "` makes no array ", [*numbers.tolist(), [[1.0], [2.0, 3.0]]]
    endless: list[Any] = []
    endless.append(endless)
    yield "deep", endless


@pytest.mark.parametrize(("named", "good", "call"), ARRAYS, ids=[f"{i}-{name}" for i, (name, *_) in enumerate(ARRAYS)])
def test_an_array_holds_nothing_but_numbers(
    named: str, good: list[Any], call: Callable[[funicular.Robot, Any], object], robot: funicular.Robot
) -> None:
    call(robot, good)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for said, value in bad_arrays(good):
            with pytest.raises(funicular.InputError, match=f"^`{named}.*({said})"):
                call(robot, value)


@pytest.mark.filterwarnings("ignore:the matrix subclass")
@pytest.mark.parametrize(("named", "good", "call"), ARRAYS, ids=[f"{i}-{name}" for i, (name, *_) in enumerate(ARRAYS)])
def test_an_array_of_any_real_numbers_is_the_same(
    named: str, good: list[Any], call: Callable[[funicular.Robot, Any], object], robot: funicular.Robot
) -> None:
    expected = call(robot, good)
    exact = np.array(good)
    forms = [exact, exact.astype(">f8"), exact.astype(object), np.ma.array(exact), exact.astype(np.longdouble), exact.astype(bool) * exact]
    forms += [np.vectorize(Decimal, otypes=[object])(exact), np.vectorize(Fraction, otypes=[object])(exact)]
    forms += [np.asfortranarray(exact), np.repeat(exact, 2, axis=0)[::2], tuple(exact.tolist()), deque(exact.tolist()), memoryview(exact)]
    if exact.ndim == 1:
        forms.append(array("d", exact))
    else:
        forms.append(np.asmatrix(exact))
    for form in forms:
        found = call(robot, form)
        same = np.array_equal(found, expected) if isinstance(expected, np.ndarray) else None
        if isinstance(expected, tuple):
            same = all(np.array_equal(a, b) for a, b in zip(found, expected, strict=True))  # type: ignore[call-overload]
        assert found == expected if same is None else same, type(form)


# In `equilibria` a row that is no state has a reason instead of an equilibrium.
SINGLE = [case for i, case in enumerate(ARRAYS) if i not in (9, 10)]


@pytest.mark.parametrize(("named", "good", "call"), SINGLE, ids=[f"{i}-{name}" for i, (name, *_) in enumerate(SINGLE)])
def test_no_number_of_an_array_is_infinite(
    named: str, good: list[Any], call: Callable[[funicular.Robot, Any], object], robot: funicular.Robot
) -> None:
    for value, kind in itertools.product((np.nan, np.inf, -np.inf, 1e300), (float, object)):
        numbers = np.array(good, dtype=kind)
        numbers.flat[numbers.size - 1] = value
        with pytest.raises(funicular.InputError, match="finite|beyond 1e12|is not from 0 to"):
            call(robot, numbers)


@pytest.mark.filterwarnings("ignore:the matrix subclass")
def test_a_matrix_is_no_row(robot: funicular.Robot) -> None:
    with pytest.raises(funicular.InputError, match="`pose` has 2 dimensions"):
        robot.equilibrium(pose=np.asmatrix(POSE))


def test_tables_of_pandas_are_numbers_or_refused(robot: funicular.Robot) -> None:
    pandas = pytest.importorskip("pandas")
    for kind in ("float64", "Float64", "object"):
        column = pandas.Series(POSE, dtype=kind)
        assert robot.equilibrium(pose=column) == robot.equilibrium(pose=POSE)
        hidden = column.copy()
        hidden[1] = None if kind == "object" else pandas.NA if kind == "Float64" else np.nan
        with pytest.raises(funicular.InputError, match="`pose|finite"):
            robot.equilibrium(pose=hidden)
    table = pandas.DataFrame([POSE, POSE], columns=["x", "y", "z"])
    assert robot.equilibria(table) == robot.equilibria([POSE, POSE])
    for column in (["a", "b"], [True, False], [1j, 2j], pandas.to_datetime(["2000-01-01", "2000-01-02"])):
        with pytest.raises(funicular.InputError, match="^`poses"):
            robot.equilibria(table.assign(z=column))
    with pytest.raises(funicular.InputError, match="`below_hz` has 1 dimensions"):
        robot.modes(pandas.Series([5.0]))


def test_responses_may_be_complex_and_nothing_more() -> None:
    for good in ([1, 2j, 1], np.array([1, 2, 1], dtype=np.complex64), [1, Fraction(2), 1]):
        assert funicular.peaks([1, 2, 3], good)[0].tolist() == [2]
    for bad in ([1, "2", 1], [1, True, 1], masked([1, 2, 1], 1), np.ma.array([1, 2j, 1], mask=[0, 1, 0]), ["a"], None):
        with pytest.raises(funicular.InputError, match="^`response"):
            funicular.peaks([1, 2, 3], bad)


# Every public argument that takes a whole number.
COUNTS: list[tuple[str, Callable[[funicular.Robot, Any], object]]] = [
    ("points", lambda robot, n: robot.equilibrium().cable_points(n)),
    ("threads", lambda robot, n: robot.equilibria([POSE], threads=n)),
    ("threads", lambda robot, n: robot.map(poses=[POSE], threads=n)),
    ("chunks_per_task", lambda robot, n: robot.map(poses=[POSE], executor=lambda: None, chunks_per_task=n)),  # type: ignore[arg-type, return-value]
    (r"x\[2\]", lambda robot, n: robot.map({"x": (-0.1, 0.1, n), "y": 0, "z": 0.5})),
]


@pytest.mark.parametrize(("named", "call"), COUNTS, ids=[f"{i}-{name}" for i, (name, _) in enumerate(COUNTS)])
def test_a_count_is_a_whole_number(
    named: str, call: Callable[[funicular.Robot, Any], object], robot: funicular.Robot
) -> None:
    for value in (True, np.True_, "5", 5.0, np.float64(5), 5j, Decimal(5), [5], np.array([5]), np.ma.masked, np.ma.array(5, mask=True), 0, -1, -(2**80)):
        with pytest.raises(funicular.InputError, match=f"^`{named}"):
            call(robot, value)
    if named != "chunks_per_task":
        for value in (5, np.int64(5), np.uint8(5), np.array(5)):
            call(robot, value)


@pytest.mark.parametrize(
    "value",
    [True, "5", 5j, None, np.ma.masked, masked([5.0, 6.0], 0), np.array(5j), np.datetime64(5, "ns"), np.timedelta64(5, "ns")]
    + [np.array((5.0,), dtype=[("a", float)]), b"5", {5}, np.array(True), np.array("5"), Decimal("NaN"), [5.0], np.array([5.0])],
)
def test_a_number_of_the_robot_file_is_nothing_else(value: Any, robot: funicular.Robot) -> None:
    with pytest.raises(funicular.RobotFileError):
        robot.with_({"platform.mass_kg": value})
    with pytest.raises(funicular.RobotFileError):
        robot.with_({"cables.3.anchor_m": [value, 2.2, 4.2]})
    table = robot.to_dict()
    table["platform"]["mass_kg"] = value
    with pytest.raises(funicular.RobotFileError):
        funicular.Robot.from_dict(table)


def test_three_values_in_a_tuple_are_told_from_a_range(robot: funicular.Robot) -> None:
    with pytest.raises(funicular.InputError, match=r"^`z\[2\]` is 0.75, of type float: give a whole number; .* give a list for values"):
        robot.map({"x": 0, "y": 0, "z": (0.5, 0.625, 0.75)})


def test_figures_hide_nothing_of_a_response() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    for hz, response in [([1, 2], masked([1, 2], 1)), (masked([1, 2], 0), [1j, 2]), (["1", "2"], [1, 2]), ([1, 2j], [1, 2])]:
        with pytest.raises(funicular.InputError, match="^`(hz|response)"):
            funicular.plot.frf(hz, response)


def test_arrays_of_numbers_go_into_a_robot_file(robot: funicular.Robot) -> None:
    expected = robot.with_({"cables.3.anchor_m": [5.25, 2.25, 4.25]})
    anchor = np.array([5.25, 2.25, 4.25])
    for form in (anchor, anchor.astype(np.float32), anchor.astype(np.longdouble), anchor.astype(object), np.ma.array(anchor)):
        assert robot.with_({"cables.3.anchor_m": form}) == expected
    assert robot.with_({"cables.3.anchor_m": [Decimal("5.25"), Fraction(9, 4), np.float16(4.25)]}) == expected
    with pytest.raises(funicular.RobotFileError, match=r"`cables.3.anchor_m\[1\]` is masked"):
        robot.with_({"cables.3.anchor_m": masked(anchor, 1)})
    with pytest.raises(funicular.RobotFileError):
        robot.with_({"cables.3.anchor_m": np.array((1.0, 2.0, 3.0), dtype=[(axis, float) for axis in "xyz"])})


def test_a_mistyped_keyword_of_a_class_method_gets_a_hint() -> None:
    with pytest.raises(TypeError, match="unexpected keyword argument 'pth'; did you mean `path`"):
        funicular.Robot.from_file(pth="robot.toml")  # type: ignore[call-arg]
    with pytest.raises(funicular.InputError, match="`text` is 3, of type int: give text"):
        funicular.Robot.from_toml(3)  # type: ignore[arg-type]
    assert funicular.Robot.from_toml(funicular.Robot.example().to_toml()) == funicular.Robot.example()
