"""One reader of arguments: `design`, `identify` and requests say argument and place as all other methods do."""

from typing import Any, get_args

import funicular
import numpy as np
import pytest
from funicular import _words

PATH = "cables.1.anchor_m.x"
MEASURED = {"measured_pose": [1, 2, 1.5]}


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({PATH: "0.1"}, rf'`change\["{PATH}"\]` is \'0.1\', of type str'),
        ({PATH: (-8, -7, 3)}, "has 3 numbers: give minimum and maximum"),
        ({PATH: (1, "a")}, r"\[1\]` is 'a', of type str"),
        ({PATH: None}, "is None, of type NoneType"),
        ({PATH: np.nan}, "NaN is not a finite number"),
        ({PATH: {"min": 3}}, "has no key `min`: it has plus_minus"),
        ([PATH], "is of type list: give a mapping"),
        (f"{PATH}=0.1", "is of type str: give a mapping"),
        (None, "is of type NoneType: give a mapping"),
        ({3: 1}, "has the path 3"),
    ],
)
def test_what_design_changes(change: Any, said: str, cogiro: funicular.Robot) -> None:
    with pytest.raises(funicular.InputError, match=said):
        cogiro.design(change, pose=[0, 0, 1.5])


@pytest.mark.parametrize(
    ("keywords", "said"),
    [
        ({"weights": [np.nan]}, r"`weights\[0\]`: NaN"),
        ({"weights": 1}, "`weights` has 0 dimensions"),
        ({"avoid_hz": (1,)}, "`avoid_hz` has 1 numbers"),
        ({"poses": [[np.nan, 0, 1]]}, r"`poses\[0\]\[0\]`: NaN"),
        ({"max_iterations": -1}, "`max_iterations` is -1"),
        ({"max_iterations": 2.0}, "`max_iterations` is 2.0, of type float"),
        ({"min_frequency_hz": "1"}, "`min_frequency_hz` is '1'"),
        ({"goal": 3}, "`goal` is 3, of type int: give text"),
    ],
)
def test_other_arguments_of_design(keywords: dict[str, Any], said: str, cogiro: funicular.Robot) -> None:
    with pytest.raises(funicular.InputError, match=said):
        cogiro.design({PATH: 0.1}, **({"pose": [0, 0, 1.5]} | keywords))


@pytest.mark.parametrize(
    ("fit", "experiments", "keywords", "said"),
    [
        ({"platform.mass_kg": [1]}, MEASURED, {}, "has 1 numbers: give minimum and maximum"),
        ({"platform.mass_kg": 3}, MEASURED, {}, "is 3, of type int: give None, bounds"),
        ({"platform.mass_kg": (np.nan, 20)}, MEASURED, {}, r'`fit\["platform.mass_kg"\]\[0\]`: NaN'),
        ({"platform.mass_kg": {"prior": "3"}}, MEASURED, {}, r'"\].prior` is \'3\''),
        (None, MEASURED, {}, "`fit` is of type NoneType"),
        ("platform.mass_kg", "x", {}, "`experiments` is of type str"),
        ("platform.mass_kg", None, {}, "`experiments` is of type NoneType"),
        ("platform.mass_kg", {"measured_pose": [1, 2, np.nan]}, {}, r"`experiments\[0\].measured_pose\[2\]`: NaN"),
        ("platform.mass_kg", {**MEASURED, "mass_kg": "3"}, {}, r"`experiments\[0\].mass_kg` is '3'"),
        ("platform.mass_kg", MEASURED, {"response_noise": np.nan}, "`response_noise`: NaN"),
        ("platform.mass_kg", MEASURED, {"from_hz": -1}, "`from_hz`: -1 is negative"),
        ("platform.mass_kg", MEASURED, {"starts": -1}, "`starts` is -1"),
        ("platform.mass_kg", MEASURED, {"rigid_cables": 1}, "`rigid_cables` is 1, of type int: give True or False"),
    ],
)
def test_arguments_of_identify(
    fit: Any, experiments: Any, keywords: dict[str, Any], said: str, cogiro: funicular.Robot
) -> None:
    with pytest.raises(funicular.InputError, match=said):
        cogiro.identify(fit, experiments, pose=[1, 2, 1.5], **keywords)


