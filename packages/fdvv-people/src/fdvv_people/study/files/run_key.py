"""The run key of a study: what its sessions need besides people's codes. It is in no file.

It follows from the key holder's private key, one way: whoever has it can run sessions, and opens no trial
that was sealed. The key holder's passphrase brings it into the memory of the studio for as long as that runs.
"""

from __future__ import annotations

import hashlib
import hmac
import secrets

CLOSED = "sessions are not open in this process"
OPEN_FIRST = "the key holder opens them with the passphrase: in the studio, under People"


class RunKey:
    """A secret of 32 bytes, and the study it belongs to.

    Attributes
    ----------
    seal : the study's sealing key, as text. counted : how often the study's counts were written, as far as
        this process knows: the one number that a rolled back folder cannot change.
    """

    def __init__(self, secret: bytes, seal: str) -> None:
        self._secret, self.seal, self.counted = secret, seal, 0

    @classmethod
    def of(cls, private: bytes, seal: str) -> RunKey:
        """Derive the run key from a key holder's private key."""
        return cls(hashlib.blake2b(key=private, person=b"fdvv run key", digest_size=32).digest(), seal)

    @classmethod
    def drawn(cls) -> RunKey:
        """Draw a run key of no study."""
        return cls(secrets.token_bytes(32), "")

    def joined(self, code_key: bytes) -> bytes:
        """Return the key of a box that needs both this key and one that was stretched from a code."""
        return hashlib.blake2b(code_key, key=self._secret, person=b"fdvv schedule", digest_size=32).digest()

    def mark(self, text: str) -> str:
        """Return the mark of a text, which cannot be made without this key."""
        return hashlib.blake2b(
            text.encode(), key=self._secret, person=b"fdvv mark", digest_size=32
        ).hexdigest()

    def made(self, mark: str, text: str) -> bool:
        """Whether a text carries the mark of this key."""
        return hmac.compare_digest(mark.encode(), self.mark(text).encode())

    def __repr__(self) -> str:
        return "RunKey(…)"
