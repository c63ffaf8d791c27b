"""Locks: only the keeper, or who has the code, reads what they hold; its length tells nothing."""

from __future__ import annotations

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv_people.study.files.seal import (
    ALPHABET,
    KeyHolder,
    SealingKey,
    lock_with_code,
    new_code,
    new_key_holder,
    unlock_with_code,
)
from tests.support.studies import CHEAP, PASSPHRASE

HOLDER, KEEPER = new_key_holder(PASSPHRASE, CHEAP)
SEAL = HOLDER.seal


@settings(max_examples=20)
@given(st.binary(max_size=3000))
def test_what_is_sealed_is_read_by_its_keeper(data: bytes) -> None:
    assert KeyHolder.open(KEEPER, PASSPHRASE).unlock(SealingKey.of(SEAL.text).lock(data)) == data


@settings(max_examples=20)
@given(st.binary(max_size=3000))
def test_what_a_code_locks_is_read_with_it(data: bytes) -> None:
    code = new_code()
    assert unlock_with_code(lock_with_code(data, code, cost=CHEAP), code) == data


@settings(max_examples=20)
@given(st.binary(max_size=8188), st.binary(max_size=8188))
def test_all_that_fits_into_a_room_is_as_long(one: bytes, other: bytes) -> None:
    assert len(SEAL.lock(one)) == len(SEAL.lock(other))
    code = new_code()
    assert len(lock_with_code(one, code, cost=CHEAP)) == len(lock_with_code(other, code, cost=CHEAP))


def test_the_same_is_never_sealed_to_the_same() -> None:
    assert len({SEAL.lock(b"FD") for _ in range(20)}) == 20


@pytest.mark.parametrize("wrong", ["four words of no sensE", "", "four words of no sense "])
def test_a_wrong_passphrase_is_refused_in_one_line(wrong: str) -> None:
    with pytest.raises(InputError, match="passphrase: does not open it") as caught:
        KeyHolder.open(KEEPER, wrong)
    assert "\n" not in str(caught.value)


def test_a_passphrase_is_the_same_however_its_accents_are_typed() -> None:
    made, text = new_key_holder("vier Wörter ohne Sinn", CHEAP)
    assert KeyHolder.open(text, "vier Wo\u0308rter ohne Sinn").unlock(made.seal.lock(b"x")) == b"x"


def test_a_code_is_read_as_people_type_it() -> None:
    locked = lock_with_code(b"secret", "0O1I-l5S8-BABE".replace("O", "0").replace("I", "1"), cost=CHEAP)
    for typed in ("001115s8babe", " oOiL-15S8-babe ", "0011 15S8 BABE"):
        assert unlock_with_code(locked, typed) == b"secret"


@pytest.mark.parametrize("typed", ["", "0123", "0123-4567-89A", "0123-4567-89A!", "ü123-4567-89AB"])
def test_what_is_no_code_is_refused_before_anything_is_tried(typed: str) -> None:
    with pytest.raises(InputError, match="12 letters and digits"):
        unlock_with_code("", typed)


def test_codes_are_drawn_from_all_of_sixty_bits() -> None:
    codes = [new_code() for _ in range(400)]
    assert all(re.fullmatch(f"([{ALPHABET}]{{4}}-){{2}}[{ALPHABET}]{{4}}", code) for code in codes)
    assert len(set(codes)) == 400
    assert set("".join(codes)) == {*ALPHABET, "-"}


def test_another_studys_keeper_reads_nothing() -> None:
    _, other = new_key_holder(PASSPHRASE, CHEAP)
    with pytest.raises(InputError, match="is of another study, or was changed"):
        KeyHolder.open(other, PASSPHRASE).unlock(SEAL.lock(b"FD"))


@settings(max_examples=20)
@given(st.integers(0, 10_000), st.integers(1, 255))
def test_a_changed_box_is_noticed(place: int, by: int) -> None:
    box = bytearray(SEAL.lock(b"FD", 64).encode())
    box[place % len(box)] ^= by
    with pytest.raises(InputError):
        KeyHolder.open(KEEPER, PASSPHRASE).unlock(box.decode("latin-1"))


@pytest.mark.parametrize("text", ["", "{}", "[]", "not JSON", '{"format": "fdvv-keeper", "version": 2}'])
def test_a_file_of_no_key_holder_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(InputError) as caught:
        KeyHolder.open(text, PASSPHRASE)
    assert "\n" not in str(caught.value)


def test_a_file_that_asks_for_all_memory_is_refused() -> None:
    import base64

    import msgspec

    locked = {"passes": 3, "memory_bytes": 1 << 40, "salt": b"0" * 16, "box": b""}
    record = msgspec.json.decode(KEEPER)
    record["locked"] = base64.b64encode(msgspec.json.encode(locked)).decode()
    with pytest.raises(InputError, match="was changed"):
        KeyHolder.open(msgspec.json.encode(record), PASSPHRASE)


@pytest.mark.parametrize("text", ["", "AAAA", "not base 64"])
def test_what_is_no_seal_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="is none"):
        SealingKey.of(text)