def test_arrays_and_series_are_taken_where_lists_are(cogiro: funicular.Robot) -> None:
    ends = cogiro.request("identify", fit={"platform.mass_kg": np.array([1, 200])}, experiments=MEASURED)["fit"]
    assert ends == [{"path": "platform.mass_kg", "minimum": 1, "maximum": 200}]
    assert len(cogiro.pose_error(np.array([60.0, 90, 3]), pose=[1, 2, 1.5])["points"]) == 3
    for bad, said in (((1, 2), "has 2 numbers"), (np.linspace(10, 20, 5), "has 5 numbers"), ("a", "is 'a', of type str")):
        with pytest.raises(funicular.InputError, match=f"^`mass_kg` {said}"):
            cogiro.pose_error(bad)


def test_one_text_is_a_list_of_one_and_an_empty_list_is_refused(rest: funicular.Equilibrium) -> None:
    robot = rest.robot
    assert len(rest.gradient("tensions", by="platform.mass_kg", tolerances={"platform.mass_kg": "1%"})["results"]) == 12
    assert rest.state_space("fz", "z", below_hz=2) == rest.state_space(["fz"], ["z"], below_hz=2)
    assert rest.reduce(2, "fz", "z") == rest.reduce(2, ["fz"], ["z"])
    assert robot.map(poses=[[0, 0, 0.5]], quantities="tension-max") == robot.map(poses=[[0, 0, 0.5]], quantities=["tension-max"])
    for call in (
        lambda: rest.state_space([], "z", below_hz=2),
        lambda: rest.reduce(2, "fz", []),
        lambda: rest.gradient([]),
        lambda: rest.gradient("tensions", by=[]),
        lambda: robot.map(poses=[[0, 0, 0.5]], quantities=[]),
    ):
        with pytest.raises(funicular.InputError, match="is an empty list"):
            call()
    with pytest.raises(funicular.InputError, match=r"`of\[0\]` is 3, of type int: give text"):
        rest.gradient([3])  # type: ignore[list-item]


def test_what_has_two_meanings_is_refused(cogiro: funicular.Robot) -> None:
    rest = cogiro.equilibrium(pose=[1, 2, 1.5])
    for call, said in (
        (lambda: cogiro.with_({"platform.mass_kg": 80}, mass_kg=90), "give one of them"),
        (lambda: cogiro.uncertainty(["platform.mass_kg=1%", "platform.mass_kg=2%"], pose=[1, 2, 1.5]), "has no effect"),
        (lambda: cogiro.uncertainty({"platform.mass_kg": "1%"}, {"platform": "2%"}, pose=[1, 2, 1.5]), "has no effect"),
        (lambda: rest.gradient("tensions", tolerances=["platform=1%", "platform=2%"]), "has no effect"),
        (lambda: cogiro.uncertainty({"platform.mass_kg": "1%"}, of="tensions", at_hz=1, pose=[1, 2, 1.5]), "`at_hz` has no effect"),
        (lambda: rest.gradient("tensions", below_hz=5), "`below_hz` has no effect"),
        (lambda: funicular.run('{"command": "schema", "command": "schema"}'), "the key `command` is there twice"),
        (lambda: cogiro.uncertainty({"platform.mass_kg": "1%"}, samples=-1, pose=[1, 2, 1.5]), "`samples` is -1"),
        (lambda: cogiro.uncertainty({"platform.mass_kg": "1%"}, seed=2**63, pose=[1, 2, 1.5]), "`seed` is 9223372036854775808"),
        (lambda: cogiro.equilibria(lengths_m=np.ones((2, 3))), "rows of 3 numbers, and the robot has 8 cables"),
        (lambda: cogiro.request("statics", mass_kg=np.nan), "`mass_kg`: NaN"),
        (lambda: funicular.new_robot(box_m=[np.nan, 1, 1]), r"`box_m\[0\]`: NaN"),
    ):
        with pytest.raises(funicular.InputError, match=said):
            call()
    # The special entry after the general one counts, as documented.
    found = cogiro.uncertainty(["platform=1%", "platform.mass_kg=2%"], of="tensions", hold="pose", pose=[1, 2, 1.5])
    assert found.group_names == ("platform=1%", "platform.mass_kg=2%")


def test_a_mistyped_keyword_has_a_hint(cogiro: funicular.Robot) -> None:
    for call, name in (
        (lambda: cogiro.equilibrium(mass=20), "mass_kg"),
        (lambda: cogiro.modes(below=20), "below_hz"),
        (lambda: funicular.new_robot(mass=3), "mass_kg"),
    ):
        with pytest.raises(TypeError, match=f"did you mean `{name}`"):
            call()
    with pytest.raises(funicular.InputError, match="`static_model` is 3, of type int: give text"):
        cogiro.equilibrium(static_model=3)  # type: ignore[arg-type]


