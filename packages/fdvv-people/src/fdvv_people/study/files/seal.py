"""Encryption of what is secret in a study, for its key holder or for a person's sessions.

A **sealing key** locks and cannot unlock (libsodium's sealed box: X25519, XSalsa20-Poly1305). The private
half is the key holder's, locked with a passphrase (Argon2id, then a secret box). A **code** is a person's; it
opens their schedule with the **run key**. What is locked is padded: its length reveals nothing.
"""

from __future__ import annotations

import base64
import secrets
import unicodedata
from dataclasses import dataclass
from types import ModuleType
from typing import Annotated, Literal

import msgspec
from msgspec import Meta, Struct

from fdvv.errors import BuildError, InputError
from fdvv.io.documents import Kind, pretty
from fdvv_people.study.files.layout import read_record
from fdvv_people.study.files.run_key import RunKey

ROOM_bytes = 8192
"""Data are padded to a multiple of it by default."""
ALPHABET = "0123456789ABCDEFGHJKMNPQRSTVWXYZ"
"""Of codes: digits and letters that are not confused (Crockford's base 32)."""
CODE_LETTERS = 12  # of 5 bits, 60 together: at CODE_COST a guess beyond any search; three groups of four
SHORTEST_PASSPHRASE = 12  # assumed: four short words have as many; each guess costs PASSPHRASE_COST
KEEPER = Kind(
    "fdvv-keeper", 1, "a keeper's file", "name the keeper.json that was made when the study was frozen"
)


@dataclass(frozen=True)
class Cost:
    """Cost of one guess: passes of Argon2id over an amount of memory."""

    passes: int
    memory_bytes: int


PASSPHRASE_COST = Cost(3, 128 << 20)
CODE_COST = Cost(2, 64 << 20)
"""0.5 s, and 0.25 s, on one core; a code has 60 bits by itself."""


class KeyHolderFile(Struct, frozen=True, forbid_unknown_fields=True):
    """Content of keeper.json: the private half, locked with the passphrase."""

    format: Literal["fdvv-keeper"]
    version: Literal[1]
    seal: str
    locked: str


class Locked(Struct, frozen=True, forbid_unknown_fields=True):
    """Data locked with a passphrase or code: cost, salt and box."""

    passes: Annotated[int, Meta(ge=1, le=20)]
    memory_bytes: Annotated[int, Meta(ge=8192, le=1 << 30)]
    salt: bytes
    box: bytes


@dataclass(frozen=True)
class SealingKey:
    """The public key of a study: it locks, and cannot unlock.

    Attributes
    ----------
    text : of it, as files hold it.
    """

    text: str

    @classmethod
    def of(cls, text: str, source: object = "seal") -> SealingKey:
        """Read a sealing key. InputError where the text is none."""
        if len(_decoded(text)) != 32:
            raise InputError(source, "seal", f"{text!r:.60} is none", "take it from the study's frozen.json")
        return cls(text)

    def lock(self, data: bytes, room_bytes: int = ROOM_bytes) -> str:
        """Lock data for the key holder, padded to a multiple of the room. BuildError without PyNaCl."""
        key = _nacl("public").PublicKey(_decoded(self.text))
        box: bytes = _nacl("public").SealedBox(key).encrypt(_padded(data, room_bytes))
        return base64.b64encode(box).decode()


class KeyHolder:
    """The private key of a study, opened with the passphrase by `open`.

    Attributes
    ----------
    seal, run_key : of the study; both follow from the private key.
    """

    def __init__(self, private: bytes) -> None:
        key = _nacl("public").PrivateKey(private)
        self.seal = SealingKey(base64.b64encode(bytes(key.public_key)).decode())
        self.run_key = RunKey.of(private, self.seal.text)
        self._box = _nacl("public").SealedBox(key)

    @classmethod
    def open(cls, text: str | bytes, passphrase: str, source: object = "keeper.json") -> KeyHolder:
        """Open keeper.json. InputError on another file, and on a wrong passphrase."""
        file = read_record(text, source, KEEPER, KeyHolderFile)
        private = _unlocked(file.locked, _words(passphrase), source)
        if private is None:
            raise InputError(
                source, "passphrase", "does not open it", "type the one the study was frozen with"
            )
        keeper = cls(private)
        if keeper.seal.text != file.seal:
            raise InputError(source, "$.seal", "is not that of the key it holds", KEEPER.remedy)
        return keeper

    def unlock(self, text: str, source: object = "sealed box") -> bytes:
        """Return what was locked with the seal. InputError where it was locked with another, or changed."""
        try:
            found: bytes = self._box.decrypt(_decoded(text))
        except (_nacl("exceptions").CryptoError, ValueError, TypeError):
            reason = "is of another study, or was changed"
            raise InputError(source, "sealed box", reason, "take the file from a backup") from None
        return _bare(found)


