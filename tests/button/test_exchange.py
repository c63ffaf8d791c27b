"""Export and import: what is written is summarized in figures, and what is read goes where it belongs."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.button.export_file import EXPORT_FORMATS, export_button, export_format, export_vibration, read_back
from fdvv.button.import_file import ImportSettings, import_file
from fdvv.errors import FdvvError, InputError
from fdvv.formats.exchange.exchange_format import ExportSettings
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin, save_model
from fdvv.model.model import FDVVModel, Provenance
from fdvv.model.vibration import Mode, Vibration
from fdvv.recording.file import save_recording
from fdvv.recording.types import Recording, Stream, Take

TWO = Vibration(Stroke.PRESS, None, 1.0, 0.05, (Mode(180.0, 5.0, 60.0, 0.3), Mode(260.0, 3.0, 120.0, 1.0)))


@pytest.mark.parametrize("form", [f for f in EXPORT_FORMATS if f.of != "recording"], ids=lambda f: f.name)
def test_every_format_writes_the_published_button(form: object, tmp_path: Path) -> None:
    assert isinstance(form, type(EXPORT_FORMATS[0]))
    made = export_button("mx-clear", form.name, tmp_path / f"a{form.suffix}")
    assert made.format == form.name
    assert made.data
    assert made.kept
    assert made.lost
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "form"),
    [("a.csv", "csv"), ("a.xml", "mjcf"), ("a.ahap", "ahap"), ("A.HAPTIC", "haptic"), ("a.wav", "wav")],
)
def test_the_ending_tells_the_format(name: str, form: str) -> None:
    assert export_format(None, name).name == form
    assert export_format(None, "a.csv", "recording").name == "recording-csv"


def test_an_ending_that_tells_none_or_several_is_refused() -> None:
    with pytest.raises(InputError, match=r"'\.json' may be tester-json or smartknob"):
        export_format(None, "a.json")
    with pytest.raises(InputError, match="tells no format"):
        export_format(None, "a.txt")
    with pytest.raises(InputError, match="choose one of csv, bluepylons-csv"):
        export_format("stl", "a.stl")


@pytest.mark.parametrize("form", ["ahap", "haptic", "hjif"])
def test_one_mode_without_a_phase_loses_nothing_that_is_felt(form: str) -> None:
    found = load_builtin("mx-clear").vibration(Stroke.PRESS, 100.0)
    assert found is not None
    figures = export_vibration(found, form, "a", "2026-01-01").figures
    for name in ("correlation", "spectral_similarity", "st_sim", "spqi"):
        assert 0.995 < (figures[name] or 0) <= 1 + 1e-9


def test_two_modes_are_lost_in_envelopes_and_kept_in_hjif() -> None:
    figures = {f: export_vibration(TWO, f, "a", "2026-01-01").figures for f in ("ahap", "haptic", "hjif")}
    assert (figures["hjif"]["correlation"] or 0) > 0.999
    for form in ("ahap", "haptic"):
        assert 0.5 < (figures[form]["correlation"] or 0) < 0.9


def test_what_is_read_back_stands_where_the_original_stood() -> None:
    vibration = replace(TWO, stroke=Stroke.RELEASE, velocity_mm_s=50.0, onset_mm=2.5)
    back = read_back(vibration, export_vibration(vibration, "hjif", "a", "2026-01-01"))
    assert (back.stroke, back.velocity_mm_s, back.onset_mm) == (Stroke.RELEASE, 50.0, 2.5)


@pytest.mark.parametrize("form", ["ahap", "haptic", "hjif", "wav"])
def test_a_vibration_goes_into_another_button(form: str, tmp_path: Path) -> None:
    path = tmp_path / "snap.bin"
    made = export_button("mx-clear", form, f"a.{form}")
    made.save(path)
    scale = made.figures["full_scale_m_s2"] if form == "wav" else None
    found = import_file(path, ImportSettings(into="mx-blue", full_scale_m_s2=scale))
    assert found.format == form
    (vibration,) = found.model.vibrations
    (mode,) = vibration.modes
    assert mode.frequency_Hz == pytest.approx(239, rel=0.01)
    assert mode.amplitude_m_s2 == pytest.approx(4.6, rel=0.06)
    assert vibration.duration_s == pytest.approx(0.016, abs=0.002)
    assert vibration.onset_mm == pytest.approx(1.68, abs=0.01)
    assert replace(found.model, vibrations=(), provenance=Provenance()) == replace(
        load_builtin("mx-blue"), vibrations=(), provenance=Provenance()
    )
    assert any("put at the peak of the press" in note for note in found.notes)
    assert f"vibration from snap.bin ({form})" in found.model.provenance.method
    assert any("peak of the press" in a for a in found.model.provenance.assumptions)


def test_a_vibration_takes_the_place_of_the_one_that_was_there(tmp_path: Path) -> None:
    export_button("mx-clear", "hjif", "a.hjif").save(tmp_path / "a.hjif")
    settings = ImportSettings(name="new", into="mx-clear", stroke=Stroke.RELEASE, onset_mm=1.0)
    found = import_file(tmp_path / "a.hjif", settings)
    assert found.model.name == "new"
    assert [v.stroke for v in found.model.vibrations] == [Stroke.PRESS, Stroke.RELEASE]
    assert found.model.vibrations[1].onset_mm == 1.0
    assert "1 vibrations of the button were replaced" in found.notes
    assert not any("no file tells where" in note for note in found.notes)


def test_curves_come_in_as_they_are_fitted(tmp_path: Path) -> None:
    export_button("mx-clear", None, "a.csv").save(tmp_path / "a.csv")
    found = import_file(tmp_path / "a.csv", ImportSettings(name="again"))
    assert (found.model.name, found.format) == ("again", "plain-csv")
    whole = load_builtin("mx-clear")
    assert len(found.model.curves) == 10
    for curve in found.model.curves:
        of = whole.nearest(curve.stroke, curve.velocity_mm_s)
        assert of is not None
        # a fit begins where the cap carries and ends at its stop
        x = np.linspace(curve.start_mm, curve.end_mm, 200)
        assert curve.end_mm - curve.start_mm > 3.8
        assert np.sqrt(np.mean((curve.force_cN(x) - of.force_cN(x)) ** 2)) < 0.1
    assert found.to_dict()["curves"][0] == {"stroke": "press", "velocity_mm_s": 0.5}


def test_strokes_of_slightly_different_speed_come_back_both(tmp_path: Path) -> None:
    speeds = {Stroke.PRESS: 0.149, Stroke.RELEASE: 0.147}
    red = load_builtin("mx-red")
    model = replace(red, curves=tuple(replace(c, velocity_mm_s=speeds[c.stroke]) for c in red.curves))
    save_model(model, tmp_path / "a.fdvv.json")
    export_button(str(tmp_path / "a.fdvv.json"), None, "a.csv").save(tmp_path / "a.csv")
    found = import_file(tmp_path / "a.csv")
    assert {c.stroke: c.velocity_mm_s for c in found.model.curves} == speeds
    assert not any("left out" in note for note in found.notes)


def test_speeds_that_a_header_states_are_not_repeats(tmp_path: Path) -> None:
    clear = load_builtin("mx-clear")
    kept = [c for c in clear.curves if c.velocity_mm_s in (100.0, 150.0)]
    close = {100.0: 100.0, 150.0: 105.0}
    model = replace(clear, curves=tuple(replace(c, velocity_mm_s=close[c.velocity_mm_s or 0]) for c in kept))
    save_model(model, tmp_path / "a.fdvv.json")
    export_button(str(tmp_path / "a.fdvv.json"), None, "a.csv").save(tmp_path / "a.csv")
    assert import_file(tmp_path / "a.csv").model.velocities_mm_s("press") == (100.0, 105.0)


@pytest.mark.parametrize("form", ["csv", "bluepylons-csv", "haata", "tester-json"])
def test_a_table_says_what_an_import_makes_of_it(form: str, tmp_path: Path) -> None:
    made = export_button("mx-clear", form, "a")
    path = tmp_path / ("a.json" if form == "tester-json" else "a.csv")
    made.save(path)
    model, whole = import_file(path).model, load_builtin("mx-clear")
    assert made.figures["imported_curves"] == len(model.curves)
    assert made.figures["imported_travel_mm"] == pytest.approx(model.travel_mm - whole.travel_mm, abs=1e-9)
    slow = model.of("release")[0]
    x = np.linspace(slow.start_mm, slow.end_mm, 401)
    off = np.abs(slow.force_cN(x) - whole.of("release")[0].force_cN(x)).max()
    assert off <= (made.figures["imported_max_cN"] or 0) + 1e-12 < 1


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"<mujoco/>", "MuJoCo models and pages cannot be read back"),
        (b'{"detent_strength_unit": 1}', "holds no force curve"),
        (b'{"format": "fdvv-model"}', "needs no import"),
        (b"", "it is empty"),
        (b'{"Pattern": []}', "no haptic event"),
        (b"RIFF....WAVE", "does not say what full scale is"),
    ],
)
def test_what_cannot_be_imported_is_refused_in_one_line(content: bytes, message: str, tmp_path: Path) -> None:
    path = tmp_path / "x.json"
    path.write_bytes(content)
    with pytest.raises(InputError, match=message) as found:
        import_file(path)
    assert "\n" not in str(found.value)


def test_a_vibration_without_a_button_and_curves_into_one_are_refused(tmp_path: Path) -> None:
    export_button("mx-clear", None, "a.ahap").save(tmp_path / "a.ahap")
    export_button("mx-red", None, "a.csv").save(tmp_path / "a.csv")
    with pytest.raises(InputError, match="name the button with --into"):
        import_file(tmp_path / "a.ahap")
    with pytest.raises(InputError, match="leave --into out"):
        import_file(tmp_path / "a.csv", ImportSettings(into="mx-blue"))
    with pytest.raises(InputError, match="leave --velocity out"):
        import_file(tmp_path / "a.csv", ImportSettings(velocity_mm_s=100.0))
    with pytest.raises(InputError, match="give the button a name"):
        import_file(tmp_path / "a.csv", ImportSettings(name=" "))


def test_a_button_that_lacks_what_a_format_needs_is_reported(tmp_path: Path) -> None:
    whole = load_builtin("mx-red")
    save_model(FDVVModel("back", whole.travel_mm, whole.of("release")), tmp_path / "b.fdvv.json")
    with pytest.raises(InputError, match="it has no press curve"):
        export_button(str(tmp_path / "b.fdvv.json"), None, "a.xml")
    with pytest.raises(InputError, match="it has none of the press; import or tune one first"):
        export_button("mx-red", None, "a.wav")


def test_a_recording_goes_out_as_a_table_and_not_as_a_button(tmp_path: Path) -> None:
    stream = Stream("force", "force", "c", np.array([0.0, 0.1]), np.array([1.0, 2.0]))  # type: ignore[arg-type]
    path = tmp_path / "r.recording.jsonl"
    save_recording(Recording("r", (Take(1, (stream,)),)), path)
    made = export_button(str(path), None, "a.csv")
    assert made.text.splitlines()[1] == "1,unknown,,force,,force,cN,c,0.0,1.0"
    with pytest.raises(InputError, match="process it first"):
        export_button(str(path), "mjcf", "a.xml")
    with pytest.raises(InputError, match=r"name a \*\.recording\.jsonl"):
        export_button("mx-red", "recording-csv", "a.csv")


def test_the_springs_follow_the_press_at_the_velocity_that_is_asked_for() -> None:
    figures = export_button("mx-clear", "mjcf", "a.xml", ExportSettings(velocity_mm_s=100.0)).figures
    assert (figures["press_100mm_s_max_cN"] or 99) <= 0.25


@settings(max_examples=40, deadline=None)
@given(
    data=st.binary(max_size=200),
    start=st.sampled_from([b"", b"{", b'{"signals":', b"RIFF", b"\xef\xbb\xbf{"]),
)
def test_any_file_is_read_or_refused_in_a_line(
    data: bytes, start: bytes, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.json"
    path.write_bytes(start + data)
    with pytest.raises(FdvvError) as found:
        import_file(path)
    assert "\n" not in str(found.value)


def test_a_cut_export_is_refused(tmp_path: Path) -> None:
    whole = export_button("mx-clear", "wav", "a.wav").data
    path = tmp_path / "a.wav"
    for end in (4, 30, 43, 44, 46):
        path.write_bytes(whole[:end])
        with pytest.raises(InputError):
            import_file(path, ImportSettings(into="mx-blue", full_scale_m_s2=1.0))