def test_the_words_of_the_types_are_those_of_the_program(cogiro: funicular.Robot) -> None:
    """A message for a word that there is not lists all words."""
    rest = cogiro.equilibrium(pose=[1, 2, 1.5])
    for words, call in (
        (_words.StaticModel, lambda: cogiro.equilibrium(static_model="#")),  # type: ignore[arg-type]
        (_words.TensionRule, lambda: cogiro.equilibrium(tension_rule="#")),  # type: ignore[arg-type]
        (_words.CableModel, lambda: rest.modes(3, cable_model="#")),  # type: ignore[arg-type]
        (_words.Assembly, lambda: rest.modes(3, assembly="#")),  # type: ignore[arg-type]
        (_words.Winches, lambda: rest.modes(3, winches="#")),  # type: ignore[arg-type]
        (_words.Hold, lambda: rest.gradient("tensions", hold="#")),  # type: ignore[arg-type]
        (_words.Per, lambda: rest.gradient("tensions", per="#")),  # type: ignore[arg-type]
        (_words.Method, lambda: cogiro.uncertainty({"platform.mass_kg": 1}, method="#")),  # type: ignore[arg-type]
        (_words.Goal, lambda: cogiro.design({PATH: 1}, goal="#")),  # type: ignore[arg-type]
        (_words.ExportFormat, lambda: rest.export("#", "a")),  # type: ignore[arg-type]
        (_words.Result, lambda: rest.gradient("#")),  # type: ignore[arg-type]
    ):
        with pytest.raises(funicular.InputError) as error:
            call()
        listed = str(error.value).split("there are ", 1)[1]
        assert sorted(word.strip("`") for word in listed.split(", ")) == sorted(get_args(words)), listed


def test_a_cable_with_numbers_too_far_apart_is_refused() -> None:
    good = {"unstrained_length_m": 12.0, "weight_n_per_m": 1.0, "axial_stiffness_n": 1e5}
    for change in ({"axial_stiffness_n": 1e-300}, {"weight_n_per_m": 1e300}, {"unstrained_length_m": 1e13}, {"weight_n_per_m": -1}):
        with pytest.raises(funicular.InputError, match="^`"):
            funicular.Catenary(10, 0, **(good | change))
    generator = np.random.default_rng(0)
    for _ in range(300):
        numbers = dict(zip(good, 10.0 ** generator.uniform(-12, 12, 3), strict=True))
        try:
            cable = funicular.Catenary(*generator.uniform(-1e3, 1e3, 2), **numbers)
        except funicular.InputError:
            continue
        assert np.isfinite([cable.tension_start_n, cable.tension_end_n, cable.horizontal_force_n]).all()
        assert np.isfinite(cable.tangent_n_per_m).all()


def test_arrays_of_results_are_read_only_and_results_compare_by_values(cogiro: funicular.Robot) -> None:
    import copy
    import pickle
    import weakref

    rest = cogiro.equilibrium(pose=[1, 2, 1.5])
    modes, states = rest.modes(4), cogiro.equilibria([[1, 2, 1.5]])
    deviations = cogiro.uncertainty({"platform.mass_kg": "1%"}, of="tensions", hold="pose", pose=[1, 2, 1.5])
    for result, array in ((modes, "frequency_hz"), (states, "position_m"), (deviations, "value")):
        for one in (result, copy.copy(result), copy.deepcopy(result), pickle.loads(pickle.dumps(result))):
            assert one == result
            with pytest.raises(ValueError, match="read-only"):
                getattr(one, array)[...] = 0
    for one in (cogiro, rest, rest.pose):
        assert weakref.ref(one)() is one


def test_the_program_and_the_dictionary_differ_by_one_search(rest: funicular.Equilibrium) -> None:
    whole = rest.to_dict(another_stable_equilibrium=True)
    whole.pop("another_stable_equilibrium", None)
    assert rest.to_dict() == whole


def test_one_frequency_of_a_cable(rest: funicular.Equilibrium) -> None:
    one, row = rest.cable("1", 2.0), rest.cable("1", [2.0])
    assert np.array_equal(one["world"], row["world"]) and one["world"].shape == (1, 3, 3)
    assert one["local"]["k_a"].dtype == complex