def new_key_holder(passphrase: str, cost: Cost = PASSPHRASE_COST) -> tuple[KeyHolder, str]:
    """Make a pair of keys, and the text of keeper.json. InputError on a short passphrase."""
    if len(passphrase) < SHORTEST_PASSPHRASE:
        reason = f"has {len(passphrase)} characters, {SHORTEST_PASSPHRASE} are needed"
        raise InputError("passphrase", "whole", reason, "take four words that do not belong together")
    private = bytes(_nacl("public").PrivateKey.generate())
    holder = KeyHolder(private)
    locked = _locked(private, _words(passphrase), cost)
    record = {"format": KEEPER.format, "version": KEEPER.version, "seal": holder.seal.text, "locked": locked}
    return holder, pretty(record) + "\n"


def new_code() -> str:
    """Draw a person's code, as it is shown: three groups of four."""
    letters = "".join(secrets.choice(ALPHABET) for _ in range(CODE_LETTERS))
    return "-".join(letters[i : i + 4] for i in range(0, CODE_LETTERS, 4))


def plain_code(code: str) -> str:
    """Read a code as people type it: small letters, blanks, O for 0, I and L for 1. InputError."""
    plain = "".join(code.upper().split()).replace("-", "").replace("O", "0")
    plain = plain.replace("I", "1").replace("L", "1")
    if len(plain) != CODE_LETTERS or not set(plain) <= set(ALPHABET):
        raise InputError("code", "whole", "is not one of 12 letters and digits", "type it as the card has it")
    return plain


def lock_with_code(
    data: bytes,
    code: str,
    room_bytes: int = ROOM_bytes,
    cost: Cost = CODE_COST,
    run_key: RunKey | None = None,
) -> str:
    """Lock data with a person's code, padded to a multiple of the room. InputError, BuildError.

    run_key : what it takes besides the code to unlock them; None: nothing.
    """
    return _locked(_padded(data, room_bytes), plain_code(code).encode(), cost, run_key)


def unlock_with_code(
    text: str, code: str, source: object = "schedule", run_key: RunKey | None = None
) -> bytes:
    """Return what was locked with a code, and a run key where one is passed. InputError on a wrong one."""
    found = _unlocked(text, plain_code(code).encode(), source, run_key)
    if found is None:
        raise InputError("code", "whole", "is not the code of this person", "type it as the card has it")
    return _bare(found)


def _locked(data: bytes, words: bytes, cost: Cost, run_key: RunKey | None = None) -> str:
    salt = secrets.token_bytes(16)
    key = _stretched(words, salt, cost)
    box = bytes(_nacl("secret").SecretBox(run_key.joined(key) if run_key else key).encrypt(data))
    record = msgspec.json.encode(Locked(cost.passes, cost.memory_bytes, salt, box))
    return base64.b64encode(record).decode()


def _unlocked(text: str, words: bytes, source: object, run_key: RunKey | None = None) -> bytes | None:
    """Return what words lock; None where they are wrong. InputError on a text that nothing locked."""
    try:
        found = msgspec.json.decode(_decoded(text), type=Locked)
        key = _stretched(words, found.salt, Cost(found.passes, found.memory_bytes))
        opened: bytes = _nacl("secret").SecretBox(run_key.joined(key) if run_key else key).decrypt(found.box)
    except _nacl("exceptions").CryptoError:
        return None
    except (ValueError, TypeError) as error:
        raise InputError(source, "locked", "was changed", "take the file from a backup") from error
    return opened


def _words(passphrase: str) -> bytes:
    """Return the bytes of a passphrase; one letter with an accent may be typed as two on another machine."""
    return unicodedata.normalize("NFC", passphrase).encode()


def _stretched(words: bytes, salt: bytes, cost: Cost) -> bytes:
    argon2id = _nacl("pwhash").argon2id
    key: bytes = argon2id.kdf(32, words, salt, opslimit=cost.passes, memlimit=cost.memory_bytes)
    return key


def _padded(data: bytes, room_bytes: int) -> bytes:
    # the first four bytes tell where the data end and the padding begins
    whole = len(data) + 4
    return len(data).to_bytes(4, "big") + data + bytes(-whole % room_bytes)


def _bare(padded: bytes) -> bytes:
    return padded[4 : 4 + int.from_bytes(padded[:4], "big")]


def _decoded(text: str) -> bytes:
    try:
        return base64.b64decode(text, validate=True)
    except ValueError:
        return b""


def _nacl(part: str) -> ModuleType:
    """Import a part of PyNaCl, which only studies need. BuildError."""
    import importlib

    try:
        return importlib.import_module(f"nacl.{part}")
    except ImportError as error:
        raise BuildError("blind studies need PyNaCl: pip install 'fdvv[study]'") from error
