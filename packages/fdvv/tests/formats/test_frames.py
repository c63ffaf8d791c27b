"""Tables and labelled arrays hold the same numbers as the records, each with its unit."""

import csv
import io
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from fdvv.errors import ModelError
from fdvv.formats.exchange.frames import (
    model_to_xarray,
    presses_from_pandas,
    presses_to_pandas,
    recording_csv,
    recording_to_pandas,
    recording_to_xarray,
)
from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.press import Press
from fdvv.recording.types import UNITS, Mark, Quantity, Recording, Stream, Take

pd = pytest.importorskip("pandas")
xr = pytest.importorskip("xarray")

finite = st.floats(-1e6, 1e6)
words = st.text(st.characters(codec="utf-8", exclude_categories=["C", "Z"]), min_size=1, max_size=8)


@st.composite
def streams(draw: st.DrawFn, name: str) -> Stream:
    count = draw(st.integers(1, 6))
    t = np.cumsum(draw(hnp.arrays(np.float64, count, elements=st.floats(1e-6, 10))))
    quantity = draw(st.sampled_from(Quantity))
    shape = (count, 3) if quantity is Quantity.MARKER else (count,)
    kind = draw(st.sampled_from([np.int16, np.float64]))
    numbers = st.integers(-32768, 32767) if kind is np.int16 else st.one_of(finite, st.just(np.nan))
    raw = draw(hnp.arrays(kind, shape, elements=numbers))
    return Stream(name, quantity, draw(words), t, raw, draw(st.floats(0.001, 100)), draw(finite))


@st.composite
def recordings(draw: st.DrawFn) -> Recording:
    takes = []
    for number in range(1, draw(st.integers(0, 3)) + 1):
        names = draw(st.lists(words.map(lambda w: "s" + w.replace("/", "|")), max_size=3, unique=True))
        marks = [Mark("on", "c", t) for t in draw(st.lists(finite, max_size=3))]
        speed = draw(st.one_of(st.none(), st.floats(0.1, 500)))
        takes.append(Take(number, tuple(draw(streams(n)) for n in names), tuple(marks), velocity_mm_s=speed))
    return Recording(draw(words), tuple(takes), simulated=draw(st.booleans()))


@settings(max_examples=12, deadline=None)
@given(recording=recordings())
def test_every_sample_of_a_recording_is_in_its_table(recording: Recording) -> None:
    table = recording_to_pandas(recording)
    assert len(table) == sum(s.raw.size for take in recording.takes for s in take.streams)
    assert table.attrs["simulated"] == int(recording.simulated)
    for take in recording.takes:
        for stream in take.streams:
            rows = table[(table["take"] == take.number) & (table["stream"] == stream.name)]
            assert set(rows["unit"]) == {UNITS[stream.quantity]}
            values = stream.values.reshape(stream.t_s.size, -1)
            for i, (_, axis) in enumerate(rows.groupby("axis", observed=True, sort=True)):
                np.testing.assert_array_equal(axis["value"], values[:, i])
                np.testing.assert_array_equal(axis["t_s"], stream.t_s)


@settings(max_examples=12, deadline=None)
@given(recording=recordings())
def test_the_table_of_text_is_the_table(recording: Recording) -> None:
    rows = list(csv.DictReader(io.StringIO(recording_csv(recording).text)))
    table = recording_to_pandas(recording)
    assert len(rows) == len(table)
    found = np.array([float(r["value"] or "nan") for r in rows])
    np.testing.assert_array_equal(found, table["value"].to_numpy(dtype=np.float64))
    np.testing.assert_array_equal([float(r["t_s"]) for r in rows], table["t_s"].to_numpy(dtype=np.float64))
    assert not any(r["stream"].startswith(("=", "+", "-", "@")) for r in rows)


@settings(max_examples=12, deadline=None)
@given(recording=recordings())
def test_every_stream_is_a_variable_with_its_unit_and_its_own_time(recording: Recording) -> None:
    tree = recording_to_xarray(recording)
    assert tree.attrs["name"] == recording.name
    assert len(tree.children) == len(recording.takes)
    for take in recording.takes:
        node = tree[f"take_{take.number}"]
        for stream in take.streams:
            variable = node[stream.name]
            np.testing.assert_array_equal(variable.values, stream.values)
            np.testing.assert_array_equal(node[f"t_{stream.name}"].values, stream.t_s)
            assert node[f"t_{stream.name}"].attrs["units"] == "s"
            assert variable.attrs["units"].replace("m s-2", "m/s2") == UNITS[stream.quantity]


@st.composite
def presses(draw: st.DrawFn) -> Press:
    count = draw(st.integers(2, 6))
    column = hnp.arrays(np.float64, count, elements=finite)
    flags = hnp.arrays(np.bool_, count)
    t = np.cumsum(draw(hnp.arrays(np.float64, count, elements=st.floats(1e-4, 1))))
    rig = {n: draw(st.one_of(st.none(), column)) for n in ("sensed_mm", "sensed_cN", "commanded_cN")}
    optional = {n: draw(st.one_of(st.none(), flags)) for n in ("saturated", "tick")}
    speed, simulated = draw(st.floats(1, 300)), draw(st.booleans())
    return Press(t, draw(column), draw(column), speed, **rig, **optional, simulated=simulated)


@settings(max_examples=12, deadline=None)
@given(wanted=st.lists(presses(), max_size=4))
def test_presses_come_back_from_their_table(wanted: list[Press]) -> None:
    table = presses_to_pandas(wanted)
    found = presses_from_pandas(table)
    assert len(found) == len(wanted)
    for a, b in zip(found, wanted, strict=True):
        for name, value in vars(b).items():
            if isinstance(value, np.ndarray):
                np.testing.assert_array_equal(getattr(a, name), value)
            else:
                assert getattr(a, name) == value
    assert table.attrs["units"]["force_cN"] == "cN"


def test_a_table_that_lacks_columns_is_refused_with_their_names() -> None:
    with pytest.raises(ModelError, match="lacks columns: displacement_mm, force_cN"):
        presses_from_pandas(pd.DataFrame({"press": [0], "velocity_mm_s": [1.0], "t_s": [0.0]}))


@pytest.mark.parametrize("name", builtin_names())
def test_a_model_is_its_force_over_stroke_velocity_and_displacement(name: str) -> None:
    model = load_builtin(name)
    data = model_to_xarray(model)
    assert data["force"].dims == ("stroke", "velocity", "displacement")
    units = {n: data[n].attrs["units"] for n in ("force", "stiffness", "velocity", "displacement")}
    assert units == {"force": "cN", "stiffness": "cN mm-1", "velocity": "mm s-1", "displacement": "mm"}
    assert float(data["displacement"][-1]) == model.travel_mm
    for curve in model.curves:
        at = data.sel(stroke=str(curve.stroke))
        at = at.isel(velocity=0) if curve.velocity_mm_s is None else at.sel(velocity=curve.velocity_mm_s)
        np.testing.assert_allclose(at["force"], curve.force_cN(data["displacement"].values), atol=1e-9)


def test_a_model_can_be_asked_for_other_velocities() -> None:
    model = load_builtin("mx-clear")
    data = model_to_xarray(model, [75.0, 20.0], 0.1)
    assert data["velocity"].values.tolist() == [75, 20]
    wanted = model.force_cN(data["displacement"].values, 75.0, "release")
    np.testing.assert_allclose(data["force"].sel(stroke="release", velocity=75), wanted)


def test_a_stroke_without_curves_is_left_out() -> None:
    whole = load_builtin("mx-red")
    data = model_to_xarray(FDVVModel("p", whole.travel_mm, whole.of("press")))
    assert data["stroke"].values.tolist() == ["press"]
    with pytest.raises(ModelError, match="step_mm must be positive"):
        model_to_xarray(whole, step_mm=0.0)


def test_streams_whose_names_would_clash_are_refused() -> None:
    def stream(name: str) -> Stream:
        return Stream(name, "force", "c", np.array([0.0]), np.array([1.0]))  # type: ignore[arg-type]

    for names in (("a/b", "a_b"), ("x", "t_x")):
        with pytest.raises(ModelError, match="rename one of the streams"):
            recording_to_xarray(Recording("r", (Take(1, tuple(map(stream, names))),)))


def test_without_pandas_the_extra_is_named() -> None:
    code = (
        "import sys; sys.modules['pandas'] = None\n"
        "from fdvv.formats.exchange.frames import model_to_xarray\n"
        "from fdvv import load_builtin\n"
        "try:\n    model_to_xarray(load_builtin('mx-red'))\nexcept Exception as error:\n    print(error)"
    )
    output = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert 'pip install "fdvv[frames]"' in output
